# SPDX-License-Identifier: Apache-2.0
"""The parts of a plan as a file has them: names, lists, and rows of endpoints, each checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from sys import intern
from typing import Any

from multibot_rewrite.base.model import InputError
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.spelling.plan import planned_end
from multibot_rewrite.system.records import (
    KINDS,
    ROLES,
    End,
)

FIELDS = 5
# Between several types of an endpoint.
OR = " | "
_TEXTS = {str}
_ROLE_WORDS, _KIND_WORDS = frozenset(ROLES), frozenset(KINDS)


def check_keys(given: Mapping[str, Any], keys: tuple[str, ...], place: str) -> None:
    for key in given:
        if key not in keys:
            raise InputError(f"{place}: {unknown('key', str(key), keys)}")


def full_name(value: object, place: str) -> str:
    if not isinstance(value, str) or not value.startswith("/"):
        raise InputError(f"{place}: {_not_full(value)}")
    return intern(value)


def _not_full(value: object) -> str:
    return f"{value!r} is not a full name; write it with a / in front"


def mapping(
    value: object, keys: tuple[str, ...], file: str, what: str, more: tuple[str, ...] = ()
) -> Mapping[str, Any]:
    """``value``, checked to have all of ``keys`` and otherwise only ``more``; any without ``keys``."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: {what} is not a mapping; write it as multibot plan does")
    missing = [key for key in keys if key not in value]
    unknown = [key for key in value if keys and key not in (*keys, *more)]
    if missing or unknown:
        wrong = f"key {missing[0]!r} is missing" if missing else f"unknown key {unknown[0]!r}"
        raise InputError(f"{file}: {what}: {wrong}; the keys are {', '.join((*keys, *more))}")
    return value


def texts(value: object, place: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
        raise InputError(f"{place} is not a list of names")
    return tuple(value)


def read_endpoints(node: str, rows: object, place: str) -> Iterator[End]:
    if rows is not None and not isinstance(rows, list):
        raise InputError(f"{place} is not a list; write [] for a node without planned endpoints")
    for at, row in enumerate(rows or ()):
        wrong = _wrong_row(row)
        if wrong:
            raise InputError(f"{place}[{at}]: {wrong}")
        # Many nodes have the same names, types and words.
        role, kind, name, types, code_name = map(intern, row)
        also: tuple[str, ...] = ()
        if OR in types:
            types, *others = types.split(OR)
            also = (*others,)
        yield planned_end(node, kind, role, name, types, code_name, also)


def _wrong_row(row: object) -> str:
    """What is wrong with a row of the plan; empty for an endpoint."""
    if type(row) is not list or len(row) != FIELDS or {*map(type, row)} != _TEXTS:
        return "write [role, kind, name, type, name in the node's code]"
    role, kind, name, _, _ = row
    if role not in _ROLE_WORDS or kind not in _KIND_WORDS:
        allowed = f"a role ({', '.join(ROLES)}) and a kind ({', '.join(KINDS)})"
        return f"{role!r}, {kind!r}: write {allowed}"
    return "" if name.startswith("/") else _not_full(name)
