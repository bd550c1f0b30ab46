# SPDX-License-Identifier: Apache-2.0
"""A URDF -> links with shapes, and joints, as the view draws them. What is no number counts as missing:
the lint reports it.

Source: urdfdom urdf_parser: a material without a colour is that of its name in the robot; an axis is
x, a mimic's factor 1 where none is written.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import pi

from lxml.etree import _Element

from multibot_rewrite.description.checks.numbers import numbers, vector
from multibot_rewrite.description.checks.poses import HERE, X, origin_of
from multibot_rewrite.pages.view.models import (
    UNCOLOURED,
    Joint,
    Matrix,
    Model,
    Shape,
    matrix_of,
    mesh_shape,
)

Colour = tuple[float, ...]


def load_urdf(root: _Element, source: str) -> Model:
    """The model of a URDF; ``source`` is the file it was made from. Raises nothing."""
    named = {it.get("name", ""): _rgba(it) for it in root.iterchildren("material")}
    links = {
        it.get("name", ""): tuple(_shapes(it, named, source)) for it in root.iterchildren("link")
    }
    return Model(links, tuple(map(_joint, root.iterchildren("joint"))))


def _rgba(material: _Element | None) -> Colour:
    written = None if material is None else material.find("color")
    found = None if written is None else numbers(written.get("rgba", ""))
    return found if found and len(found) == 4 else UNCOLOURED


def _pose(element: _Element) -> Matrix:
    return matrix_of(origin_of(element) or HERE)


def _shapes(link: _Element, named: Mapping[str, Colour], source: str) -> Iterator[Shape]:
    for visual in link.iterchildren("visual"):
        material = visual.find("material")
        name = "" if material is None else material.get("name", "")
        colour = _rgba(material) or named.get(name, UNCOLOURED)
        for it in visual.iterfind("geometry/*"):
            yield from _shape(it, _pose(visual), colour, source)


def _shape(it: _Element, pose: Matrix, colour: Colour, source: str) -> Iterator[Shape]:
    size = vector(it.get("size", ""))
    radius, long = (numbers(it.get(name, "")) for name in ("radius", "length"))
    if it.tag == "box" and size:
        yield Shape("box", size, pose, colour)
    elif it.tag in ("cylinder", "capsule") and radius and long:
        yield Shape("cylinder", (radius[0], long[0]), pose, colour)
    elif it.tag == "sphere" and radius:
        yield Shape("sphere", radius[:1], pose, colour)
    elif it.tag == "mesh":
        scale = vector(it.get("scale", "")) or (1.0, 1.0, 1.0)
        yield mesh_shape(it.get("filename", ""), scale, pose, colour, source)


def _joint(it: _Element) -> Joint:
    parent, child = (_named(it, tag, "link") for tag in ("parent", "child"))
    axis = it.find("axis")
    kind = it.get("type", "")
    return Joint(
        it.get("name", ""),
        kind,
        parent,
        child,
        _pose(it),
        X if axis is None else vector(axis.get("xyz", "")) or X,
        *_limits(it, kind),
        _mimic(it),
    )


def _named(joint: _Element, tag: str, key: str) -> str:
    found = joint.find(tag)
    return "" if found is None else found.get(key, "")


def _limits(joint: _Element, kind: str) -> tuple[float, float]:
    if kind == "continuous":
        return -round(pi, 4), round(pi, 4)
    if kind not in ("revolute", "prismatic"):
        return 0.0, 0.0
    return _number(joint, "limit", "lower", 0.0), _number(joint, "limit", "upper", 0.0)


def _number(joint: _Element, tag: str, key: str, default: float) -> float:
    found = numbers(_named(joint, tag, key))
    return found[0] if found else default


def _mimic(joint: _Element) -> tuple[str, float, float] | None:
    leader = _named(joint, "mimic", "joint")
    if not leader:
        return None
    return (
        leader,
        _number(joint, "mimic", "multiplier", 1.0),
        _number(joint, "mimic", "offset", 0.0),
    )
