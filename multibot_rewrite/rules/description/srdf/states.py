# SPDX-License-Identifier: Apache-2.0
"""Planning groups and their named states."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.planning_groups import (
    chain,
    groups_of,
    is_whole,
    joints_of,
    links_of,
    text_of,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.names import of_moveit, srdf_rule
from multibot_rewrite.rules.schema.srdf import ELEMENTS, numbers_in
from multibot_rewrite.rules.subject import Subject

# State values are written with a few digits.
ROUNDING = 1e-4


@srdf_rule("MB808", "duplicate-state", WARNING)
@of_moveit
def duplicate_state(subject: Subject) -> Iterator[Problem]:
    """Report every state but the first of its name."""
    seen = set()
    for it in subject.document.root.iterchildren("group_state"):
        key = text_of(it), text_of(it, "group")
        if key in seen:
            message = f"group {key[1]!r} has another state {key[0]!r}"
            yield Problem(it, message, "name", "rename one")
        seen.add(key)


@srdf_rule("MB812", "state-of-another-group", WARNING)
@of_moveit
def state_of_another_group(subject: Subject) -> Iterator[Problem]:
    """Report joints of states that exist and are not in the group, if all its groups are known."""
    robot = subject.beside
    if robot is None:
        return
    groups = groups_of(subject.document.root)
    joints: dict[str, frozenset[str]] = {}
    for it, group, joint in _states(subject.document.root):
        if not is_whole(group, groups) or joint not in robot.joint:
            continue
        if group not in joints:
            joints[group] = frozenset(joints_of(group, groups, robot))
        if joint not in joints[group]:
            yield Problem(it, f"joint {joint!r} is not in group {group!r}", "name", "remove it")


@srdf_rule("MB813", "state-beyond-limits", WARNING)
def state_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Report joints of one value that have limits."""
    robot = subject.beside
    for it, _, name in _states(subject.document.root) if robot else ():
        assert robot is not None
        joint, values = robot.joint.get(name), numbers_in(it.get("value", ""))
        limits = _limits(joint) if joint and joint.type in ("revolute", "prismatic") else None
        if limits is None or not values or len(values) > 1:
            continue
        lower, upper = limits
        if not lower - ROUNDING <= values[0] <= upper + ROUNDING:
            message = f"{name!r} is {values[0]:g}, its limits are {lower:g} to {upper:g}"
            yield Problem(it, message, "value", "correct the value")


def _states(root: _Element) -> Iterator[tuple[_Element, str, str]]:
    """Yield the joints of named states, with the group and the joint's name."""
    for state in root.iterchildren("group_state"):
        for it in state.iterchildren("joint"):
            yield it, text_of(state, "group"), text_of(it)


def _limits(joint: Joint) -> tuple[float, float] | None:
    """Return the limits of a joint; None unless they are two numbers in order."""
    limit = joint.element.find("limit")
    if limit is None:
        return None
    found = [numbers_in(limit.get(side, "0")) for side in ("lower", "upper")]
    lower, upper = (it[0] if it and len(it) == 1 else None for it in found)
    if lower is None or upper is None or lower > upper:
        return None
    return lower, upper


@srdf_rule("MB810", "broken-chain", ERROR)
def broken_chain(subject: Subject) -> Iterator[Problem]:
    """Report chains whose links exist."""
    robot = subject.beside
    for it in subject.document.root.iterfind("group/chain") if robot else ():
        base, tip = text_of(it, "base_link"), text_of(it, "tip_link")
        assert robot is not None
        if base not in robot.link or tip not in robot.link:
            continue
        if not chain(robot, base, tip):
            fault = "are one link" if base == tip else "are not connected"
            yield Problem(it, f"{base!r} and {tip!r} {fault}", None, "use two links of one tree")


@srdf_rule("MB811", "empty-group", WARNING)
@of_moveit
def empty_group(subject: Subject) -> Iterator[Problem]:
    """Yield a problem for each group with nothing in it."""
    for it in subject.document.root.iterchildren("group"):
        if not any(child.tag in ELEMENTS["group"][2] for child in it.iterchildren("*")):
            yield Problem(it, f"group {text_of(it)!r} is empty", "name", "add a joint")


@srdf_rule("MB816", "end-effector-parent", WARNING)
def end_effector_parent(subject: Subject) -> Iterator[Problem]:
    """End effectors that name their parent group."""
    robot, groups = subject.beside, groups_of(subject.document.root)
    for it in subject.document.root.iterchildren("end_effector"):
        parent, link = text_of(it, "parent_group"), text_of(it, "parent_link")
        if parent and parent == text_of(it, "group"):
            message = f"group {parent!r} is its own parent"
            yield Problem(it, message, "parent_group", "use the group that carries it")
        elif (
            robot
            and parent in groups
            and link in robot.link
            and link not in links_of(parent, groups, robot)
        ):
            message = f"group {parent!r} does not have the parent link {link!r}"
            yield Problem(it, message, "parent_group", "use the group that has it")
