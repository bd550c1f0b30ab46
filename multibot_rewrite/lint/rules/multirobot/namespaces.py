"""Namespaces of plugins, and the robot description that they read."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.findings.finding import NOTE
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.facts.source_values import claim_is_fixed, is_fixed, starts_of
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.lint.rules.multirobot.shared import APART, claims_of, is_plain
from multibot_rewrite.model import Claim
from multibot_rewrite.rewriters.insert import insertions

DESCRIPTIONS = ("robot_param", "robotParam", "robot_param_node")


@rule(
    "MB403",
    "hard-coded-namespace",
    NOTE,
    what="A plugin's namespace is written out in the description.",
    why="Both copies put their nodes and topics under it: in Gazebo Classic of ROS 2 the second "
    "node of one name is refused (gazebo_ros node.hpp), in ROS 1 both answer on one topic.",
    fix="Make it a xacro argument, or let urdf-postfix put each robot's name in front; "
    "spawn_entity.py -robot_namespace overwrites it.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros><namespace>/demo'
    "</namespace></ros></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><ros/></plugin></gazebo>',
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
    what="Plugins that make ROS nodes stand in no namespace.",
    why="The second robot's nodes have the same full names and topics: Gazebo Classic of ROS 2 gives "
    "the second plugin no node at all, and parameters and services answer for one robot only.",
    fix="Spawn each robot with -robot_namespace, or give the plugins a <namespace>: a xacro argument, "
    "or urdf-postfix. ros_gz_sim's create has no such option.",
    bad='<gazebo><plugin name="d" filename="libgazebo_ros_joint_state_publisher.so"><joint_name>j'
    "</joint_name></plugin></gazebo>",
    good='<gazebo><plugin name="d" filename="libgazebo_ros_joint_state_publisher.so"><ros>'
    "<namespace>r1/</namespace></ros></plugin></gazebo>",
)
def no_namespace(subject: Subject) -> Iterator[Problem]:
    """The first plugin without a namespace, and how many there are."""
    declared = subject.inventory.declared
    bare = []
    for host in subject.inventory.hosts:
        rewriter = host.node.section
        if rewriter is None or not any("namespace" in it.kinds for it in rewriter.sites):
            continue
        items = insertions(host.element, rewriter, declared, APART)
        if any(it.kind == "namespace" for it in items):
            bare.append(host.element)
    if bare:
        more = f" and {len(bare) - 1} more" if len(bare) > 1 else ""
        message = f"plugin {bare[0].get('name', '')!r}{more} in no namespace"
        yield Problem(bare[0], message, None, "give it one for each robot")


@rule(
    "MB410",
    "one-robot-description",
    NOTE,
    what="A plugin reads the robot description from an absolute name.",
    why="Every copy reads the first robot's description: its controllers then claim joints that the "
    "second robot, where it was renamed, does not have, and wait for a node outside their namespace.",
    fix="Name it relative to the plugin's namespace: robot_description, robot_state_publisher.",
    bad='<gazebo><plugin name="c" filename="libgazebo_ros_control.so"><robotParam>'
    "/robot_description</robotParam></plugin></gazebo>",
    good='<gazebo><plugin name="c" filename="libgazebo_ros_control.so"><robotParam>'
    "robot_description</robotParam></plugin></gazebo>",
)
def one_robot_description(subject: Subject) -> Iterator[Problem]:
    """Absolute names of descriptions and of the nodes that hold them."""
    found = [it for it in _children(subject, DESCRIPTIONS) if (it.text or "").strip()[:1] == "/"]
    starts = starts_of(subject, found)
    for element in found:
        if is_fixed(subject, starts[element], ""):
            message = f"<{element.tag}> {(element.text or '').strip()!r} is the same for all robots"
            yield Problem(element, message, "", "leave out what stands before the last slash")


def _children(subject: Subject, tags: tuple[str, ...]) -> list[_Element]:
    plugins = [it.element for it in subject.inventory.hosts if it.element.tag == "plugin"]
    return [child for plugin in plugins for child in plugin.iterchildren(*tags)]
