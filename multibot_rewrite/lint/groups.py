# SPDX-License-Identifier: Apache-2.0
"""The groups of rules, and which rules are active for a document."""

from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import URDF, Rule
from multibot_rewrite.base.findings.selection import is_on
from multibot_rewrite.rules.declaration import rules_in
from multibot_rewrite.rules.settings import Settings


class Group(NamedTuple):
    """The rules whose codes begin with ``start``, in a module or package of ``rules``.

    Some are ``of_urdf``, or all are for other files: then a lint of a URDF does not load them."""

    start: str
    module: str
    of_urdf: bool = True


GROUPS = (
    Group("MB0", "description.meta"),
    Group("MB1", "description.files"),
    Group("MB2", "description.references"),
    Group("MB3", "description.names"),
    Group("MB4", "description.multirobot"),
    Group("MB5", "description.structure"),
    Group("MB6", "description.physics"),
    Group("MB7", "description.meshes"),
    Group("MB8", "description.srdf", False),
    Group("MB8", "files", False),
    Group("MB9", "description.rewriting"),
)
# A module of rules that find nothing where no robots are named.
OF_ROBOTS = ("meeting",)


def rules_of(group: Group, of_robots: bool = True) -> list[Rule]:
    """Return the rules of a group, those that are ``of_robots`` too."""
    return rules_in(group.module, *(() if of_robots else OF_ROBOTS))


def active_rules(settings: Settings, format_: str) -> tuple[Rule, ...]:
    """Return the rules that are on for a format, by code; those of robots only if some are named."""
    levels = tuple(settings.levels.items())
    return _active_rules(settings.select, settings.ignore, levels, format_, bool(settings.robots))


@lru_cache(maxsize=16)
def _active_rules(
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    levels: tuple[tuple[str, str], ...],
    format_: str,
    of_robots: bool,
) -> tuple[Rule, ...]:
    """Return ``active_rules`` for the parts of the settings that it needs, which can be cached."""
    settings = Settings(select=select, ignore=ignore, levels=dict(levels))
    groups = (it for it in GROUPS if it.of_urdf or format_ != URDF)
    rules = (it for group in groups for it in rules_of(group, of_robots) if format_ in it.formats)
    return tuple(sorted((it for it in rules if is_on(settings, it.code)), key=lambda it: it.code))
