"""What the named robots would share in the running system, as the programs read the rewritten file."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.multirobot.shared import APART, AS_WRITTEN, TWO
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

ODOMETRY_APART = make_naming("tf-per-robot", shared_topics=[*SHARED_TOPICS, "tf_static"])

IN_FRONT = make_naming("postfix", affix="prefix")


@memoized
def _shared(subject: Subject) -> tuple[Problem, ...]:
    """What a rewrite for the named robots would report; nothing where it would be refused."""
    if not subject.settings.robots:
        return ()
    # Without robots a lint loads none of it.
    from multibot_rewrite.description.checks.meeting import shared_by_all
    from multibot_rewrite.description.steps.apply import cut
    from multibot_rewrite.description.steps.plan import make_plan

    naming, document = subject.settings.naming, subject.document
    plan = make_plan(subject.inventory, naming)
    if any(it.level == ERROR for it in plan.findings):
        return ()
    pieces = cut(document.source, plan.edits)
    return tuple(shared_by_all(document, pieces, naming, subject.tree.vocabulary))


def _of_code(code: str, subject: Subject) -> Iterator[Problem]:
    return (it for it in _shared(subject) if it.code == code)


sensor_names_collide = rule(
    "MB425",
    "lookup-in-the-world",
    WARNING,
    what="A plugin looks a sensor, link or light up by its bare name in the whole world, and all "
    "robots have it under the same name.",
    why="gz_ros2_control takes the first IMU with that name; the realsense and kobuki plugins find "
    "none if two have it: the second robot reads the first one's data, or nothing.",
    fix="Use the layout called both (L3), which renames sensors for each robot.",
    bad='<link name="a"/>\n'
    '<gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>\n'
    '<ros2_control name="h" type="system">\n'
    "  <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>\n"
    '  <sensor name="imu"/>\n'
    "</ros2_control>\n",
    good='<link name="a"/><gazebo reference="a"><sensor name="imu" type="imu"/></gazebo>',
    line=3,
    options={"robots": TWO, "naming": AS_WRITTEN},
)(partial(_of_code, "MB425"))

shared_topic = rule(
    "MB430",
    "shared-topic",
    WARNING,
    what="After a rewrite all robots would still have the same topic or service.",
    why="The nodes of all robots use it: one command moves all robots, or their data is mixed. "
    "A rewrite leaves a topic as it is where it holds a placeholder, or where the plugin takes no "
    "parameter or remap rule for it.",
    fix="Write a topic that can be renamed for each robot, give the plugin a namespace, or allow it "
    "with --shared-topics.",
    bad='<link name="a"/>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="lidar" type="gpu_lidar">\n'
    "    <topic>{name}/scan</topic>\n"
    "  </sensor>\n"
    "</gazebo>\n",
    good='<link name="a"/>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="lidar" type="gpu_lidar">\n'
    "    <topic>scan</topic>\n"
    "  </sensor>\n"
    "</gazebo>\n",
    line=3,
    options={"robots": TWO, "naming": APART},
)(partial(_of_code, "MB430"))

controllers_apart = rule(
    "MB435",
    "controllers-without-rules",
    WARNING,
    what="All robots would have a topic of their controllers. From ros2_control 6.5 on (Lyrical) "
    "controllers take no remap rules of the plugin that loads them.",
    why="The controllers keep the name in their code: the odometry of all robots is on one /tf, and "
    "the tree of each robot jumps between them. The rule in the plugin is applied to the controller "
    "manager alone.",
    fix="Start each controller with its spawner and its option --controller-ros-args "
    '"-r /tf:=tf"; multibot plan and build print the lines if a stack names the controllers '
    "(--stack gz_ros2_control).",
    bad='<link name="a"/>\n'
    "<gazebo>\n"
    '  <plugin name="c" filename="gz_ros2_control-system">\n'
    "    <parameters>controllers.yaml</parameters>\n"
    "    <ros><remapping>/tf:=tf</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good='<link name="a"/>\n'
    "<gazebo>\n"
    '  <plugin name="d" filename="gz-sim-diff-drive-system">\n'
    "    <left_joint>l</left_joint>\n"
    "    <right_joint>r</right_joint>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
    options={"robots": TWO, "naming": ODOMETRY_APART},
)(partial(_of_code, "MB435"))

lost_rule = rule(
    "MB436",
    "lost-remap-rule",
    WARNING,
    what="A remap rule of a plugin would match no name after the rewrite that it matched before.",
    why="rcl compares the left side with the full name of a topic: where both get the robot's name "
    "in other places the rule does nothing, and the topic has the name of the plugin's code.",
    fix="Write the topic and the left side of its rule the same way, best without a slash in front.",
    bad="<gazebo>\n"
    '  <plugin name="imu" filename="libhector_gazebo_ros_imu.so">\n'
    "    <ros><namespace>a</namespace><remapping>imu:=imu/raw</remapping></ros>\n"
    "    <topicName>/a/imu</topicName>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="imu" filename="libhector_gazebo_ros_imu.so">\n'
    "    <ros><namespace>a</namespace><remapping>imu:=imu/raw</remapping></ros>\n"
    "    <topicName>imu</topicName>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=2,
    options={"robots": TWO, "naming": IN_FRONT},
)(partial(_of_code, "MB436"))

shared_node = rule(
    "MB431",
    "shared-node",
    WARNING,
    what="After a rewrite the node of a plugin would have the same full name for all robots.",
    why="Nodes of one name cannot be told apart: parameters and services of the wrong one are "
    "called, and a launch file's parameters reach both.",
    fix="Give the plugin a namespace without a placeholder, or another name.",
    bad="<gazebo>\n"
    '  <plugin name="drive" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><namespace>{name}</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="drive" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><namespace>demo</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=2,
    options={"robots": TWO, "naming": APART},
)(partial(_of_code, "MB431"))

shared_frame = rule(
    "MB432",
    "shared-frame",
    WARNING,
    what="After a rewrite all robots would still have the same frame, in a layout that gives each "
    "robot its own frames.",
    why="The transforms of all robots meet in one frame: it has two parents, or it jumps between "
    "the robots.",
    fix="Write the frame without a placeholder, or allow it with --shared-frames.",
    bad='<link name="a"/>\n'
    "<gazebo>\n"
    '  <plugin name="drive" filename="libgazebo_ros_diff_drive.so">\n'
    "    <odometry_frame>__odom__</odometry_frame>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good='<link name="a"/>\n'
    "<gazebo>\n"
    '  <plugin name="drive" filename="libgazebo_ros_diff_drive.so">\n'
    "    <odometry_frame>odom</odometry_frame>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
    options={"robots": TWO, "naming": APART},
)(partial(_of_code, "MB432"))
