"""What a description says, whatever version says it: poses are matrices, capsules their parts.

This is what proves a conversion: both texts have to say the same. A quaternion counts in every version.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

from lxml.etree import _Element

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.checks.poses import ROTATIONS, pose_of
from multibot_rewrite.description.checks.rotation import NO_ROTATION, SAME, matrix_of_quaternion
from multibot_rewrite.rules.convert.capsules import capsules, ends_of

_IDENTITY = matrix_of_quaternion(NO_ROTATION)
_UNREAD = {"origin": ("xyz", *ROTATIONS), "robot": ("version",)}


class Meaning(NamedTuple):
    """An element: ``numbers`` are those of a pose, the matrix in rows."""

    tag: str
    attributes: Mapping[str, str]
    numbers: Sequence[float]
    texts: tuple[str, str]
    children: tuple[Meaning, ...]


def same_meaning(one: _Element, other: _Element) -> bool:
    """Do two descriptions say the same, each element in the same place?"""
    return _is_same(_meaning(one), _meaning(other))


def _is_same(one: Meaning, other: Meaning) -> bool:
    if one._replace(numbers=(), children=()) != other._replace(numbers=(), children=()):
        return False
    if len(one.numbers) != len(other.numbers) or len(one.children) != len(other.children):
        return False
    if any(abs(a - b) > SAME for a, b in zip(one.numbers, other.numbers, strict=True)):
        return False
    return all(map(_is_same, one.children, other.children))


def _meaning(element: _Element) -> Meaning:
    tag, pose = str(element.tag), pose_of(element) if element.tag == "origin" else None
    unread = _UNREAD.get(tag, ()) if tag != "origin" or pose else ()
    attributes = {str(key): str(it) for key, it in element.items() if key not in unread}
    numbers = (*pose.at, *chain(*pose.matrix)) if pose else ()
    texts = ((element.text or "").strip(), (element.tail or "").strip())
    parts = [_meaning(it) for it in element.iterchildren("*")]
    if tag == "geometry" and parts and parts[0].tag == "capsule":
        parts[0] = parts[0]._replace(tag="cylinder")
    more = _half_spheres(element) if tag == "link" else ()
    return Meaning(tag, attributes, numbers, texts, (*parts, *more))


def _half_spheres(link: _Element) -> Iterator[Meaning]:
    """What stands for the ends of a link's capsules, after all else."""
    for shape, holder in capsules(link):
        pose, length = (
            pose_of(next(holder.iterchildren("origin"), None)),
            number(shape.get("length")),
        )
        sphere = _plain("sphere", {"radius": shape.get("radius", "")})
        materials = [_meaning(it) for it in holder.iterchildren("material")]
        for end in ends_of(pose, length) if pose and length else ():
            origin = _plain("origin")._replace(numbers=(*end, *chain(*_IDENTITY)))
            geometry = _plain("geometry")._replace(children=(sphere,))
            yield _plain(str(holder.tag))._replace(children=(origin, geometry, *materials))


def _plain(tag: str, attributes: Mapping[str, str] | None = None) -> Meaning:
    return Meaning(tag, attributes or {}, (), ("", ""), ())
