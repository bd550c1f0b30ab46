# SPDX-License-Identifier: Apache-2.0
"""A system as a file: JSON, one record on each line, or YAML, which people edit. Pure.

Both are one value, read with the same checks; ``system.schema.json`` describes it."""

from __future__ import annotations

import json
from codecs import BOM_UTF8
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from math import inf
from sys import intern
from typing import Any

from multibot_rewrite.base.bounded import QUOTED, load_json, load_yaml
from multibot_rewrite.base.file_kinds import PLAN, SNAPSHOT, refuse_others
from multibot_rewrite.base.lazy import gc_paused, lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.system.nested import fields_of, has_rows, system_from
from multibot_rewrite.system.record_values import WrongValue, in_file, plain_value, reader, shown
from multibot_rewrite.system.records import KINDS, ROLES, End, Node, Qos, System

REMEDY = "use the file that multibot plan or snapshot wrote"
# What is written, and what else can be read: schema 2 has nothing below anything, and no short forms.
SCHEMA, BEFORE = 3, 2
# Text that YAML reads back unchanged without quotes, in brackets too.
_PLAIN = lazy_compile(r"(?:[A-Za-z_~]|\.{0,2}/)(?:[A-Za-z0-9_./~-]|:(?=[A-Za-z0-9_/])| \| )*")


def to_json(system: System) -> bytes:
    """Return the system as JSON, one record on each line, in the order of the records."""
    parts = [f'"schema": {SCHEMA}']
    parts += [f'"{name}": {_json_text(value)}' for name, value in fields_of(system).items()]
    return ("{\n " + ",\n ".join(parts) + "\n}\n").encode("utf-8", "backslashreplace")


def _json_text(value: Any) -> str:
    if has_rows(value):
        lines = (json.dumps(plain_value(it), ensure_ascii=False) for it in value)
        return "[\n  " + ",\n  ".join(lines) + "\n ]"
    plain = plain_value(value)
    indent = 1 if isinstance(plain, dict) else None
    return json.dumps(plain, indent=indent, ensure_ascii=False).replace("\n", "\n ")


def to_yaml(system: System) -> str:
    """Return the system as YAML, a line for each end and for each record with nothing below it."""
    return "".join(_block({"schema": SCHEMA, **fields_of(system)}, ""))


def _block(value: Mapping[str, Any], indent: str) -> Iterator[str]:
    """Yield the lines of a mapping in YAML, a line for each record."""
    for key, item in value.items():
        if not has_rows(item):
            yield f"{indent}{key}: {_flow(plain_value(item))}\n"
            continue
        yield f"{indent}{key}:\n"
        for row in map(plain_value, item):
            if isinstance(row, dict) and any(map(has_rows, row.values())):
                lines = "".join(_block(row, f"{indent}  "))
                yield f"{indent}- {lines[len(indent) + 2 :]}"
            else:
                yield f"{indent}- {_flow(row)}\n"


def _flow(value: object) -> str:
    """Return a value on one line of YAML (flow style)."""
    if isinstance(value, list):
        # Nearly all are rows of texts.
        each = _scalar if {*map(type, value)} == {str} else _flow
        return f"[{', '.join(map(each, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_flow(key)}: {_flow(it)}' for key, it in value.items())}}}"
    return _scalar(value)


@lru_cache(100_000, typed=True)
def _scalar(value: object) -> str:
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in QUOTED:
        return value
    import yaml

    style = '"' if isinstance(value, str) else None
    text = str(yaml.dump(value, default_style=style, width=inf, allow_unicode=True))
    return text.partition("\n")[0]


def is_json(data: bytes) -> bool:
    """Return whether the file is JSON. YAML begins with a comment or a key."""
    return data.removeprefix(BOM_UTF8)[:1000].lstrip().startswith(b"{")


def read_system(data: bytes, file: str) -> System:
    """Return the system in YAML or JSON; raises InputError with file, key, fault and remedy."""
    return from_json(data, file) if is_json(data) else from_yaml(data, file)


def from_yaml(data: bytes, file: str) -> System:
    """Return the system that ``to_yaml`` wrote; raises as ``read_system``."""
    try:
        with gc_paused():
            return from_value(load_yaml(data.decode("utf-8-sig"), file, REMEDY), file)
    except UnicodeDecodeError:
        raise InputError(f"{file}: not valid YAML: it is not UTF-8; {REMEDY}") from None


def from_json(data: bytes, file: str) -> System:
    """Return the system that ``to_json`` wrote; raises as ``read_system``."""
    with gc_paused():
        return from_value(json_value(data, file), file)


def json_value(data: bytes, file: str) -> object:
    """Return the value of a JSON file, the sound records of a snapshot read; raises InputError."""
    refuse_others(data, file, SNAPSHOT, PLAN)
    try:
        with gc_paused():
            return load_json(data, _record_or_object)
    except json.JSONDecodeError as error:
        if not is_json(data):
            refuse_others(data, file, SNAPSHOT)
        place = f"{file}:{error.lineno}:{error.colno}"
        raise InputError(f"{place}: not valid JSON: {error.msg}; {REMEDY}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: not valid JSON: it is not UTF-8; {REMEDY}") from None
    except ValueError as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}; {REMEDY}") from None


def _record_or_object(value: dict[str, object]) -> object:
    """Return the node or end for an object of JSON, which saves memory; a wrong object as it is."""
    made = _FREQUENT.get(next(iter(value), ""))
    try:
        return made(**value) if made else value
    # A TypeError also for other keys, and for what is no text: it cannot be interned.
    except (TypeError, WrongValue):
        return value


def _node(name: Any, process: Any = "", enclave: Any = "") -> Node:
    name, process, enclave = map(intern, (name, process, enclave))
    if not name.startswith("/"):
        raise TypeError
    return Node(name, process, enclave)


def _end(
    kind: Any, role: Any, name: Any, type: Any, node: Any,
    type_hash: Any = "", qos: Any = None, process: Any = "",
) -> End:  # fmt: skip
    kind, role, name, type, type_hash, node, process = map(
        intern, (kind, role, name, type, type_hash, node, process)
    )
    known = kind in KINDS and role in ROLES and isinstance(qos, Qos | None)
    if not (known and name.startswith("/") and node.startswith("/")):
        raise TypeError
    return End(kind, role, name, type, type_hash, node, qos, process)


def _qos(**fields: Any) -> Qos:
    return _one_of_equal(reader(Qos)(fields))


# By their first keys.
_FREQUENT: Mapping[str, Callable[..., object]] = {"name": _node, "kind": _end, "history": _qos}


@lru_cache(1000)
def _one_of_equal(record: Qos) -> Qos:
    """Return the record; the cache makes equal ones one object, as a fleet has few profiles."""
    return record


def from_value(value: object, file: str) -> System:
    """Return the system that a value holds; raises InputError with file, key and what is wrong."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: no plan or snapshot, but {shown(value)}; {REMEDY}")
    schema = value.pop("schema", None)
    if schema is None and "layout" in value:
        hint = f"make it again: multibot plan fleet.yaml -o {file}, or multibot build fleet.yaml"
        raise InputError(f"{file}: a plan of an earlier version, without schema: {SCHEMA}; {hint}")
    if type(schema) is not int or schema not in (SCHEMA, BEFORE):
        hint = "write it again with multibot plan or snapshot of this version"
        raise InputError(f"{file}: schema: expected {SCHEMA}, not {shown(schema)}; {hint}")
    return in_file(system_from, value, file)
