# SPDX-License-Identifier: Apache-2.0
"""Turns changes of the values of an expansion into edits of the xacro files that make them.

A value is put together from pieces (``description/sources/trace.py``). A change can be made where all
of it is in one piece that is in a file as it is; what an expression computes is left to its author.
"""

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.sources.expand import Expansion
from multibot_rewrite.description.sources.trace import EXPRESSION, GIVEN, Piece
from multibot_rewrite.description.steps.document import Document, place_in, value_slot


class ValueEdit(NamedTuple):
    """Characters ``start`` to ``end`` of a value become ``new``; without attribute, of a text.

    ``element`` counts in the order of the document."""

    element: int
    attribute: str
    value: str
    start: int
    end: int
    new: str


def change_of(document: Document, claim: Claim, start: int, end: int, new: str) -> ValueEdit:
    """Return the change of a claimed value; a claim has a text without the white space around it."""
    number = bisect_left(document.starts, claim.start)
    value = claim.value if claim.attribute else claim.element.text or ""
    by = value.find(claim.value)
    return ValueEdit(number, claim.attribute, value, by + start, by + end, new)


class SourceEdit(NamedTuple):
    """Bytes ``start`` to ``end`` of a file become ``new``."""

    file: str
    start: int
    end: int
    new: bytes


class Composed(NamedTuple):
    """A change that no edit makes: the value, the place of what makes it, and why."""

    value: str
    place: str
    why: str


def source_edit(read: Expansion, document: Document, change: ValueEdit) -> SourceEdit | Composed:
    """Return the edit of a source that makes a change."""
    start, end, new = _changed_part(change)
    pieces = read.pieces.of(change.element, change.attribute, change.value)
    at = 0
    touched = []
    for piece in pieces:
        last = at + len(piece.text)
        if at <= start and end <= last and piece.kind not in (EXPRESSION, GIVEN):
            first = piece.start + len(piece.text[: start - at].encode())
            size = len(change.value[start:end].encode())
            return SourceEdit(piece.file, first, first + size, new.encode())
        if at < end and start < last:
            touched.append(piece)
        at = last
    return Composed(
        change.value, _place_of_change(read, document, change, touched), _why_not_edited(touched)
    )


def _changed_part(change: ValueEdit) -> tuple[int, int, str]:
    """Return what of a change is different: start, end, and the new characters."""
    _, _, value, start, end, new = change
    while start < end and new and value[start] == new[0]:
        start, new = start + 1, new[1:]
    while start < end and new and value[end - 1] == new[-1]:
        end, new = end - 1, new[:-1]
    return start, end, new


def _place_of_change(
    read: Expansion, document: Document, change: ValueEdit, touched: list[Piece]
) -> str:
    """Return ``file:line:column`` of a change's first source, or what is known of its place."""
    if known := next((it for it in touched if it.file in read.sources), None):
        return place(known.file, read.sources[known.file], known.start)
    return place_of(read, change.element) or document.file


def place_of(read: Expansion | None, element: int) -> str:
    """Return where an element of an expansion comes from; empty if unknown."""
    origin = read and read.origins.of(element)
    return place(origin.file, read.sources[origin.file], origin.start) if read and origin else ""


def place(file: str, source: bytes, offset: int) -> str:
    """Return ``file:line:column`` of an offset."""
    return ":".join(map(str, (file, *locate(source, offset))))


def _why_not_edited(touched: list[Piece]) -> str:
    if len(touched) > 1:
        return "it is put together from " + " and ".join(repr(it.text) for it in touched)
    made = touched[0].kind if touched else EXPRESSION
    return f"an {made} makes it" if made == EXPRESSION else f"it is a {made}"


def expected(document: Document, changes: Iterable[ValueEdit]) -> bytes | None:
    """Return the text of a document with the changes made; None where escapes hide one of them."""
    found = list(spans(document, changes))
    if None in found:
        return None
    edits = [SourceEdit("", *it) for it in found if it]
    return edited({"": document.source}, edits).get("", document.source)


def spans(
    document: Document, changes: Iterable[ValueEdit]
) -> Iterator[tuple[int, int, bytes] | None]:
    """Yield (start, end, new bytes) for each change in a document; None for one that is hidden."""
    for element, attribute, value, start, end, new in changes:
        slot = value_slot(document.source, document.starts[element], attribute, value)
        begin, last = (slot and place_in(document.source, slot, value, at) for at in (start, end))
        yield None if begin is None or last is None else (begin, last, new.encode())


def edited(sources: Mapping[str, bytes], edits: Iterable[SourceEdit]) -> dict[str, bytes]:
    """Return the changed files with their new bytes; raises ValueError for overlapping edits."""
    made: dict[str, bytes] = {}
    every = sorted(set(edits))
    for file in dict.fromkeys(it.file for it in every):
        source, last = sources[file], 0
        parts: list[bytes] = []
        for _, start, end, new in (it for it in every if it.file == file):
            if start < last:
                raise ValueError(file, start)
            parts += (source[last:start], new)
            last = end
        made[file] = b"".join(parts) + source[last:]
    return made


def first_difference(made: bytes, wanted: bytes | None) -> str:
    """Return the first line of a text that is not the wanted one; "" where there is none."""
    lines = zip(made.splitlines(), (wanted or b"").splitlines(), strict=False)
    line = next((one for one, other in lines if one != other), b"")
    return line.strip().decode(errors="replace")
