"""Which rules are on, and at which level: the same for every command and configuration."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from multibot_rewrite.base.findings.finding import LEVELS, Finding
from multibot_rewrite.base.record import NamedTuple

# In the place of a level: the rule is off.
OFF = "off"
NO_LEVELS: Mapping[str, str] = {}


class Selecting(Protocol):
    """``select`` and ``ignore`` are codes or how they begin, the longer one wins; ``levels`` maps
    them to levels or ``OFF``."""

    @property
    def select(self) -> Sequence[str]: ...
    @property
    def ignore(self) -> Sequence[str]: ...
    @property
    def levels(self) -> Mapping[str, str]: ...


class Selection(NamedTuple):
    """What ``--select`` and ``--ignore`` ask for; every code begins with an M."""

    select: tuple[str, ...] = ("M",)
    ignore: tuple[str, ...] = ()
    levels: Mapping[str, str] = NO_LEVELS


def selected(findings: Iterable[Finding], selection: Selecting) -> list[Finding]:
    """The findings of rules that are on, each with the level that the selection gives it."""
    return [
        it._replace(level=level_of(selection, it.code, it.level))
        for it in findings
        if is_on(selection, it.code)
    ]


def fails(findings: Iterable[Finding], fail_on: str) -> bool:
    """Is one of the findings at the level ``fail_on`` or worse?"""
    failing = LEVELS[: LEVELS.index(fail_on) + 1]
    return any(it.level in failing for it in findings)


def matched(codes: Sequence[str], code: str) -> int:
    """The length of the longest of ``codes`` that ``code`` begins with; -1 for none."""
    return max([len(it) for it in codes if code.startswith(it)], default=-1)


def is_on(selection: Selecting, code: str) -> bool:
    """Is the rule on? The code that selects it has to be longer than the one that ignores it."""
    decided = _level_key(selection, code)
    off = len(decided) if selection.levels.get(decided) == OFF else -1
    return matched(selection.select, code) > max(matched(selection.ignore, code), off)


def level_of(selection: Selecting, code: str, default: str) -> str:
    """The level that the selection gives a rule, by the longest beginning of its code."""
    level = selection.levels.get(_level_key(selection, code), OFF)
    return default if level == OFF else level


def _level_key(selection: Selecting, code: str) -> str:
    if not selection.levels:
        return ""
    return max((it for it in selection.levels if code.startswith(it)), key=len, default="")
