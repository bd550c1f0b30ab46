# SPDX-License-Identifier: Apache-2.0
"""Types, axes and origins of joints."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import (
    ONE_AXIS,
    TOLERANCE,
    Joint,
    joints_with,
)
from multibot_rewrite.description.checks.numbers import vector
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

FAR = 50.0


@rule("MB519", "zero-axis", ERROR)
def zero_axis(subject: Subject) -> Iterator[Problem]:
    """Axes of length 0."""
    for joint, axis, length in _axes(subject):
        if length == 0:
            fault = "is 0 0 0" if axis.get("xyz") else "has no xyz, which is 0 0 0"
            yield Problem(axis, f"<axis> of {joint.type} joint {joint.name!r} {fault}", "xyz")


@rule("MB520", "axis-length", WARNING)
def axis_length(subject: Subject) -> Iterator[Problem]:
    """Axes whose length is neither 0 nor 1."""
    for joint, axis, length in _axes(subject):
        if length and abs(length - 1) > TOLERANCE:
            message = f"axis of joint {joint.name!r} has the length {length:.4g}"
            level = "" if joint.type == "prismatic" else NOTE
            yield Problem(axis, message, "xyz", level=level)


@memoized
def _axes(subject: Subject) -> list[tuple[Joint, _Element, float]]:
    """The joints that use an <axis>, and its length; without xyz it is 0."""
    found = []
    for joint, axis in joints_with(subject.robot, "axis"):
        if joint.type in ONE_AXIS:
            xyz = vector(axis.get("xyz", "0 0 0"))
            if xyz is not None:
                found.append((joint, axis, hypot(*xyz)))
    return found


@rule("MB522", "fixed-joint-ignores", NOTE)
def fixed_joint_ignores(subject: Subject) -> Iterator[Problem]:
    """One finding per joint; exporters write <axis> and <dynamics> everywhere."""
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
    """Joints of these two types."""
    for joint in subject.robot.joints:
        if joint.type in ("floating", "planar"):
            tf = "gets no transform" if joint.type == "floating" else "is fixed in tf"
            yield Problem(joint.element, f"{joint.type} joint {joint.name!r} {tf}", "type")


@rule("MB524", "joint-origin-units", WARNING)
def joint_origin_units(subject: Subject) -> Iterator[Problem]:
    """Origins that are farther away than any robot is long."""
    for joint, origin in joints_with(subject.robot, "origin"):
        xyz = vector(origin.get("xyz"))
        if xyz and max(map(abs, xyz)) >= FAR:
            message = f"joint {joint.name!r} is {hypot(*xyz):.4g} m away from {joint.parent!r}"
            yield Problem(origin, message, "xyz", "are these millimetres?")
