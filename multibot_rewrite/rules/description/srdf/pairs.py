# SPDX-License-Identifier: Apache-2.0
"""Pairs of links that are not checked for collision."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.description.checks.links_and_joints import Joint, Robot
from multibot_rewrite.description.checks.planning_groups import text_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.references.lookup import undeclared
from multibot_rewrite.rules.description.srdf.shared import APART, ARM, SHOWN, srdf_rule
from multibot_rewrite.rules.subject import Subject


@srdf_rule(
    "MB807",
    "stale-pair",
    WARNING,
    what="A collision pair names a link that the URDF does not have.",
    why="srdfdom ignores the line. If the link was renamed, the pair is now checked, and a robot "
    "that touches itself there cannot plan.",
    fix="Delete the line, or correct the name.",
    bad=ARM + '<disable_collisions link1="a" link2="bb" reason="Adjacent"/>',
    good=ARM + APART,
    line=2,
)
def stale_pair(subject: Subject) -> Iterator[Problem]:
    """One finding per name, at its first pair."""
    found = list(undeclared("MB807", subject))
    names = Counter(_link(it) for it in found)
    for it in found:
        more = names.pop(_link(it), 0) - 1
        if more >= 0:
            also = f"; {more} more pairs name it" if more else ""
            yield it._replace(message=it.message + also)


def _link(problem: Problem) -> str:
    return text_of(problem.element, problem.attribute or "")


@srdf_rule(
    "MB809",
    "duplicate-pair",
    NOTE,
    what="Pairs of links are disabled twice.",
    why="The second line has no effect; it may have been meant for other links.",
    fix="Delete the second line.",
    bad=APART + '<disable_collisions link1="b" link2="a" reason="Never"/>',
    good=APART,
    line=2,
)
def duplicate_pair(subject: Subject) -> Iterator[Problem]:
    """One finding per file; the order of the two does not matter."""
    first: dict[frozenset[str], _Element] = {}
    found = []
    for it in subject.document.root.iterchildren("disable_collisions"):
        pair = frozenset((text_of(it, "link1"), text_of(it, "link2")))
        if first.setdefault(pair, it) is not it:
            found.append(it)
    if found:
        names = [f"{text_of(it, 'link1')}-{text_of(it, 'link2')}" for it in found[:SHOWN]]
        more = ", ..." if len(found) > SHOWN else ""
        message = f"{len(found)} pairs are already disabled: {', '.join(names)}{more}"
        yield Problem(found[0], message, None, "delete the line")


@srdf_rule(
    "MB818",
    "self-pair",
    WARNING,
    what="A collision pair names the same link twice.",
    why="A link never collides with itself, so the line has no effect; the intended pair is still "
    "checked.",
    fix="Name the other link.",
    bad='<disable_collisions link1="a" link2="a" reason="Never"/>',
    good=APART,
)
def self_pair(subject: Subject) -> Iterator[Problem]:
    """Pairs to disable or to enable."""
    for it in subject.document.root.iterchildren("disable_collisions", "enable_collisions"):
        one = text_of(it, "link1")
        if one and one == text_of(it, "link2"):
            yield Problem(it, f"{one!r} is paired with itself", "link2", "name the other link")


@srdf_rule(
    "MB819",
    "pair-without-shape",
    NOTE,
    what="Collision pairs name links that have no collision geometry.",
    why="MoveIt has nothing to check there, so the lines have no effect. Often the geometry was "
    "forgotten, or the lines were made for another version of the URDF.",
    fix="Give the links a <collision>, or delete the lines.",
    bad=ARM + '<disable_collisions link1="a" link2="c" reason="Never"/>',
    good=ARM + APART,
    line=2,
)
def pair_without_shape(subject: Subject) -> Iterator[Problem]:
    """One finding per link, at its first pair."""
    robot = subject.beside
    reported = set()
    for it in subject.document.root.iterchildren("disable_collisions") if robot else ():
        for attribute in ("link1", "link2"):
            name = text_of(it, attribute)
            if (
                robot
                and name in robot.link
                and name not in reported
                and not _has_shape(robot, name)
            ):
                reported.add(name)
                message = f"{name!r} has no collision geometry"
                yield Problem(
                    it,
                    message,
                    attribute,
                    "delete the line, it has no effect; or add <collision> to the link",
                )


@srdf_rule(
    "MB820",
    "adjacent-links",
    NOTE,
    what="Links that a joint connects are checked for collision with each other.",
    why="Their shapes usually touch, so every state of the robot is in collision and no motion can "
    "be planned.",
    fix="Disable the pair with the reason Adjacent, if the links may touch.",
    bad=ARM + '<disable_collisions link1="a" link2="c" reason="Never"/>',
    good=ARM + APART,
    line=2,
)
def adjacent_links(subject: Subject) -> Iterator[Problem]:
    """One finding per file, if it disables any pair."""
    root, robot = subject.document.root, subject.beside
    pairs = list(root.iterchildren("disable_collisions"))
    if robot is None or not pairs:
        return
    apart = {frozenset((text_of(it, "link1"), text_of(it, "link2"))) for it in pairs}
    alone = {text_of(it, "link") for it in root.iterchildren("disable_default_collisions")}
    left = [it for it in robot.joints if _both_checked(it, robot, alone) and _ends(it) not in apart]
    if left:
        names = ", ".join(f"{it.parent}-{it.child}" for it in left[:SHOWN])
        more = ", ..." if len(left) > SHOWN else ""
        message = f"{len(left)} pairs of adjacent links are checked: {names}{more}"
        yield Problem(pairs[0], message, None, 'disable them with reason="Adjacent"')


def _has_shape(robot: Robot, link: str) -> bool:
    return robot.link[link].element.find("collision") is not None


def _ends(joint: Joint) -> frozenset[str]:
    return frozenset((joint.parent, joint.child))


def _both_checked(joint: Joint, robot: Robot, alone: set[str]) -> bool:
    """Are both links of a joint checked against each other?"""
    ends = _ends(joint)
    return len(ends) == 2 and all(
        it in robot.link and it not in alone and _has_shape(robot, it) for it in ends
    )
