# SPDX-License-Identifier: Apache-2.0
"""Reads xacro files for the parameters and properties that can take an argument.

A call with ``prefix=""`` becomes ``prefix="$(arg prefix)"``. Which calls can have it is found by one
expansion in which each gets a mark of its own: a mark may only be where a prefix is wanted.
A file that is included has the argument's property as well, empty where nobody has set it: packages
that are not looked at include it, too. Where macros have a parameter of that name, it is the argument
itself. Source: xacro README (properties are global where they are outside of macros; ``default`` of a
property; the first declaration of an argument counts)."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import accumulate
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.reports.xacro_arguments import declared_in, names_robots
from multibot_rewrite.description.steps.document import (
    Document,
    attribute_slots,
    read_document,
    tag_end,
)
from multibot_rewrite.refactor.placing import Spot
from multibot_rewrite.refactor.source_edits import SourceEdit, ValueEdit, spans

NAMES = ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
SPACES = ("namespace", "robot_namespace", "ros_namespace")
_SPACE = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_PARAMETER = re.compile(r"([\w.]+)(?:\s*:?=\s*(?:'([^']*)'|(\S*)))?")
_NAMED = re.compile(r"\s*\$(?:\(arg ([\w.-]+)\)|\{\s*(\w+)\s*\})\s*")
MARK = re.compile(rb"qz\d{3}z")


class Place(NamedTuple):
    """A parameter of a macro, or a property (of no macro), that ``element`` gives a value.

    A word goes to ``spot``, before the value, with ``before`` and ``after`` around it."""

    macro: str
    name: str
    value: str
    element: _Element
    spot: Spot
    before: str
    after: str

    @property
    def may_be_prefix(self) -> bool:
        """Whether it is for names of robots, and its value is known or outside of macros."""
        is_known = "$" not in self.value and "^" not in self.value
        return names_robots(self.name.lower()) and (is_known or not _macro_of(self.element))

    def edit(self, word: str) -> SourceEdit:
        """Return the edit that puts a word there."""
        return SourceEdit(*self.spot, self.spot[1], f"{self.before}{word}{self.after}".encode())

    def is_argument(self, argument: str, carriers: Collection[tuple[str, str]]) -> bool:
        """Return whether the value is the argument, itself or by the name of a carrier of it."""
        if (found := _NAMED.fullmatch(self.value)) is None:
            return False
        names = {(macro, found[2]) for macro in ("", _macro_of(self.element))}
        return found[1] == argument or not names.isdisjoint(carriers)


class Sources:
    """The xacro files of descriptions."""

    def __init__(self, texts: Mapping[str, bytes]) -> None:
        # YAML that an expression loads is among them.
        own = {file: data for file, data in texts.items() if b"<robot" in data}
        self.arguments = declared_in(own)
        self.documents = {file: read_document(data, file) for file, data in own.items()}
        macros = (it for one in self.documents.values() for it in one.root.iter("{*}macro"))
        every = ((_name(it), _PARAMETER.findall(it.get("params", ""))) for it in macros)
        self.macros = {name: {it: a or b for it, a, b in found} for name, found in every}
        self.places = [it for file in self.documents for it in self._places(file)]

    @property
    def hiding(self) -> set[str]:
        """The names of properties and parameters, where a new property would mean something else."""
        names = {name for own in self.macros.values() for name in own}
        return names | {it.name for it in self.places if not it.macro}

    def free_name(self, names: Iterable[str], hiding: Collection[str] = ()) -> str:
        """Return a name that no argument has, and none of those that are ``hiding`` it."""
        taken = self.arguments.keys() | set(hiding)
        free = next((name for name in names if name not in taken), None)
        if free is None:
            raise UsageError(
                f"{', '.join(names)} are all taken by its xacro arguments or properties: rename one"
            )
        return free

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

    def word_at(
        self, spot: Spot, argument: str, carriers: Collection[tuple[str, str]], as_property: bool
    ) -> str:
        """Return an expression with the argument's value at a place, by a carrier if there is one."""
        macro, source = self.macro_at(spot), self.documents[spot[0]].source
        own = [name for of, name in carriers if of and of == macro]
        own = own or [it for of, it in carriers if not of and b"${%s}" % it.encode() in source]
        name = argument if argument in own or as_property > bool(own) else min(own, default="")
        return f"${{{name}}}" if name else f"$(arg {argument})"

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
            tag_text = document.source[start : tag_end(document.source, start)]
            end = start + len(tag_text.rstrip(b" />"))
            for of, name, default, attribute in given:
                value = element.get(attribute, default)
                at = slots.get(attribute.encode(), (end, end))[0]
                around = ("", "") if at != end else (f' {attribute}="', f'{value}"')
                yield Place(of, name, value, element, (file, at), *around)


def _name(element: _Element) -> str:
    return element.get("name", "").removeprefix("xacro:")


def _macro_of(element: _Element) -> str:
    return next((_name(it) for it in element.iterancestors("{*}macro")), "")


class Compared(NamedTuple):
    """What a description lacks whose names were marked: ``lacks`` are its changes.

    ``astray`` are marks in other places; it holds "" if the description differs besides."""

    lacks: tuple[ValueEdit, ...]
    astray: frozenset[str]


def compared(
    base: Document, wanted: Collection[ValueEdit], other: Document, word: re.Pattern[bytes]
) -> Compared:
    """Compare a description with itself after something put words before its names."""
    if word.sub(b"", other.source) != base.source:
        return Compared((), frozenset(("",)))
    found = [(it.start(), it[0].decode()) for it in word.finditer(other.source)]
    sizes = accumulate((len(it) for _, it in found), initial=0)
    # Where each is in the text without them; of several at one place the first is enough.
    places = [(at - size, it) for (at, it), size in zip(found, sizes, strict=False)]
    first = dict(reversed(places))
    begins = [it[0] if it else -1 for it in spans(base, wanted)]
    lacks: list[ValueEdit] = []
    for edit, begin in zip(wanted, begins, strict=True):
        if begin not in first:
            element, start = other.elements[edit.element], len(edit.value[: edit.start].encode())
            inside = (mark for place, mark in places if begin - start <= place < begin)
            at = edit.start + sum(map(len, inside))
            text = element.get(edit.attribute) if edit.attribute else element.text
            lacks.append(edit._replace(value=text or "", start=at, end=at))
    wrong = first.keys() - {*begins}
    astray = (it for at, it in places if at in wrong or it != first[at])
    return Compared(tuple(lacks), frozenset(astray))


def declared(
    texts: Mapping[str, bytes],
    edits: Iterable[SourceEdit],
    tops: Collection[str],
    argument: str,
    as_property: bool,
) -> Iterator[SourceEdit]:
    """Yield the edits that declare an argument in the ``tops`` and in files whose ``edits`` use it."""
    # ``as_property`` is the property, which has its value in the tops.
    word = rf"\b{argument}\b" if as_property else rf"\$\(arg {argument}\)"
    using = {it.file for it in edits if re.search(word.encode(), it.new)}
    own = [f'arg name="{argument}" default=""/>']
    if as_property and using:
        own.append(f'property name="{argument}" value="$(arg {argument})"/>')
    empty = [f'property name="{argument}" default=""/>']
    for path in {*tops, *using}:
        lines = own if path in tops or not as_property else empty
        document, source = read_document(texts[path], path), texts[path]
        every = zip(document.elements, document.starts, strict=True)
        named = ((str(it.tag), at) for it, at in every if it.get("name") == argument)
        there = {tag.rpartition("}")[2]: at for tag, at in named}
        start = document.starts[0]
        text = "".join(f"\n  <xacro:{it}" for it in lines if it.split()[0] not in there)
        end = tag_end(source, there.get("arg", start))
        yield from [SourceEdit(path, end, end, text.encode())] * bool(text)
        if b"xmlns:xacro" not in source[start : tag_end(source, start)]:
            at = start + len(b"<robot")
            yield SourceEdit(path, at, at, _SPACE)
