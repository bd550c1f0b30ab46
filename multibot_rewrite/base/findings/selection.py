# SPDX-License-Identifier: Apache-2.0
"""Which rules are on, and at which level: the same for every command and configuration."""

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.findings.finding import LEVELS, Finding, Remap, Setting

# In the place of a level: the rule is off.
OFF = "off"
NO_LEVELS: Mapping[str, str] = {}
# Stands for the robot in a text that two robots share. A name counts where no letter or digit is next
# to it: ``robot1`` in ``base_link_robot1``, not in ``robot11``.
_SLOT = "\0"


if TYPE_CHECKING:
    from typing import Protocol

    class Selecting(Protocol):
        """Codes or their beginnings to select and ignore (the longer wins), and their levels."""

        @property
        def select(self) -> Sequence[str]:
            """Return the codes and names of rules that alone are wanted."""

        @property
        def ignore(self) -> Sequence[str]:
            """Return the codes and names of rules that are off."""

        @property
        def levels(self) -> Mapping[str, str]:
            """Return the chosen level of each rule."""


class Selection(NamedTuple):
    """What ``--select`` and ``--ignore`` ask for."""

    select: tuple[str, ...] = ("M",)
    ignore: tuple[str, ...] = ()
    levels: Mapping[str, str] = NO_LEVELS


def selected(findings: Iterable[Finding], selection: "Selecting") -> list[Finding]:
    """Return the findings of rules that are on, with the level that the selection gives each."""
    return [
        it._replace(level=level_of(selection, it.code, it.level))
        for it in findings
        if is_on(selection, it.code)
    ]


def fails(findings: Iterable[Finding], fail_on: str) -> bool:
    """Return whether one of the findings is at the level ``fail_on`` or worse."""
    failing = LEVELS[: LEVELS.index(fail_on) + 1]
    return any(it.level in failing for it in findings)


def matched(codes: Sequence[str], code: str) -> int:
    """Return the length of the longest of ``codes`` that ``code`` begins with; -1 for none."""
    return max([len(it) for it in codes if code.startswith(it)], default=-1)


def is_on(selection: "Selecting", code: str) -> bool:
    """Return whether the rule is on; the longer of the codes that select and ignore it counts."""
    decided = _level_key(selection, code)
    off = len(decided) if selection.levels.get(decided) == OFF else -1
    return matched(selection.select, code) > max(matched(selection.ignore, code), off)


def level_of(selection: "Selecting", code: str, default: str) -> str:
    """Return the level that the selection gives a rule, by the longest beginning of its code."""
    level = selection.levels.get(_level_key(selection, code), OFF)
    return default if level == OFF else level


def _level_key(selection: "Selecting", code: str) -> str:
    """Return the longest beginning of a code for which a level is set, or ""."""
    if not selection.levels:
        return ""
    return max((it for it in selection.levels if code.startswith(it)), key=len, default="")


def grouped(findings: Iterable[Finding], names: Mapping[str, str]) -> list[Finding]:
    """Return the findings in order, one for all ``robots`` of those that differ only in the robot.

    ``names`` maps each name of a robot in texts (its name, its prefix) to the robot."""
    return [first for first, _ in with_members(findings, names)]


def with_members(
    findings: Iterable[Finding], names: Mapping[str, str]
) -> list[tuple[Finding, list[Finding]]]:
    """Return the findings as ``grouped``, each with the findings that it replaces."""
    order = {robot: at for at, robot in enumerate(dict.fromkeys(names.values()))}
    groups: dict[Finding, list[tuple[str, Finding]]] = {}
    for it in findings:
        robot = it.robot or next(iter(it.robots), "")
        if not robot:
            # The one robot that it speaks of.
            text = f"{it.message} {it.hint} {it.node}"
            said = {of for word, of in names.items() if _pattern(word).search(text)}
            robot = said.pop() if len(said) == 1 else ""
        groups.setdefault(_without(it, robot, names), []).append((robot, it))
    found = []
    for members in groups.values():
        (robot, first), *more = members
        # What is grouped already keeps its robots.
        met = [*first.robots, *(name for it, other in more for name in other.robots or (it,))]
        others = dict.fromkeys(name for name in met if name and name != robot)
        # In the order of the fleet, robot2 before robot10.
        rest = sorted(others, key=lambda it: order.get(it, len(order)))
        first = first._replace(robots=(robot, *rest)) if rest else first
        found.append((first, [it for _, it in members]))
    return found


def _without(finding: Finding, robot: str, names: Mapping[str, str]) -> Finding:
    """Return the finding with a placeholder for the robot; unchanged without a robot."""
    words = sorted((word for word, of in names.items() if of == robot), key=len, reverse=True)
    if not robot or not words:
        return finding
    pattern = _pattern("|".join(map(re.escape, words)), escaped=True)
    blank = partial(pattern.sub, _SLOT)
    return finding._replace(
        message=blank(finding.message),
        hint=blank(finding.hint),
        node=blank(finding.node),
        robot=_SLOT,
        names=tuple(map(blank, finding.names)),
        remaps=tuple(Remap(*map(blank, it)) for it in finding.remaps),
        settings=tuple(Setting(*map(blank, it)) for it in finding.settings),
        robots=(),
    )


def said_of(text: str, finding: Finding, robot: str) -> str:
    """Return a text of a finding for another of its ``robots``; unchanged for other robots."""
    first, *others = finding.robots or ("",)
    return _pattern(first).sub(robot, text) if robot in others else text


def _pattern(word: str, *, escaped: bool = False) -> re.Pattern[str]:
    """Return an expression that finds a word as a whole; ``escaped`` if it is an expression already."""
    inner = word if escaped else re.escape(word)
    return re.compile(rf"(?<![A-Za-z0-9])(?:{inner})(?![A-Za-z0-9])")
