# SPDX-License-Identifier: Apache-2.0
"""Namespaces of plugins and of Gazebo itself, and the robot description that plugins read."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.checks import hazards
from multibot_rewrite.description.checks.model_namespaces import ignored_namespaces, used_namespaces
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.insert import lacks_namespace
from multibot_rewrite.rules.description.multirobot.shared import (
    APART,
    AS_WRITTEN,
    claims_of,
    is_plain,
)
from multibot_rewrite.rules.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB403",
    "hard-coded-namespace",
    NOTE,
    what="A plugin's namespace is fixed in the description.",
    why="All copies of the robot put their nodes and topics in it. Gazebo Classic for ROS 2 "
    "rejects the second node with the same name (gazebo_ros node.hpp). In ROS 1 both respond on "
    "one topic.",
    fix="Make it a xacro argument, or let urdf-postfix put each robot's name in front; "
    "spawn_entity.py -robot_namespace overrides it.",
    bad="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><namespace>/demo</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros/></plugin></gazebo>',
    line=3,
)
def hard_coded_namespace(subject: Subject) -> Iterator[Problem]:
    """Each literal namespace, at its first place."""
    found: dict[str, list[Claim]] = {}
    for claim in claims_of(subject, ("namespace",)):
        if is_plain(claim.value) and claim_is_fixed(subject, claim):
            found.setdefault(claim.value, []).append(claim)
    for value, claims in found.items():
        where = f" in {len(claims)} plugins" if len(claims) > 1 else ""
        message = f"the namespace {value!r}{where} is the same for every copy of the robot"
        yield Problem(claims[0].element, message, claims[0].attribute, "make it a xacro argument")


@rule(
    "MB409",
    "no-namespace",
    NOTE,
    what="Plugins with ROS nodes have no namespace.",
    why="The second robot's nodes have the same full names and topics. Gazebo Classic for ROS 2 "
    "creates no node for the second plugin. Parameters and services respond for one robot only.",
    fix="Spawn each robot with -robot_namespace, or give the plugins a <namespace>: a xacro argument, "
    "or urdf-postfix. ros_gz_sim's create has no such option, in no release (ros_gz#925 is open).",
    bad="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_joint_state_publisher.so">\n'
    "    <joint_name>j</joint_name>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_joint_state_publisher.so">\n'
    "    <ros><namespace>r1/</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=2,
)
def no_namespace(subject: Subject) -> Iterator[Problem]:
    """The first plugin without a namespace, and how many there are."""
    inventory = subject.inventory
    bare = [
        element
        for element, section in inventory.served
        if lacks_namespace(element, section, inventory.declared, APART)
    ]
    if bare:
        have = f"and {len(bare) - 1} more have" if len(bare) > 1 else "has"
        message = f"plugin {bare[0].get('name', '')!r} {have} no namespace"
        yield Problem(bare[0], message, None, "give each robot its own")


@rule(
    "MB410",
    "one-robot-description",
    NOTE,
    what="A plugin reads the robot description from an absolute name.",
    why="Every copy reads the first robot's description. If the second robot was renamed, its "
    "controllers claim joints that it does not have. They also wait for a node outside their "
    "namespace.",
    fix="Use a name relative to the plugin's namespace: robot_description, robot_state_publisher.",
    bad="<gazebo>\n"
    '  <plugin name="c" filename="libgazebo_ros_control.so">\n'
    "    <robotParam>/robot_description</robotParam>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="c" filename="libgazebo_ros_control.so">\n'
    "    <robotParam>robot_description</robotParam>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
)
def one_robot_description(subject: Subject) -> Iterator[Problem]:
    """Absolute names of descriptions and of the nodes that hold them."""
    found = [*hazards.one_description(subject.inventory, AS_WRITTEN)]
    starts = starts_of(subject, [it.element for it in found])
    yield from (it for it in found if is_fixed(subject, starts[it.element], ""))


_MODEL = """\
<gazebo>
  <model name="base"{}>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <topic>cmd_vel</topic>
    </plugin>
  </model>
</gazebo>
"""


@rule(
    "MB419",
    "ignored-model-namespace",
    WARNING,
    what="A model has a namespace that the release's Gazebo does not read.",
    why="sdformat reads <model namespace> and <include><namespace> from version 17 on. Fortress, "
    "Harmonic, Ionic and Jetty, which Humble to Lyrical have, print a warning and go on without "
    "it. The topics of all copies are the same.",
    fix="Set the topics of the plugins, or let urdf-postfix put each robot's name into them; for a "
    "Gazebo built from main say --distro rolling.",
    bad=_MODEL.format(' namespace="robot"'),
    good=_MODEL.format(""),
    line=2,
)
def ignored_model_namespace(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return ignored_namespaces(subject.inventory, subject.tree)


@rule(
    "MB429",
    "model-namespace-in-use",
    WARNING,
    what="Plugins put the namespace of their model in front of their relative topics, in some builds "
    "of Gazebo.",
    why="For DiffDrive it is gz-sim's pull request 3878, which no release has. urdf-postfix "
    "puts the robot's name into the namespace and leaves relative topics. A Gazebo without "
    "the change ignores the namespace, so all robots have the same topics.",
    fix="Write absolute topics, which all builds take as they are; for the Gazebo of packages name "
    "another release than rolling with --distro.",
    bad=_MODEL.format(' namespace="robot"'),
    good=_MODEL.format(""),
    line=2,
    options={"distro": "rolling"},
)
def model_namespace_in_use(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return used_namespaces(subject.inventory, subject.tree)
