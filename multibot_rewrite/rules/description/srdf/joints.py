"""Virtual joints and joint properties."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.description.checks.links_and_joints import Robot
from multibot_rewrite.description.checks.planning_groups import text_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.shared import ARM, VIRTUAL, srdf_rule
from multibot_rewrite.rules.subject import Subject


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


def _root(robot: Robot) -> str:
    """The root link; empty where there is none or there are several."""
    roots = [it.name for it in robot.links if it.name not in robot.above]
    return roots[0] if len(roots) == 1 else ""
