# SPDX-License-Identifier: Apache-2.0
"""A system as JSON: written, one record on each line, and read with checks. Pure.

``system.schema.json`` says the same of a file as a JSON schema.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from functools import cache, lru_cache, partial
from sys import intern
from types import NoneType
from typing import Any, cast, get_args, get_origin, get_type_hints

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.file_kinds import PLAN, SNAPSHOT, refuse_others
from multibot_rewrite.base.findings.finding import LEVELS, Finding
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.base.model import InputError
from multibot_rewrite.system.json_values import (
    Reader,
    WrongValue,
    read_full_name,
    read_list,
    read_nothing,
    read_plain,
    read_seconds,
    read_transform,
    read_word,
    shown,
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
    Qos,
    Sure,
    System,
)

_REMEDY = "use the file that multibot snapshot -o wrote"
SCHEMA = 2
_EMPTY: tuple[object, ...] = ("", ())

ALLOWED_WORDS: Mapping[tuple[type, str], tuple[str, ...]] = {
    (End, "kind"): KINDS,
    (End, "role"): ROLES,
    (Address, "kind"): (DEVICE, CALIBRATION, COMPUTER, OWN),
    (Sure, "word"): tuple(it.word for it in (RUNS, MAY, UNKNOWN, OFF)),
    (Environment, "settled"): (EXPECTED, QUIET, TIMEOUT, CHANGING),
    (Finding, "level"): LEVELS,
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
}
_NUMBERS = {(Edge, "transform"), (Heard, "pose")}
# The transforms of a plan say who sends them and not on which topic.
MAYBE_FULL_NAMES: Mapping[type, str] = {Edge: "topic"}
# What fixes a file is for the program that found it.
LEFT_OUT: Mapping[type, str] = {Finding: "edits"}


def to_json(system: System) -> bytes:
    """The system as JSON, one record on each line, in the order of the records."""
    told = zip(System._fields, system, strict=True)
    parts = [f'"schema": {SCHEMA}']
    parts += [
        f'"{name}": {_value(value)}'
        for name, value in told
        if value not in (*_EMPTY, Environment())
    ]
    return ("{\n " + ",\n ".join(parts) + "\n}\n").encode("utf-8", "backslashreplace")


def _value(value: Any) -> str:
    if isinstance(value, Environment):
        return json.dumps(plain_value(value), indent=1, ensure_ascii=False).replace("\n", "\n ")
    if isinstance(value, str) or isinstance(value[0], str):
        return _line(value)
    return "[\n  " + ",\n  ".join(map(_line, value)) + "\n ]"


def _line(record: object) -> str:
    return json.dumps(plain_value(record), ensure_ascii=False)


def plain_value(value: object) -> object:
    """A record as JSON has it, without what is as usual."""
    if isinstance(value, tuple):
        fields = getattr(value, "_fields", None)
        if fields is None:
            return [plain_value(item) for item in value]
        kind = type(value)
        usual = kind._field_defaults  # type: ignore[attr-defined]
        pairs = zip(fields, value, strict=True)
        told = (it for it in pairs if usual.get(it[0], ...) != it[1])
        left_out = LEFT_OUT.get(kind)
        return {name: plain_value(it) for name, it in told if name != left_out}
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def from_json(data: bytes, file: str) -> System:
    """Read what ``to_json`` wrote; raises InputError with file, key, what is wrong, what to do."""
    return from_value(json_value(data, file), file)


def json_value(data: bytes, file: str) -> object:
    """The value of a JSON file, with the records of a snapshot that are as they have to be; raises
    InputError with file, what is wrong, what to do."""
    refuse_others(data, file, SNAPSHOT, PLAN)
    try:
        with gc_paused():
            return load_json(data, _record_or_object)
    except json.JSONDecodeError as error:
        refuse_others(data, file, SNAPSHOT)
        place = f"{file}:{error.lineno}:{error.colno}"
        raise InputError(f"{place}: not valid JSON: {error.msg}; {_REMEDY}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: not valid JSON: it is not UTF-8; {_REMEDY}") from None
    except ValueError as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}") from None


def _record_or_object(value: dict[str, object]) -> object:
    """The node or endpoint that an object of JSON is; else the object, whose reader says what is wrong.

    A large fleet has hundreds of thousands, and records with shared texts need a fifth of the memory.
    """
    made = _FREQUENT.get(tuple(value))
    try:
        return made(*value.values()) if made else value
    # A TypeError also for what is no text: it cannot be interned.
    except (TypeError, WrongValue):
        return value


def _node(*fields: Any) -> Node:
    name, process, enclave = map(intern, (*fields, "", "")[:3])
    record = Node(name, process, enclave)
    if not record.name.startswith("/"):
        raise TypeError
    return record


def _end(*fields: Any) -> End:
    *texts, qos, process = fields
    kind, role, name, type_, hash_, node = map(intern, texts)
    known = kind in KINDS and role in ROLES and type(qos) in (Qos, NoneType)
    if not (known and name.startswith("/") and node.startswith("/")):
        raise TypeError
    return End(kind, role, name, type_, hash_, node, qos, intern(process))


def _qos(*fields: Any) -> Qos:
    return _one_of_equal(cast(Qos, _reader(Qos)(dict(zip(Qos._fields, fields, strict=True)))))


# By their keys.
_FREQUENT: Mapping[tuple[str, ...], Callable[..., object]] = {
    **{Node._fields[:count]: _node for count in (1, 2, 3)},
    End._fields[:8]: _end,
    Qos._fields: _qos,
}


@lru_cache(1000)
def _one_of_equal(record: Qos) -> Qos:
    """A fleet has a handful of profiles."""
    return record


def from_value(value: object, file: str) -> System:
    """The system that a JSON value holds; raises InputError with file, key and what is wrong."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: not a snapshot, but {shown(value)}")
    schema = value.pop("schema", None)
    if schema != SCHEMA:
        hint = "take the snapshot again with this version"
        raise InputError(f"{file}: schema: expected {SCHEMA}, not {shown(schema)}; {hint}")
    return cast(System, record_from(System, value, file))


def record_from(kind: type, value: object, file: str) -> object:
    """A value as the record ``kind``; raises InputError with file, key and what is wrong."""
    try:
        return _reader(kind)(value)
    except WrongValue as wrong:
        key = "".join(reversed(wrong.keys)).lstrip(".")
        raise InputError(f"{file}: {key}: {wrong.reason}") from None


# Each reader is made once: a snapshot of 1,000 robots has half a million values.
@cache
def _reader(expected: Any) -> Reader:
    """A function that reads a JSON value as the type ``expected``, or raises WrongValue."""
    options = get_args(expected)
    if NoneType in options:
        inner = _reader(options[0])
        return lambda value: None if value is None else inner(value)
    if get_origin(expected) is tuple:
        return partial(read_list, _reader(options[0]))
    if hasattr(expected, "_fields"):
        hints = get_type_hints(expected)
        readers = {name: _field_reader(expected, name, hint) for name, hint in hints.items()}
        return partial(_read_record, expected, readers)
    return read_seconds if expected is float else partial(read_plain, expected)


def _field_reader(kind: Any, name: str, hint: Any) -> Reader:
    words = ALLOWED_WORDS.get((kind, name))
    if words:
        return partial(read_word, words)
    if (kind, name) in _NUMBERS:
        return read_transform
    if MAYBE_FULL_NAMES.get(kind) == name:
        return lambda value: value if value == "" else read_full_name(value)
    if LEFT_OUT.get(kind) == name:
        return read_nothing
    return read_full_name if (kind, name) in FULL_NAMES else _reader(hint)


def _read_record(kind: Any, readers: Mapping[str, Reader], value: object) -> object:
    if type(value) is kind:
        return value
    if type(value) in (Node, End, Qos):
        value = cast(Any, value)._asdict()
    if not isinstance(value, dict):
        raise unexpected("an object", value)
    if value.keys() != readers.keys():
        value = {**kind._field_defaults, **value}
    if value.keys() != readers.keys():
        raise _wrong_key(readers, value)
    name = ""
    try:
        fields = []
        for name, reader in readers.items():
            fields.append(reader(value[name]))
    except WrongValue as wrong:
        wrong.keys.append(f".{name}")
        raise
    return kind._make(fields)


def _wrong_key(readers: Mapping[str, Reader], value: Mapping[str, object]) -> WrongValue:
    for name in readers:
        if name not in value:
            return WrongValue("missing; it is needed", f".{name}")
    name = next(name for name in value if name not in readers)
    return WrongValue(f"unknown key; the keys are {', '.join(readers)}", f".{name}")
