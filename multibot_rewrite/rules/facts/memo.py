# SPDX-License-Identifier: Apache-2.0
"""What several rules need of one document is computed once and kept with its subject; and what an
error may rest on: that nothing elsewhere and no other release makes it right.

What may be right all the same is a warning, or a note.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import wraps
from typing import NamedTuple, TypeVar

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.links_and_joints import roots
from multibot_rewrite.description.checks.poses import Pose
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject

_Made = TypeVar("_Made")


def memoized(make: Callable[[Subject], _Made]) -> Callable[[Subject], _Made]:
    """Decorates a function of a subject: it runs once for each, ``subject.memo`` has the result."""

    @wraps(make)
    def look_up(subject: Subject) -> _Made:
        memo = subject.memo
        if make not in memo:
            memo[make] = make(subject)
        made: _Made = memo[make]
        return made

    return look_up


@memoized
def link_poses(subject: Subject) -> Mapping[str, Pose]:
    """Each link's pose in the root of its tree; those below an origin that is no number are left
    out."""
    return poses.link_poses(subject.robot)


@memoized
def driven_joints(subject: Subject) -> frozenset[str]:
    """The joints that ``<ros2_control>``, transmissions and plugins name."""
    claims = subject.inventory.claims
    return frozenset(
        it.value for it in claims if it.site.whole_value_kind == "joint" and _drives_a_joint(it)
    )


def _drives_a_joint(claim: Claim) -> bool:
    return claim.site.role == "uses" and claim.site.section != "element joint"


class LinkPart(NamedTuple):
    """A ``<visual>`` or ``<collision>`` of a link: its first ``<geometry>``, and the shape in that."""

    link: _Element
    element: _Element
    geometry: _Element | None
    shape: _Element | None


@memoized
def parts(subject: Subject) -> list[LinkPart]:
    """All visuals of links in document order, then all collisions."""
    geometries = subject.elements.first("geometry")
    found = []
    for element in subject.elements.every("visual", "collision"):
        link = element.getparent()
        if link is not None and link.tag == "link":
            geometry = geometries.get(element)
            shape = None if geometry is None else _first(geometry)
            found.append(LinkPart(link, element, geometry, shape))
    return found


def _first(geometry: _Element) -> _Element | None:
    """The first element in it. Mostly there is no comment before it, and that is quick to see."""
    if not len(geometry):
        return None
    first = geometry[0]
    return first if isinstance(first.tag, str) else next(geometry.iterchildren("*"), None)


@memoized
def level_of_absence(subject: Subject) -> str:
    """How bad it is that a description lacks something: a xacro file may be a part of a robot, or have
    it behind a condition. What is a part for certain has links that all hang on others."""
    robot = subject.robot
    is_part = robot.links and not roots(robot) and any(it not in robot.link for it in robot.below)
    levels = (WARNING, NOTE) if subject.origins else (ERROR, WARNING)
    return levels[bool(is_part)]


def lacking(subject: Subject, found: Iterable[Problem]) -> Iterator[Problem]:
    """What a description lacks, no louder than that it does may be told."""
    level = level_of_absence(subject)
    for it in found:
        yield it if level == ERROR or (it.level and level == WARNING) else it._replace(level=level)


def since_jazzy(subject: Subject) -> str:
    """The level of what ros2_control refuses since Jazzy: in Humble it goes on without."""
    return WARNING if subject.settings.distro == OF_OLD else ""
