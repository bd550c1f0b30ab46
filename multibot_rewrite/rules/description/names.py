# SPDX-License-Identifier: Apache-2.0
"""MB3: names of links, joints, robots, frames, topics and interfaces that some reader refuses."""

from __future__ import annotations

import re
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, SRDF, URDF, WARNING, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.base.naming import FRAME_KINDS, NOT_PLAIN, is_keyword
from multibot_rewrite.base.rosnames import (
    check_node_name,
    check_topic_name,
    propose_token,
    split_remap,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import value_slot
from multibot_rewrite.related_files.named_file import EVERY
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.simulators import simulated
from multibot_rewrite.rules.subject import Subject

WORLD = "world"


@rule("MB302", "empty-name", ERROR)
def empty_name(subject: Subject) -> Iterator[Problem]:
    """Report names that are empty or white space."""
    for kind, name, element in named(subject):
        if not name.strip():
            yield Problem(element, f"a {kind} has an empty name", "name")


@rule("MB303", "space-in-name", WARNING)
def space_in_name(subject: Subject) -> Iterator[Problem]:
    """Report white space in a name or around it."""
    for kind, name, element in named(subject):
        if name.strip() and BLANK.search(name):
            where = "" if name == name.strip() else " around it"
            near = "_".join(name.split())
            hint = f"use {near!r}"
            yield Problem(element, f"{kind} {name!r} contains white space{where}", "name", hint)


@rule("MB305", "double-colon", ERROR)
def double_colon(subject: Subject) -> Iterator[Problem]:
    """Report names with '::', which SDF reads as a path of names."""
    for kind, name, element in named(subject):
        if "::" in name:
            hint = f"use {name.replace('::', '_')!r}"
            message = f"{kind} {name!r} contains '::', which SDF reserves"
            yield Problem(element, message, "name", hint)
    if "::" in (name_of_robot(subject) or ""):
        message = "the robot's name contains '::', which SDF reserves"
        yield Problem(subject.document.root, message, "name")


@rule("MB306", "reserved-name", ERROR)
def reserved_name(subject: Subject) -> Iterator[Problem]:
    """Report links, joints and the robot; a link called world is MB307."""
    for kind, name, element in named(subject):
        if is_keyword(name) or (kind == "joint" and name == WORLD):
            yield Problem(element, f"SDF reserves the name {name!r}: no {kind} may have it", "name")
    robot = name_of_robot(subject)
    if robot is not None and (is_keyword(robot) or robot == WORLD):
        message = f"SDF reserves the name {robot!r}: no model may have it"
        yield Problem(subject.document.root, message, "name")


@rule("MB307", "world-link", WARNING)
def world_link(subject: Subject) -> Iterator[Problem]:
    """Report the worst fault of a link called world."""
    link = subject.robot.link.get(WORLD)
    if link is None:
        return
    above = subject.robot.above.get(WORLD, ())
    content = next(
        (it.tag for it in link.element.iterchildren("inertial", "visual", "collision")), ""
    )
    if above:
        message = f"link 'world' is not the root: joint {above[0].name!r} moves it with the robot"
        yield Problem(link.element, message, "name")
    elif content:
        message = f"link 'world' has <{content}>, which Gazebo ignores"
        yield Problem(link.element, message, "name")


@rule("MB308", "link-and-joint-alike", WARNING)
def link_and_joint_alike(subject: Subject) -> Iterator[Problem]:
    """Report a link and a joint of one name, unless Gazebo merges the link away."""
    robot = subject.robot
    for joint in robot.joints:
        if joint.name not in robot.link or joint.type == "fixed" or not joint.name.strip():
            continue
        if all(it.type != "fixed" or it.parent == WORLD for it in robot.above.get(joint.name, ())):
            message = f"{joint.name!r} is a joint and a link"
            yield Problem(joint.element, message, "name", f"call it {joint.name + '_joint'!r}")


@rule("MB309", "names-differ-by-case", NOTE)
def names_differ_by_case(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for the second name of each pair that differs only by case."""
    links = {it.name: it.element for it in subject.robot.links}
    joints = {it.name: it.element for it in subject.robot.joints}
    for kind, parts in (("link", links), ("joint", joints)):
        if len({name.lower() for name in parts}) == len(parts):
            continue
        seen: dict[str, str] = {}
        for name, element in parts.items():
            first = seen.setdefault(name.lower(), name)
            if first != name:
                message = f"{kind} {name!r} differs from {first!r} only in upper and lower case"
                yield Problem(element, message, "name")


@rule("MB310", "name-not-ascii", NOTE)
def name_not_ascii(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for each name with a letter outside ASCII; its code is in the message."""
    for kind, name, element in named(subject):
        if not name.isascii():
            letter = next(it for it in name if not it.isascii())
            code = f"U+{ord(letter):04X}"
            yield Problem(element, f"{kind} {name!r} contains {letter!r} ({code})", "name")


# Names with a substitution are skipped: MB105 reports them.
SUBSTITUTION = "$"
BLANK = lazy_compile(r"\s")


@memoized
def named(subject: Subject) -> list[tuple[str, str, _Element]]:
    """Return (kind, name, element) of links and joints that have a name without substitution."""
    links, joints = subject.robot.links, subject.robot.joints
    every = [
        *[("link", it.name, it.element) for it in links],
        *[("joint", it.name, it.element) for it in joints],
    ]
    has_name = (it for it in every if it[1] or it[2].get("name") is not None)
    return [it for it in has_name if SUBSTITUTION not in it[1]]


def name_of_robot(subject: Subject) -> str | None:
    """Return the robot's own name; None where it has none, or a substitution."""
    root = subject.document.root
    name = root.get("name") if root.tag == "robot" else None
    return None if name is None or SUBSTITUTION in name else name


# Interfaces that ros2_control has names for (hardware_interface_type_values.hpp).
STANDARD = frozenset(("position", "velocity", "effort", "acceleration"))
ROS_KINDS = frozenset({"topic", "service", "namespace"})
_TOKEN = lazy_compile(r"[A-Za-z_]\w*", re.ASCII)
# ROS 1, ROS 2 and both Gazebos agree on these.
_ALLOWED_EVERYWHERE = lazy_compile(r"[\w/~]*", re.ASCII)


@rule("MB301", "leading-slash", WARNING, formats=(URDF, SRDF, *EVERY))
def leading_slash(subject: Subject) -> Iterator[Problem]:
    """Report frames with a leading slash, with a fix if the rest is a link; /world may have it."""
    shared = subject.settings.naming.shared_frames
    for claim in subject.inventory.claims:
        if claim.value[:1] != "/" or claim.site.form != "whole":
            continue
        name = claim.value[1:]
        if claim.site.kinds[0] in FRAME_KINDS and name and name not in shared:
            source = subject.document.source
            known = name in subject.inventory.declared["link"]
            slot = value_slot(source, claim.start, claim.attribute, claim.value) if known else None
            written = slot is not None and source.startswith(b"/", slot[0])
            edits = (Edit(slot[0], slot[0] + 1, b"", None),) if slot and written else ()
            message = f"frame {claim.value!r} starts with a slash, which tf2 refuses"
            yield Problem(claim.element, message, claim.attribute, "delete the slash", edits)


@rule("MB304", "slash-in-joint", NOTE)
def slash_in_joint(subject: Subject) -> Iterator[Problem]:
    """Report slashes in every component that has interfaces."""
    for system in subject.elements.every("ros2_control"):
        for part in system.iterchildren("joint", "sensor", "gpio"):
            name = part.get("name", "")
            if "/" in name and SUBSTITUTION not in name:
                cut = name.partition("/")[0]
                owner = f"its interfaces are taken as those of {cut!r}"
                message = f"{part.tag} {name!r} contains a slash: {owner}"
                yield Problem(part, message, "name", f"use {name.replace('/', '_')!r}")


@rule("MB311", "robot-name", NOTE)
def robot_name(subject: Subject) -> Iterator[Problem]:
    """Report a robot's name that ROS refuses; names with '::' are MB305."""
    name = name_of_robot(subject)
    if name is None or "::" in name or _TOKEN.fullmatch(name):
        return
    hint = f"use {propose_token(name)!r}" if name.strip() else "add one"
    message = f"robot name {name!r} is not a valid ROS name"
    yield Problem(subject.document.root, message, "name", hint)


@rule("MB312", "invalid-ros-name", WARNING, formats=(URDF, *EVERY))
def invalid_ros_name(subject: Subject) -> Iterator[Problem]:
    """Report values relative to a ROS namespace; those with a substitution are skipped."""
    for claim in subject.inventory.claims:
        site = claim.site
        if not site.namespaced or site.kinds[0] not in ROS_KINDS:
            continue
        for name in _ros_names(claim):
            if fault := _name_fault(name, site.section):
                message = f"{site.kinds[0]} {name!r} is not a valid ROS name: {fault}"
                yield Problem(claim.element, message, claim.attribute)
    yield from _hardware_without_node(subject)


def _hardware_without_node(subject: Subject) -> Iterator[Problem]:
    """Report hardware components after which no node can be called, where ros2_control makes one."""
    in_simulator = {it for it, *_ in simulated(subject)}
    for system in subject.elements.every("ros2_control"):
        name = system.get("name", "").strip()
        fault = check_node_name(name.replace("/", "_")) if name else None
        if fault is None or SUBSTITUTION in name or system in in_simulator:
            continue
        from multibot_rewrite.knowledge.node_sets import built_in  # hardly any name is wrong
        from multibot_rewrite.system.records import HARDWARE_NODE

        if HARDWARE_NODE in built_in(subject.settings.distro).nodes:
            message = (
                f"hardware {name!r} has a node of this name, which ROS refuses: {fault.reason}"
            )
            hint = f"use {propose_token(name)!r}"
            yield Problem(system, message, "name", hint)


def _ros_names(claim: Claim) -> list[str]:
    """Return the names in a value: the value itself, or both sides of a remap rule."""
    sides = [claim.value] if claim.site.form == "whole" else []
    if claim.site.form in ("remap", "argument"):
        rule = split_remap(claim.value)
        sides = [rule.source, rule.target] if rule and not rule.source.startswith("__") else []
    return [it for it in sides if it.strip("/") and NOT_PLAIN.isdisjoint(it.replace(" ", ""))]


def _name_fault(name: str, section: str) -> str:
    """Return why rcl rejects a name; in a plugin that may be for ROS 1 or Gazebo, why all do."""
    if _ALLOWED_EVERYWHERE.fullmatch(name) and not section.startswith("block ros"):
        return ""
    fault = check_topic_name(name.rstrip("/"))
    return fault.reason if fault else ""


@rule("MB313", "odd-interface-name", WARNING)
def odd_interface(subject: Subject) -> Iterator[Problem]:
    """Report components and their interfaces; a joint's name is reported at its declaration."""
    for system in subject.elements.every("ros2_control"):
        for it in system.iter(
            "ros2_control", "sensor", "gpio", "command_interface", "state_interface"
        ):
            name = it.get("name")
            words = (name or "").split()
            # Drivers name registers with blanks, but no standard interface.
            is_slip = not it.tag.endswith("_interface") or not STANDARD.isdisjoint(words)
            if name is not None and (not words or (len(words) > 1 and is_slip)):
                hint = "" if name.strip() else "give it a name"
                yield Problem(it, f"<{it.tag}> has the name {name!r}", "name", hint)
