"""The inverse, from the rewritten file alone: take every affix and every inserted element out."""

from __future__ import annotations

from multibot_rewrite.model import Claim, Edit
from multibot_rewrite.naming import Naming, removal
from multibot_rewrite.rewriters.contact import respell_collisions
from multibot_rewrite.rewriters.spelling import ResolvedName, is_reached, unspelled
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import emptied, value_places, value_slot
from multibot_rewrite.steps.inserted import removals


def strip_edits(inventory: Inventory, naming: Naming, robot: str) -> list[Edit]:
    """Edits that undo ``make_plan`` for ``robot``, in source order."""
    document = inventory.document
    edits = removals(document, robot)
    claims = not_inserted(inventory.claims, edits)
    removed = list(edits)
    # Claims share the names of equal values, so few are different.
    known: dict[tuple[int, bool], list[tuple[int, int]]] = {}
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        key = id(names), claim.site.namespaced
        spans = known.get(key)
        if spans is None:
            spans = known[key] = _spans(names, claim.site.namespaced, naming, robot)
        if spans and is_reached(claim, naming) and not is_inside(claim, removed):
            edits += _claim_edits(document.source, claim, spans)

    def unspell(kind: str, name: str) -> str:
        return unspelled(naming, kind, name, robot)

    for claim, old in respell_collisions(document.root, claims, inventory.declared, unspell):
        slot = value_slot(document.source, *claim[2:])
        if slot is not None:
            edits.append(Edit(*slot, old.encode(), None))
    return sorted(edits, key=lambda edit: edit.start)


def stripped(claim: Claim, names: tuple[ResolvedName, ...], naming: Naming, robot: str) -> str:
    """A claimed value without its affixes."""
    value = claim.value
    if is_reached(claim, naming):
        for start, end in reversed(_spans(names, claim.site.namespaced, naming, robot)):
            value = value[:start] + value[end:]
    return value


def not_inserted(claims: list[Claim], removed: list[Edit]) -> list[Claim]:
    """The claims that are not in inserted elements."""
    return [claim for claim in claims if not is_inside(claim, removed)] if removed else claims


def is_inside(claim: Claim, removed: list[Edit]) -> bool:
    """Is the claim in an inserted element?"""
    return bool(removed) and any(edit.start <= claim.start < edit.end for edit in removed)


def _spans(
    names: tuple[ResolvedName, ...], namespaced: bool, naming: Naming, robot: str
) -> list[tuple[int, int]]:
    """The parts of a value with these names that an affix put there."""
    spans = []
    for name in names:
        span = removal(naming, robot, name.kind, name.text, namespaced)
        if span is not None:
            spans.append((name.at + span[0], name.at + span[1]))
    return spans


def _claim_edits(source: bytes, claim: Claim, spans: list[tuple[int, int]]) -> list[Edit]:
    value = claim.start, claim.attribute, claim.value
    if claim.site.form == "prefix" and spans == [(0, len(claim.value))]:
        slot = value_slot(source, *value)
        return [emptied(source, slot)] if slot else []
    places = value_places(source, *value, [at for span in spans for at in span]) or []
    return [Edit(a, b, b"", None) for a, b in zip(places[::2], places[1::2], strict=True)]
