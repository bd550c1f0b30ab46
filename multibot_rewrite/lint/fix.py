# SPDX-License-Identifier: Apache-2.0
"""Safe edits -> the fixed text, and the proof that nothing else changed and no finding is new."""

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit, ProofError
from multibot_rewrite.description.checks import poses
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.convert import capsules, ends_of
from multibot_rewrite.rules.settings import Settings

# A fix may make another one possible; more rounds than this never end.
ROUNDS = 5
_LINE = re.compile(r"\bline \d+")


def fix(path: str, source: bytes, settings: Settings) -> tuple[bytes, list[Finding]]:
    """Return the fixed text and the findings that are left; raises InputError, ProofError."""
    findings = lint_data(path, source, settings)
    for _ in range(ROUNDS):
        found = {edit for it in findings if it.file == path for edit in it.edits}
        edits = list(_not_overlapping(found))
        if not edits:
            return source, findings
        fixed = b"".join(cut(source, edits))
        after = lint_data(path, fixed, settings)
        _verify(path, (source, findings), (fixed, after), edits)
        source, findings = fixed, after
    raise ProofError(f"{path}: there is still something to fix after {ROUNDS} rounds")


def _not_overlapping(edits: Iterable[Edit]) -> Iterator[Edit]:
    """Yield the edits in source order, without those that overlap an earlier one."""
    end = -1
    for edit in sorted(edits, key=lambda it: (it.start, it.end)):
        if edit.start >= max(end, 0) and edit.end > edit.start:
            yield edit
            end = edit.end


def _verify(
    path: str,
    old: tuple[bytes, Sequence[Finding]],
    new: tuple[bytes, Sequence[Finding]],
    edits: Sequence[Edit],
) -> None:
    """Raise ProofError unless all but the edited elements means the same, and no finding is new."""
    before, after = (read_document(data, path) for data, _ in (old, new))
    # For each element: is there an edit between its start tag and the next one?
    numbers = {bisect_right(before.starts, it.start) - 1 for it in edits}
    touched = [number in numbers for number in range(len(before.starts))]
    pairs = zip(before.root.iter("*"), after.root.iter("*"), touched, strict=False)
    same = len(before.starts) == len(after.starts)
    alike = same and all(_is_alike(old, new, there) for old, new, there in pairs)
    if not alike and not same_meaning(before.root, after.root):
        raise ProofError(f"{path}: a fix would change more than it may")
    if more := _codes_and_messages(new[1]) - _codes_and_messages(old[1]):
        raise ProofError(f"{path}: a fix would cause a new finding: {min(more)}")


def _is_alike(old: _Element, new: _Element, touched: bool) -> bool:
    """Return whether two elements are alike; of a ``touched`` one only the tag counts."""
    return old.tag == new.tag and (touched or (old.attrib, old.text) == (new.attrib, new.text))


def _codes_and_messages(findings: Iterable[Finding]) -> set[tuple[str, str]]:
    # Lines move where an edit takes one out; what is said of an element is said of its copy.
    return {(it.code, _LINE.sub("line N", it.message)) for it in findings}


_IDENTITY = poses.matrix_of_quaternion(poses.NO_ROTATION)
_UNREAD = {"origin": ("xyz", *poses.ROTATIONS), "robot": ("version",)}


class Meaning(NamedTuple):
    """An element: ``numbers`` are those of a pose, the matrix in rows."""

    tag: str
    attributes: Mapping[str, str]
    numbers: Sequence[float]
    texts: tuple[str, str]
    children: "tuple[Meaning, ...]"


def same_meaning(one: _Element, other: _Element) -> bool:
    """Return whether two descriptions mean the same, each element in the same place."""
    return _is_same(_meaning(one), _meaning(other))


def _is_same(one: Meaning, other: Meaning) -> bool:
    if one._replace(numbers=(), children=()) != other._replace(numbers=(), children=()):
        return False
    if len(one.numbers) != len(other.numbers) or len(one.children) != len(other.children):
        return False
    if any(abs(a - b) > poses.SAME for a, b in zip(one.numbers, other.numbers, strict=True)):
        return False
    return all(map(_is_same, one.children, other.children))


def _meaning(element: _Element) -> Meaning:
    tag, pose = str(element.tag), poses.pose_of(element) if element.tag == "origin" else None
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
    """Yield two spheres, as elements, for the ends of each of a link's capsules."""
    for shape, holder in capsules(link):
        pose = poses.pose_of(next(holder.iterchildren("origin"), None))
        length = number(shape.get("length"))
        sphere = _bare_element("sphere", {"radius": shape.get("radius", "")})
        materials = [_meaning(it) for it in holder.iterchildren("material")]
        for end in ends_of(pose, length) if pose and length else ():
            origin = _bare_element("origin")._replace(numbers=(*end, *chain(*_IDENTITY)))
            geometry = _bare_element("geometry")._replace(children=(sphere,))
            yield _bare_element(str(holder.tag))._replace(children=(origin, geometry, *materials))


def _bare_element(tag: str, attributes: Mapping[str, str] | None = None) -> Meaning:
    return Meaning(tag, attributes or {}, (), ("", ""), ())
