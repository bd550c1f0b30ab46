# SPDX-License-Identifier: Apache-2.0
"""Records as plain values of JSON and YAML, without what is as usual, and back with checks. Pure."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Mapping
from functools import cache, partial
from operator import attrgetter
from types import NoneType
from typing import Annotated, Any, TypeVar, cast, get_args, get_origin, get_type_hints

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.system.records import (
    End,
    FullName,
    MaybeFullName,
    Node,
    Place,
    Qos,
    Robot,
    Sure,
    place_of,
)

Reader = Callable[[Any], Any]
# Plans of earlier versions have it.
_OLD_KEYS = {"stack": "node_set"}
_TYPE_NAMES = {str: "text", int: "a whole number", bool: "true or false"}
# NaN is not below it, and every whole number below it fits into a float.
_LARGEST = 1e300
# What no robot reaches, in metres. NaN is not below it, either.
FARTHEST = 1e12
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


class WrongValue(Exception):
    """A wrong value; ``keys`` is the path to it, the innermost key first."""

    def __init__(self, reason: str, *keys: str) -> None:
        super().__init__(reason)
        self.reason = reason
        self.keys = list(keys)


def unexpected(expected: str, value: object) -> WrongValue:
    """Return the error for a value that is not what ``expected`` says."""
    return WrongValue(f"expected {expected}, not {shown(value)}")


def read_plain(expected: type, value: object) -> object:
    """Return a text, whole number or truth value; raises WrongValue for another type."""
    # Not isinstance: True is an int as well.
    if type(value) is not expected:
        raise unexpected(_TYPE_NAMES[expected], value)
    return value


def read_word(words: tuple[str, ...], value: object) -> object:
    """Return the value, if it is one of these words; raises WrongValue for another."""
    if value not in words:
        raise unexpected(f"one of {', '.join(words)}", value)
    return value


def read_policies(policies: Collection[str], value: object) -> object:
    """Return policies with their words, which may be written in small letters."""
    if not isinstance(value, dict):
        raise unexpected("a mapping, as {durability: transient_local}", value)
    for policy, word in value.items():
        if policy not in policies or not isinstance(word, str):
            what = f"write words of {', '.join(policies)}, as {{durability: transient_local}}"
            raise WrongValue(what, f".{policy}")
    return tuple((policy, word.upper()) for policy, word in value.items())


def read_nothing(value: object) -> object:
    """Raise WrongValue for a field that no file can have."""
    raise WrongValue("not a key of a file; leave it out")


def read_full_name(may_be_empty: bool, value: object) -> object:
    """Return a name with a slash in front; raises WrongValue without."""
    if not isinstance(value, str) or not (value.startswith("/") or (may_be_empty and not value)):
        raise unexpected("a full name that starts with /", value)
    return value


def read_seconds(value: object) -> object:
    """Return a time; null is no limit. Raises WrongValue for anything else."""
    if value is None:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _LARGEST:
        raise unexpected("a number or null", value)
    return float(value)


def read_transform(value: object) -> object:
    """Return three numbers and four, or nothing; null is a number that is NaN."""
    numbers = read_list(read_seconds, value)
    if len(numbers) not in (0, 7) or not all(
        abs(it) < FARTHEST or it == math.inf for it in numbers
    ):
        raise unexpected("7 numbers: x, y, z and a quaternion x, y, z, w", value)
    return numbers


def read_list(reader: Reader, value: Any) -> tuple[Any, ...]:
    """Return a list of what ``reader`` reads; raises WrongValue with the place of a wrong item."""
    # An empty tuple is the default of a key that is left out.
    if not isinstance(value, list) and value != ():
        raise unexpected("a list", value)
    result = []
    try:
        for item in value:
            result.append(reader(item))
    except WrongValue as wrong:
        wrong.keys.append(f"[{len(result)}]")
        raise
    return tuple(result)


def shown(value: object) -> str:
    """Return the value as a message shows it."""
    text = json.dumps(value, ensure_ascii=False, default=str, skipkeys=True)
    return text if len(text) <= 40 else f"{text[:39]}…"


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
        unusual = (it for it in named if usual.get(it[0], ...) != it[1])
        return {name: plain_value(it) for name, it in unusual if name != left_out}
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
    if get_origin(expected) is Annotated:
        return _limited(expected, options[1])
    if hasattr(expected, "_fields"):
        hints = get_type_hints(expected, include_extras=True)
        readers = {name: reader(hint) for name, hint in hints.items()}
        if expected in LEFT_OUT:
            readers[LEFT_OUT[expected]] = read_nothing
        whole = partial(_read_record, expected, readers, needed(expected, hints))
        return partial(_read_short, expected, whole) if expected in SHORT else whole
    return read_seconds if expected is float else partial(read_plain, expected)


def _limited(expected: Any, limit: object) -> Reader:
    """Return the reader of a field of ``records`` that only some words, names or numbers fit."""
    if isinstance(limit, tuple):
        return partial(read_word, limit)
    if isinstance(limit, str):
        return partial(read_full_name, expected == MaybeFullName)
    return read_transform


def _read_short(kind: type, whole: Reader, value: object) -> object:
    """Return a record from a value, or from the text that is short for it."""
    return whole(SHORT[kind][1](value)._asdict() if isinstance(value, str) else value)


def needed(kind: Any, hints: Mapping[str, Any]) -> list[str]:
    """Return the fields that a file must have: without a default, or full names."""
    usual = kind._field_defaults
    return [
        name
        for name, hint in hints.items()
        if name not in usual or (usual[name] == "" and hint == FullName)
    ]


def _read_record(
    kind: Any, readers: Mapping[str, Reader], needed: Collection[str], value: object
) -> object:
    if type(value) is kind:
        return value
    if type(value) in (Node, End, Qos):
        value = plain_value(value)
    if not isinstance(value, dict):
        raise unexpected("an object", value)
    fields: dict[str, object] = {}
    name = ""
    try:
        for key, given in value.items():
            name = str(_OLD_KEYS.get(key, key))
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
