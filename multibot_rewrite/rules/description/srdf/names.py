# SPDX-License-Identifier: Apache-2.0
"""Names of an SRDF that its URDF, or the SRDF, does not have; collision pairs; groups and states."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial, wraps

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, SRDF, WARNING, rule
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.description.checks.links_and_joints import Joint, Robot
from multibot_rewrite.description.checks.planning_groups import (
    FREE_FLYER,
    chain,
    groups_of,
    is_pinocchios,
    is_whole,
    joints_of,
    links_of,
    text_of,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import repeated
from multibot_rewrite.rules.description.references.undeclared import undeclared
from multibot_rewrite.rules.schema.srdf import ELEMENTS, numbers_in
from multibot_rewrite.rules.subject import Subject

# A rule about an SRDF.
srdf_rule = partial(rule, formats=(SRDF,))


def of_moveit(
    check: Callable[[Subject], Iterator[Problem]],
) -> Callable[[Subject], Iterator[Problem]]:
    """Return the check limited to SRDFs that MoveIt reads; those for Pinocchio are left alone."""

    @wraps(check)
    def found(subject: Subject) -> Iterator[Problem]:
        if not is_pinocchios(subject.document.root):
            yield from check(subject)

    return found


def level_of(subject: Subject) -> str:
    """Return the level of a name that the URDF lacks, a warning where that may be no error.

    Pinocchio leaves a joint of a state out and reads no group; a URDF that was found may be another
    variant of the robot."""
    is_named = subject.settings.urdf and not is_pinocchios(subject.document.root)
    return "" if is_named else WARNING


def undeclared_for_moveit(code: str) -> Callable[[Subject], Iterator[Problem]]:
    """Return a check that yields a rule's undeclared names in an SRDF for MoveIt."""

    def check(subject: Subject) -> Iterator[Problem]:
        return undeclared(code, subject)

    return of_moveit(check)


@srdf_rule("MB801", "srdf-without-urdf", NOTE)
def srdf_without_urdf(subject: Subject) -> Iterator[Problem]:
    """Report, once per file, that no URDF was found."""
    root = subject.document.root
    if subject.beside is None:
        message = f"no URDF of a robot {root.get('name', '')!r} with its links was found"
        yield Problem(root, message, "name", "give it with --urdf")


other_robot = srdf_rule("MB802", "other-robot", WARNING, options={"urdf": "r.urdf"})(
    undeclared_for_moveit("MB802")
)


@srdf_rule("MB803", "srdf-link", ERROR)
def srdf_link(subject: Subject) -> Iterator[Problem]:
    """Report undeclared links; in an SRDF of Pinocchio, which reads none of them, as a warning."""
    level = level_of(subject)
    yield from (it._replace(level=level) for it in undeclared("MB803", subject))


@srdf_rule("MB804", "srdf-joint", ERROR)
def srdf_joint(subject: Subject) -> Iterator[Problem]:
    """Report all joints but a free flyer's state for Pinocchio, where others are a warning."""
    level = level_of(subject)
    yield from (
        it._replace(level=level)
        for it in undeclared("MB804", subject)
        if it.element.tag != "joint" or text_of(it.element) != FREE_FLYER
    )


srdf_group = srdf_rule("MB805", "srdf-group", ERROR)(undeclared_for_moveit("MB805"))


@srdf_rule("MB806", "srdf-duplicate", ERROR)
def srdf_duplicate(subject: Subject) -> Iterator[Problem]:
    """Report every declaration of a name but the first."""
    for claim, _ in repeated(subject.inventory):
        message = f"there is another {claim.element.tag} {claim.value.strip()!r}"
        yield Problem(claim.element, message, claim.attribute, "rename one")


@srdf_rule("MB815", "virtual-joint-not-at-root", WARNING)
def virtual_joint_not_at_root(subject: Subject) -> Iterator[Problem]:
    """Report virtual joints; a fixed one is right if the root link is ``world``, as for Gazebo."""
    robot = subject.beside
    roots = [it.name for it in robot.links if it.name not in robot.above] if robot else []
    root = roots[0] if len(roots) == 1 else ""
    for it in subject.document.root.iterchildren("virtual_joint") if root else ():
        child = text_of(it, "child_link")
        dummy = root == "world" and text_of(it, "type").lower() == "fixed"
        if robot and child in robot.link and child != root and not dummy:
            message = f"{child!r} is not the root link, which is {root!r}"
            yield Problem(it, message, "child_link", f"use {root!r}")


@srdf_rule("MB807", "stale-pair", WARNING)
def stale_pair(subject: Subject) -> Iterator[Problem]:
    """Report names in pairs that the URDF lacks, each once, at its first pair."""
    found = list(undeclared("MB807", subject))
    links = [text_of(it.element, it.attribute or "") for it in found]
    names = Counter(links)
    for it, link in zip(found, links, strict=True):
        more = names.pop(link, 0) - 1
        if more >= 0:
            also = f"; {more} more pairs name it" if more else ""
            yield it._replace(message=it.message + also)


@srdf_rule("MB809", "duplicate-pair", NOTE)
def duplicate_pair(subject: Subject) -> Iterator[Problem]:
    """Report repeated pairs of disabled collisions, once per file; order does not matter."""
    first: dict[frozenset[str], _Element] = {}
    found = []
    for it in subject.document.root.iterchildren("disable_collisions"):
        pair = frozenset((text_of(it, "link1"), text_of(it, "link2")))
        if first.setdefault(pair, it) is not it:
            found.append(it)
    if found:
        names = [f"{text_of(it, 'link1')}-{text_of(it, 'link2')}" for it in found]
        message = f"{plural(len(found), 'pair')} disabled twice: {shorten(names, SEVERAL)}"
        yield Problem(found[0], message, None, "delete the line")


@srdf_rule("MB818", "self-pair", WARNING)
def self_pair(subject: Subject) -> Iterator[Problem]:
    """Report pairs of a link with itself, to disable or to enable."""
    for it in subject.document.root.iterchildren("disable_collisions", "enable_collisions"):
        one = text_of(it, "link1")
        if one and one == text_of(it, "link2"):
            yield Problem(it, f"{one!r} is paired with itself", "link2", "name the other link")


@srdf_rule("MB819", "pair-without-shape", NOTE)
def pair_without_shape(subject: Subject) -> Iterator[Problem]:
    """Report links in pairs that have no collision, each once, at its first pair."""
    robot = subject.beside
    reported = set()
    for it in subject.document.root.iterchildren("disable_collisions") if robot else ():
        for attribute in ("link1", "link2"):
            name = text_of(it, attribute)
            is_new = robot and name in robot.link and name not in reported
            if robot and is_new and not _has_shape(robot, name):
                reported.add(name)
                message = f"{name!r} has no collision geometry"
                hint = "delete the line, it has no effect; or add <collision> to the link"
                yield Problem(it, message, attribute, hint)


@srdf_rule("MB820", "adjacent-links", NOTE)
def adjacent_links(subject: Subject) -> Iterator[Problem]:
    """Report adjacent links whose collisions are not disabled, once per file."""
    root, robot = subject.document.root, subject.beside
    pairs = list(root.iterchildren("disable_collisions"))
    if robot is None or not pairs:
        return
    apart = {frozenset((text_of(it, "link1"), text_of(it, "link2"))) for it in pairs}
    alone = {text_of(it, "link") for it in root.iterchildren("disable_default_collisions")}
    left = [
        it
        for it in robot.joints
        if _both_checked(it, robot, alone) and {it.parent, it.child} not in apart
    ]
    if left:
        names = shorten((f"{it.parent}-{it.child}" for it in left), SEVERAL)
        message = f"{len(left)} pairs of adjacent links are checked: {names}"
        yield Problem(pairs[0], message, None, 'disable them with reason="Adjacent"')


def _has_shape(robot: Robot, link: str) -> bool:
    return robot.link[link].element.find("collision") is not None


def _both_checked(joint: Joint, robot: Robot, alone: set[str]) -> bool:
    """Return whether both links of a joint are checked against each other."""
    ends = {joint.parent, joint.child}
    return len(ends) == 2 and all(
        it in robot.link and it not in alone and _has_shape(robot, it) for it in ends
    )


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
    for it, group, joint in _state_joints(subject.document.root):
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
    for it, _, name in _state_joints(subject.document.root) if robot else ():
        assert robot is not None
        joint, values = robot.joint.get(name), numbers_in(it.get("value", ""))
        limits = _limits(joint) if joint and joint.type in ("revolute", "prismatic") else None
        if limits is None or not values or len(values) > 1:
            continue
        lower, upper = limits
        if not lower - ROUNDING <= values[0] <= upper + ROUNDING:
            message = f"joint {name!r} is {values[0]:g}, its limits are {lower:g} to {upper:g}"
            yield Problem(it, message, "value", "correct the value")


def _state_joints(root: _Element) -> Iterator[tuple[_Element, str, str]]:
    """Yield (element, group, joint) for the joints of named states."""
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
    """Report chains whose links exist and are not in one line."""
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
    """Report end effectors that name their parent group."""
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
