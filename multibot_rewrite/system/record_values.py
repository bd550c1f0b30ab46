# SPDX-License-Identifier: Apache-2.0
"""Records as plain values of JSON and YAML, without what is as usual, and back with checks. Pure."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from functools import cache, partial
from operator import attrgetter
from types import NoneType
from typing import Any, TypeVar, cast, get_args, get_origin, get_type_hints

from multibot_rewrite.base.findings.finding import LEVELS, Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.system.json_values import (
    Reader,
    WrongValue,
    read_full_name,
    read_list,
    read_nothing,
    read_plain,
    read_policies,
    read_seconds,
    read_transform,
    read_word,
    unexpected,
)
from multibot_rewrite.system.records import (
    CALIBRATION,
    CHANGING,
    COMPUTER,
    DEVICE,
    EXPECTED,
    KINDS,
    MAY,
    OFF,
    OWN,
    QUIET,
    ROLES,
    RUNS,
    TIMEOUT,
    UNKNOWN,
    Address,
    Controller,
    Edge,
    End,
    Environment,
    Heard,
    Lookup,
    Node,
    Parameter,
    Place,
    Qos,
    Robot,
    Sure,
    System,
    Topic,
    place_of,
)

# Of a field that is a list, what its items may be.
ALLOWED_WORDS: Mapping[tuple[type, str], tuple[str, ...]] = {
    (End, "kind"): KINDS,
    (End, "role"): ROLES,
    (Topic, "bridge"): ROLES,
    (Address, "kind"): (DEVICE, CALIBRATION, COMPUTER, OWN),
    (Sure, "word"): tuple(it.word for it in (RUNS, MAY, UNKNOWN, OFF)),
    (Environment, "settled"): (EXPECTED, QUIET, TIMEOUT, CHANGING),
    (Finding, "level"): LEVELS,
    (System, "release"): ("", *RELEASES),
}
FULL_NAMES = {
    (Node, "name"),
    (End, "name"),
    (End, "node"),
    (Heard, "topic"),
    (Lookup, "node"),
    (Address, "node"),
    (Parameter, "node"),
    (Controller, "manager"),
    (Robot, "tf_topic"),
    (Topic, "name"),
}
_NUMBERS = {(Edge, "transform"), (Heard, "pose")}
# The transforms of a plan say who sends them and not on which topic.
MAYBE_FULL_NAMES: Mapping[type, str] = {Edge: "topic"}
# What fixes a file is for the program that found it.
LEFT_OUT: Mapping[type, str] = {Finding: "edits"}
# Records that a text says whole, as far as it does: how it is made, and read.
SHORT: Mapping[type, tuple[Callable[[Any], str], Callable[[str], Any]]] = {
    Place: (str, place_of),
    Sure: (attrgetter("word"), Sure),
}
# What a file may have below a record.
BELOW: Mapping[type, tuple[str, ...]] = {Robot: ("nodes",), Node: ("ends", "parameters")}
Read = TypeVar("Read")
# The type of a field whose pairs are a mapping in a file: policies of Qos whose value is a word.
POLICIES = tuple[tuple[str, str], ...]
POLICY_NAMES = ("history", "reliability", "durability", "liveliness")


def plain_value(value: object) -> Any:
    """Return a record as JSON has it, without what is as usual; a plain value is returned as it is."""
    if isinstance(value, tuple):
        fields = getattr(value, "_fields", None)
        if fields is None:
            pairs = value and type(value[0]) is tuple
            return dict(value) if pairs else [plain_value(item) for item in value]
        kind = type(value)
        if kind in SHORT:
            text = SHORT[kind][0](value)
            if SHORT[kind][1](text) == value:
                return text
        usual, left_out = cast(Any, kind)._field_defaults, LEFT_OUT.get(kind)
        named = zip(fields, value, strict=True)
        told = (it for it in named if usual.get(it[0], ...) != it[1])
        return {name: plain_value(it) for name, it in told if name != left_out}
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def record_from(kind: type, value: object, file: str) -> Any:
    """Return a value as the record ``kind``; raises InputError with file, key and what is wrong."""
    return in_file(reader(kind), value, file)


def in_file(read: Callable[[Any], Read], value: object, file: str) -> Read:
    """Return what is read of a value; raises InputError with file, key and what is wrong."""
    try:
        return read(value)
    except WrongValue as wrong:
        key = "".join(reversed(wrong.keys)).lstrip(".")
        raise InputError(f"{file}: {key}: {wrong.reason}") from None


# Each reader is made once: a snapshot of 1,000 robots has half a million values.
@cache
def reader(expected: Any) -> Reader:
    """Return a function that reads a JSON value as the type ``expected``, or raises WrongValue."""
    options = get_args(expected)
    if expected == POLICIES:
        return partial(read_policies, POLICY_NAMES)
    if NoneType in options:
        inner = reader(options[0])
        return lambda value: None if value is None else inner(value)
    if get_origin(expected) is tuple:
        return partial(read_list, reader(options[0]))
    if hasattr(expected, "_fields"):
        hints = get_type_hints(expected)
        readers = {name: _field_reader(expected, name, hint) for name, hint in hints.items()}
        needed = [it for it in hints if is_needed(expected, it)]
        whole = partial(_read_record, expected, readers, needed)
        return partial(_read_short, expected, whole) if expected in SHORT else whole
    return read_seconds if expected is float else partial(read_plain, expected)


def _field_reader(kind: Any, name: str, hint: Any) -> Reader:
    words = ALLOWED_WORDS.get((kind, name))
    if words:
        one = partial(read_word, words)
        return partial(read_list, one) if get_origin(hint) is tuple else one
    if (kind, name) in _NUMBERS:
        return read_transform
    if MAYBE_FULL_NAMES.get(kind) == name:
        return lambda value: value if value == "" else read_full_name(value)
    if LEFT_OUT.get(kind) == name:
        return read_nothing
    return read_full_name if (kind, name) in FULL_NAMES else reader(hint)


def _read_short(kind: type, whole: Reader, value: object) -> object:
    return whole(SHORT[kind][1](value)._asdict() if isinstance(value, str) else value)


def is_needed(kind: Any, name: str) -> bool:
    """Must a file have the field: has it no default, or one that is no full name where it has to be?"""
    usual = kind._field_defaults
    return name not in usual or (usual[name] == "" and (kind, name) in FULL_NAMES)


def _read_record(
    kind: Any, readers: Mapping[str, Reader], needed: Collection[str], value: object
) -> object:
    if type(value) is kind:
        return value
    if type(value) in (Node, End, Qos):
        value = cast(Any, value)._asdict()
    if not isinstance(value, dict):
        raise unexpected("an object", value)
    fields: dict[str, object] = {}
    name = ""
    try:
        for name, given in value.items():
            fields[name] = readers[name](given)
    except WrongValue as wrong:
        wrong.keys.append(f".{name}")
        raise
    except KeyError:
        keys = ", ".join((*readers, *BELOW.get(kind, ())))
        raise WrongValue(f"unknown key; the keys are {keys}", f".{name}") from None
    for name in needed:
        if name not in fields:
            raise WrongValue("missing; it is needed", f".{name}")
    return kind(**fields)
