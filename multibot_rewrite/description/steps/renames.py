# SPDX-License-Identifier: Apache-2.0
"""Inventory + naming -> rename map: names are spelled once, everything after reads the map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.naming import Affix, Naming, affix
from multibot_rewrite.description.rewriters.contact import Respell
from multibot_rewrite.description.rewriters.spelling import (
    Renamed,
    ResolvedName,
    Spelling,
    is_reached,
    renamed_at,
)
from multibot_rewrite.description.steps.collect import Inventory

# Kind and text of a name, and whether a ROS namespace reaches it.
NameKey = tuple[str, str, bool]


class RenameMap(NamedTuple):
    """What the names of a description become under a naming, for any robot.

    ``affixes`` has every name that changes: in a value, or declared here or in the URDF beside an
    SRDF. ``values`` are the names that change in each claimed value, in the order of the claims.
    """

    naming: Naming
    affixes: Mapping[NameKey, Affix]
    values: list[Spelling]

    def changes(self, kind: str, name: str) -> bool:
        """Does this declared name change?"""
        return (kind, name, False) in self.affixes

    def spelled(self, robot: str, kind: str, name: str, namespaced: bool = False) -> str:
        """A name as it is spelled for ``robot``; unchanged where the map does not have it."""
        there = self.affixes.get((kind, name, namespaced))
        return there.spell(name, robot) if there else name


def make_renames(inventory: Inventory, naming: Naming) -> RenameMap:
    """Ask the naming once for every distinct name of a description."""
    declared = inventory.declared.items()
    asked: dict[NameKey, Affix | None] = {
        (kind, name, False): affix(naming, kind, name) for kind, names in declared for name in names
    }
    # Claims share the names of equal values, so few are different.
    known: dict[tuple[int, bool], Spelling] = {}
    values: list[Spelling] = []
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        namespaced = claim.site.namespaced
        spelling = known.get((id(names), namespaced))
        if spelling is None:
            spelling = tuple(_renamed(names, namespaced, naming, asked))
            known[id(names), namespaced] = spelling
        values.append(spelling if is_reached(claim, naming) else ())
    affixes = {key: there for key, there in asked.items() if there is not None}
    return RenameMap(naming, affixes, values)


def _renamed(
    names: tuple[ResolvedName, ...],
    namespaced: bool,
    naming: Naming,
    asked: dict[NameKey, Affix | None],
) -> Iterator[Renamed]:
    """The names that change; ``asked`` is what the naming said before, and takes what it says now."""
    for at, text, kind, _ in names:
        key = kind, text, namespaced
        if key not in asked:
            asked[key] = affix(naming, *key)
        there = asked[key]
        if there is not None:
            yield renamed_at(at, *key, there)


def respeller(renames: RenameMap, robot: str) -> Respell:
    """The new spelling of a declared link, joint or model for ``robot``."""
    return lambda kind, name: renames.spelled(robot, kind, name)
