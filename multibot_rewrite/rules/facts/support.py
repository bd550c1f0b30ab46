# SPDX-License-Identifier: Apache-2.0
"""Where a robot on wheels touches the ground, with every joint at 0."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot

from lxml.etree import _Element

from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.poses import Pose, origin_of, placed, plus, scaled, turned
from multibot_rewrite.description.checks.shapes import extent_of, shapes_of
from multibot_rewrite.rules.facts.drives import drives, radii
from multibot_rewrite.rules.facts.memo import link_poses
from multibot_rewrite.rules.subject import Subject

Point = tuple[float, float]
# A wheel or caster so far above the ground touches it as soon as the robot stands.
LIFTED = 0.02
LEVEL = 0.05


def ground_of(subject: Subject) -> float | None:
    """Return the height of the ground below the wheels of all drives; None where it is unknown."""
    heights = [
        wheel.pose.at[2] - max(found)
        for drive in drives(subject)
        for wheel in (*drive.left, *drive.right)
        if (found := radii(subject.robot, wheel))
    ]
    return min(heights, default=None)


def contacts(subject: Subject) -> list[Point] | None:
    """Return where simple shapes touch the ground; None if a collision is unknown or not simple."""
    ground, poses = ground_of(subject), link_poses(subject)
    if ground is None:
        return None
    found: list[Point] = []
    for link in subject.robot.links:
        for element, shape in shapes_of(link.element, "collision"):
            own = origin_of(element)
            if own is None or link.name not in poses or shape.tag not in _SIMPLE:
                return None
            found += _touching_points(shape, placed(poses[link.name], own), ground + LIFTED)
    return found


_SIMPLE = ("box", "cylinder", "sphere")


def _touching_points(shape: _Element, pose: Pose, height: float) -> Iterator[Point]:
    extent = extent_of(shape, pose)
    if extent is None or extent.low[2] > height:
        return
    axis = turned(pose.matrix, (0.0, 0.0, 1.0))
    if shape.tag == "sphere":
        yield pose.at[:2]
    elif shape.tag == "cylinder" and abs(axis[2]) < LEVEL:
        half = (number(shape.get("length")) or 0) / 2
        yield plus(pose.at, scaled(axis, half))[:2]
        yield plus(pose.at, scaled(axis, -half))[:2]
    else:
        for x in (extent.low[0], extent.high[0]):
            for y in (extent.low[1], extent.high[1]):
                yield x, y


def hull(points: Sequence[Point]) -> list[Point]:
    """Return the corners of the smallest convex area around points, counter-clockwise."""
    ordered = sorted(set(points))
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return lower[:-1] + upper[:-1]


def _chain(points: Sequence[Point]) -> list[Point]:
    """Return the points that turn left from each to the next."""
    found: list[Point] = []
    for it in points:
        while len(found) > 1 and side(found[-2], found[-1], it) <= 0:
            found.pop()
        found.append(it)
    return found


def side(start: Point, end: Point, point: Point) -> float:
    """Return a number above 0 if a point is left of the line from ``start`` to ``end``."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])


def beyond(corners: Sequence[Point], point: Point) -> float:
    """Return how far a point is outside of a convex area, or from a line; below 0 inside of it."""
    edges = zip(corners, [*corners[1:], corners[0]], strict=True)
    return max(-side(a, b, point) / hypot(b[0] - a[0], b[1] - a[1]) for a, b in edges)
