# SPDX-License-Identifier: Apache-2.0
"""Finds the xacro argument, or the line, that gives each robot a value of its own."""

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.expand import Expansion, expand, expand_traced
from multibot_rewrite.description.sources.read import is_xacro, read_file
from multibot_rewrite.description.sources.trace import EXPRESSION, GIVEN, Piece
from multibot_rewrite.description.steps.document import attribute_slots, read_document
from multibot_rewrite.fleet.robots.member import Member

# What stands for another value, and how many arguments are tried.
_MARK, _TRIED = "multibot_mark", 12


class Written(NamedTuple):
    """The file of a robot's description, or of its model for the simulator, and its arguments."""

    path: str
    arguments: Mapping[str, str]


class Source(NamedTuple):
    """What gives a value: an ``argument`` of the xacro, or else the place that it is written at."""

    argument: str = ""
    place: str = ""


def sources_of(written: Written, member: Member, elements: Iterable[_Element]) -> list[Source]:
    """Return what gives the texts of elements in a robot's description; empty if unknown."""
    path, arguments = written
    if not is_xacro(path):
        return []
    try:
        read = expand_traced(path, read_file(path), arguments, in_pieces=True)
    except InputError:
        return []
    numbers = {it: at for at, it in enumerate(member.source.elements)}
    found: dict[Source, None] = {}
    for it in elements:
        its = read.pieces.of(numbers[it], "", it.text or "")
        sources = [one for piece in its for one in _sources_of_piece(read, piece)]
        named = [one for one in sources if one.argument]
        if sources and not named:
            named = [*_by_trying(written, read.sources, it, numbers[it])]
        found.update(dict.fromkeys(named or sources))
    return list(found)


def _by_trying(
    written: Written, sources: Mapping[str, bytes], element: _Element, number: int
) -> Iterator[Source]:
    """Yield the argument that changes an element's text, by way of a default or a property."""
    names = (
        it.get("name", "")
        for file, data in sources.items()
        # A xacro reads YAML, too.
        if data.lstrip().startswith(b"<")
        for it in read_document(data, file).root.iter("{*}arg")
    )
    alike = sorted(dict.fromkeys(names), key=lambda it: it != element.get("name"))
    for name in alike[:_TRIED]:
        with suppress(InputError):
            data = expand(written.path, {**written.arguments, name: _MARK})
            made = read_document(data, written.path).elements
            if number < len(made) and _MARK in (made[number].text or ""):
                yield Source(name)
                return


def _sources_of_piece(read: Expansion, piece: Piece) -> Iterator[Source]:
    """Yield what wrote a piece; nothing for blanks and computed pieces."""
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
    """Return what to write so that each robot has its own value; empty where nothing is known."""
    its = list(sources)
    names = ", ".join(f"{it.argument}: ..." for it in its if it.argument)
    places = " and ".join(it.place for it in its if it.place)
    said = []
    if names:
        said.append(f"give each robot its own in the fleet file: arguments: {{{names}}}")
    if places:
        said.append(f"make an argument of the value in {places}, and give each robot its own")
    return "; ".join(said)
