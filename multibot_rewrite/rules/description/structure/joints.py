# SPDX-License-Identifier: Apache-2.0
"""Types, axes and origins of joints, their limits, soft limits and dynamics."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, pi, radians

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.checks.links_and_joints import (
    BOUNDED,
    ONE_AXIS,
    TOLERANCE,
    TYPES,
    Joint,
    Robot,
    joints_with,
)
from multibot_rewrite.description.checks.numbers import number, numbers, value_of, vector
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.simulators import commanded
from multibot_rewrite.rules.schema.versions import KNOWN, version_of
from multibot_rewrite.rules.subject import Subject

FAR = 50.0


@rule("MB519", "zero-axis", ERROR)
def zero_axis(subject: Subject) -> Iterator[Problem]:
    """Report axes of length 0."""
    for joint, axis, length in _axes_with_length(subject):
        if length == 0:
            fault = "is 0 0 0" if axis.get("xyz") else "has no xyz, which is 0 0 0"
            yield Problem(axis, f"<axis> of {joint.type} joint {joint.name!r} {fault}", "xyz")


@rule("MB520", "axis-length", WARNING)
def axis_length(subject: Subject) -> Iterator[Problem]:
    """Report axes whose length is neither 0 nor 1."""
    for joint, axis, length in _axes_with_length(subject):
        if length and abs(length - 1) > TOLERANCE:
            message = f"axis of joint {joint.name!r} has the length {length:.4g}"
            level = "" if joint.type == "prismatic" else NOTE
            yield Problem(axis, message, "xyz", level=level)


@memoized
def _axes_with_length(subject: Subject) -> list[tuple[Joint, _Element, float]]:
    """Return (joint, axis, its length) of joints that use one; without xyz the length is 0."""
    found = []
    for joint, axis in joints_with(subject.robot, "axis"):
        if joint.type in ONE_AXIS:
            xyz = vector(axis.get("xyz", "0 0 0"))
            if xyz is not None:
                found.append((joint, axis, hypot(*xyz)))
    return found


@rule("MB522", "fixed-joint-ignores", NOTE)
def fixed_joint_ignores(subject: Subject) -> Iterator[Problem]:
    """Report what a fixed joint ignores, once a joint; exporters write <axis> everywhere."""
    for joint in subject.robot.joints:
        if joint.type != "fixed":
            continue
        useless = [it for it in ("limit", "mimic", "safety_controller") if it in joint.parts]
        if useless:
            tags = ", ".join(f"<{it}>" for it in useless)
            message = f"fixed joint {joint.name!r} ignores its {tags}"
            hint = f"delete {tags}, or correct the type of the joint"
            yield Problem(joint.parts[useless[0]], message, None, hint)


@rule("MB523", "floating-or-planar", WARNING)
def floating_or_planar(subject: Subject) -> Iterator[Problem]:
    """Report joints of these two types."""
    for joint in subject.robot.joints:
        if joint.type in ("floating", "planar"):
            tf = "gets no transform" if joint.type == "floating" else "is fixed in tf"
            yield Problem(joint.element, f"{joint.type} joint {joint.name!r} {tf}", "type")


@rule("MB524", "joint-origin-units", WARNING)
def joint_origin_units(subject: Subject) -> Iterator[Problem]:
    """Report origins that are farther away than any robot is long."""
    for joint, origin in joints_with(subject.robot, "origin"):
        xyz = vector(origin.get("xyz"))
        if xyz and max(map(abs, xyz)) >= FAR:
            message = f"joint {joint.name!r} is {hypot(*xyz):.4g} m away from {joint.parent!r}"
            yield Problem(origin, message, "xyz", "are these millimetres?")


# Above DEGREES[0] radians (more than two turns) and up to DEGREES[1] degrees (two turns); ENDLESS are
# numbers that people write for "no limit".
DEGREES = (4.5 * pi, 720.0)
_TURN, _ROUND = 2.05 * pi, 5.0
# A round number above a turn has two digits or an exponent: most values are told without being read.
_LARGE = lazy_compile(r"(?<![.\d])\d\d|[eE]")
ENDLESS = frozenset((50.0, 100.0, 200.0, 500.0, 999.0))
# Metres; a gripper moves so many millimetres.
LONG_WAY = 25.0
ENDS = ("lower", "upper")
# From this version on bounds are needed, effort and velocity are not, and a negative limit is refused.
STRICT = KNOWN[2]


@rule("MB509", "limit-missing", ERROR)
def limit_missing(subject: Subject) -> Iterator[Problem]:
    """Report joints without a limit that they need, and limits without a part that they need."""
    strict = version_of(subject.document.root) >= STRICT
    motor = () if strict else ("effort", "velocity")
    for joint in subject.robot.joints:
        limit, is_bounded = joint.parts.get("limit"), joint.type in BOUNDED
        if limit is None:
            if is_bounded:
                yield Problem(joint.element, f"{joint.type} joint {joint.name!r} has no <limit>")
            continue
        there = limit.keys()
        bounds = ENDS if is_bounded else ()
        for needed, level in ((motor, ""), (bounds, "" if strict else WARNING)):
            if missing := [it for it in needed if it not in there]:
                message = f"<limit> of joint {joint.name!r} has no {' and no '.join(missing)}"
                yield Problem(limit, message, level=level)


@rule("MB511", "limits-inverted", ERROR)
def limits_inverted(subject: Subject) -> Iterator[Problem]:
    """Report lower limits above the upper one; in URDF 1.2 of any joint."""
    types = TYPES if version_of(subject.document.root) >= STRICT else BOUNDED
    for joint, limit, lower, upper in _bounds(subject):
        if lower > upper and joint.type in types:
            message = f"joint {joint.name!r}: lower {lower:g} is above upper {upper:g}"
            yield Problem(limit, message, "lower")


@rule("MB512", "limits-zero-range", NOTE)
def limits_zero_range(subject: Subject) -> Iterator[Problem]:
    """Report equal limits: an exporter's mistake, or a frame that Gazebo should not merge."""
    for joint, limit, lower, upper in _bounds(subject):
        if lower == upper and joint.type in BOUNDED:
            who = f"{joint.type} joint {joint.name!r}"
            yield Problem(limit, f"{who} cannot move: lower and upper are {lower:g}")


@rule("MB515", "zero-limit", NOTE)
def zero_limit(subject: Subject) -> Iterator[Problem]:
    """Report limits of 0, once a joint; one that mimics or cannot move needs no effort."""
    for joint, limit in joints_with(subject.robot, "limit"):
        if joint.type not in ONE_AXIS or "mimic" in joint.parts:
            continue
        zero = [it for it in ("effort", "velocity") if value_of(limit, it) == 0]
        bounds = {value_of(limit, it, 0.0) for it in ("lower", "upper")}
        if zero and not (joint.type in BOUNDED and len(bounds) == 1):
            verb = "are" if zero[1:] else "is"
            message = f"joint {joint.name!r}: {' and '.join(zero)} {verb} 0"
            weak = zero[0] == "effort" and joint.name in commanded(subject)
            yield Problem(limit, message, zero[0], level=WARNING if weak else "")


@rule("MB516", "continuous-limits", WARNING)
def continuous_limits(subject: Subject) -> Iterator[Problem]:
    """Report bounds of less than a turn: a whole turn means the same as continuous."""
    for joint, limit in joints_with(subject.robot, "limit"):
        if joint.type != "continuous" or limit.get("lower") is None:
            continue
        lower, upper = value_of(limit, "lower"), value_of(limit, "upper", 0.0)
        if lower is not None and upper is not None and 0 < upper - lower < 1.99 * pi:
            message = f"continuous joint {joint.name!r} ignores its limits {lower:g} to {upper:g}"
            yield Problem(limit, message, "lower")


@rule("MB517", "prismatic-units", WARNING)
def prismatic_units(subject: Subject) -> Iterator[Problem]:
    """Report long ranges of prismatic joints that move something, unless equal to both sides."""
    for joint, limit, lower, upper in _bounds(subject):
        far = max(abs(lower), abs(upper))
        is_long = joint.type == "prismatic" and LONG_WAY <= far < 1e4 and lower != -upper
        if is_long and not _moves_nothing(subject.robot, joint):
            message = f"prismatic joint {joint.name!r} goes from {lower:g} m to {upper:g} m"
            name = "upper" if abs(upper) == far else "lower"
            yield Problem(limit, message, name, "are these millimetres?")


def _moves_nothing(robot: Robot, joint: Joint) -> bool:
    """Return whether a joint's child is an empty link at the end of a robot that else has bodies."""
    child = robot.link.get(joint.child)
    empty = child is not None and not len(child.element) and joint.child not in robot.below
    return empty and any(len(it.element) for it in robot.links)


def limits_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report round numbers that are many turns in radians, and an angle in degrees."""
    for joint, limit, lower, upper in _bounds(subject):
        if joint.type == "revolute" and (_is_degrees(lower) or _is_degrees(upper)):
            message = f"revolute joint {joint.name!r} turns from {lower:g} to {upper:g} radians"
            name = "upper" if _is_degrees(upper) else "lower"
            yield Problem(limit, message, name, "are these degrees?")


def origins_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report rotations of more than a turn by a round number: nobody writes 90 radians."""
    origins = subject.elements.every("origin")
    different = {it.get("rpy", "") for it in origins}
    large = filter(_LARGE.search, different)
    turned = {rpy: odd for rpy in large if (odd := _angle_in_degrees(rpy)) is not None}
    for origin in origins if turned else ():
        odd = turned.get(origin.get("rpy", ""))
        if odd is not None:
            message = f"rpy has {odd:g}, which is more than a turn: it is in radians"
            yield Problem(origin, message, "rpy", f"{odd:g} degrees are {radians(odd):.4g}")


def _angle_in_degrees(rpy: str) -> float | None:
    """Return the first rotation by a round number of more than a turn; None without one."""
    found = numbers(rpy) or ()
    return next((it for it in found if abs(it) > _TURN and it % _ROUND == 0), None)


def _is_degrees(angle: float) -> bool:
    """Return whether a limit is a round number of many turns."""
    size = abs(angle)
    return DEGREES[0] < size <= DEGREES[1] and size % 0.5 == 0 and size not in ENDLESS


@memoized
def _bounds(subject: Subject) -> list[tuple[Joint, _Element, float, float]]:
    """Return (joint, limit, lower, upper) for joints of known types that have both bounds."""
    found = []
    for joint, limit in joints_with(subject.robot, "limit"):
        if joint.type in TYPES:
            lower, upper = number(limit.get("lower")), number(limit.get("upper"))
            if lower is not None and upper is not None:
                found.append((joint, limit, lower, upper))
    return found


@rule("MB532", "soft-limits", WARNING)
def soft_limits(subject: Subject) -> Iterator[Problem]:
    """Report soft limits compared with hard limits that leave a range themselves."""
    for joint, safety in joints_with(subject.robot, "safety_controller"):
        limit = joint.parts.get("limit")
        if joint.type not in BOUNDED or limit is None:
            continue
        # Both pairs of limits as MoveIt reads them.
        soft = (value_of(safety, f"soft_{it}_limit", 0.0) for it in ENDS)
        hard = (value_of(limit, it, 0.0) for it in ENDS)
        read = [it for it in (*soft, *hard) if it is not None]
        if len(read) != 4 or read[2] >= read[3]:
            continue
        soft_low, soft_high, low, high = read
        said = f"joint {joint.name!r}: the soft limits {soft_low:g} to {soft_high:g}"
        if max(soft_low, low) >= min(soft_high, high):
            yield Problem(safety, f"{said} leave no range")
        if soft_low < low - TOLERANCE or soft_high > high + TOLERANCE:
            yield Problem(safety, f"{said} are outside of {low:g} to {high:g}", level=NOTE)


@rule("MB534", "dynamics-empty", ERROR)
def dynamics_empty(subject: Subject) -> Iterator[Problem]:
    """Report dynamics without a value."""
    for joint, dynamics in joints_with(subject.robot, "dynamics"):
        if dynamics.get("damping") is None and dynamics.get("friction") is None:
            message = f"<dynamics> of joint {joint.name!r} has neither damping nor friction"
            yield Problem(dynamics, message)
