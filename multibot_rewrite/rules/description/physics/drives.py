# SPDX-License-Identifier: Apache-2.0
"""Drives against the robot: where their wheels are, how large, which way they turn, their grip."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.rules.facts.drives import (
    Drive,
    are_opposite,
    are_swapped,
    drives,
    radius,
    rolling_faults,
    separation,
    size_of,
    wheel_joints,
)
from multibot_rewrite.rules.facts.memo import driven_joints
from multibot_rewrite.rules.facts.sensors import number_at
from multibot_rewrite.rules.subject import Subject

# A wheel with limits so far apart is not meant to stop, in radians.
ENDLESS = 20 * pi


@rule("MB620", "wheel-size", WARNING)
def wheel_size(subject: Subject) -> Iterator[Problem]:
    """The distance along the axis of the first pair, of joints or of shapes, and the radii of round
    shapes of all wheels; of other wheels they are unknown."""
    for drive in drives(subject):
        tags, robot = drive.tags, drive.robot
        value = size_of(drive, tags.separation, tags.defaults[0])
        found = separation(robot, *drive.pairs[0], bool(drive.left[1:]))
        if value is not None and value > 0 and found and not found.holds(value):
            yield _size(drive, tags.separation, value, "the wheels are", found.best)
        value, unit = size_of(drive, tags.radius, tags.defaults[1]), tags.radius_of
        found = radius(robot, (*drive.left, *drive.right))
        if value is not None and value > 0 and found and not found.holds(value * unit):
            yield _size(drive, tags.radius, value, "the wheels have", found.best / unit)


def _size(drive: Drive, name: str, value: float, words: str, measured: float) -> Problem:
    element = drive.sizes[name]
    said = (
        f"{name} is {value:g} m" if element is not None else f"{name} is not said, and {value:g} m"
    )
    message = f"{said}, but {words} {measured:.4g} m" + (" apart" if "sep" in name.lower() else "")
    place = (drive.plugin, None) if element is None else (element, "")
    return Problem(place[0], message, place[1], f"write {measured:.4g}")


@rule("MB622", "wheels-turn-wrong", WARNING)
def wheels_turn_wrong(subject: Subject) -> Iterator[Problem]:
    """The first pair of each drive whose plugin turns left with slower left wheels, and pairs whose
    axes are against each other in the robot's frame."""
    for drive in drives(subject):
        left, right = drive.pairs[0]
        way = are_swapped(left, right) if drive.tags.turns_left else 0.0
        if way:
            names = f"{left.joint.name!r} is {way:.3g} m right of {right.joint.name!r}"
            hint = "swap left and right, or turn the axes of both joints around"
            yield Problem(left.named, f"left wheel {names}", "", hint)
        for left, right in drive.pairs:
            if "fixed" in (left.joint.type, right.joint.type):
                continue  # MB624
            for words in rolling_faults(drive.robot, left, right):
                yield Problem(right.named, words, "", "the drive takes them for wheels that roll")
            if are_opposite(left, right):
                names = f"{left.joint.name!r} and {right.joint.name!r}"
                message = f"the axes of wheels {names} point in opposite directions"
                yield Problem(right.named, message, "", "turn one of them around")


@rule("MB624", "wheel-cannot-turn", ERROR)
def wheel_cannot_turn(subject: Subject) -> Iterator[Problem]:
    """Each such joint that a drive names."""
    for element, joint in wheel_joints(subject):
        fault = _fault_of(joint)
        if fault:
            yield Problem(element, f"wheel joint {joint.name!r} {fault}", "", "make it continuous")


def _fault_of(joint: Joint) -> str:
    if joint.type in ("fixed", "prismatic"):
        return f"is {joint.type}: it cannot turn"
    limit = joint.parts.get("limit")
    if joint.type != "revolute":
        return ""
    if limit is not None:
        lower, upper = number(limit.get("lower", "0")), number(limit.get("upper", "0"))
    else:  # of an SDF
        lower, upper = (number_at(joint.element, f"axis/limit/{it}") for it in ("lower", "upper"))
    if lower is None or upper is None or upper - lower >= ENDLESS:
        return ""
    return f"turns from {lower:g} to {upper:g} radians only"


_FRICTION = ("mu1", "mu", "mu2")


@rule("MB636", "wheel-without-grip", WARNING)
def wheel_without_grip(subject: Subject) -> Iterator[Problem]:
    """Blocks of links on a continuous joint that something drives, if nothing else moves the robot."""
    blocks = [it for it in subject.elements.tops("gazebo") if it.get("reference")]
    driven = driven_joints(subject) if blocks and not _is_pushed(subject) else ()
    wheels = {
        it.child for it in subject.robot.joints if it.type == "continuous" and it.name in driven
    }
    for block in blocks:
        name = block.get("reference", "")
        # A wheel with rollers has grip one way alone, along <fdir1> or across it.
        for tag in _FRICTION if name in wheels and block.find("fdir1") is None else ():
            value, element = number_at(block, tag), block.find(tag)
            if value is not None and value <= 0 and element is not None:
                message = f"{tag} of driven wheel {name!r} is {value:g}: it has no grip"
                yield Problem(element, message, "", "write 1.0 or so")
                break


# They set the speed of the body, and the wheels turn for the eye.
_PUSHING = frozenset(("gazebo_ros_planar_move", "gz-sim-velocity-control-system"))


def _is_pushed(subject: Subject) -> bool:
    """Has the robot a plugin that moves its body, or one of which nothing is known?"""
    blocks = set(subject.elements.tops("gazebo"))
    return any(
        is_unknown(section) or not _PUSHING.isdisjoint(section.names)
        for plugin, section in subject.inventory.served
        if plugin.tag == "plugin" and plugin.getparent() in blocks
    )
