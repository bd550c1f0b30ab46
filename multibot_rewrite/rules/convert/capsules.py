# SPDX-License-Identifier: Apache-2.0
"""A ``<capsule>`` as a cylinder and two spheres: the same set of points.

The ``length`` is that of the cylinder alone (urdfdom's README, version 1.1). The cylinder stays where
the capsule is; the spheres go to the end of the link, so that the numbers of other collisions stay.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.numbers import Vector, number
from multibot_rewrite.description.checks.poses import Pose, pose_of
from multibot_rewrite.description.checks.rotation import turned
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.rules.convert.spans import Spanned, end_of, end_tag_of

CAPSULE, CYLINDER = b"capsule", b"cylinder"
HOLDERS = ("visual", "collision")
# What a sphere may do without.
_PLAIN = frozenset(("origin", "geometry", "material", "verbose"))
_CLOSED = lazy_compile(rb"\s*</(capsule)\s*>")


def capsules(link: _Element) -> list[tuple[_Element, _Element]]:
    """The capsules that are read of a link, each with its visual or collision."""
    found = []
    for holder in link.iterchildren(*HOLDERS):
        geometry = next(holder.iterchildren("geometry"), None)
        shape = None if geometry is None else next(geometry.iterchildren("*"), None)
        if shape is not None and shape.tag == "capsule":
            found.append((shape, holder))
    return found


def capsule_edits(text: Spanned, link: _Element) -> tuple[Edit, ...]:
    """The edits for all capsules of a link; none where one of them means more than its shape."""
    found = capsules(link)
    if not found or not all(_is_plain(text, link, *it) for it in found):
        return ()
    edits = [edit for shape, _ in found for edit in _cylinder(text, shape)]
    spheres = [it for shape, holder in found for it in _spheres(text, shape, holder)]
    return (*edits, _at_the_end(text, link, found[0][1], spheres))


def ends_of(pose: Pose, length: float) -> tuple[Vector, Vector]:
    """The centres of the half spheres of a capsule."""
    x, y, z = turned(pose.matrix, (0.0, 0.0, length / 2))
    (a, b, c) = pose.at
    return (a + x, b + y, c + z), (a - x, b - y, c - z)


def _is_plain(text: Spanned, link: _Element, shape: _Element, holder: _Element) -> bool:
    """Is it a shape and nothing else: nobody may ask for this collision by its name."""
    asked = f"{link.get('name')}_collision".encode() in text.source or holder.get("name")
    if holder.tag == "collision" and asked:
        return False
    sizes = [number(shape.get(it)) for it in ("length", "radius")]
    known = {it.tag for it in holder.iterchildren("*")} <= _PLAIN
    return known and all(it is not None and it > 0 for it in sizes) and _pose(holder) is not None


def _pose(holder: _Element) -> Pose | None:
    return pose_of(next(holder.iterchildren("origin"), None))


def _cylinder(text: Spanned, shape: _Element) -> Iterator[Edit]:
    start = text.starts[shape] + 1
    yield Edit(start, start + len(CAPSULE), CYLINDER, None)
    closed = _CLOSED.match(text.source, tag_end(text.source, start - 1))
    if closed:
        yield Edit(closed.start(1), closed.end(1), CYLINDER, None)


def _spheres(text: Spanned, shape: _Element, holder: _Element) -> Iterator[bytes]:
    pose, length = _pose(holder), number(shape.get("length"))
    materials = (
        text.source[text.starts[it] : end_of(text, it)] for it in holder.iterchildren("material")
    )
    material = b"".join(materials)
    radius = f'<geometry><sphere radius="{shape.get("radius")}"/></geometry>'
    for end in ends_of(pose, length) if pose and length else ():
        xyz = " ".join(map(written, end))
        head = f'<{holder.tag}><origin xyz="{xyz}"/>{radius}'.encode()
        yield head + material + f"</{holder.tag}>".encode()


def _at_the_end(text: Spanned, link: _Element, like: _Element, spheres: Sequence[bytes]) -> Edit:
    """The spheres before the end tag of the link, a line each where the link's end has its own."""
    at = end_tag_of(text, link)
    margin, inner = map(partial(_margin, text.source), (at, text.starts[like]))
    if margin is None:
        lines = b"".join(spheres)
    else:
        more = (inner or b"").removeprefix(margin)
        line_end = b"\r\n" if b"\r\n" in text.source else b"\n"
        lines = b"".join(more + it + line_end + margin for it in spheres)
    return Edit(at, at + 2, lines + text.source[at : at + 2], None)


def _margin(source: bytes, at: int) -> bytes | None:
    """The white space before it in its line; None where there is more than that."""
    line = source[source.rfind(b"\n", 0, at) + 1 : at]
    return None if line.strip() or b"\n" not in source[:at] else line


def written(value: float) -> str:
    """A number as the shortest text that reads back as it."""
    return f"{value + 0.0!r}".removesuffix(".0")
