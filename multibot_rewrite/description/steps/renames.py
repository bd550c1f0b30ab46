# SPDX-License-Identifier: Apache-2.0
"""Inventory + naming -> rename map: names are renamed once, everything after reads the map."""

from collections.abc import Mapping
from typing import NamedTuple

from multibot_rewrite.base.naming import Affix, Naming, affix
from multibot_rewrite.description.rewriters.contact import Respell
from multibot_rewrite.description.rewriters.renaming import Spelling, is_reached, renamed_at
from multibot_rewrite.description.steps.collect import Inventory

# Kind and text of a name, and whether a ROS namespace reaches it.
NameKey = tuple[str, str, bool]


class RenameMap(NamedTuple):
    """What the names of a description become under a naming, for any robot.

    ``affixes`` has every name that changes: in a value, or declared here or in the URDF of an SRDF.
    ``values`` are the names that change in each claimed value, in the order of the claims."""

    naming: Naming
    affixes: Mapping[NameKey, Affix]
    values: list[Spelling]

    def changes(self, kind: str, name: str) -> bool:
        """Return whether a declared name changes."""
        return (kind, name, False) in self.affixes

    def spelled(self, robot: str, kind: str, name: str, namespaced: bool = False) -> str:
        """Return a name as it is for ``robot``; unchanged if the map does not have it."""
        there = self.affixes.get((kind, name, namespaced))
        return there.spell(name, robot) if there else name


def make_renames(inventory: Inventory, naming: Naming) -> RenameMap:
    """Return the new name of every distinct name of a description, asked of the naming once."""
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
            keys = [(it.at, (it.kind, it.text, namespaced)) for it in names]
            asked |= {key: affix(naming, *key) for _, key in keys if key not in asked}
            found = ((at, key, asked[key]) for at, key in keys)
            spelling = tuple(renamed_at(at, *key, it) for at, key, it in found if it is not None)
            known[id(names), namespaced] = spelling
        values.append(spelling if is_reached(claim, naming) else ())
    affixes = {key: there for key, there in asked.items() if there is not None}
    return RenameMap(naming, affixes, values)


def respeller(renames: RenameMap, robot: str) -> Respell:
    """Return a function for the new name of a declared link, joint or model for ``robot``."""
    return lambda kind, name: renames.spelled(robot, kind, name)
