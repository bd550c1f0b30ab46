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
from multibot_rewrite.rules.description.references.undeclared import undeclared
from multibot_rewrite.rules.description.srdf.shared import SHOWN, srdf_rule
from multibot_rewrite.rules.subject import Subject


@srdf_rule("MB807", "stale-pair", WARNING)
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


@srdf_rule("MB809", "duplicate-pair", NOTE)
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


@srdf_rule("MB818", "self-pair", WARNING)
def self_pair(subject: Subject) -> Iterator[Problem]:
    """Pairs to disable or to enable."""
    for it in subject.document.root.iterchildren("disable_collisions", "enable_collisions"):
        one = text_of(it, "link1")
        if one and one == text_of(it, "link2"):
            yield Problem(it, f"{one!r} is paired with itself", "link2", "name the other link")


@srdf_rule("MB819", "pair-without-shape", NOTE)
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


@srdf_rule("MB820", "adjacent-links", NOTE)
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
