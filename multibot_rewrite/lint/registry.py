"""All rules, by code; which of them are active."""

from __future__ import annotations

from functools import lru_cache
from types import ModuleType

from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.findings.selection import is_on
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.rules import (
    beside,
    files,
    meshes,
    meta,
    multirobot,
    names,
    physics,
    references,
    rewriting,
    structure,
)

GROUPS: tuple[tuple[str, str, ModuleType], ...] = (
    ("MB0", "the lint itself", meta),
    ("MB1", "file, encoding and values", files),
    ("MB2", "references", references),
    ("MB3", "names", names),
    ("MB4", "several robots", multirobot),
    ("MB5", "structure", structure),
    ("MB6", "physics", physics),
    ("MB7", "meshes and packages", meshes),
    ("MB8", "files beside the URDF: SRDF, parameters, RViz, MoveIt, bridges", beside),
    ("MB9", "rewriting", rewriting),
)


def rules_of(group: ModuleType) -> list[Rule]:
    """The rules of a group's themes; a group of one file is its own theme."""
    themes: tuple[ModuleType, ...] = getattr(group, "THEMES", (group,))
    return [it for theme in themes for it in vars(theme).values() if isinstance(it, Rule)]


_FOUND = [rule for *_, group in GROUPS for rule in rules_of(group)]
RULES = {it.code: it for it in sorted(_FOUND, key=lambda it: it.code)}
assert len(RULES) == len(_FOUND), "two rules have one code"


def active_rules(settings: Settings, format_: str) -> tuple[Rule, ...]:
    """The rules that are on and check a subject of that format."""
    levels = tuple(settings.levels.items())
    return _active(settings.select, settings.ignore, levels, format_)


@lru_cache(maxsize=16)
def _active(
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    levels: tuple[tuple[str, str], ...],
    format_: str,
) -> tuple[Rule, ...]:
    settings = Settings(select=select, ignore=ignore, levels=dict(levels))
    rules = (it for it in RULES.values() if format_ in it.formats)
    return tuple(it for it in rules if is_on(settings, it.code))
