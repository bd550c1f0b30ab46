# SPDX-License-Identifier: Apache-2.0
"""The groups of rules, and which rules are active for a document."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from types import ModuleType

from multibot_rewrite.base.findings.rule import URDF, Rule
from multibot_rewrite.base.findings.selection import is_on
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.rules.settings import Settings


class Group(NamedTuple):
    """The rules whose codes begin with ``start``, in a module or package of ``rules``; some are
    ``of_urdf``, or all are for other files: then a lint of a URDF does not load them."""

    start: str
    module: str
    of_urdf: bool = True


GROUPS = (
    Group("MB0", "meta"),
    Group("MB1", "files"),
    Group("MB2", "references"),
    Group("MB3", "names"),
    Group("MB4", "multirobot"),
    Group("MB5", "structure"),
    Group("MB6", "physics"),
    Group("MB7", "meshes"),
    Group("MB8", "beside", False),
    Group("MB9", "rewriting"),
)


def rules_of(group: Group, of_robots: bool = True) -> list[Rule]:
    """The rules of a group's themes, those that are ``of_robots`` too; a group of one file is its own
    theme."""
    module = import_module(f"multibot_rewrite.rules.description.{group.module}")
    themes: tuple[str | ModuleType, ...] = getattr(module, "THEMES", (module,))
    more = getattr(module, "OF_ROBOTS", ()) if of_robots else ()
    found = (_loaded(theme, module.__name__) for theme in (*themes, *more))
    return [it for theme in found for it in vars(theme).values() if isinstance(it, Rule)]


def _loaded(theme: str | ModuleType, package: str) -> ModuleType:
    return import_module(theme, package) if isinstance(theme, str) else theme


def active_rules(settings: Settings, format_: str) -> tuple[Rule, ...]:
    """The rules that are on and check a subject of that format, by their codes; none of those that
    find nothing without robots where none are named."""
    levels = tuple(settings.levels.items())
    return _active(settings.select, settings.ignore, levels, format_, bool(settings.robots))


@lru_cache(maxsize=16)
def _active(
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    levels: tuple[tuple[str, str], ...],
    format_: str,
    of_robots: bool,
) -> tuple[Rule, ...]:
    settings = Settings(select=select, ignore=ignore, levels=dict(levels))
    groups = (it for it in GROUPS if it.of_urdf or format_ != URDF)
    rules = (it for group in groups for it in rules_of(group, of_robots) if format_ in it.formats)
    return tuple(sorted((it for it in rules if is_on(settings, it.code)), key=_code))


def _code(rule: Rule) -> str:
    return rule.code
