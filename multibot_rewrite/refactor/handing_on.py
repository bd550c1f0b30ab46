# SPDX-License-Identifier: Apache-2.0
"""Macros and properties that take a prefix already get the argument, so their names need no other edit.

A call with ``prefix=""`` becomes ``prefix="$(arg prefix)"``. Which calls can have it is found by one
expansion in which each gets a mark of its own: a mark may only be where a prefix is wanted.
A file that is included has the argument's property as well, empty where nobody has set it: packages
that are not looked at include it, too. Source: xacro README (properties are global where they are
outside of macros; ``default`` of a property)."""

from __future__ import annotations

import os
import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.steps.document import (
    Document,
    attribute_slots,
    read_document,
    tag_end,
)
from multibot_rewrite.refactor.package import Description
from multibot_rewrite.refactor.placing import Spot, values_of
from multibot_rewrite.refactor.source_edits import SourceEdit, ValueEdit

NAMES = ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
SPACES = ("namespace", "robot_namespace", "ros_namespace")
_SPACE = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_PARAMETER = re.compile(r"([\w.]+)(?:\s*:?=\s*(?:'([^']*)'|(\S*)))?")
_NAMED = re.compile(r"\s*\$(?:\(arg ([\w.-]+)\)|\{\s*(\w+)\s*\})\s*")
_LIKE = re.compile("prefix", re.IGNORECASE)
MARK = re.compile(r"qz\d{3}z")


class Place(NamedTuple):
    """A parameter of a macro, or a property (of no macro), that is given a value by ``element``: where
    a word goes before that, with what is around it."""

    macro: str
    name: str
    value: str
    element: _Element
    spot: Spot
    before: str
    after: str

    @property
    def may_be_prefix(self) -> bool:
        """Is it called so, and is its value known, or outside of macros?"""
        is_known = "$" not in self.value and "^" not in self.value
        return bool(_LIKE.search(self.name)) and (is_known or not _macro_of(self.element))

    def edit(self, word: str) -> SourceEdit:
        """Return the edit that puts a word there."""
        return SourceEdit(*self.spot, self.spot[1], f"{self.before}{word}{self.after}".encode())

    def is_argument(self, argument: str, carriers: Collection[tuple[str, str]]) -> bool:
        """Is the value the argument, as it is or by the name of something that carries it?"""
        found = _NAMED.fullmatch(self.value)
        if found is None or found[1]:
            return found is not None and found[1] == argument
        return (_macro_of(self.element), found[2]) in carriers or ("", found[2]) in carriers


class Sources:
    """The xacro files of descriptions; ``tops`` are those of the descriptions themselves."""

    def __init__(self, texts: Mapping[str, bytes], tops: Collection[str]) -> None:
        self.tops = tops
        own = {file: data for file, data in texts.items() if b"<robot" in data}
        self.documents = {file: read_document(data, file) for file, data in own.items()}
        macros = (it for one in self.documents.values() for it in one.root.iter("{*}macro"))
        every = ((_name(it), _PARAMETER.findall(it.get("params", ""))) for it in macros)
        self.macros = {name: {it: a or b for it, a, b in found} for name, found in every}
        self.places = [it for file in self.documents for it in self._places(file)]

    def macro_at(self, spot: Spot) -> str:
        """Return the macro that a place is in; empty if it is in none."""
        document = self.documents[spot[0]]
        return _macro_of(document.elements[bisect_right(document.starts, spot[1]) - 1])

    def carriers(self, argument: str) -> set[tuple[str, str]]:
        """Return the parameters, with their macros, and properties that always are the argument."""
        given = lists_by_key(((it.macro, it.name), it) for it in self.places)
        found: set[tuple[str, str]] = set()
        while more := {
            key
            for key, its in given.items()
            if key not in found and all(it.is_argument(argument, found) for it in its)
        }:
            found |= more
        return found

    def _places(self, file: str) -> Iterator[Place]:
        document = self.documents[file]
        for element, start in zip(document.elements, document.starts, strict=True):
            uri, _, tag = str(element.tag).partition("}")
            if not uri.endswith("xacro"):
                continue
            macro = tag.rpartition(".")[2]
            given = [(macro, *it, it[0]) for it in self.macros.get(macro, {}).items()]
            if tag == "property" and "value" in element.attrib and not _macro_of(element):
                given = [("", _name(element), "", "value")]
            slots = attribute_slots(document.source, start) if given else {}
            end = start + len(
                document.source[start : tag_end(document.source, start)].rstrip(b" />")
            )
            for of, name, default, attribute in given:
                value = element.get(attribute, default)
                at = slots.get(attribute.encode(), (end, end))[0]
                around = ("", "") if at != end else (f' {attribute}="', f'{value}"')
                yield Place(of, name, value, element, (file, at), *around)


def _name(element: _Element) -> str:
    return element.get("name", "").removeprefix("xacro:")


def _macro_of(element: _Element) -> str:
    return next((_name(it) for it in element.iterancestors("{*}macro")), "")


class Words(NamedTuple):
    """What is written for the argument, place by place; is it a new one?"""

    argument: str
    is_new: bool
    sources: Sources
    carriers: Collection[tuple[str, str]]

    def at(self, spot: Spot, in_call: bool = False) -> bytes | None:
        """Return an expression that has the argument's value at a place; None if none has."""
        macro, source = self.sources.macro_at(spot), self.sources.documents[spot[0]].source
        own = b'arg name="%s"' % self.argument.encode() in source or spot[0] in self.sources.tops
        is_hidden = self.argument in self.sources.macros.get(macro, ())
        if name := self._carrier(spot):
            return b"${%s}" % name.encode()
        if own and (in_call or is_hidden or not self.is_new):
            return b"$(arg %s)" % self.argument.encode()
        return None if is_hidden else b"${%s}" % self.argument.encode()

    def _carrier(self, spot: Spot) -> str:
        """Return a parameter or property that has the value there; empty if none has."""
        macro, source = self.sources.macro_at(spot), self.sources.documents[spot[0]].source
        own = [name for of, name in self.carriers if of and of == macro]
        own = own or [it for of, it in self.carriers if not of and b"${%s}" % it.encode() in source]
        return self.argument if self.argument in own else min(own, default="")

    def using(self, edits: Iterable[SourceEdit]) -> set[str]:
        """Return the files whose edits use the property of the argument, which has to be declared."""
        word = b"${%s}" % self.argument.encode()
        return {it.file for it in edits if word in it.new and not self._carrier(it[:2])}


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
    lacks: list[ValueEdit] = []
    astray: set[str] = set()
    for number, (one, two) in enumerate(zip_longest(base.elements, other.elements)):
        if one is None or two is None or _shape(one) != _shape(two):
            return Compared((), frozenset(("",)))
        for (attribute, value), (_, text) in zip(values_of(one), values_of(two), strict=True):
            own = changes.get((number, attribute), [])
            found = _words(value, text, word)
            if found is None:
                astray.add("")
                continue
            # Of several at one place the first that was given is enough.
            first = {at: min(it for place, it in found if place == at) for at, _ in found}
            wrong = first.keys() - {it.start for it in own}
            astray |= {it for at, it in found if at in wrong or it != first[at]}
            for it in own:
                at = it.start + sum(len(that) for place, that in found if place < it.start)
                lack = it._replace(value=text, start=at, end=at)
                lacks += [] if it.start in first else [lack]
    return Compared(tuple(lacks), frozenset(astray))


def _shape(element: _Element) -> tuple[object, ...]:
    return element.tag, element.keys(), len(element)


def _words(value: str, text: str, word: re.Pattern[str]) -> list[tuple[int, str]] | None:
    """Return the words that a text has more than a value, each with its place in that; None if that is
    not all."""
    found, at, place = [], 0, 0
    while at < len(text):
        if it := word.match(text, at):
            found.append((place, it[0]))
            at = it.end()
        elif value[place : place + 1] != text[at]:
            return None
        else:
            at, place = at + 1, place + 1
    return found if place == len(value) else None


def free_name(
    found: Iterable[Description],
    names: Sequence[str] = NAMES,
    known: Collection[str] | None = None,
) -> str:
    """Return a name that no argument, property or parameter of a macro has; where properties are
    ``known`` to take the argument, those may have it, and parameters."""
    taken: set[str] = set()
    sources = {file: data for it in found for file, data in it.sources.items()}
    # YAML that an expression loads is among them.
    for file, data in ((file, data) for file, data in sources.items() if b"<robot" in data):
        for element in read_document(data, file).root.iter("{*}arg", "{*}property", "{*}macro"):
            is_argument = str(element.tag).endswith("}arg")
            own = {element.get("name", "")}
            words = element.get("params", "").replace(":=", " ").replace("=", " ").split()
            taken |= own.union(words) if known is None else own - set(() if is_argument else known)
    free = next((name for name in names if name not in taken), None)
    if free is None:
        raise UsageError(f"{', '.join(names)} are all names of its arguments or properties")
    return free


def declared(
    tops: Iterable[Description],
    texts: Mapping[str, bytes],
    using: Collection[str],
    argument: str,
) -> Iterator[SourceEdit]:
    """Yield the argument in the descriptions' own files. Where a file is ``using`` its property, that
    too: with the argument's value in those, otherwise empty. ``texts`` are the bytes by real path."""
    value = f'<xacro:property name="{argument}" value="$(arg {argument})"/>'
    lines: dict[str, list[str]] = {}
    for it in tops:
        known = any(b'arg name="%s"' % argument.encode() in data for data in it.sources.values())
        argued = [f'<xacro:arg name="{argument}" default=""/>'] * bool(using or not known)
        lines[os.path.realpath(it.path)] = argued + [value] * bool(using)
    for path in using:
        lines.setdefault(path, [f'<xacro:property name="{argument}" default=""/>'])
    for path, own in lines.items():
        yield from _first(path, texts[path], own, argument) if b"<robot" in texts[path] else ()


def _first(path: str, source: bytes, lines: Iterable[str], argument: str) -> Iterator[SourceEdit]:
    """Yield the edits for missing lines, first in the root element or behind the argument."""
    document = read_document(source, path)
    start = document.starts[0]
    every = zip(document.elements, document.starts, strict=True)
    there = {str(it.tag).rpartition("}")[2]: at for it, at in every if it.get("name") == argument}
    text = "".join(f"\n  {it}" for it in lines if it[7:].split()[0] not in there)
    if b"xmlns:xacro" not in source[start : tag_end(source, start)]:
        at = start + len(b"<robot")
        yield SourceEdit(path, at, at, _SPACE)
    if text:
        end = tag_end(source, there.get("arg", start))
        yield SourceEdit(path, end, end, text.encode())
