# SPDX-License-Identifier: Apache-2.0
"""Finds where in the xacro files elements and pieces of values of an expansion were written.

A child reports numbers (``child/run_xacro.py``, ``child/pieces.py``); what they stand for is
looked up in the files as they were read here, so a wrong number leads nowhere else. A piece
counts as written there only where the bytes read back as it."""

import os
import re
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.steps.document import attribute_slots, start_offsets, tag_end

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.conversation import Result, Sources


NOWHERE = -1
# No macro is called from so deep: Python's recursion ends before.
DEEPEST = 500


class Call(NamedTuple):
    """A macro call: the macro's name, the file of the call and the byte offset of its tag."""

    macro: str
    file: str
    start: int


class WrittenAt(NamedTuple):
    """The file an element was written in, the byte offset of its tag, the innermost call first."""

    file: str
    start: int
    calls: tuple[Call, ...]


class Trace:
    """The files of one expansion, and what a child's numbers mean in them.

    ``sources`` are the files that were read, named as ``given`` is where that is possible.
    """

    def __init__(self, result: "Result", sources: "Sources", given: str) -> None:
        self.result = result
        texts = sources.texts
        self.names = [it if it == given else alike(it, given) for it, _ in result.files]
        self.starts = [_starts(texts.get(name, b""), count) for name, count in result.files]
        read = zip(self.names, result.files, strict=True)
        self.sources = {name: texts[asked] for name, (asked, _) in read if asked in texts}

    def place(self, file: int, element: int) -> tuple[str, int] | None:
        """Return the name of a file, and the offset of an element's tag in it; None if unknown."""
        known = 0 <= file < len(self.names) and 0 <= element < len(self.starts[file])
        return (self.names[file], self.starts[file][element]) if known else None

    def calls(self, number: int) -> tuple[Call, ...]:
        """Return a macro call and those around it, the innermost first."""
        found: list[Call] = []
        numbers, macros = self.result.calls, self.result.macros
        while 0 <= number < len(numbers) // 4 and len(found) < DEEPEST:
            around, macro, file, element = numbers[4 * number : 4 * number + 4]
            place = self.place(file, element)
            if place and 0 <= macro < len(macros):
                found.append(Call(macros[macro], *place))
            number = around if around < number else NOWHERE
        return tuple(found)


class Origins(NamedTuple):
    """The origin of each element of an expanded document, in its order: looked up when asked for."""

    trace: Trace

    def of(self, number: int) -> WrittenAt | None:
        """Return the origin of an element; None if xacro itself made it."""
        file, element, call = self.trace.result.origins[3 * number : 3 * number + 3]
        place = self.trace.place(file, element)
        return WrittenAt(*place, self.trace.calls(call)) if place else None


def _starts(source: bytes, count: int) -> Sequence[int]:
    """Return the offsets of the tags of a file; none if their number is not that of its elements."""
    found = start_offsets(source)
    return found if len(found) == count else ()


def alike(path: str, given: str) -> str:
    """Return a path, relative if ``given`` is relative and it leads no further up."""
    path = os.path.normpath(path)
    if os.path.isabs(given) or not os.path.isabs(path):
        return path
    relative = os.path.relpath(path)
    up, least = (it.split(os.sep).count(os.pardir) for it in (relative, os.path.normpath(given)))
    return relative if up <= least else path


EIGHT = 8
TEXT_NODE, FIRST_TEXT = "#", "#0"
LITERAL, EXPRESSION, GIVEN, YAML = "literal", "expression", "given argument", "YAML"
# What wrote a piece, by the element that it stands in; any other one of xacro's is a macro call.
_KINDS = {"xacro:property": "property", "xacro:arg": "argument", "xacro:macro": "default"}


class Piece(NamedTuple):
    """A part of a value; it, or the expression that makes it, is in ``file`` at ``start:end``.

    ``kind`` says what wrote it: literal, property, argument, default, parameter, YAML,
    expression, given argument (no file)."""

    text: str
    kind: str
    file: str = ""
    start: int = 0
    end: int = 0


class Pieces:
    """The pieces of the values of one expansion."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    def of(self, element: int, attribute: str, value: str) -> tuple[Piece, ...]:
        """Return the pieces of an attribute, or of the text if it is empty; () if unknown."""
        found, at = [], 0
        for row in self._rows_by_value.get(
            (element, _without_namespace(attribute) or TEXT_NODE), ()
        ):
            length = row[0]
            found.append(self._piece_of_row(value[at : at + length], row))
            at += length
        return tuple(found) if at == len(value) else ()

    @cached_property
    def _rows_by_value(self) -> dict[tuple[int, str], list[tuple[int, ...]]]:
        """The rows of numbers by element and attribute, one for each piece."""
        numbers, words = self.trace.result.pieces, self.trace.result.words
        every = (numbers[at : at + EIGHT] for at in range(0, len(numbers), EIGHT))
        return lists_by_key(
            ((element, _without_namespace(words[attribute])), tuple(row))
            for element, attribute, *row in every
            if 0 <= attribute < len(words)
        )

    def _piece_of_row(self, text: str, row: tuple[int, ...]) -> Piece:
        """Return the piece with a text that a row of numbers is about."""
        _, file, element, word, offset, whole = row
        words, names = self.trace.result.words, self.trace.names
        attribute = words[word] if 0 <= word < len(words) else ""
        if not 0 <= file < len(names):
            return Piece(text, GIVEN if attribute else EXPRESSION, attribute)
        name = names[file]
        source = self.trace.sources.get(name, b"")
        length = whole or len(text)
        if not self.trace.result.files[file][1]:
            start = len(source.decode("utf-8", "replace")[:offset].encode())
            end = start + len(text.encode())
            kind = YAML if source[start:end] == text.encode() else EXPRESSION
            return Piece(text, kind, name, start, end)
        place = self.trace.place(file, element)
        slot = _slot(source, place[1], attribute) if place else None
        if place is None or slot is None:
            return Piece(text, EXPRESSION, name)
        start = place[1]
        begin, end = (_byte(source, slot, it) for it in (offset, offset + length))
        as_is = not whole and source[begin:end] == text.encode()
        tag = source[start + 1 : tag_end(source, start)].split(None, 1)[0].rstrip(b"/>").decode()
        kind = _KINDS.get(tag, "parameter" if tag.startswith("xacro:") else LITERAL)
        return Piece(text, kind if as_is else EXPRESSION, name, begin, end)


def _without_namespace(attribute: str) -> str:
    """Return the name of an attribute, the same for ``gz:name`` and ``{uri}name``."""
    local = re.split("[}:]", attribute)[-1]
    return attribute if local == attribute else f":{local}"


def _slot(source: bytes, start: int, attribute: str) -> tuple[int, int] | None:
    """Return where a value is: of an attribute, or the first text in an element."""
    if not attribute.startswith(TEXT_NODE):
        return attribute_slots(source, start).get(attribute.encode())
    begin = tag_end(source, start)
    return (begin, source.find(b"<", begin)) if attribute == FIRST_TEXT else None


def _byte(source: bytes, slot: tuple[int, int], at: int) -> int:
    """Return the offset of character ``at`` of a value, if nothing before it is escaped."""
    begin, end = slot
    return min(end, begin + len(source[begin:end].decode("utf-8", "replace")[:at].encode()))
