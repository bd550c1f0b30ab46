"""Named states of planning groups."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.planning_groups import (
    groups_of,
    is_whole,
    joints_of,
    text_of,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.srdf.shared import STATE, srdf_rule
from multibot_rewrite.rules.schema.srdf import numbers_in
from multibot_rewrite.rules.subject import Subject

LIMITED = ("revolute", "prismatic")
# State values are written with a few digits.
ROUNDING = 1e-4


@srdf_rule(
    "MB808",
    "duplicate-state",
    WARNING,
    what="Two states of one group have the same name.",
    why="MoveIt keeps the values of the last one only.",
    fix="Rename one.",
    bad=STATE.format("") + '<group_state name="home" group="arm"/>',
    good=STATE.format("") + '<group_state name="up" group="arm"/>',
    line=3,
)
def duplicate_state(subject: Subject) -> Iterator[Problem]:
    """Every state but the first of its name."""
    seen = set()
    for it in subject.document.root.iterchildren("group_state"):
        key = text_of(it), text_of(it, "group")
        if key in seen:
            yield Problem(
                it, f"group {key[1]!r} has another state {key[0]!r}", "name", "rename one"
            )
        seen.add(key)


@srdf_rule(
    "MB812",
    "state-of-another-group",
    WARNING,
    what="A state has a value for a joint that is not in its group.",
    why="MoveIt ignores the value ('that joint is not part of group').",
    fix="Remove the joint, or add it to the group.",
    bad=STATE.format('<joint name="k" value="0"/>'),
    good=STATE.format('<joint name="j" value="0"/>'),
    line=2,
)
def state_of_another_group(subject: Subject) -> Iterator[Problem]:
    """Joints of states that exist and are not in the group, of which all groups are known."""
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


@srdf_rule(
    "MB813",
    "state-beyond-limits",
    WARNING,
    what="The value of a state is outside of the joint's limits.",
    why="MoveIt rejects the state as a goal, and a plan that starts there is invalid.",
    fix="Correct the value or the limit.",
    bad=STATE.format('<joint name="j" value="1.5"/>'),
    good=STATE.format('<joint name="j" value="1"/>'),
    line=2,
)
def state_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Joints of one value that have limits."""
    robot = subject.beside
    for it, _, name in _states(subject.document.root) if robot else ():
        assert robot is not None
        joint, values = robot.joint.get(name), numbers_in(it.get("value", ""))
        limits = _limits(joint) if joint and joint.type in LIMITED else None
        if limits is None or not values or len(values) > 1:
            continue
        lower, upper = limits
        if not lower - ROUNDING <= values[0] <= upper + ROUNDING:
            message = f"{name!r} is {values[0]:g}, its limits are {lower:g} to {upper:g}"
            yield Problem(it, message, "value", "correct the value")


def _states(root: _Element) -> Iterator[tuple[_Element, str, str]]:
    """The joints of states, their groups and names."""
    for state in root.iterchildren("group_state"):
        for it in state.iterchildren("joint"):
            yield it, text_of(state, "group"), text_of(it)


def _limits(joint: Joint) -> tuple[float, float] | None:
    """The limits of a joint; None where they are not two numbers in order."""
    limit = joint.element.find("limit")
    if limit is None:
        return None
    found = [numbers_in(limit.get(side, "0")) for side in ("lower", "upper")]
    lower, upper = (it[0] if it and len(it) == 1 else None for it in found)
    if lower is None or upper is None or lower > upper:
        return None
    return lower, upper
