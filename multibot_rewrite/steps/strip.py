"""The inverse, from the rewritten file alone: take every affix and every inserted element out."""

from __future__ import annotations

from multibot_rewrite.model import Claim, Edit
from multibot_rewrite.naming import Naming, removal
from multibot_rewrite.rewriters.contact import respell_collisions
from multibot_rewrite.rewriters.spelling import kind_of, spelled_in, spelling_key, unspelled
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import emptied, value_slot
from multibot_rewrite.steps.inserted import removals
from multibot_rewrite.steps.plan import value_place


def strip_edits(inventory: Inventory, naming: Naming, robot: str) -> list[Edit]:
    """Edits that undo ``make_plan`` for ``robot``, in source order."""
    document = inventory.document
    edits = removals(document, robot)
    claims = outside_of(inventory.claims, edits)
    known: dict[tuple[object, str], list[tuple[int, int]]] = {}
    for claim in claims:
        key = spelling_key(claim)
        spans = known.get(key)
        if spans is None:
            spans = known[key] = _spans(inventory, claim, naming, robot)
        if spans:
            edits += _claim_edits(document.source, claim, spans)

    def unspell(kind: str, name: str) -> str:
        return unspelled(naming, kind, name, robot)

    for claim, old in respell_collisions(document.root, claims, inventory.declared, unspell):
        slot = value_slot(document.source, *claim[2:])
        if slot is not None:
            edits.append(Edit(*slot, old.encode(), None))
    return sorted(edits, key=lambda edit: edit.start)


def outside_of(claims: list[Claim], removed: list[Edit]) -> list[Claim]:
    """The claims that do not stand in inserted text."""
    if not removed:
        return claims
    inside = [(edit.start, edit.end) for edit in removed]
    return [c for c in claims if not any(start <= c.start < end for start, end in inside)]


def _spans(inventory: Inventory, claim: Claim, naming: Naming, robot: str) -> list[tuple[int, int]]:
    """The parts of the claimed value that an affix put there."""
    site = claim.site
    spans = []
    for part in spelled_in(claim, inventory.declared, naming):
        kind = kind_of(part, site.role, inventory.declared)
        span = removal(naming, robot, kind, part.text, site.namespaced) if kind else None
        if span is not None:
            spans.append((part.at + span[0], part.at + span[1]))
    return spans


def _claim_edits(source: bytes, claim: Claim, spans: list[tuple[int, int]]) -> list[Edit]:
    slot = value_slot(source, claim.start, claim.attribute, claim.value)
    if slot is None:
        return []
    if claim.site.form == "prefix" and spans == [(0, len(claim.value))]:
        return [emptied(source, slot)]
    places = [[value_place(source, slot, claim.value, at) for at in span] for span in spans]
    return [Edit(a, b, b"", None) for a, b in places if a is not None and b is not None]
