# SPDX-License-Identifier: Apache-2.0
"""What is known about a line of a xacro file: the values that it makes, and which pieces make them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.reports.explain import Explanation
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.included_by import whole_robots
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.trace import EXPRESSION, GIVEN, LITERAL, Piece
from multibot_rewrite.description.steps.document import Document, tag_end

# What is on a line of a document.
OnLine = Callable[[int], list[Explanation]]


def explain_source(
    path: str,
    line: int,
    arguments: Mapping[str, str],
    trust: bool,
    explaining: Callable[[str], tuple[Document, OnLine]],
) -> list[Explanation]:
    """The values that ``line`` of the file ``path`` makes: of elements that are written on it, and
    those with a piece of it, as of a macro's call; else in a description that includes the file.
    Raises InputError where none of them can be read."""
    reach = TRUSTED if trust else BOUNDED
    failed: list[InputError] = []
    wholes = (path, *whole_robots(path))
    for it in wholes:
        try:
            read = expand_traced(it, read_file(it), arguments, None, reach, True)
            found = dict.fromkeys(_made_on(_Line(read, _named(read, path), line), *explaining(it)))
        except InputError as error:
            failed.append(error)
            continue
        if found:
            return [one._replace(within="" if it == path else it) for one in found]
    if len(failed) == len(wholes):
        raise failed[0]
    return []


def _named(read: Expansion, path: str) -> str:
    """The name that a file has among those that were read; empty where it was not."""
    return next((it for it in read.sources if os.path.realpath(it) == os.path.realpath(path)), "")


class _Line(NamedTuple):
    """A line of a file that is read for an expansion."""

    read: Expansion
    file: str
    line: int

    def has(self, start: int, end: int) -> bool:
        """Is some of these bytes of the file on it?"""
        source = self.read.sources[self.file]
        return locate(source, start)[0] <= self.line <= locate(source, end)[0]

    def begins(self, pieces: Iterable[Piece]) -> int | None:
        """Where the first of some pieces that is on it begins."""
        mine = (it.start for it in pieces if it.file == self.file and self.has(it.start, it.start))
        return next(mine, None)


def _made_on(it: _Line, document: Document, explain: OnLine) -> Iterator[Explanation]:
    """What a line makes, each at its place there."""
    for number, element in enumerate(document.elements):
        origin = it.read.origins.of(number)
        written = None
        if origin and origin.file == it.file:
            end = tag_end(it.read.sources[it.file], origin.start)
            written = origin.start if it.has(origin.start, end) else None
        values = [*element.attrib.items(), ("", element.text or "")]
        every = (it.read.pieces.of(number, str(key), str(value)) for key, value in values)
        if written is None and all(it.begins(one) is None for one in every):
            continue
        for found in explain(locate(document.source, document.starts[number])[0]):
            pieces = _pieces(it.read, number, found)
            at = it.begins(pieces) if written is None else written
            if at is not None:
                line, column = locate(it.read.sources[it.file], at)
                made_of = _made_of(it.read, pieces)
                yield found._replace(line=line, column=column, made_of=made_of)


def _pieces(read: Expansion, number: int, it: Explanation) -> tuple[Piece, ...]:
    """The pieces of a value of an element."""
    _, at, attribute = it.path.rpartition("@")
    return read.pieces.of(number, attribute if at else "", it.value)


def _made_of(read: Expansion, pieces: tuple[Piece, ...]) -> tuple[str, ...]:
    """The pieces in words; () for a value that stands in the element as it is."""
    plain = len(pieces) < 2 and all(one.kind == LITERAL for one in pieces)
    return () if plain else tuple(_words(read, pieces))


def _words(read: Expansion, pieces: tuple[Piece, ...]) -> Iterator[str]:
    """Each piece, what wrote it, and where."""
    for piece in pieces:
        if piece.kind == GIVEN:
            yield f"{piece.text!r} (argument {piece.file} that was given)"
            continue
        source = read.sources.get(piece.file, b"")
        where = ":".join(map(str, (piece.file, *locate(source, piece.start))))
        made = source[piece.start : piece.end].decode() if piece.kind == EXPRESSION else piece.kind
        yield f"{piece.text!r} ({made}, {where})"
