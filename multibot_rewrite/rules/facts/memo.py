# SPDX-License-Identifier: Apache-2.0
"""What several rules need of one document is computed once and kept with its subject."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import TypeVar

from lxml.etree import _Element

from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.poses import Pose
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
