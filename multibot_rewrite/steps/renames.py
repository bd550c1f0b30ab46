"""Inventory + naming -> rename map: names are spelled once, everything after reads the map."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from multibot_rewrite.naming import Affix, Naming, affix
from multibot_rewrite.rewriters.contact import Respell
from multibot_rewrite.rewriters.spelling import (
    Renamed,
    ResolvedName,
    Spelling,
    is_reached,
    renamed_at,
)
from multibot_rewrite.steps.collect import Inventory

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
    # Claims share the names of equal values, so few are different.
    pairs = zip(inventory.claims, inventory.names, strict=True)
    at = [(id(names), claim.site.namespaced) for claim, names in pairs]
    different = dict(zip(at, inventory.names, strict=True))
    declared = inventory.declared.items()
    keys: set[NameKey] = {(kind, name, False) for kind, names in declared for name in names}
    keys |= {(n.kind, n.text, reach) for (_, reach), names in different.items() for n in names}
    asked = ((key, affix(naming, *key)) for key in keys)
    affixes = {key: there for key, there in asked if there is not None}
    known = {key: _spelling(names, key[1], affixes) for key, names in different.items()}
    reached = (is_reached(claim, naming) for claim in inventory.claims)
    values = [known[key] if it else () for key, it in zip(at, reached, strict=True)]
    return RenameMap(naming, affixes, values)


def _spelling(
    names: tuple[ResolvedName, ...], namespaced: bool, affixes: Mapping[NameKey, Affix]
) -> tuple[Renamed, ...]:
    found = ((name, affixes.get((name.kind, name.text, namespaced))) for name in names)
    return tuple(
        renamed_at(name.at, name.kind, name.text, namespaced, there)
        for name, there in found
        if there is not None
    )


def respeller(renames: RenameMap, robot: str) -> Respell:
    """The new spelling of a declared link, joint or model for ``robot``."""
    return lambda kind, name: renames.spelled(robot, kind, name)
