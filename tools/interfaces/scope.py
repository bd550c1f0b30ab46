# SPDX-License-Identifier: Apache-2.0
"""What a name in a class stands for: a type, a value, a constructor's argument."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from multibot_rewrite.producers.sources.expressions import last, template_arguments
from multibot_rewrite.producers.sources.records import (
    Alias,
    Call,
    Class,
    Constructor,
    Place,
    Source,
    Value,
)

DEEPEST = 8
# Whose classes a repository inherits from, besides its own.
ABOVE = {"ros2_controllers": ("ros2_control",), "gz_ros2_control": ("ros2_control",)}
_PART = re.compile(r"<([^<>]*)>")
_BRACED = re.compile(r"\{([^{}]*)\}")
_ROS_TYPE = re.compile(r"(\w+)(?:::|/|\.)(msg|srv|action)(?:::|/|\.)(\w+)")
Located = TypeVar("Located", Class, Call, Value)
Item = TypeVar("Item")
Key = TypeVar("Key", bound=Hashable)


class Index(NamedTuple):
    """What was read, by the names that it is asked for."""

    classes: Mapping[str, tuple[Class, ...]]
    calls: Mapping[str, tuple[Call, ...]]
    functions: Mapping[str, tuple[Call, ...]]
    values: Mapping[tuple[str, str], tuple[Value, ...]]
    variables: Mapping[str, tuple[Value, ...]]
    aliases: Mapping[str, tuple[Alias, ...]]
    constructors: Mapping[str, tuple[Constructor, ...]]
    plugins: Mapping[str, tuple[str, ...]]


class Scope(NamedTuple):
    """Where a text is read: a class with its bases, and what is known of its names and types."""

    place: Place
    owners: tuple[str, ...]
    given: Mapping[str, str]
    types: Mapping[str, str]


class Resolved(NamedTuple):
    """A text with its names replaced, and the parameter that sets it."""

    text: str
    parameter: str = ""


def indexed(source: Source) -> Index:
    """Return the index of what was read."""
    return Index(
        _by(source.classes, lambda it: it.name),
        _by(source.calls, lambda it: it.owner),
        _by((it for it in source.calls if not it.owner), lambda it: it.function),
        _by(source.values, lambda it: (it.owner, it.variable)),
        _by(source.values, lambda it: it.variable),
        _by(source.aliases, lambda it: it.name),
        _by(source.constructors, lambda it: it.owner),
        {
            base: tuple(it.name for it in source.plugins if it.base == base)
            for base in {it.base for it in source.plugins}
        },
    )


def _by(items: Iterable[Item], key: Callable[[Item], Key]) -> dict[Key, tuple[Item, ...]]:
    found: dict[Key, list[Item]] = {}
    for item in items:
        found.setdefault(key(item), []).append(item)
    return {name: tuple(rows) for name, rows in found.items()}


def nearest(items: Iterable[Located], place: Place) -> tuple[Located, ...]:
    """Those of the same package, else of the same repository, else of those it builds on."""
    found = tuple(items)
    package = tuple(it for it in found if it.place.package == place.package)
    repository = tuple(it for it in found if it.place.repository == place.repository)
    above = ABOVE.get(place.repository, ())
    return package or repository or tuple(it for it in found if it.place.repository in above)


def type_of(index: Index, scope: Scope, type_: str) -> str:
    """Return a C++ type as ROS writes it, by its names in a class; its own text if unknown."""
    for _ in range(DEEPEST):
        ros = _ROS_TYPE.search(type_)
        if ros:
            return "/".join(ros.groups())
        name = last(type_.removeprefix("typename "))
        if name in scope.types and scope.types[name] != type_:
            type_ = scope.types[name]
            continue
        near = _alias(index, scope, name)
        if not near or near == type_:
            return type_
        type_ = near
    return type_


def _alias(index: Index, scope: Scope, name: str) -> str:
    """Return what a name of a type stands for, nearest first."""
    rows = index.aliases.get(name, ())
    own = [it.type for owner in scope.owners for it in rows if it.owner == owner]
    return next(iter(own), rows[0].type if len({it.type for it in rows}) == 1 else "")


def text_in(index: Index, scope: Scope, function: str, text: str, depth: int = 0) -> Resolved:
    """Return a text with every name in <> replaced by what it stands for, where that is known."""
    parameter = ""

    def replaced(part: re.Match[str]) -> str:
        nonlocal parameter
        found = _value(index, scope, function, part[1], depth)
        parameter = parameter or found.parameter
        return found.text

    return Resolved(_PART.sub(replaced, text), parameter)


def _value(index: Index, scope: Scope, function: str, name: str, depth: int) -> Resolved:
    if depth > DEEPEST or name.startswith("Node:"):
        return Resolved(f"<{name}>")
    if name.startswith("@"):
        return _parameter(index, scope, function, name, depth)
    for text in _candidates(index, scope, function, name):
        if text.strip() and text not in (f"<{name}>", "<?>"):
            found = text_in(index, scope, function, text, depth + 1)
            if found.parameter or (found.text and found.text != f"<{name}>"):
                return found
    return Resolved(f"<{name}>")


def _candidates(index: Index, scope: Scope, function: str, name: str) -> Iterator[str]:
    """Texts that a name may stand for, the best first."""
    if name in scope.given:
        yield scope.given[name]
    rows = [it for owner in scope.owners for it in index.values.get((owner, name), ())]
    own = [it for it in nearest(rows, scope.place) if it.owner or it.function in ("", function)]
    own.sort(key=lambda it: (it.function != function, "@" not in it.text))
    yield from (it.text for it in own)
    if name.isupper():
        yield from (
            it.text
            for it in nearest(index.variables.get(name, ()), scope.place)
            if "<" not in it.text
        )


def _parameter(index: Index, scope: Scope, function: str, name: str, depth: int) -> Resolved:
    """Return the default of a parameter, and its name."""
    rows = nearest(index.variables.get(name, ()), scope.place)
    texts = [it.text for it in rows if it.text and "<" not in it.text]
    parameter = _BRACED.sub(
        lambda it: text_in(index, scope, function, f"<{it[1]}>", depth + 1).text, name[1:]
    )
    unknown = f"<{parameter.replace('<', '').replace('>', '')}>"
    return Resolved(texts[0] if texts else unknown, parameter)


def bound(index: Index, name: str, given: tuple[str, ...]) -> dict[str, str]:
    """Return what a constructor's parameters are given, by their names."""
    fitting = [
        it.names
        for it in index.constructors.get(name, ())
        if it.function == name and len(it.names) >= len(given)
    ]
    names = min(fitting, key=len, default=())
    return dict(zip(names, given, strict=False))


def bound_types(found: Class, type_: str) -> dict[str, str]:
    """Return what a template's parameters are given, by their names."""
    heads = [it.partition("=")[::2] for it in found.parameters]
    defaults = {name: default for name, default in heads if default}
    names = [name for name, _ in heads]
    return defaults | dict(zip(names, template_arguments(type_), strict=False))
