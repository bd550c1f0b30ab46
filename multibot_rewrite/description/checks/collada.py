# SPDX-License-Identifier: Apache-2.0
"""How large a Collada mesh is, as RViz and Gazebo show it.

``<unit>`` counts, ``<up_axis>`` does not: RViz has Assimp ignore it (assimp_loader.cpp sets
AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION), and ColladaLoader.cc of gz-common does not read it.
Corners that no triangle has count too: the box may be larger than what is seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from io import BytesIO
from itertools import count
from math import cos, isfinite, radians, sin, sqrt
from typing import NamedTuple

from lxml.etree import XMLSyntaxError, _Element, iterparse

from multibot_rewrite.description.checks.shapes import Extent, around

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
                corners[it.get("id", "")] = _corners(it)
            it.clear()
        root = stream.root
        nodes = {it.get("id", ""): it for it in root.iter("{*}node", "{*}visual_scene")}
        file = _File(corners, nodes)
        unit = float(_attribute(root, "{*}asset/{*}unit", "meter") or 1.0)
        scene = _target(_attribute(root, "{*}scene/{*}instance_visual_scene", "url"))
        scaled = tuple(tuple(unit * it for it in row) for row in _SAME)
        boxes = list(_boxes(file, file.nodes[scene], scaled, count()))
    except (XMLSyntaxError, ValueError, KeyError, IndexError, RecursionError):
        return None
    known = boxes and all(isfinite(sum(it.low) + sum(it.high)) for it in boxes)
    return around(boxes) if known else None


def _corners(geometry: _Element) -> tuple[Sequence[float], ...]:
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
    rows = reduce(_product, filter(None, map(_transform, node)), above)
    for it in node.iterchildren("{*}instance_geometry"):
        if columns := file.corners[_target(it.get("url", ""))]:
            ends = [_ends(row, columns) for row in rows]
            yield Extent(*zip(*ends, strict=True))
    for it in node.iterchildren("{*}instance_node"):
        yield from _boxes(file, file.nodes[_target(it.get("url", ""))], rows, visits)
    for it in node.iterchildren("{*}node"):
        yield from _boxes(file, it, rows, visits)


def _ends(row: Sequence[float], columns: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Return the least and largest coordinate of all corners along an axis."""
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


def _product(outer: _Rows, inner: _Rows) -> _Rows:
    columns = [*zip(*inner, strict=True)]
    return tuple(
        tuple(
            row[0] * p + row[1] * q + row[2] * r + (row[3] if at == 3 else 0.0)
            for at, (p, q, r) in enumerate(columns)
        )
        for row in outer
    )


def _attribute(root: _Element, path: str, name: str) -> str:
    found = root.find(path)
    return "" if found is None else found.get(name, "")


def _target(url: str) -> str:
    """Return the id that a reference within the file has; raises ValueError for another file."""
    if not url.startswith("#"):
        raise ValueError(url)
    return url[1:]
