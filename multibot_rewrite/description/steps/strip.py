# SPDX-License-Identifier: Apache-2.0
"""The inverse, from the rewritten file alone: take every affix and every inserted element out."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable
from functools import partial
from itertools import accumulate

from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.base.naming import Naming, removal
from multibot_rewrite.description.rewriters.contact import respell_collisions
from multibot_rewrite.description.rewriters.renaming import ResolvedName, is_reached, unspelled
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import emptied, value_places, value_slot
from multibot_rewrite.description.steps.inserted import removals

# A name of a description: the number of its value among the claims, its own in the value.
Place = tuple[int, int]
NOWHERE: frozenset[Place] = frozenset()


def own_places(inventory: Inventory, naming: Naming) -> frozenset[Place]:
    """Return where a description that is not rewritten has names that are the robot's already."""
    places = (
        (at, number, (name.kind, name.text))
        for at, names in enumerate(inventory.names if naming.own else ())
        for number, name in enumerate(names)
    )
    return frozenset((at, number) for at, number, key in places if naming.own.get(key, key) is None)


def strip_edits(
    inventory: Inventory, naming: Naming, robot: str, own: frozenset[Place] = NOWHERE
) -> list[Edit]:
    """Return edits that undo ``make_plan`` for ``robot``, in source order, but those at ``own``."""
    document = inventory.document
    edits = removals(document, robot)
    is_inserted = inside_of(edits)
    # Claims share the names of equal values, so few are different.
    known: dict[tuple[int, bool], list[tuple[int, int]]] = {}
    kept_out = _without(inventory, own, is_inserted) if own else inventory.names
    for claim, names in zip(inventory.claims, kept_out, strict=True):
        key = id(names), claim.site.namespaced
        spans = known.get(key)
        if spans is None:
            found = ((it.at, removal(naming, robot, it.kind, it.text, key[1])) for it in names)
            # What an affix put into a value with these names.
            spans = known[key] = [(at + span[0], at + span[1]) for at, span in found if span]
        if spans and is_reached(claim, naming) and not is_inserted(claim):
            edits += _claim_edits(document.source, claim, spans)

    unspell = partial(unspelled, naming, robot=robot)
    claims = [it for it in inventory.claims if not is_inserted(it)] if edits else inventory.claims
    for claim, old in respell_collisions(document.root, claims, inventory.declared, unspell):
        slot = value_slot(document.source, *claim[2:])
        if slot is not None:
            edits.append(Edit(*slot, old.encode(), None))
    return sorted(edits, key=lambda edit: edit.start)


def stripped(claim: Claim, names: tuple[ResolvedName, ...], naming: Naming, robot: str) -> str:
    """Return a claimed value without its affixes."""
    value, namespaced = claim.value, claim.site.namespaced
    for name in reversed(names) if is_reached(claim, naming) else ():
        span = removal(naming, robot, name.kind, name.text, namespaced)
        if span is not None:
            value = value[: name.at + span[0]] + value[name.at + span[1] :]
    return value


def _without(
    inventory: Inventory, own: frozenset[Place], is_inserted: Callable[[Claim], bool]
) -> list[tuple[ResolvedName, ...]]:
    """Return the names in each value, except those at places of ``own``."""
    at = 0
    found = []
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        if is_inserted(claim):
            found.append(names)
            continue
        found.append(tuple(it for number, it in enumerate(names) if (at, number) not in own))
        at += 1
    return found


def inside_of(removed: Iterable[Edit]) -> Callable[[Claim], bool]:
    """Return a function that says whether a claim is in one of the removed elements."""
    spans = sorted((edit.start, edit.end) for edit in removed)
    starts = [start for start, _ in spans]
    # How far those up to each one reach.
    ends = [0, *accumulate((end for _, end in spans), max)]
    return lambda claim: claim.start < ends[bisect_right(starts, claim.start)]


def _claim_edits(source: bytes, claim: Claim, spans: list[tuple[int, int]]) -> list[Edit]:
    value = claim.start, claim.attribute, claim.value
    if claim.site.form == "prefix" and spans == [(0, len(claim.value))]:
        slot = value_slot(source, *value)
        return [emptied(source, slot)] if slot else []
    places = value_places(source, *value, [at for span in spans for at in span]) or []
    return [Edit(a, b, b"", None) for a, b in zip(places[::2], places[1::2], strict=True)]
