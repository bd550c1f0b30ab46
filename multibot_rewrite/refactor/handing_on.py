# SPDX-License-Identifier: Apache-2.0
"""Macros and properties that take a prefix already get the argument, so their names need no other edit.

A call with ``prefix=""`` becomes ``prefix="$(arg prefix)"``. Which calls can have it is found by one
expansion in which each gets a mark of its own: a mark may only be where a prefix is wanted.
Source: xacro README (properties are global where they are outside of macros; ``default``)."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import zip_longest
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.steps.document import (
    Document,
    attribute_slots,
    read_document,
    tag_end,
)
from multibot_rewrite.refactor.placing import Spot, values_of
from multibot_rewrite.refactor.source_edits import SourceEdit, ValueEdit

_PARAMETER = re.compile(r"([\w.]+)(?:\s*:?=\s*('[^']*'|\S*))?")
_NAMED = re.compile(r"\$(?:\(arg ([\w.-]+)\)|\{\s*(\w+)\s*\})")
_LIKE = re.compile("prefix", re.IGNORECASE)
MARK = re.compile(r"qz\d{3}z")
# A parameter or property that has the argument's value, with the macro that it is a parameter of.
Carrier = tuple[str, str]


class Place(NamedTuple):
    """Where a prefix can be handed to a parameter or property: the offset, what goes around it, and
    what the value is without it."""

    spot: Spot
    before: str
    after: str
    value: str
    carrier: Carrier

    def edit(self, word: str) -> SourceEdit:
        """Return the edit that puts a word there."""
        file, at = self.spot
        return SourceEdit(file, at, at, f"{self.before}{word}{self.after}".encode())


class Sources:
    """The xacro files of descriptions, read once; ``tops`` are those of the descriptions themselves."""

    def __init__(self, texts: Mapping[str, bytes], tops: Collection[str]) -> None:
        self.tops = tops
        own = {file: data for file, data in texts.items() if b"<robot" in data}
        self.documents = {file: read_document(data, file) for file, data in own.items()}
        found = (it for one in self.documents.values() for it in one.root.iter("{*}macro"))
        self.macros = {_name(it): dict(_parameters(it.get("params", ""))) for it in found}

    def macro_at(self, spot: Spot) -> str:
        """Return the macro that a place is in; empty if it is in none."""
        document = self.documents[spot[0]]
        element = document.elements[bisect_right(document.starts, spot[1]) - 1]
        return _macro_of(element)

    def places(self) -> Iterator[Place]:
        """Yield the places where calls and properties take a literal prefix, or none."""
        for file, document in self.documents.items():
            starts = dict(zip(document.elements, document.starts, strict=True))
            for carrier, value, element, attribute in self._given(document):
                start = starts[element]
                slot = attribute_slots(document.source, start).get(attribute.encode())
                is_computed = "$" in value or "^" in value
                if not _LIKE.search(carrier[1]) or (
                    is_computed and (not slot or _macro_of(element))
                ):
                    continue
                if slot:
                    yield Place((file, slot[0]), "", "", value, carrier)
                elif attribute == carrier[1]:
                    tag = document.source[start : tag_end(document.source, start)]
                    end = start + len(tag.rstrip(b"/>").rstrip())
                    yield Place((file, end), f' {attribute}="', f'{value}"', value, carrier)

    def carriers(self, argument: str) -> set[Carrier]:
        """Return the parameters and properties whose value is always that of the argument."""
        given = lists_by_key(
            (carrier, (value, element))
            for one in self.documents.values()
            for carrier, value, element, _ in self._given(one)
        )
        found: set[Carrier] = {*given}
        while wrong := {
            it
            for it in found
            if not all(_is_argument(*one, argument, found - {it}) for one in given[it])
        }:
            found -= wrong
        return found

    def _given(self, document: Document) -> Iterator[tuple[Carrier, str, _Element, str]]:
        """Yield parameters of calls, and properties: with the value, the element and the attribute."""
        for element in document.root.iter("{*}*"):
            uri, _, tag = str(element.tag)[1:].partition("}")
            if not uri.endswith("xacro"):
                continue
            macro = tag.rpartition(".")[2]
            found = [(macro, *it, it[0]) for it in self.macros.get(macro, {}).items()]
            if tag == "property" and "value" in element.attrib and not _macro_of(element):
                found.append(("", _name(element), "", "value"))
            for of, name, default, attribute in found:
                yield (of, name), element.get(attribute, default), element, attribute


def _name(element: _Element) -> str:
    return element.get("name", "").removeprefix("xacro:")


def _macro_of(element: _Element) -> str:
    return next((_name(it) for it in element.iterancestors("{*}macro")), "")


def _parameters(text: str) -> Iterator[tuple[str, str]]:
    for name, default in _PARAMETER.findall(text):
        yield name, default.strip("'")


def _is_argument(
    value: str, element: _Element, argument: str, carriers: Collection[Carrier]
) -> bool:
    """Is a value the argument, as it is or by the name of a carrier?"""
    found = _NAMED.fullmatch(value.strip())
    if found is None or found[1]:
        return found is not None and found[1] == argument
    return bool({(_macro_of(element), found[2]), ("", found[2])}.intersection(carriers))


class Words(NamedTuple):
    """What is written for the argument, place by place; is it a new one?"""

    argument: str
    is_new: bool
    sources: Sources
    carriers: Collection[Carrier]

    def at(self, spot: Spot, in_call: bool = False) -> bytes | None:
        """Return an expression that has the argument's value at a place; None if none has."""
        file = spot[0]
        is_own = file in self.sources.tops or b'arg name="%s"' % self.argument.encode() in (
            self.sources.documents[file].source
        )
        name = self._carrier(spot)
        hidden = self.argument in self.sources.macros.get(self.sources.macro_at(spot), ())
        if not name and is_own and (in_call or hidden or not self.is_new):
            return b"$(arg %s)" % self.argument.encode()
        if hidden and not name:
            return None
        return b"${%s}" % (name or self.argument).encode()

    def _carrier(self, spot: Spot) -> str:
        """Return a parameter or property that has the value there; empty if none has."""
        macro, source = self.sources.macro_at(spot), self.sources.documents[spot[0]].source
        own = [name for of, name in self.carriers if of and of == macro]
        own = own or [
            name for of, name in self.carriers if not of and b"${%s}" % name.encode() in source
        ]
        return self.argument if self.argument in own else min(own, default="")

    def using(self, edits: Iterable[SourceEdit]) -> set[str]:
        """Return the files whose edits use the property of the argument, which has to be declared."""
        word = b"${%s}" % self.argument.encode()
        return {
            it.file for it in edits if word in it.new and not self._carrier((it.file, it.start))
        }


class Compared(NamedTuple):
    """What a description with something before its names lacks still, as changes of it; and the words
    that are elsewhere, "" among them where it is another one."""

    lacks: tuple[ValueEdit, ...]
    astray: frozenset[str]


def compared(
    base: Document, wanted: Iterable[ValueEdit], other: Document, word: re.Pattern[str]
) -> Compared:
    """Compare a description with itself after something put words before its names."""
    changes = lists_by_key(((it.element, it.attribute), it) for it in wanted)
    pairs = zip_longest(base.elements, other.elements)
    lacks: list[ValueEdit] = []
    astray: set[str] = set()
    for number, (one, two) in enumerate(pairs):
        if one is None or two is None or one.tag != two.tag or one.keys() != two.keys():
            return Compared((), frozenset(("",)))
        others = dict(values_of(two))
        for attribute, value in values_of(one):
            own = changes.get((number, attribute), [])
            text = others.get(attribute, "")
            found = _words(value, text, word)
            if found is None:
                astray.add("")
                continue
            astray |= {it for at, it in found if at not in {one.start for one in own}}
            starts = [at for at, _ in found]
            # Of several at one place the first that was given is enough.
            astray |= {
                it for at, it in found if it != min(own for place, own in found if place == at)
            }
            for it in own:
                if it.start not in starts:
                    at = it.start + sum(
                        len(it_word) for place, it_word in found if place < it.start
                    )
                    lacks.append(it._replace(value=text, start=at, end=at))
    return Compared(tuple(lacks), frozenset(astray))


def _words(value: str, text: str, word: re.Pattern[str]) -> list[tuple[int, str]] | None:
    """Return the words that a text has more than a value, each with its place in that; None if that is
    not all."""
    found, at, place = [], 0, 0
    while at < len(text):
        if it := word.match(text, at):
            found.append((place, it[0]))
            at = it.end()
        elif value[place : place + 1] == text[at]:
            at, place = at + 1, place + 1
        else:
            return None
    return found if place == len(value) else None
