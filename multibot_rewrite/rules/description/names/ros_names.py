# SPDX-License-Identifier: Apache-2.0
"""Names that are not valid in ROS: frames, topics, interfaces, the robot."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.base.naming import FRAME_KINDS, NOT_PLAIN
from multibot_rewrite.base.rosnames import check_topic_name, propose_token, split_remap
from multibot_rewrite.companions.kinds import EVERY
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import value_slot
from multibot_rewrite.rules.description.names.shared import SUBSTITUTION, TOKEN, name_of_robot
from multibot_rewrite.rules.subject import Subject

# Interfaces that ros2_control has names for (hardware_interface_type_values.hpp).
STANDARD = frozenset(("position", "velocity", "effort", "acceleration"))
ROS_KINDS = frozenset({"topic", "service", "namespace"})
# ROS 1, ROS 2 and both Gazebos agree on these.
_ALLOWED_EVERYWHERE = lazy_compile(r"[\w/~]*", re.ASCII)


@rule(
    "MB301",
    "leading-slash",
    WARNING,
    what="A frame starts with a slash, in a description or a file beside it. In a file it is a note "
    "where the node takes the slash off in this release; then it is written without it.",
    why="tf2 lookups throw: \"tf2 frame_ids cannot start with a '/'\". robot_state_publisher sends "
    "a link's name as it is, so a link with a leading slash cannot be looked up. Some nodes took "
    "the slash off up to Kilted and no longer do.",
    fix="Delete the slash.",
    bad='<link name="lidar"/>\n'
    "<gazebo>\n"
    '  <plugin name="p" filename="libgazebo_ros_imu_sensor.so">\n'
    "    <frame_name>/lidar</frame_name>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good='<link name="lidar"/>\n'
    "<gazebo>\n"
    '  <plugin name="p" filename="libgazebo_ros_imu_sensor.so">\n'
    "    <frame_name>lidar</frame_name>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=4,
    fixed='<link name="lidar"/>\n'
    "<gazebo>\n"
    '  <plugin name="p" filename="libgazebo_ros_imu_sensor.so">\n'
    "    <frame_name>lidar</frame_name>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    formats=(URDF, SRDF, *EVERY),
)
def leading_slash(subject: Subject) -> Iterator[Problem]:
    """With a fix where the frame without the slash is a link. Plugins know /world."""
    shared = subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if claim.value[:1] != "/" or claim.site.form != "whole":
            continue
        name = claim.value[1:]
        if claim.site.kinds[0] in FRAME_KINDS and name and name not in shared:
            known = name in subject.inventory.declared["link"]
            message = f"frame {claim.value!r} starts with a slash, which tf2 refuses"
            edits = _without_slash(subject, claim) if known else ()
            yield Problem(claim.element, message, claim.attribute, "delete the slash", edits)


def _without_slash(subject: Subject, claim: Claim) -> tuple[Edit, ...]:
    slot = value_slot(subject.document.source, claim.start, claim.attribute, claim.value)
    if slot is None or subject.document.source[slot[0] : slot[0] + 1] != b"/":
        return ()
    return (Edit(slot[0], slot[0] + 1, b"", None),)


@rule(
    "MB304",
    "slash-in-joint",
    NOTE,
    what="The name of a joint, sensor or gpio in <ros2_control> contains a slash.",
    why="Its interfaces are called NAME/INTERFACE, and the controller manager splits that at the "
    "first slash. If there is a controller 'arm', arm/j1/position is taken as one of its "
    "interfaces.",
    fix="Use an underscore, in the URDF and in the controllers' parameters; or give no controller "
    "the name before the slash.",
    bad='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    '  <joint name="arm/j1"><state_interface name="position"/></joint>\n'
    "</ros2_control>\n",
    good='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    '  <joint name="arm_j1"><state_interface name="position"/></joint>\n'
    "</ros2_control>\n",
    line=3,
)
def slash_in_joint(subject: Subject) -> Iterator[Problem]:
    """Every component that has interfaces."""
    for system in subject.elements.every("ros2_control"):
        for part in system.iterchildren("joint", "sensor", "gpio"):
            name = part.get("name", "")
            if "/" in name and SUBSTITUTION not in name:
                cut = name.partition("/")[0]
                owner = f"its interfaces are taken as those of {cut!r}"
                message = f"{part.tag} {name!r} contains a slash: {owner}"
                yield Problem(part, message, "name", f"use {name.replace('/', '_')!r}")


@rule(
    "MB311",
    "robot-name",
    NOTE,
    what="The robot's name is not a valid ROS name: empty, or with spaces, hyphens, dots or a "
    "leading digit.",
    why="Spawners use it for the model, and Gazebo puts it into topics like /model/NAME/odometry. "
    "ROS rejects these when they are bridged. It also rejects a namespace or node name made from "
    "it.",
    fix="Use letters, digits and underscores.",
    bad='<robot name="my-robot"><link name="a"/></robot>',
    good='<robot name="my_robot"><link name="a"/></robot>',
)
def robot_name(subject: Subject) -> Iterator[Problem]:
    """Names with '::' are MB305."""
    name = name_of_robot(subject)
    if name is None or "::" in name or TOKEN.fullmatch(name):
        return
    hint = f"use {propose_token(name)!r}" if name.strip() else "add one"
    yield Problem(
        subject.document.root, f"robot name {name!r} is not a valid ROS name", "name", hint
    )


@rule(
    "MB312",
    "invalid-ros-name",
    WARNING,
    what="A topic, service, namespace or node name, of a plugin or in a file beside the description, "
    "is not a valid ROS name. Without ros_topic_name the topic of a bridge is the gz topic, where a "
    "part may be a number.",
    why="rcl throws InvalidTopicNameError, or the node is not created. The plugin does not load, "
    "or publishes nothing. rcl also rejects a file with such a section, and a topic is not "
    "bridged.",
    fix="Use letters, digits, underscores and slashes, without a leading digit.",
    bad="<gazebo>\n"
    '  <plugin name="p" filename="libgazebo_ros_imu_sensor.so">\n'
    "    <ros><namespace>my-robot</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    good="<gazebo>\n"
    '  <plugin name="p" filename="libgazebo_ros_imu_sensor.so">\n'
    "    <ros><namespace>my_robot</namespace></ros>\n"
    "  </plugin>\n"
    "</gazebo>\n",
    line=3,
    formats=(URDF, *EVERY),
)
def invalid_ros_name(subject: Subject) -> Iterator[Problem]:
    """Values that are relative to a ROS namespace; those with a substitution are skipped."""
    for claim in subject.inventory.claims:
        site = claim.site
        if not site.namespaced or site.kinds[0] not in ROS_KINDS:
            continue
        for name in _ros_names(claim):
            if fault := _name_fault(name, site.section):
                message = f"{site.kinds[0]} {name!r} is not a valid ROS name: {fault}"
                yield Problem(claim.element, message, claim.attribute)


def _ros_names(claim: Claim) -> list[str]:
    """The names in a value: itself, or both sides of a remap rule."""
    sides = [claim.value] if claim.site.form == "whole" else []
    if claim.site.form in ("remap", "argument"):
        rule = split_remap(claim.value)
        sides = [rule.source, rule.target] if rule and not rule.source.startswith("__") else []
    return [it for it in sides if it.strip("/") and NOT_PLAIN.isdisjoint(it.replace(" ", ""))]


def _name_fault(name: str, section: str) -> str:
    """Why rcl rejects a name; in a plugin that may be for ROS 1 or Gazebo, why all of them do."""
    if _ALLOWED_EVERYWHERE.fullmatch(name) and not section.startswith("block ros"):
        return ""
    fault = check_topic_name(name.rstrip("/"))
    return fault.reason if fault else ""


@rule(
    "MB313",
    "odd-interface-name",
    WARNING,
    what="A <ros2_control> component or interface has an empty name, or a component's name has "
    "white space. Or an interface's name has white space beside position, velocity, effort or "
    "acceleration.",
    why="Controllers ask for NAME/INTERFACE exactly: the parser strips white space around a name "
    "but not inside it, and an empty name cannot be requested. Interfaces of a driver's own may have "
    "it on purpose, as the registers of Dynamixel's: 'Present Position'.",
    fix="Write the name without spaces, or two interfaces for two names.",
    bad='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    '  <joint name="j"><state_interface name=""/></joint>\n'
    "</ros2_control>\n",
    good='<ros2_control name="c" type="system">\n'
    "  <hardware><plugin>p/P</plugin></hardware>\n"
    '  <joint name="j"><state_interface name="position"/></joint>\n'
    "</ros2_control>\n",
    line=3,
)
def odd_interface(subject: Subject) -> Iterator[Problem]:
    """Components and their interfaces; the name of a joint is reported at its declaration."""
    for system in subject.elements.every("ros2_control"):
        for it in system.iter(
            "ros2_control", "sensor", "gpio", "command_interface", "state_interface"
        ):
            name = it.get("name")
            if name is not None and (not name.strip() or _is_odd(it.tag, name.split())):
                yield Problem(it, f"<{it.tag}> has the name {name!r}", "name")


def _is_odd(tag: str, words: Collection[str]) -> bool:
    """Is white space inside a name a slip, not the way a driver calls its registers?"""
    return len(words) > 1 and (not tag.endswith("_interface") or not STANDARD.isdisjoint(words))
