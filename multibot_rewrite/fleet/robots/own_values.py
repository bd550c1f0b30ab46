# SPDX-License-Identifier: Apache-2.0
"""How each robot of a fleet gets a value of its own in its description: by which argument of its xacro,
or at which line that has no argument."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.pieces import EXPRESSION, GIVEN, Piece
from multibot_rewrite.description.sources.read import is_xacro, read_file
from multibot_rewrite.description.steps.document import attribute_slots
from multibot_rewrite.fleet.robots.member import Member


class Written(NamedTuple):
    """The file that a robot's description, or its model for the simulator, is made of, and the
    arguments that it gets."""

    path: str
    arguments: Mapping[str, str]


class Source(NamedTuple):
    """What gives a value: an ``argument`` of the xacro, or else the place that it is written at."""

    argument: str = ""
    place: str = ""


def sources_of(written: Written, member: Member, elements: Iterable[_Element]) -> list[Source]:
    """What gives the texts of elements of a robot's description, as it was read; none where it is not
    known: of a file that is no xacro, or that cannot be expanded within bounds."""
    path, arguments = written
    if not is_xacro(path):
        return []
    try:
        read = expand_traced(path, read_file(path), arguments, in_pieces=True)
    except InputError:
        return []
    numbers = {it: at for at, it in enumerate(member.source.elements)}
    pieces = (piece for it in elements for piece in read.pieces.of(numbers[it], "", it.text or ""))
    return list(dict.fromkeys(it for piece in pieces for it in _source(read, piece)))


def _source(read: Expansion, piece: Piece) -> Iterator[Source]:
    """What wrote a piece; nothing of blanks and of what is computed."""
    if piece.kind == EXPRESSION or not piece.text.strip():
        return
    if piece.kind == GIVEN:
        yield Source(piece.file)
        return
    source = read.sources.get(piece.file, b"")
    if piece.kind == "argument":
        start = source.rfind(b"<", 0, piece.start)
        first, end = attribute_slots(source, start).get(b"name", (0, 0))
        yield Source(source[first:end].decode("utf-8", "replace"))
    elif source:
        line, _ = locate(source, piece.start)
        yield Source(place=f"{os.path.relpath(piece.file)}:{line}")


def own_value(sources: Iterable[Source]) -> str:
    """What to write so that each robot has its own; empty where nothing is known."""
    its = list(sources)
    names = ", ".join(f"{it.argument}: ..." for it in its if it.argument)
    places = " and ".join(it.place for it in its if it.place)
    said = []
    if names:
        said.append(f"give each robot its own in the fleet file: arguments: {{{names}}}")
    if places:
        said.append(f"make an argument of the value in {places}, and give each robot its own")
    return "; ".join(said)
