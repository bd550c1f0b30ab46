# SPDX-License-Identifier: Apache-2.0
"""The states of a plan's nodes and what is open in its robots, as values of its keys, and back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from multibot_rewrite.base.findings.finding import LEVELS, Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.system.parameters import parameter_text, parameter_value
from multibot_rewrite.system.records import Node, Parameter, Place, place_of

KEYS = ("lifecycle", "host", "parameters")
# lifecycle_msgs/msg/State, the primary ones.
LIFECYCLE = ("unconfigured", "inactive", "active", "finalized")


class NodeDemand(NamedTuple):
    """What is planned of a node besides its ends."""

    node: str
    lifecycle: str
    host: str
    parameters: tuple[Parameter, ...]


def state_value(node: Node, parameters: Iterable[Parameter]) -> dict[str, object]:
    """A mapping; a parameter that is from a file is not the plan's own."""
    own = {it.name: parameter_value(it.value) for it in parameters if not it.place.file}
    given = {"lifecycle": node.lifecycle, "host": node.host, "parameters": own}
    return {key: value for key, value in given.items() if value}


def read_states(value: object, file: str) -> Iterator[NodeDemand]:
    """The states by node; raises InputError with the place and what to write there."""
    for node, given in _mapping(value or {}, f"{file}: states").items():
        place = f"{file}: states.{node}"
        if not node.startswith("/"):
            raise InputError(f"{place}: {node!r} is not a full name; write it with a / in front")
        yield _read(node, _mapping(given, place), place)


def _read(node: str, given: Mapping[str, Any], place: str) -> NodeDemand:
    for key in given:
        if key not in KEYS:
            raise InputError(f"{place}: {unknown('key', key, KEYS)}")
    lifecycle, host = (given.get(key, "") for key in KEYS[:2])
    if lifecycle and lifecycle not in LIFECYCLE:
        raise InputError(f"{place}: lifecycle: {unknown('state', str(lifecycle), LIFECYCLE)}")
    if not isinstance(host, str):
        raise InputError(f"{place}: host: write a word in quotes")
    parameters = _mapping(given.get("parameters") or {}, f"{place}.parameters")
    own = (_parameter(node, name, it, f"{place}.parameters") for name, it in parameters.items())
    return NodeDemand(node, lifecycle, host, tuple(own))


def _parameter(node: str, name: str, value: object, place: str) -> Parameter:
    items = value if isinstance(value, list) else [value]
    if not all(isinstance(it, bool | int | float | str) for it in items):
        raise InputError(f"{place}.{name}: write a text, a number, true or false, or a list of one")
    return Parameter(node, name, parameter_text(value))


def _mapping(value: object, place: str) -> Mapping[str, Any]:
    if not isinstance(value, dict) or not all(isinstance(it, str) for it in value):
        raise InputError(f"{place} is not a mapping with names as keys")
    return value


GAP_KEYS = ("code", "level", "at", "message", "hint")


def gap_value(gap: Finding) -> dict[str, str]:
    """A finding as a row; ``at`` is the place in a file, empty for none."""
    at = Place(gap.file, gap.line, gap.column if gap.column > 1 else 0)
    return dict(zip(GAP_KEYS, (gap.code, gap.level, f"{at}", gap.message, gap.hint), strict=True))


def read_gaps(value: object, place: str) -> Iterator[Finding]:
    """The findings of rows; raises InputError with the ``place`` and what to write there."""
    if value is not None and not isinstance(value, list):
        raise InputError(f"{place} is not a list; leave it out for a plan without open ends")
    for number, row in enumerate(value or ()):
        yield _gap(row, f"{place}[{number}]")


def _gap(row: object, place: str) -> Finding:
    if not isinstance(row, dict) or {*row} != {*GAP_KEYS}:
        raise InputError(f"{place}: write a mapping of {', '.join(GAP_KEYS)}")
    if not all(isinstance(it, str) for it in row.values()):
        raise InputError(f"{place}: write texts")
    if row["level"] not in LEVELS:
        raise InputError(f"{place}: {row['level']!r} is not one of {', '.join(LEVELS)}")
    at = place_of(row["at"])
    if at.file and not at.line:
        raise InputError(f"{place}: at: write file:line, or nothing")
    found = Finding(row["code"], row["level"], row["message"], row["hint"])
    return found._replace(file=at.file, line=at.line, column=at.column or 1) if at.file else found
