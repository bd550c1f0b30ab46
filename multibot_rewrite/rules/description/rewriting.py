# SPDX-License-Identifier: Apache-2.0
"""MB9: what a rewrite for several robots leaves as it is, because its meaning is not known."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.companions.kinds import EVERY
from multibot_rewrite.description.checks.audit import (
    other_releases,
    other_ros,
)
from multibot_rewrite.description.checks.mentions import (
    MENTIONED,
    as_problem,
    unclaimed_mentions,
    usual_names,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import unknown_parts
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import slot_values
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB901",
    "name-of-unknown-use",
    WARNING,
    what="A value, key, parameter or port is not known to hold names. But it has the name of a "
    "link, joint, light, frame or topic of the robot. Or it has /tf, while each robot has its own "
    "tf topic. Of a file it is a note where it is not sure which robot it is for.",
    why="It stays as it is when the file is written for several robots. If it is a name, a plugin "
    "or node looks for a link, frame or joint that no longer has it. Or two robots use the same "
    "topic.",
    fix="Say whether it is a name: for a description in a vocabulary file, for a parameter in "
    "a file under `nodes:` of the fleet file. In other files rename it by hand for each "
    "robot.",
    bad='<link name="gripper_left"/><custom><grasp part="gripper_left"/></custom>',
    good='<link name="gripper_left"/><custom><grasp part="left"/></custom>',
    formats=(URDF, SRDF, *EVERY),
)
def unclaimed_mention(subject: Subject) -> Iterator[Problem]:
    """Values that no site claims and that hold a declared name."""
    inventory = subject.inventory
    names = {name for kind in MENTIONED for name in inventory.declared[kind]}
    values, usual = slot_values(subject.document.root), usual_names(subject.settings.naming)
    mentions = unclaimed_mentions(inventory, values, names, subject.tree, usual)
    yield from map(as_problem, mentions)


Audit = Callable[[Inventory, Tree], Iterator[Problem]]


def _audit(audit: Audit, subject: Subject) -> Iterator[Problem]:
    """What an audit of the vocabulary finds in a document."""
    return audit(subject.inventory, subject.tree)


@memoized
def _unknown_parts(subject: Subject) -> tuple[Problem, ...]:
    return tuple(unknown_parts(subject.inventory, subject.tree))


def _unknown(code: str, subject: Subject) -> Iterator[Problem]:
    """What runs in a document and is not known, of one code."""
    return (it for it in _unknown_parts(subject) if it.code == code)


unknown_plugin = rule(
    "MB902",
    "unknown-plugin",
    NOTE,
    what="A plugin or a type of sensor is not in the vocabulary. Or its section does not say what "
    "it opens: topics, services, files, network addresses. Or no Gazebo of the release loads it.",
    why="Its parameters for links, joints, frames or topics stay the same for every robot, "
    "unless other plugins have parameters of these names. Its own topics may collide, too.",
    fix="Add a section for it to a vocabulary file, with a line for each topic and service; where it "
    "opens none, `opens: nothing`.",
    bad='<gazebo><plugin name="p" filename="libmy_company_thing.so"/></gazebo>',
    good='<gazebo><plugin name="gz::sim::systems::OdometryPublisher" '
    'filename="gz-sim-odometry-publisher-system"/></gazebo>',
)(partial(_unknown, "MB902"))

unknown_hardware_class = rule(
    "MB903",
    "unknown-hardware",
    NOTE,
    what="A ros2_control hardware class is not in the vocabulary, or its section does not say what it "
    "opens.",
    why="One of its parameters may be a name, or a prefix that the driver puts in front of names. "
    "Such a parameter is not changed: it is the same for every robot. And its code may open topics "
    "that are the same for all.",
    fix="Add a section for it to a vocabulary file; where it opens nothing, `opens: nothing`.",
    bad='<ros2_control name="h" type="system">\n'
    "  <hardware>\n"
    "    <plugin>my_company/Arm</plugin>\n"
    '    <param name="side">left</param>\n'
    "  </hardware>\n"
    "</ros2_control>\n",
    good='<ros2_control name="h" type="system">\n'
    "  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>\n"
    "</ros2_control>\n",
)(partial(_unknown, "MB903"))

parameter_of_ros_1 = rule(
    "MB904",
    "parameter-of-ros-1",
    NOTE,
    what="A Gazebo Classic plugin of ROS 2 has parameters that only its ROS 1 version reads.",
    why="A plugin with a <ros> is one of ROS 2, which takes its topics from there. A topic, frame "
    "or joint in such a parameter has no effect, with one robot or several.",
    fix="Delete it, or say it with <ros> and the parameters of the ROS 2 plugin.",
    bad="<gazebo>\n"
    '  <plugin name="move" filename="libgazebo_ros_planar_move.so">\n'
    "    <ros><namespace>/demo</namespace></ros>\n"
    "    <commandTopic>cmd_vel</commandTopic>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="move" filename="libgazebo_ros_planar_move.so">\n'
    "    <ros><namespace>/demo</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=2,
)(partial(_audit, other_ros))

row_of_another_release = rule(
    "MB905",
    "row-of-another-release",
    NOTE,
    what="A plugin has a parameter that the vocabulary knows, and its release does not read it.",
    why="The plugin reads it in other releases only. In this one it has no effect, so no name in it is "
    "renamed.",
    fix="Delete the parameter, or name the release that the description is for: --distro, or distro: "
    "in a fleet file.",
    bad='<gazebo><plugin name="p" filename="libmy_lamp.so"><lamp_link>a</lamp_link></plugin></gazebo>',
    good='<gazebo><plugin name="p" filename="libmy_lamp.so"><link>a</link></plugin></gazebo>',
    beside={
        "my.vocab": "[plugin my_lamp]\nlamp_link uses link releases=<=jazzy\n"
        "link uses link releases=kilted+\n"
    },
    options={"vocabulary": ["my.vocab"], "distro": "lyrical"},
)(partial(_audit, other_releases))

included_model = rule(
    "MB906",
    "included-model",
    NOTE,
    what="A model of an SDF, or a <gazebo>, includes a model of another file.",
    why="That file is not read with this one. Its sensors and plugins have the same topics, nodes "
    "and frames for all robots, unless they are made of the model's name.",
    fix="Rewrite its model.sdf for each robot, and write the model in place of its <include>.",
    bad='<?xml version="1.0"?><sdf version="1.9"><model name="rover">\n'
    '  <link name="base"/>\n'
    "  <include><uri>model://lidar</uri><name>front</name></include>\n"
    "</model></sdf>\n",
    good='<?xml version="1.0"?><sdf version="1.9"><model name="rover">\n'
    '  <link name="base"/>\n'
    '  <model name="front"><link name="l"/></model>\n'
    "</model></sdf>\n",
    line=3,
)(partial(_unknown, "MB906"))
