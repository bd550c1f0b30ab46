# SPDX-License-Identifier: Apache-2.0
"""Edits that make a description one of another version of URDF, where it means the same in both.

A ``<capsule>`` becomes a cylinder and two spheres: the same set of points. The ``length`` is that
of the cylinder alone (urdfdom's README, version 1.1). The cylinder stays where the capsule is; the
spheres go to the end of the link, so that the numbers of other collisions stay."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.numbers import Vector, number
from multibot_rewrite.description.steps.document import Document, attribute_slot, tag_end
from multibot_rewrite.rules.schema.versions import OLDEST, Version


class Spanned(NamedTuple):
    """A document, and where its elements start."""

    document: Document
    starts: Mapping[_Element, int]

    @property
    def source(self) -> bytes:
        """The bytes of the document."""
        return self.document.source


def text_of(document: Document) -> Spanned:
    """Return the text of a document with the places of its elements."""
    return Spanned(document, dict(zip(document.elements, document.starts, strict=True)))


def end_of(text: Spanned, element: _Element) -> int:
    """Return the offset right after an element's end tag."""
    end = tag_end(text.source, text.starts[element])
    if text.source[end - 2 : end] == b"/>":
        return end
    return text.source.index(b">", end_tag_of(text, element)) + 1


def end_tag_of(text: Spanned, element: _Element) -> int:
    """Return the offset of the end tag of an element that has one."""
    *_, last = element.iter("*")
    start, tag = text.starts[last], f"</{element.tag}".encode()
    at = text.source.index(tag, start)
    while text.source.count(b"<!--", start, at) > text.source.count(b"-->", start, at):
        at = text.source.index(tag, at + 1)
    return at


def renamed(text: Spanned, element: _Element, name: str, new: str, value: str) -> Edit | None:
    """Return the edit that gives an attribute another name and value; None where it is not found."""
    if slot := _attribute_span(text, element, name):
        quote = text.source[slot[0] - 1 : slot[0]].decode()
        begin = text.source.rindex(name.encode(), 0, slot[0])
        return Edit(begin, slot[1], f"{new}={quote}{value}".encode(), None)
    return None


def removed(text: Spanned, element: _Element, name: str) -> Edit | None:
    """Return the edit that removes an attribute with the white space before it; None without one."""
    if slot := _attribute_span(text, element, name):
        before = len(text.source[: text.source.rindex(name.encode(), 0, slot[0])].rstrip())
        return Edit(before, slot[1] + 1, b"", None)
    return None


def revalued(text: Spanned, element: _Element, name: str, value: str) -> Edit | None:
    """Return the edit that gives an attribute another value, or adds it as the first one."""
    start = text.starts[element]
    if element.get(name) is None:
        tag = text.source[start : start + 1 + len(str(element.tag))]
        return Edit(start, start + len(tag), tag + f' {name}="{value}"'.encode(), None)
    slot = _attribute_span(text, element, name)
    return None if slot is None else Edit(*slot, value.encode(), None)


def _attribute_span(text: Spanned, element: _Element, name: str) -> tuple[int, int] | None:
    return attribute_slot(text.source, text.starts[element], name, element.get(name, ""))


# All that URDF 1.0 needs, and what it means where nothing is written differs.
LIMITS = ("lower", "upper", "effort", "velocity")
_OF_LINKS = ("visual", "collision", "inertial")


def rotated_origins(root: _Element) -> Iterator[_Element]:
    """Yield the origins that urdfdom reads and that have a quaternion."""
    for origin in root.iter("origin"):
        holder = origin.getparent()
        if origin.get("quat_xyzw") is None or holder is None or holder.getparent() is None:
            continue
        above = holder.getparent()
        of_link = above is not None and above.tag == "link" and holder.tag in _OF_LINKS
        if of_link or (holder.tag == "joint" and above is root):
            yield origin


def as_rpy(text: Spanned, origin: _Element) -> tuple[Edit, ...]:
    """Return the edit that writes a quaternion as roll, pitch and yaw; none if they would differ."""
    if origin.get("rpy") is not None:
        return one_rotation(text, origin, "quat_xyzw")
    turn = poses.quaternion(origin)
    if turn is None:
        return ()
    matrix = poses.matrix_of_quaternion(turn)
    rpy = poses.rpy_of(matrix)
    if not poses.is_same(matrix, poses.matrix_of_quaternion(poses.quaternion_of_rpy(rpy))):
        return ()
    return _edits_of(renamed(text, origin, "quat_xyzw", "rpy", " ".join(map(written, rpy))))


def one_rotation(text: Spanned, origin: _Element, other: str) -> tuple[Edit, ...]:
    """Return the edit that removes one of two rotations of an origin; none if they differ."""
    turn, matrix = poses.quaternion(origin), poses.rolled(origin)
    if turn is None or matrix is None:
        return ()
    same = poses.is_same(matrix, poses.matrix_of_quaternion(turn))
    return _edits_of(removed(text, origin, other)) if same else ()


def raised(text: Spanned, version: Version) -> tuple[Edit, ...]:
    """Return the edit that declares a version which reads quaternions; none if one is unreadable."""
    root = text.document.root
    capsule = any(capsules(link) for link in root.iterchildren("link"))
    if capsule or not all(map(_is_readable, rotated_origins(root))):
        return ()
    return _edits_of(revalued(text, root, "version", str(version)))


def lowered(text: Spanned) -> tuple[Edit, ...]:
    """Return all edits to URDF 1.0; none if the description would not mean the same there."""
    root = text.document.root
    limits = (it for joint in root.iterchildren("joint") for it in joint.iterchildren("limit"))
    if any(limit.get(name) is None for limit in limits for name in LIMITS):
        return ()
    links = [it for it in root.iterchildren("link") if capsules(it)]
    groups = [
        *(as_rpy(text, it) for it in rotated_origins(root)),
        *(capsule_edits(text, it) for it in links),
        _edits_of(revalued(text, root, "version", str(OLDEST))),
    ]
    return tuple(edit for group in groups for edit in group) if all(groups) else ()


def _is_readable(origin: _Element) -> bool:
    """Return whether an origin has one rotation, and that can be read."""
    turn = poses.quaternion(origin)
    alone = origin.get("rpy") is None and poses.pose_of(origin) is not None
    return alone and turn is not None and 0 < poses.length_of(turn) < float("inf")


def _edits_of(edit: Edit | None) -> tuple[Edit, ...]:
    return () if edit is None else (edit,)


CAPSULE, CYLINDER = b"capsule", b"cylinder"
# What a sphere may do without.
_PLAIN = frozenset(("origin", "geometry", "material", "verbose"))
_CLOSED = lazy_compile(rb"\s*</(capsule)\s*>")


def capsules(link: _Element) -> list[tuple[_Element, _Element]]:
    """Return the capsules that are read in a link, each with its visual or collision."""
    found = []
    for holder in link.iterchildren("visual", "collision"):
        geometry = next(holder.iterchildren("geometry"), None)
        shape = None if geometry is None else next(geometry.iterchildren("*"), None)
        if shape is not None and shape.tag == "capsule":
            found.append((shape, holder))
    return found


def capsule_edits(text: Spanned, link: _Element) -> tuple[Edit, ...]:
    """Return the edits for all capsules of a link; none where one of them means more than its shape."""
    found = capsules(link)
    if not found or not all(_is_plain(text, link, *it) for it in found):
        return ()
    edits = [edit for shape, _ in found for edit in _cylinder_edits(text, shape)]
    spheres = [it for shape, holder in found for it in _sphere_texts(text, shape, holder)]
    # The spheres before the end tag of the link, a line each where the link's end has its own.
    at = end_tag_of(text, link)
    margin, inner = map(partial(_indentation, text.source), (at, text.starts[found[0][1]]))
    if margin is None:
        lines = b"".join(spheres)
    else:
        more = (inner or b"").removeprefix(margin)
        line_end = b"\r\n" if b"\r\n" in text.source else b"\n"
        lines = b"".join(more + it + line_end + margin for it in spheres)
    return (*edits, Edit(at, at + 2, lines + text.source[at : at + 2], None))


def ends_of(pose: poses.Pose, length: float) -> tuple[Vector, Vector]:
    """Return the centres of the two half spheres of a capsule."""
    x, y, z = poses.turned(pose.matrix, (0.0, 0.0, length / 2))
    (a, b, c) = pose.at
    return (a + x, b + y, c + z), (a - x, b - y, c - z)


def _is_plain(text: Spanned, link: _Element, shape: _Element, holder: _Element) -> bool:
    """Return whether a capsule's holder is a shape and nothing else, so that it can be replaced."""
    asked = f"{link.get('name')}_collision".encode() in text.source or holder.get("name")
    if holder.tag == "collision" and asked:
        return False
    sizes = [number(shape.get(it)) for it in ("length", "radius")]
    known = {it.tag for it in holder.iterchildren("*")} <= _PLAIN
    return known and all(it is not None and it > 0 for it in sizes) and _pose_of(holder) is not None


def _pose_of(holder: _Element) -> poses.Pose | None:
    return poses.pose_of(next(holder.iterchildren("origin"), None))


def _cylinder_edits(text: Spanned, shape: _Element) -> Iterator[Edit]:
    start = text.starts[shape] + 1
    yield Edit(start, start + len(CAPSULE), CYLINDER, None)
    if closed := _CLOSED.match(text.source, tag_end(text.source, start - 1)):
        yield Edit(closed.start(1), closed.end(1), CYLINDER, None)


def _sphere_texts(text: Spanned, shape: _Element, holder: _Element) -> Iterator[bytes]:
    pose, length = _pose_of(holder), number(shape.get("length"))
    spans = ((text.starts[it], end_of(text, it)) for it in holder.iterchildren("material"))
    material = b"".join(text.source[start:end] for start, end in spans)
    radius = f'<geometry><sphere radius="{shape.get("radius")}"/></geometry>'
    for end in ends_of(pose, length) if pose and length else ():
        xyz = " ".join(map(written, end))
        head = f'<{holder.tag}><origin xyz="{xyz}"/>{radius}'.encode()
        yield head + material + f"</{holder.tag}>".encode()


def _indentation(source: bytes, at: int) -> bytes | None:
    """Return the white space before an offset in its line; None if there is anything else before it."""
    line = source[source.rfind(b"\n", 0, at) + 1 : at]
    return None if line.strip() or b"\n" not in source[:at] else line


def written(value: float) -> str:
    """Return a number as the shortest text that reads back as the same number."""
    return f"{value + 0.0!r}".removesuffix(".0")
