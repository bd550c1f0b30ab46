# SPDX-License-Identifier: Apache-2.0
"""Types, axes and origins of joints."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.numbers import vector
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.structure.shared import (
    LIMIT,
    ONE_AXIS,
    TOLERANCE,
    joints_with,
    one_joint,
)
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

FAR = 50.0


@rule(
    "MB519",
    "zero-axis",
    ERROR,
    what="The axis of a joint that moves is 0 0 0, or its <axis> has no xyz.",
    why="sdformat rejects the file ('The norm of the xyz vector cannot be zero'), and so does "
    "MuJoCo. KDL divides by the length, so robot_state_publisher sends nan, which tf2 ignores.",
    fix='Write the axis: <axis xyz="0 0 1"/>; without <axis> it is 1 0 0.',
    bad=one_joint("revolute", '<axis xyz="0 0 0"/>', LIMIT),
    good=one_joint("revolute", '<axis xyz="0 0 1"/>', LIMIT),
    line=5,
)
def zero_axis(subject: Subject) -> Iterator[Problem]:
    """Axes of length 0."""
    for joint, axis, length in _axes(subject):
        if length == 0:
            fault = "is 0 0 0" if axis.get("xyz") else "has no xyz, which is 0 0 0"
            yield Problem(axis, f"<axis> of {joint.type} joint {joint.name!r} {fault}", "xyz")


@rule(
    "MB520",
    "axis-length",
    WARNING,
    what="The axis of a joint does not have length 1. It is a note for a joint that turns.",
    why="KDL (robot_state_publisher), sdformat and pinocchio normalize it. MoveIt and yourdfpy "
    "move a prismatic joint further by that factor, so the planner's robot is not the one in tf. A "
    "program that does not normalize it turns a joint by another angle.",
    fix="Divide the axis by its length.",
    bad=one_joint("prismatic", '<axis xyz="0 0 2"/>', LIMIT),
    good=one_joint("prismatic", '<axis xyz="0 0 1"/>', LIMIT),
    line=5,
)
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


@rule(
    "MB522",
    "fixed-joint-ignores",
    NOTE,
    what="A fixed joint has a limit, a mimic or a safety controller.",
    why="urdfdom reads them, but a joint that cannot move does not use them.",
    fix="Delete them, or correct the type of the joint.",
    bad=one_joint("fixed", LIMIT),
    good=one_joint("fixed"),
    line=5,
)
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


@rule(
    "MB523",
    "floating-or-planar",
    WARNING,
    what="A joint is floating or planar.",
    why="robot_state_publisher sends no transform for a floating joint, and a fixed one for a "
    "planar joint. sdformat makes neither joint and rejects the link below.",
    fix="Make the link below it the root: its pose comes from odometry or, in MoveIt, from a "
    "<virtual_joint> of the SRDF.",
    bad=one_joint("floating"),
    good=one_joint("fixed"),
    line=3,
)
def floating_or_planar(subject: Subject) -> Iterator[Problem]:
    """Joints of these two types."""
    for joint in subject.robot.joints:
        if joint.type in ("floating", "planar"):
            tf = "gets no transform" if joint.type == "floating" else "is fixed in tf"
            yield Problem(joint.element, f"{joint.type} joint {joint.name!r} {tf}", "type")


@rule(
    "MB524",
    "joint-origin-units",
    WARNING,
    what="The origin of a joint is very far from its parent link.",
    why="URDF uses metres: the child is drawn, planned and simulated at that distance.",
    fix="Divide millimetres by 1000.",
    bad=one_joint("fixed", '<origin xyz="0 0 120"/>'),
    good=one_joint("fixed", '<origin xyz="0 0 0.12"/>'),
    line=5,
)
def joint_origin_units(subject: Subject) -> Iterator[Problem]:
    """Origins that are farther away than any robot is long."""
    for joint, origin in joints_with(subject.robot, "origin"):
        xyz = vector(origin.get("xyz"))
        if xyz and max(map(abs, xyz)) >= FAR:
            message = f"joint {joint.name!r} is {hypot(*xyz):.4g} m away from {joint.parent!r}"
            yield Problem(origin, message, "xyz", "are these millimetres?")
