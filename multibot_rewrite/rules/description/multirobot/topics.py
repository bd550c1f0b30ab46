# SPDX-License-Identifier: Apache-2.0
"""Topics that two robots of one description would share."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.rules.description.multirobot.shared import (
    claims_of,
    inserted,
    is_plain,
    process_wide_plugins,
    tag_of,
)
from multibot_rewrite.rules.facts.source_values import claim_is_fixed
from multibot_rewrite.rules.subject import Subject

ROS_KINDS = ("topic", "service")
REMAP_FORMS = ("remap", "argument")
# What a plugin has a default of, in a message.
NOUNS = {"topic": "topic", "service": "service", "stem": "name"}
GZ_SECTIONS = ("plugin gz-", "element sensor", "element gazebo", "sensor ")


@rule(
    "MB401",
    "absolute-topic",
    NOTE,
    what="A plugin's topic or service is absolute, or its remap rule has an absolute target.",
    why="A ROS namespace moves relative names only (rcl expand_topic_name.c): both robots "
    "subscribe to one /cmd_vel, and their sensor data is mixed on one topic.",
    fix="Leave out the leading slash and start each robot in its namespace, or rename it for each "
    "robot with urdf-postfix.",
    bad="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><remapping>cmd_vel:=/cmd_vel</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="d" filename="libgazebo_ros_diff_drive.so">\n'
    "    <ros><remapping>cmd_vel:=drive</remapping></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
)
def absolute_topic(subject: Subject) -> Iterator[Problem]:
    """Absolute ROS names that are not shared by the settings."""
    has_wide = controller_way(subject.inventory.release).process_wide
    wide = process_wide_plugins(subject) if has_wide else set()
    for claim in claims_of(subject, ROS_KINDS):
        name = _target(claim)
        if name[:1] != "/" or not is_plain(name) or _is_gz(claim):
            continue
        if name.strip("/") in subject.settings.naming.shared_topics | set(TF_TOPICS):
            continue
        # MB426 reports these.
        if claim.site.form in REMAP_FORMS and wide and wide.intersection(_plugins_around(claim)):
            continue
        if claim_is_fixed(subject, claim):
            message = f"{tag_of(claim)} {name!r} is absolute: a namespace does not move it"
            hint = f"{name[1:]!r} follows the robot's namespace"
            yield Problem(claim.element, message, claim.attribute, hint)


def _plugins_around(claim: Claim) -> Iterator[_Element]:
    return claim.element.iterancestors("plugin")


def _target(claim: Claim) -> str:
    """The topic that a claim names; of a remap rule, its target."""
    if claim.site.form not in REMAP_FORMS:
        return claim.value.strip()
    found = split_remap(claim.value)
    return found.target if found else ""


@rule(
    "MB402",
    "gz-topic-shared",
    NOTE,
    what="A sensor or system of gz-sim has a topic that is the same for every copy of the robot.",
    why="gz topics are global in their partition, and a ROS namespace does not move them. One "
    "command drives both robots, both lidars publish on one topic, and ros_gz_bridge cannot "
    "separate them.",
    fix="Leave the element out: then gz puts the model's name into the topic. Or give each "
    "robot its own topic with a xacro argument or urdf-postfix.",
    bad='<link name="a"/>\n'
    '<gazebo reference="a">\n'
    '  <sensor name="l" type="gpu_lidar"><topic>scan</topic></sensor>\n'
    "</gazebo>\n",
    good='<link name="a"/><gazebo reference="a"><sensor name="l" type="gpu_lidar"/></gazebo>',
    line=3,
)
def gz_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Literal gz topics."""
    claims = [it for it in claims_of(subject, ROS_KINDS) if _is_gz(it)]
    if not claims or _is_classic(subject):
        return
    for claim in claims:
        topic = claim.value.strip()
        if not is_plain(topic) or topic.strip("/") in subject.settings.naming.shared_topics:
            continue
        if not claim_is_fixed(subject, claim):
            continue
        message = f"{tag_of(claim)} {topic!r} is the same gz topic for every copy of the robot"
        yield Problem(
            claim.element, message, claim.attribute, "leave it out, or set one for each robot"
        )


def _is_gz(claim: Claim) -> bool:
    return claim.site.section.startswith(GZ_SECTIONS)


def _is_classic(subject: Subject) -> bool:
    """Is it for Gazebo Classic, which itself puts the model's name before sensor topics?"""
    from multibot_rewrite.spelling.bridged_topics import GZ_LIBRARIES, plugin_libraries

    keys = plugin_libraries(subject.inventory)
    return bool(keys) and not any(key.startswith(GZ_LIBRARIES) for key in keys)


@rule(
    "MB413",
    "default-topic-shared",
    NOTE,
    what="A plugin or hardware class uses a default topic or name that a namespace does not move.",
    why="All robots' components of that class use the same absolute topic: each joint command "
    "reaches every robot.",
    fix="Set the name, a different one for each robot; urdf-postfix inserts it.",
    bad='<ros2_control name="h" type="system">\n'
    "  <hardware>\n"
    "    <plugin>topic_based_ros2_control/TopicBasedSystem</plugin>\n"
    '    <param name="joint_states_topic">states</param>\n'
    "  </hardware>\n"
    "</ros2_control>\n",
    good='<ros2_control name="h" type="system">\n'
    "  <hardware>\n"
    "    <plugin>topic_based_ros2_control/TopicBasedSystem</plugin>\n"
    '    <param name="joint_states_topic">states</param>\n'
    '    <param name="joint_commands_topic">commands</param>\n'
    "  </hardware>\n"
    "</ros2_control>\n",
)
def default_topic_shared(subject: Subject) -> Iterator[Problem]:
    """Topics, services and prefixes of names that would have to be inserted for a robot."""
    for element, (kind, old, _) in inserted(subject):
        if kind in NOUNS:
            message = f"its default {NOUNS[kind]} {old!r} is the same for every robot"
            yield Problem(element, message, None, "set it for each robot")
