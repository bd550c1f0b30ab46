"""Virtual joints and joint properties."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.description.checks.links_and_joints import Robot
from multibot_rewrite.description.checks.planning_groups import text_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.shared import ARM, VIRTUAL, srdf_rule
from multibot_rewrite.rules.subject import Subject

VIRTUAL_TYPES = ("fixed", "planar", "floating")
PROPERTIES = ("angular_distance_weight", "motion_model", "min_translational_distance")


@srdf_rule(
    "MB815",
    "virtual-joint-not-at-root",
    WARNING,
    what="The child of a virtual joint is not the root link of the URDF.",
    why="MoveIt ignores the joint ('does not match the URDF frame'): the robot is at the origin of "
    "its model frame, which is the root link and not the intended frame.",
    fix="Use the root link.",
    bad=ARM + VIRTUAL.format("fixed", "b"),
    good=ARM + VIRTUAL.format("fixed", "a"),
    line=2,
)
def virtual_joint_not_at_root(subject: Subject) -> Iterator[Problem]:
    """Virtual joints; a fixed one is right where the root link is ``world``, as Gazebo wants it."""
    robot = subject.beside
    root = _root(robot) if robot else ""
    for it in subject.document.root.iterchildren("virtual_joint") if root else ():
        child = text_of(it, "child_link")
        dummy = root == "world" and text_of(it, "type").lower() == "fixed"
        if robot and child in robot.link and child != root and not dummy:
            message = f"{child!r} is not the root link, which is {root!r}"
            yield Problem(it, message, "child_link", f"use {root!r}")


@srdf_rule(
    "MB822",
    "joint-property",
    WARNING,
    what="A joint_property has a name that MoveIt does not know.",
    why="MoveIt logs 'Unknown joint property' and ignores it.",
    fix="Use angular_distance_weight, motion_model or min_translational_distance.",
    bad=ARM + '<joint_property joint_name="j" property_name="motion" value="holonomic"/>',
    good=ARM + '<joint_property joint_name="j" property_name="motion_model" value="holonomic"/>',
    line=2,
)
def joint_property(subject: Subject) -> Iterator[Problem]:
    """Names of properties that MoveIt does not know."""
    for it in subject.document.root.iterchildren("joint_property"):
        name = text_of(it, "property_name")
        if name and name not in PROPERTIES:
            near = nearest(name, PROPERTIES)
            hint = f"did you mean {near!r}?" if near else f"use one of {', '.join(PROPERTIES)}"
            yield Problem(it, f"property {name!r} is not known", "property_name", hint)


@srdf_rule(
    "MB823",
    "virtual-joint-type",
    ERROR,
    what="The type of a virtual joint is not fixed, planar or floating.",
    why="srdfdom treats it as fixed: a mobile base cannot move.",
    fix="Use fixed, planar or floating.",
    bad=ARM + VIRTUAL.format("planer", "a"),
    good=ARM + VIRTUAL.format("planar", "a"),
    line=2,
)
def virtual_joint_type(subject: Subject) -> Iterator[Problem]:
    """Types that are unknown in upper and lower case."""
    for it in subject.document.root.iterchildren("virtual_joint"):
        type_ = text_of(it, "type")
        if "type" in it.attrib and type_.lower() not in VIRTUAL_TYPES:
            near = nearest(type_, VIRTUAL_TYPES)
            hint = f"did you mean {near!r}?" if near else f"use one of {', '.join(VIRTUAL_TYPES)}"
            yield Problem(it, f"type {type_!r} is treated as fixed", "type", hint)


def _root(robot: Robot) -> str:
    """The root link; empty where there is none or there are several."""
    roots = [it.name for it in robot.links if it.name not in robot.above]
    return roots[0] if len(roots) == 1 else ""
