# SPDX-License-Identifier: Apache-2.0
"""How large the boxes, cylinders, spheres and Collada meshes of links are, and a robot's reach.

``<unit>`` counts, ``<up_axis>`` does not: RViz has Assimp ignore it (assimp_loader.cpp sets
AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION), and ColladaLoader.cc of gz-common does not read
it. Corners without a triangle count: the box may be too large. For the reach a mesh counts by
its place."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import reduce
from io import BytesIO
from itertools import count
from math import cos, hypot, inf, isfinite, radians, sin, sqrt
from typing import NamedTuple

from lxml.etree import XMLSyntaxError, _Element, iterparse

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
        """The centre of the box."""
        return scaled(plus(self.low, self.high), 0.5)


def extent_of(shape: _Element, pose: Pose) -> Extent | None:
    """Return the box around a box, cylinder or sphere at a pose; None for other shapes."""
    half = _half_size(shape)
    if half is None:
        return None
    if shape.tag == "sphere" or pose.matrix is STRAIGHT:
        return Extent(minus(pose.at, half), plus(pose.at, half))
    return placed_box(Extent(scaled(half, -1), half), pose)


def placed_box(box: Extent, pose: Pose) -> Extent:
    """Return the box around a box at a pose."""
    centre = point_in(pose, box.middle)
    x, y, z = minus(box.high, box.middle)
    reach = _vector_of(abs(a) * x + abs(b) * y + abs(c) * z for a, b, c in pose.matrix)
    return Extent(minus(centre, reach), plus(centre, reach))


def _half_size(shape: _Element) -> Vector | None:
    """Return half of a shape's size along its own axes."""
    if shape.tag == "box":
        size = vector(_written_size(shape, "size"))
        return None if size is None or min(size) <= 0 else scaled(size, 0.5)
    if shape.tag not in ("cylinder", "sphere"):
        return None
    sizes = numbers(
        f"{_written_size(shape, 'radius') or '?'} {_written_size(shape, 'length') or '0'}"
    )
    if not sizes or sizes[1:2] == () or sizes[0] <= 0:
        return None
    return sizes[0], sizes[0], (sizes[0] if shape.tag == "sphere" else sizes[1] / 2)


def _written_size(shape: _Element, key: str) -> str | None:
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
    return Extent(_vector_of(map(min, low)), _vector_of(map(max, high)))


def _vector_of(values: Iterable[float]) -> Vector:
    x, y, z = values
    return x, y, z


def way_out(shape: _Element, start: Vector, along: Vector) -> float:
    """Return the distance from a point inside a shape to its face, in its frame; 0 if outside."""
    half = _half_size(shape)
    if half is None:
        return 0.0
    if shape.tag == "sphere":
        return _to_round_face(start, along, half[0])
    if shape.tag == "cylinder":
        flat = _to_round_face((start[0], start[1], 0.0), (along[0], along[1], 0.0), half[0])
        return min(flat, _distance_to_flat_face(start[2], along[2], half[2]))
    return min(map(_distance_to_flat_face, start, along, half))


def _distance_to_flat_face(start: float, along: float, half: float) -> float:
    if abs(start) > half:
        return 0.0
    return inf if along == 0 else (half - start * (1 if along > 0 else -1)) / abs(along)


def _to_round_face(start: Vector, along: Vector, radius: float) -> float:
    """Return the distance from a point inside to the round face; 0 if outside."""
    rest = radius * radius - dot(start, start)
    square, middle = dot(along, along), dot(start, along)
    if rest < 0:
        return 0.0
    return inf if square == 0 else (sqrt(middle * middle + square * rest) - middle) / square


def reach_of(root: _Element) -> float:
    """Return a robot's radius in metres around its root link, joints at 0; 0 without any size."""
    robot = read_robot(root)
    poses = link_poses(robot)
    return _radius_of_corners(
        [(it.element, poses[it.name], origin_of) for it in robot.links if it.name in poses]
    )


def filled_by(root: _Element) -> float:
    """Return the radius in metres that a robot fills however it is turned: half of its reach."""
    # Two robots overlap if they are nearer than both radii. In SDF the model's origin counts.
    if reach := reach_of(root):
        return reach / 2
    # The first model of an SDF, but for links whose pose another frame decides.
    model = root if root.tag == "model" else next(root.iter("model"), None)
    posed = ((it, _sdf_pose(it)) for it in (() if model is None else model.iterchildren("link")))
    return _radius_of_corners([(it, pose, _sdf_pose) for it, pose in posed if pose is not None]) / 2


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


def _radius_of_corners(links: Sequence[_Placed]) -> float:
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


# Rows of a matrix of 3 x 4: a rotation that may scale, and a place.
_Rows = tuple[tuple[float, ...], ...]
_SAME: _Rows = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
# More nodes come of nodes that are put into each other, again and again.
_MOST_NODES = 10_000
_READ_AT_ONCE = ("{*}geometry", "{*}controller", "{*}animation")
_TINY = 1e-12


class _File(NamedTuple):
    """What is kept of a file: the corners of each geometry as columns, and the nodes of its scene."""

    corners: dict[str, tuple[Sequence[float], ...]]
    nodes: dict[str, _Element]


def collada_box(data: bytes) -> Extent | None:
    """Return the box around the scene of a file, in metres; None if it cannot be computed."""
    corners = {}
    stream = iterparse(BytesIO(data), tag=_READ_AT_ONCE, resolve_entities=False)
    try:
        for _, it in stream:
            if it.tag.endswith("}geometry"):
                corners[it.get("id", "")] = _mesh_corners(it)
            it.clear()
        root = stream.root
        nodes = {it.get("id", ""): it for it in root.iter("{*}node", "{*}visual_scene")}
        file = _File(corners, nodes)
        unit = float(_attribute_at(root, "{*}asset/{*}unit", "meter") or 1.0)
        scene = _target(_attribute_at(root, "{*}scene/{*}instance_visual_scene", "url"))
        scaled = tuple(tuple(unit * it for it in row) for row in _SAME)
        boxes = list(_boxes(file, file.nodes[scene], scaled, count()))
    except (XMLSyntaxError, ValueError, KeyError, IndexError, RecursionError):
        return None
    known = boxes and all(isfinite(sum(it.low) + sum(it.high)) for it in boxes)
    return around(boxes) if known else None


def _mesh_corners(geometry: _Element) -> tuple[Sequence[float], ...]:
    """Return the columns x, y and z of a mesh; none for another geometry."""
    inputs = geometry.iterfind("{*}mesh/{*}vertices/{*}input")
    wanted = [_target(it.get("source", "")) for it in inputs if it.get("semantic") == "POSITION"]
    sources = {it.get("id", ""): it for it in geometry.iterfind("{*}mesh/{*}source")}
    if not wanted:
        return ()
    source = sources[wanted[0]]
    accessor = source.find("{*}technique_common/{*}accessor")
    step, first = (
        int(accessor.get(name, default)) if accessor is not None else int(default)
        for name, default in (("stride", "3"), ("offset", "0"))
    )
    values = [float(it) for it in (source.findtext("{*}float_array") or "").split()]
    columns = tuple(values[first + at :: max(step, 1)] for at in range(3))
    return columns if all(columns) else ()


def _boxes(file: _File, node: _Element, above: _Rows, visits: Iterator[int]) -> Iterator[Extent]:
    """Yield the boxes around the shapes of a node and of all nodes below it."""
    if next(visits) > _MOST_NODES or node.find("{*}instance_controller") is not None:
        raise ValueError("too many nodes, or a skin, which its bones move")
    rows = reduce(_combined_transform, filter(None, map(_transform, node)), above)
    for it in node.iterchildren("{*}instance_geometry"):
        if columns := file.corners[_target(it.get("url", ""))]:
            ends = [_ends(row, columns) for row in rows]
            yield Extent(*zip(*ends, strict=True))
    for it in node.iterchildren("{*}instance_node"):
        yield from _boxes(file, file.nodes[_target(it.get("url", ""))], rows, visits)
    for it in node.iterchildren("{*}node"):
        yield from _boxes(file, it, rows, visits)


def _ends(row: Sequence[float], columns: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Return (least, largest) coordinate of all corners along an axis."""
    used = [(it, column) for it, column in zip(row, columns, strict=False) if abs(it) > _TINY]
    at = row[3]
    if len(used) == 1:
        ((factor, column),) = used
        low, high = sorted((factor * min(column), factor * max(column)))
        return low + at, high + at
    a, b, c, _ = row
    places = [a * x + b * y + c * z for x, y, z in zip(*columns, strict=False)]
    return min(places) + at, max(places) + at


def _transform(element: _Element) -> _Rows | None:
    """Return the transform that a child of a node applies to it; None for another child."""
    name = str(element.tag).rpartition("}")[2]
    if name in ("lookat", "skew"):
        raise ValueError("a transform of cameras")
    if name not in ("matrix", "translate", "rotate", "scale"):
        return None
    values = [float(it) for it in (element.text or "").split()]
    if name == "matrix":
        return tuple(tuple(values[at : at + 4]) for at in (0, 4, 8))
    x, y, z, *more = values
    if name == "translate":
        return (1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z)
    return _rotation(x, y, z, more[0]) if more else ((x, 0, 0, 0), (0, y, 0, 0), (0, 0, z, 0))


def _rotation(x: float, y: float, z: float, degrees: float) -> _Rows:
    """Return the rotation by an angle about an axis."""
    length = sqrt(x * x + y * y + z * z)
    if not length:
        return _SAME
    x, y, z = x / length, y / length, z / length
    s, c = sin(radians(degrees)), cos(radians(degrees))
    d = 1 - c
    return (
        (x * x * d + c, x * y * d - z * s, x * z * d + y * s, 0.0),
        (y * x * d + z * s, y * y * d + c, y * z * d - x * s, 0.0),
        (z * x * d - y * s, z * y * d + x * s, z * z * d + c, 0.0),
    )


def _combined_transform(outer: _Rows, inner: _Rows) -> _Rows:
    columns = [*zip(*inner, strict=True)]
    return tuple(
        tuple(
            row[0] * p + row[1] * q + row[2] * r + (row[3] if at == 3 else 0.0)
            for at, (p, q, r) in enumerate(columns)
        )
        for row in outer
    )


def _attribute_at(root: _Element, path: str, name: str) -> str:
    found = root.find(path)
    return "" if found is None else found.get(name, "")


def _target(url: str) -> str:
    """Return the id that a reference within the file has; raises ValueError for another file."""
    if not url.startswith("#"):
        raise ValueError(url)
    return url[1:]
