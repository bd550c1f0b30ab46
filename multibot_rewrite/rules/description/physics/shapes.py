# SPDX-License-Identifier: Apache-2.0
"""Shapes of visuals and collisions, and the scales of their meshes."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.numbers import Vector, vector
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.physics.shared import SHAPES, moves, sizes_of
from multibot_rewrite.rules.facts.elements import Elements
from multibot_rewrite.rules.facts.memo import memoized, parts
from multibot_rewrite.rules.subject import Subject

LONG_SHAPE = 50.0
LARGE_SCALE, SMALL_SCALE, UNEVEN = 50.0, 1e-5, 100.0


@rule("MB611", "visual-without-collision", NOTE)
def visual_without_collision(subject: Subject) -> Iterator[Problem]:
    """Bodies; one finding for the robot where no link has a collision."""
    robot, root = subject.robot, subject.document.root
    if root.tag != "robot" or not robot.joints:
        return
    touch, seen = _bodies_with(subject, "collision"), _bodies_with(subject, "visual")
    bare = [it for it in seen if it not in touch and moves(robot, it) and it in robot.link]
    if not touch and bare[1:]:
        yield Problem(root, "no link has a <collision>: the robot cannot touch anything")
        return
    for name in bare:
        message = f"link {name!r} has <visual> but no <collision>"
        yield Problem(robot.link[name].element, message, "name")


def _bodies_with(subject: Subject, tag: str) -> dict[str, None]:
    """The bodies whose links have such an element."""
    parents = {it.getparent(): None for it in subject.elements.every(tag)}
    names = [it.get("name", "") for it in parents if it is not None and it.tag == "link"]
    return {subject.robot.body.get(name, name): None for name in names}


@rule("MB614", "shape-units", WARNING)
def shape_units(subject: Subject) -> Iterator[Problem]:
    """Shapes longer than LONG_SHAPE metres; a long and thin one may be a rail."""
    for shape, sizes in _shapes(subject):
        if min(sizes) >= LONG_SHAPE / 5 and max(sizes) >= LONG_SHAPE:
            words = " x ".join(f"{it:g}" for it in sizes)
            message = f"{shape.tag} of link {_owner(shape)!r} has the size {words} m"
            yield Problem(shape, message, None, "are these millimetres?")


@rule("MB615", "shape-missing", WARNING)
def shape_missing(subject: Subject) -> Iterator[Problem]:
    """Elements without a shape that urdfdom reads."""
    # MB128 reports a capsule in a file of URDF 1.0.
    known = {*SHAPES, "mesh", "capsule"}
    for link, element, geometry, shape in (
        parts(subject) if subject.document.root.tag == "robot" else ()
    ):
        if shape is None:
            lack = "<geometry>" if geometry is None else "shape in its <geometry>"
            message = f"<{element.tag}> of link {link.get('name')!r} has no {lack}"
            yield Problem(element, message)
        elif shape.tag not in known:
            tag = str(shape.tag).rpartition("}")[2]
            message = f"<{element.tag}> of link {link.get('name')!r}: unknown shape <{tag}>"
            yield Problem(shape, message)


@rule("MB616", "mesh-scale", WARNING)
def mesh_scale(subject: Subject) -> Iterator[Problem]:
    """An odd number of negative scales mirrors: two of them are a rotation."""
    for mesh, scale in _scales(subject):
        low, high = min(map(abs, scale)), max(map(abs, scale))
        of, words = f"mesh of link {_owner(mesh)!r}", mesh.get("scale")
        if scale[0] * scale[1] * scale[2] < 0:
            yield Problem(mesh, f"{of} is mirrored: {words}", "scale", level=NOTE)
        if low == 0:
            yield Problem(mesh, f"{of} is scaled by {words}", "scale")
        elif high >= LARGE_SCALE or low < SMALL_SCALE or high >= UNEVEN * low:
            yield Problem(mesh, f"{of} is scaled by {words}", "scale", level=NOTE)


@memoized
def _shapes(subject: Subject) -> list[tuple[_Element, tuple[float, ...]]]:
    """The boxes, cylinders and spheres of a URDF whose sizes are numbers, and those."""
    read = ((it, sizes_of(it)) for it in _geometries(subject.elements, *SHAPES))
    return [(shape, sizes) for shape, sizes in read if sizes]


def _geometries(elements: Elements, *tags: str) -> Iterator[_Element]:
    for shape in elements.every(*tags) if elements.root.tag == "robot" else ():
        parent = shape.getparent()
        if parent is not None and parent.tag == "geometry":
            yield shape


@memoized
def _scales(subject: Subject) -> list[tuple[_Element, Vector]]:
    """The meshes of a URDF that are scaled, and how."""
    read = ((it, vector(it.get("scale"))) for it in _geometries(subject.elements, "mesh"))
    return [(mesh, scale) for mesh, scale in read if scale is not None]


def _owner(shape: _Element) -> str:
    """The name of the link that has a shape."""
    link = next(shape.iterancestors("link"), None)
    return "" if link is None else link.get("name", "")
