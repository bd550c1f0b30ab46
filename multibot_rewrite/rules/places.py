# SPDX-License-Identifier: Apache-2.0
"""Where a file says what a finding is about: the place of a record, and of what is beside it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Protocol

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.system.records import NOWHERE, Place

if TYPE_CHECKING:
    import yaml


class Placed(Protocol):
    """A record with the place where a file has it."""

    @property
    def place(self) -> Place: ...


class OnLine(Protocol):
    """What has a place in a text; lines and columns count from 1."""

    @property
    def line(self) -> int: ...
    @property
    def column(self) -> int: ...


def remark(at: OnLine, message: str, hint: str = "", level: str = "") -> Finding:
    """A finding at the place of a name, in the file and by the rule that are asked; ``level`` is empty
    for that of the rule."""
    return Finding("", level, message, hint, "", at.line, at.column)


def remark_at(node: yaml.Node, message: str, hint: str = "", level: str = "") -> Finding:
    """The same at a node of YAML."""
    mark = node.start_mark
    return Finding("", level, message, hint, "", mark.line + 1, mark.column + 1)


def at(rule: Rule, place: Place, message: str, hint: str, **more: Any) -> Finding:
    """A finding of a rule at a place."""
    return rule.finding(message, hint, **_fields(place), **more)


def where(records: Iterable[Placed]) -> dict[str, Any]:
    """The fields of a finding at the last record that a file has; nothing where none has any."""
    places = [it.place for it in records if it.place != NOWHERE]
    return _fields(places[-1]) if places else {}


def _fields(place: Place) -> dict[str, Any]:
    return {**place._asdict(), "column": place.column or 1}


def see(records: Iterable[Placed]) -> str:
    """``; see FILE:LINE and FILE:LINE``: the places of all but the last one."""
    places = dict.fromkeys(str(it.place) for it in records if it.place != NOWHERE)
    others = [*places][:-1]
    return f"; see {' and '.join(others)}" if others else ""
