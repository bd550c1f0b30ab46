# SPDX-License-Identifier: Apache-2.0
"""How large the simple shapes of links are: boxes, cylinders and spheres, and how far a robot reaches
with them. A mesh is a file: ``mesh_box`` reads it; for the reach its place alone counts, as that of a
link without a shape."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from math import hypot, inf, sqrt
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import read_robot
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.poses import (
    HERE,
    STRAIGHT,
    Pose,
    dot,
    link_poses,
    minus,
    origin_of,
    placed,
    plus,
    point_in,
    pose_of_six,
    scaled,
)


class Extent(NamedTuple):
    """A box along the axes of a frame, from ``low`` to ``high``."""

    low: Vector
    high: Vector

    @property
    def middle(self) -> Vector:
        """Its centre."""
        return scaled(plus(self.low, self.high), 0.5)


def extent_of(shape: _Element, pose: Pose) -> Extent | None:
    """Return the box around a box, cylinder or sphere at a pose; None for other shapes."""
    half = _half(shape)
    if half is None:
        return None
    if shape.tag == "sphere" or pose.matrix is STRAIGHT:
        return Extent(minus(pose.at, half), plus(pose.at, half))
    return placed_box(Extent(scaled(half, -1), half), pose)


def placed_box(box: Extent, pose: Pose) -> Extent:
    """Return the box around a box at a pose."""
    centre = point_in(pose, box.middle)
    x, y, z = minus(box.high, box.middle)
    reach = _three(abs(a) * x + abs(b) * y + abs(c) * z for a, b, c in pose.matrix)
    return Extent(minus(centre, reach), plus(centre, reach))


def _half(shape: _Element) -> Vector | None:
    """Return half of a shape's size along its own axes."""
    if shape.tag == "box":
        size = vector(_said(shape, "size"))
        return None if size is None or min(size) <= 0 else scaled(size, 0.5)
    if shape.tag not in ("cylinder", "sphere"):
        return None
    sizes = numbers(f"{_said(shape, 'radius') or '?'} {_said(shape, 'length') or '0'}")
    if not sizes or sizes[1:2] == () or sizes[0] <= 0:
        return None
    return sizes[0], sizes[0], (sizes[0] if shape.tag == "sphere" else sizes[1] / 2)


def _said(shape: _Element, key: str) -> str | None:
    """Return a size as it is written: an attribute in URDF, an element in SDF."""
    value = shape.get(key)
    return shape.findtext(key) if value is None else value


def shapes_of(link: _Element, tag: str) -> Iterator[tuple[_Element, _Element]]:
    """Yield the ``<visual>`` or ``<collision>`` elements of a link, each with its shape."""
    for element in link.iterchildren(tag):
        geometry = next(element.iterchildren("geometry"), None)
        shape = None if geometry is None else next(geometry.iterchildren("*"), None)
        if shape is not None:
            yield element, shape


def around(extents: Iterable[Extent]) -> Extent | None:
    """Return the box around some boxes; None around nothing."""
    every = list(extents)
    if not every:
        return None
    low, high = (list(zip(*its, strict=True)) for its in zip(*every, strict=True))
    return Extent(_three(map(min, low)), _three(map(max, high)))


def _three(values: Iterable[float]) -> Vector:
    x, y, z = values
    return x, y, z


def way_out(shape: _Element, start: Vector, along: Vector) -> float:
    """Return the distance from a point inside a shape to its face; 0 from a point outside. All in
    its frame."""
    half = _half(shape)
    if half is None:
        return 0.0
    if shape.tag == "sphere":
        return _round_way(start, along, half[0])
    if shape.tag == "cylinder":
        flat = _round_way((start[0], start[1], 0.0), (along[0], along[1], 0.0), half[0])
        return min(flat, _flat_way(start[2], along[2], half[2]))
    return min(map(_flat_way, start, along, half))


def _flat_way(start: float, along: float, half: float) -> float:
    if abs(start) > half:
        return 0.0
    return inf if along == 0 else (half - start * (1 if along > 0 else -1)) / abs(along)


def _round_way(start: Vector, along: Vector, radius: float) -> float:
    rest = radius * radius - dot(start, start)
    square, middle = dot(along, along), dot(start, along)
    if rest < 0:
        return 0.0
    return inf if square == 0 else (sqrt(middle * middle + square * rest) - middle) / square


def reach_of(root: _Element) -> float:
    """Return the radius in metres of the upright cylinder around the root link with the robot's
    collisions, or its visuals, with every joint at 0; 0 if nothing has a size, and for an SDF."""
    robot = read_robot(root)
    poses = link_poses(robot)
    return _reach(
        [(it.element, poses[it.name], origin_of) for it in robot.links if it.name in poses]
    )


def filled_by(root: _Element) -> float:
    """Return the radius that a robot surely fills, however it is turned: half of its reach, in SDF from
    the origin of its model. Two robots overlap if they are nearer than both radii."""
    if reach := reach_of(root):
        return reach / 2
    # The first model of an SDF, but for links whose pose another frame decides.
    model = root if root.tag == "model" else next(root.iter("model"), None)
    posed = ((it, _sdf_pose(it)) for it in (() if model is None else model.iterchildren("link")))
    return _reach([(it, pose, _sdf_pose) for it, pose in posed if pose is not None]) / 2


_Placed = tuple[_Element, Pose, Callable[[_Element], Pose | None]]


def _sdf_pose(element: _Element) -> Pose | None:
    """Return the ``<pose>`` of an element; None if it is in another frame or unit."""
    written = element.find("pose")
    if written is None:
        return HERE
    values = numbers(written.text or "0 0 0 0 0 0")
    if written.attrib or values is None or len(values) != 6:
        return None
    return pose_of_six(values)


def _reach(links: Sequence[_Placed]) -> float:
    corners = [*_corners(links, "collision")] or [*_corners(links, "visual")]
    return max((hypot(x, y) for x, y, _ in corners), default=0.0)


def _corners(links: Iterable[_Placed], tag: str) -> Iterator[Vector]:
    """Yield the corners of the boxes around all shapes."""
    for link, pose, pose_of_shape in links:
        for element, shape in shapes_of(link, tag):
            own = pose_of_shape(element)
            extent = extent_of(shape, placed(pose, own)) if own else None
            if extent:
                (x1, y1, z), (x2, y2, _) = extent
                yield from ((x, y, z) for x in (x1, x2) for y in (y1, y2))
