# SPDX-License-Identifier: Apache-2.0
"""Shapes, the scales of their meshes, where they are, and where the centre of mass is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING, rule
from multibot_rewrite.description.checks.links_and_joints import Link
from multibot_rewrite.description.checks.numbers import Vector, vector
from multibot_rewrite.description.checks.poses import Pose, is_same, length, minus, pose_in
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.shapes import Extent, around, extent_of, placed_box
from multibot_rewrite.rules.description.meshes.lookup import box_of
from multibot_rewrite.rules.description.physics import inertia
from multibot_rewrite.rules.facts.memo import memoized, parts
from multibot_rewrite.rules.subject import Elements, Subject

LONG_SHAPE = 50.0
LARGE_SCALE, SMALL_SCALE, UNEVEN = 50.0, 1e-5, 100.0


@rule("MB611", "visual-without-collision", NOTE)
def visual_without_collision(subject: Subject) -> Iterator[Problem]:
    """Report bodies; one finding for the robot if no link has a collision."""
    robot, root = subject.robot, subject.document.root
    if root.tag != "robot" or not robot.joints:
        return
    touch, seen = _bodies_with(subject, "collision"), _bodies_with(subject, "visual")
    bare = [it for it in seen if it not in touch and inertia.moves(robot, it) and it in robot.link]
    if not touch and bare[1:]:
        yield Problem(root, "no link has a <collision>: the robot cannot touch anything")
        return
    for name in bare:
        message = f"link {name!r} has <visual> but no <collision>"
        yield Problem(robot.link[name].element, message, "name")


def _bodies_with(subject: Subject, tag: str) -> dict[str, None]:
    """Return the bodies whose links have such an element, in their order."""
    parents = {it.getparent(): None for it in subject.elements.every(tag)}
    names = [it.get("name", "") for it in parents if it is not None and it.tag == "link"]
    return {subject.robot.body.get(name, name): None for name in names}


@rule("MB614", "shape-units", WARNING)
def shape_units(subject: Subject) -> Iterator[Problem]:
    """Report shapes longer than LONG_SHAPE metres; a long and thin one may be a rail."""
    for shape in _geometries(subject.elements, *inertia.SHAPES):
        sizes = inertia.sizes_of(shape)
        if sizes and min(sizes) >= LONG_SHAPE / 5 and max(sizes) >= LONG_SHAPE:
            words = " x ".join(f"{it:g}" for it in sizes)
            message = f"{shape.tag} of link {_owner(shape)!r} has the size {words} m"
            yield Problem(shape, message, None, "are these millimetres?")


@rule("MB615", "shape-missing", WARNING)
def shape_missing(subject: Subject) -> Iterator[Problem]:
    """Report elements without a shape that urdfdom reads."""
    # MB128 reports a capsule in a file of URDF 1.0.
    known = {*inertia.SHAPES, "mesh", "capsule"}
    found = parts(subject) if subject.document.root.tag == "robot" else ()
    for link, element, geometry, shape in found:
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
    """Yield meshes whose scale mirrors (an odd number of negative factors), is 0 or unusual."""
    for mesh in _geometries(subject.elements, "mesh"):
        scale = vector(mesh.get("scale"))
        if scale is None:
            continue
        low, high = min(map(abs, scale)), max(map(abs, scale))
        of, words = f"mesh of link {_owner(mesh)!r}", mesh.get("scale")
        if scale[0] * scale[1] * scale[2] < 0:
            yield Problem(mesh, f"{of} is mirrored: {words}", "scale", level=NOTE)
        if low == 0:
            yield Problem(mesh, f"{of} is scaled by {words}", "scale")
        elif high >= LARGE_SCALE or low < SMALL_SCALE or high >= UNEVEN * low:
            yield Problem(mesh, f"{of} is scaled by {words}", "scale", level=NOTE)


def _geometries(elements: Elements, *tags: str) -> Iterator[_Element]:
    """Yield the shapes of a URDF with these tags."""
    for shape in elements.every(*tags) if elements.root.tag == "robot" else ():
        parent = shape.getparent()
        if parent is not None and parent.tag == "geometry":
            yield shape


def _owner(shape: _Element) -> str:
    """Return the name of the link that has a shape."""
    link = next(shape.iterancestors("link"), None)
    return "" if link is None else link.get("name", "")


# Metres between shapes that should be in one place, and between two places of one mesh; smaller shapes
# mark a point.
AWAY, MOVED, MARKER = 0.01, 0.05, 0.02
# A centre of mass outside of its link by more than the link's own size; of one with meshes, by
# metres. A smaller mass, in kg, is a placeholder.
FAR, FAR_OF_MESH, LIGHT = 1.0, 3.0, 0.01


@rule("MB631", "collision-away", WARNING)
def collision_away(subject: Subject) -> Iterator[Problem]:
    """Report links with shapes of known size, and links with one mesh for both."""
    for link in subject.robot.links:
        seen, hard = _shapes(subject)[link.element]
        if not seen or not hard or _is_written_alike(subject, seen[0], hard[0]):
            continue
        box = _box_around(subject, seen)
        gap = 0.0 if box is None else _gap(box, _box_around(subject, hard))
        gap = 0.0 if gap and _covers_next(subject, link, hard) else gap
        gap = gap or _distance_moved(subject, seen, hard)
        if gap:
            message = f"the collision of link {link.name!r} is {gap:.3g} m away from its visual"
            yield Problem(hard[0][0], message)


_Shapes = list[tuple[_Element, _Element]]


@memoized
def _shapes(subject: Subject) -> Mapping[_Element, tuple[_Shapes, _Shapes]]:
    """Return by link the shapes of its visuals, and those of its collisions."""
    found: dict[_Element, tuple[_Shapes, _Shapes]]
    found = {it.element: ([], []) for it in subject.robot.links}
    for link, element, _, shape in parts(subject):
        if shape is not None and link in found:
            found[link][element.tag == "collision"].append((element, shape))
    return found


def _is_written_alike(
    subject: Subject, one: tuple[_Element, _Element], other: tuple[_Element, _Element]
) -> bool:
    """Return whether two shapes are written alike, at one place. Most are, and need no computation."""
    (here, shape), (there, same) = one, other
    if shape.tag != same.tag or shape.items() != same.items():
        return False
    origins = [subject.elements.first("origin").get(it) for it in (here, there)]
    written = [[] if it is None else it.items() for it in origins]
    return written[0] == written[1]


def _pose_of(subject: Subject, element: _Element) -> Pose | None:
    return pose_in(subject.elements.first("origin").get(element))


def _box_around(subject: Subject, shapes: _Shapes) -> Extent | None:
    """Return the box around some shapes; None if one of them has no known size."""
    found = []
    for element, shape in shapes:
        own = _pose_of(subject, element)
        extent = None if own is None else _extent(subject, shape, own)
        if extent is None:
            return None
        found.append(extent)
    return around(found)


def _extent(subject: Subject, shape: _Element, pose: Pose) -> Extent | None:
    """Return the box around a shape or mesh; None for one of unknown size."""
    if shape.tag != "mesh":
        return extent_of(shape, pose)
    box = box_of(subject, shape)
    return placed_box(box, pose) if box else None


def _gap(one: Extent, other: Extent | None) -> float:
    """Return how far two boxes are apart; 0 if they touch or the other is unknown."""
    if other is None:
        return 0.0
    if min(max(minus(it.high, it.low)) for it in (one, other)) < MARKER:
        return 0.0
    gap = _apart(one, other)
    return gap if gap > AWAY else 0.0


def _apart(one: Extent, other: Extent) -> float:
    """Return how far two boxes are apart; below 0 if one is in the other."""
    ways = zip(one.low, one.high, other.low, other.high, strict=True)
    return max(max(low - b, a - high) for low, high, a, b in ways)


def _covers_next(subject: Subject, link: Link, hard: _Shapes) -> bool:
    """Return whether the collision is where a link below is seen, such as a motor in a leg's hip."""
    own = _box_around(subject, hard)
    for joint in subject.robot.below.get(link.name, ()):
        child, pose = subject.robot.link.get(joint.child), _pose_of(subject, joint.element)
        box = _box_around(subject, _shapes(subject)[child.element][0]) if child else None
        if box and own and pose and _apart(placed_box(box, pose), own) <= 0:
            return True
    return False


def _distance_moved(subject: Subject, seen: _Shapes, hard: _Shapes) -> float:
    """Return how far the one collision is from the one visual of the same mesh."""
    if len(seen) != 1 or len(hard) != 1:
        return 0.0
    (one, visual), (other, collision) = seen[0], hard[0]
    if visual.tag != "mesh" or visual.items() != collision.items():
        return 0.0
    here, there = _pose_of(subject, one), _pose_of(subject, other)
    # Of a mesh that is turned as well it is unknown where it ends up.
    if here is None or there is None or not is_same(here.matrix, there.matrix):
        return 0.0
    way = length(minus(here.at, there.at))
    return way if way > MOVED else 0.0


@rule("MB632", "centre-of-mass-outside", WARNING)
def centre_of_mass_outside(subject: Subject) -> Iterator[Problem]:
    """Report links with shapes of known size; others only if the centre is metres from all."""
    for link, inertial in inertia.inertials(subject.robot):
        if (inertial.mass or 0) < LIGHT:
            continue
        origin = subject.elements.first("origin").get(inertial.element)
        centre = None if origin is None else vector(origin.get("xyz"))
        if centre is None or not any(centre):
            continue
        if way := _outside(subject, link, centre):
            message = f"the centre of mass of link {link.name!r} is {way:.3g} m outside of it"
            yield Problem(inertia.part_of(inertial, "origin"), message, "xyz")


def _outside(subject: Subject, link: Link, centre: Vector) -> float:
    """Return how far a centre is from the shapes of its link, in metres; 0 if near enough."""
    seen, hard = _shapes(subject)[link.element]
    shapes = seen + hard
    # A mesh may show less than what weighs: the shafts of an arm's wrist are within the link before.
    box = None if any(it.tag == "mesh" for _, it in shapes) else _box_around(subject, shapes)
    if box is None:
        # How far it is from all that is known of the link: its joints and the places of its shapes.
        if length(centre) < FAR_OF_MESH:
            return 0.0
        below = [it.element for it in subject.robot.below.get(link.name, ())]
        places = [_pose_of(subject, it) for it in (*below, *(element for element, _ in shapes))]
        known = [(0.0, 0.0, 0.0), *(it.at for it in places if it is not None)]
        way = min((length(minus(centre, it)) for it in known), default=inf)
        return way if way > FAR_OF_MESH else 0.0
    size = max(minus(box.high, box.low))
    ways = zip(box.low, box.high, centre, strict=True)
    way = max(max(low - at, at - high) for low, high, at in ways)
    return way if way > FAR * size + MOVED else 0.0
