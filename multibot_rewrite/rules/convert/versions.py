# SPDX-License-Identifier: Apache-2.0
"""Edits that make a description one of another version, where it means the same in both."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.poses import pose_of, quaternion, rolled
from multibot_rewrite.description.checks.rotation import (
    is_same,
    length_of,
    matrix_of_quaternion,
    quaternion_of_rpy,
    rpy_of,
)
from multibot_rewrite.rules.convert.capsules import capsule_edits, capsules, written
from multibot_rewrite.rules.convert.spans import Spanned, removed, renamed, revalued
from multibot_rewrite.rules.schema.versions import OLDEST, Version

# All that URDF 1.0 needs, and what it means where nothing is written differs.
LIMITS = ("lower", "upper", "effort", "velocity")
_OF_LINKS = ("visual", "collision", "inertial")


def rotated_origins(root: _Element) -> Iterator[_Element]:
    """The origins that urdfdom reads and that have a quaternion."""
    for origin in root.iter("origin"):
        holder = origin.getparent()
        if origin.get("quat_xyzw") is None or holder is None or holder.getparent() is None:
            continue
        above = holder.getparent()
        of_link = above is not None and above.tag == "link" and holder.tag in _OF_LINKS
        if of_link or (holder.tag == "joint" and above is root):
            yield origin


def as_rpy(text: Spanned, origin: _Element) -> tuple[Edit, ...]:
    """The edit that writes a quaternion as roll, pitch and yaw; none where they would differ."""
    if origin.get("rpy") is not None:
        return one_rotation(text, origin, "quat_xyzw")
    turn = quaternion(origin)
    if turn is None:
        return ()
    matrix = matrix_of_quaternion(turn)
    rpy = rpy_of(matrix)
    if not is_same(matrix, matrix_of_quaternion(quaternion_of_rpy(rpy))):
        return ()
    return _one(renamed(text, origin, "quat_xyzw", "rpy", " ".join(map(written, rpy))))


def one_rotation(text: Spanned, origin: _Element, other: str) -> tuple[Edit, ...]:
    """The edit that takes one of two rotations out; none where they differ."""
    turn, matrix = quaternion(origin), rolled(origin)
    if turn is None or matrix is None or not is_same(matrix, matrix_of_quaternion(turn)):
        return ()
    return _one(removed(text, origin, other))


def raised(text: Spanned, version: Version) -> tuple[Edit, ...]:
    """The edit that declares a version that reads quaternions, where all of them can be read."""
    root = text.document.root
    capsule = any(capsules(link) for link in root.iterchildren("link"))
    if capsule or not all(map(_is_readable, rotated_origins(root))):
        return ()
    return _one(revalued(text, root, "version", str(version)))


def lowered(text: Spanned) -> tuple[Edit, ...]:
    """All edits that make a description one of URDF 1.0; none where it would not mean the same."""
    root = text.document.root
    limits = (it for joint in root.iterchildren("joint") for it in joint.iterchildren("limit"))
    if any(limit.get(name) is None for limit in limits for name in LIMITS):
        return ()
    links = [it for it in root.iterchildren("link") if capsules(it)]
    groups = [
        *(as_rpy(text, it) for it in rotated_origins(root)),
        *(capsule_edits(text, it) for it in links),
        _one(revalued(text, root, "version", str(OLDEST))),
    ]
    return tuple(edit for group in groups for edit in group) if all(groups) else ()


def _is_readable(origin: _Element) -> bool:
    turn = quaternion(origin)
    alone = origin.get("rpy") is None and pose_of(origin) is not None
    return alone and turn is not None and 0 < length_of(turn) < float("inf")


def _one(edit: Edit | None) -> tuple[Edit, ...]:
    return () if edit is None else (edit,)
