# SPDX-License-Identifier: Apache-2.0
"""Links, joints, groups and virtual joints of an SRDF that its URDF, or the SRDF, does not have."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.description.checks.links_and_joints import Robot
from multibot_rewrite.description.checks.planning_groups import FREE_FLYER, text_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import repeated
from multibot_rewrite.rules.description.references.undeclared import undeclared
from multibot_rewrite.rules.description.srdf.shared import (
    level_of,
    srdf_rule,
    undeclared_for_moveit,
)
from multibot_rewrite.rules.subject import Subject


@srdf_rule("MB801", "srdf-without-urdf", NOTE)
def srdf_without_urdf(subject: Subject) -> Iterator[Problem]:
    """One finding per file."""
    root = subject.document.root
    if subject.beside is None:
        message = f"no URDF of a robot {root.get('name', '')!r} with its links was found"
        yield Problem(root, message, "name", "give it with --urdf")


other_robot = srdf_rule("MB802", "other-robot", WARNING, options={"urdf": "r.urdf"})(
    undeclared_for_moveit("MB802")
)


@srdf_rule("MB803", "srdf-link", ERROR)
def srdf_link(subject: Subject) -> Iterator[Problem]:
    """Of Pinocchio, which reads none of these, a warning."""
    level = level_of(subject)
    yield from (it._replace(level=level) for it in undeclared("MB803", subject))


@srdf_rule("MB804", "srdf-joint", ERROR)
def srdf_joint(subject: Subject) -> Iterator[Problem]:
    """All but the free flyer in a state for Pinocchio, which leaves the others out: a warning."""
    level = level_of(subject)
    yield from (
        it._replace(level=level)
        for it in undeclared("MB804", subject)
        if it.element.tag != "joint" or text_of(it.element) != FREE_FLYER
    )


srdf_group = srdf_rule("MB805", "srdf-group", ERROR)(undeclared_for_moveit("MB805"))


@srdf_rule("MB806", "srdf-duplicate", ERROR)
def srdf_duplicate(subject: Subject) -> Iterator[Problem]:
    """Every declaration but the first."""
    for claim, _ in repeated(subject.inventory):
        message = f"there is another {claim.element.tag} {claim.value.strip()!r}"
        yield Problem(claim.element, message, claim.attribute, "rename one")


@srdf_rule("MB815", "virtual-joint-not-at-root", WARNING)
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
