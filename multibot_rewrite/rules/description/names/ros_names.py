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
from multibot_rewrite.rules.description.names.links_and_joints import SUBSTITUTION, name_of_robot
from multibot_rewrite.rules.subject import Subject

# Interfaces that ros2_control has names for (hardware_interface_type_values.hpp).
STANDARD = frozenset(("position", "velocity", "effort", "acceleration"))
ROS_KINDS = frozenset({"topic", "service", "namespace"})
_TOKEN = lazy_compile(r"[A-Za-z_]\w*", re.ASCII)
# ROS 1, ROS 2 and both Gazebos agree on these.
_ALLOWED_EVERYWHERE = lazy_compile(r"[\w/~]*", re.ASCII)


@rule("MB301", "leading-slash", WARNING, formats=(URDF, SRDF, *EVERY))
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


@rule("MB304", "slash-in-joint", NOTE)
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


@rule("MB311", "robot-name", NOTE)
def robot_name(subject: Subject) -> Iterator[Problem]:
    """Names with '::' are MB305."""
    name = name_of_robot(subject)
    if name is None or "::" in name or _TOKEN.fullmatch(name):
        return
    hint = f"use {propose_token(name)!r}" if name.strip() else "add one"
    yield Problem(
        subject.document.root, f"robot name {name!r} is not a valid ROS name", "name", hint
    )


@rule("MB312", "invalid-ros-name", WARNING, formats=(URDF, *EVERY))
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


@rule("MB313", "odd-interface-name", WARNING)
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
