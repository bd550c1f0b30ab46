"""The inverse, from the rewritten file alone: take every affix and every inserted element out."""

from __future__ import annotations

from multibot_rewrite.model import Claim, Edit
from multibot_rewrite.naming import Naming, removal
from multibot_rewrite.rewriters.contact import respell_collisions
from multibot_rewrite.rewriters.forms import FORMS
from multibot_rewrite.rewriters.spelling import resolve
from multibot_rewrite.rewriting.collect import Inventory
from multibot_rewrite.rewriting.document import attribute_slot, text_slot
from multibot_rewrite.rewriting.inserted import removals
from multibot_rewrite.rewriting.plan import value_place


def strip_edits(inventory: Inventory, naming: Naming, robot: str) -> list[Edit]:
    """Edits that undo ``make_plan`` for ``robot``, in source order."""
    document = inventory.document
    edits = removals(document, robot)
    claims = outside(inventory.claims, edits)
    for claim in claims:
        edits += _claim_edits(inventory, claim, naming, robot)

    def unspell(kind: str, name: str) -> str:
        span = removal(naming, robot, kind, name)
        return name[: span[0]] + name[span[1] :] if span else name

    for claim, old in respell_collisions(document.root, claims, unspell):
        slot = text_slot(document.source, claim.start, claim.value)
        if slot is not None:
            edits.append(Edit(*slot, old.encode(), None))
    return sorted(edits, key=lambda edit: edit.start)


def outside(claims: list[Claim], removed: list[Edit]) -> list[Claim]:
    """The claims that do not stand in inserted text."""
    if not removed:
        return claims
    inside = [(edit.start, edit.end) for edit in removed]
    return [c for c in claims if not any(start <= c.start < end for start, end in inside)]


def _claim_edits(inventory: Inventory, claim: Claim, naming: Naming, robot: str) -> list[Edit]:
    site, _, start, attribute, value = claim
    spans = []
    for part in FORMS[site.form](value, site.kinds):
        kind = resolve(part, site.role, inventory.declared)
        span = removal(naming, robot, kind, part.text, site.namespaced) if kind else None
        if span is not None:
            spans.append((part.at + span[0], part.at + span[1]))
    if not spans:
        return []
    source = inventory.document.source
    if attribute:
        slot = attribute_slot(source, start, attribute, value)
    else:
        slot = text_slot(source, start, value)
    if slot is None:
        return []
    places = [(value_place(source, slot, value, a), value_place(source, slot, value, b)) for a, b in spans]
    return [Edit(a, b, b"", None) for a, b in places if a is not None and b is not None]
