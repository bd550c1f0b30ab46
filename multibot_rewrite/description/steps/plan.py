# SPDX-License-Identifier: Apache-2.0
"""Inventory + naming -> plan: what each claimed value becomes, as edits of the source bytes.

A plan is for any robot: its edits have a slot for the robot's name.
"""

from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.rewriters.contact import respell_collisions
from multibot_rewrite.description.rewriters.insert import Insertion, insertions
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import fillable, finding, place_in, value_slot
from multibot_rewrite.description.steps.inserted import insertion_edits, slot_edits
from multibot_rewrite.description.steps.renames import RenameMap, make_renames, respeller

LAST = "~"

not_editable = declare("MB104", "not-editable", ERROR, formats=("rewrite",))


class Plan(NamedTuple):
    """Edits in source order, what they mean, and what prevents them.

    ``collisions`` are the recomputed contact collisions with their new text.
    """

    edits: list[Edit]
    renames: RenameMap
    collisions: list[tuple[Claim, str]]
    insertions: list[Insertion]
    findings: list[Finding]


def make_plan(inventory: Inventory, naming: Naming) -> Plan:
    """Return the plan of a rewrite: the naming asked once for each name, and the edits."""
    renames = make_renames(inventory, naming)
    edits, findings = _edits(inventory, renames)
    document, claims, _, declared, *_ = inventory
    collisions = respell_collisions(document.root, claims, declared, respeller(renames, ROBOT_SLOT))
    findings += _unstable(inventory, renames, collisions)
    for claim, new in collisions:
        slot = value_slot(document.source, *claim[2:])
        if slot is None:
            findings.append(_not_editable(inventory, claim))
        else:
            edits += slot_edits(*slot, new)
    added = insertions(inventory.served, declared, naming)
    edits += insertion_edits(document, added, inventory.release)
    # Stable: several edits at one place stay in the order they were made.
    edits.sort(key=lambda it: it.start)
    return Plan(edits, renames, collisions, added, findings)


def _unstable(
    inventory: Inventory, renames: RenameMap, collisions: list[tuple[Claim, str]]
) -> list[Finding]:
    """Return findings for contacts whose number depends on the robot's name."""
    document, claims, _, declared, *_ = inventory
    # ROBOT_SLOT sorts before every letter, this after.
    respell = respeller(renames, LAST)
    last = respell_collisions(document.root, claims, declared, respell) if collisions else []
    return [
        finding(
            document,
            claim.start,
            "MB424",
            ERROR,
            f"the number in {claim.value!r} would depend on the robot's name",
            "use --affix prefix, or keep the fixed joints apart with preserveFixedJoint",
        )
        for (claim, text), (_, other) in zip(collisions, last, strict=False)
        if text != other.replace(LAST, ROBOT_SLOT)
    ]


def _edits(inventory: Inventory, renames: RenameMap) -> tuple[list[Edit], list[Finding]]:
    """Return the edits that rename claimed values, and findings for those that cannot be."""
    source = inventory.document.source
    edits: list[Edit] = []
    findings: list[Finding] = []
    for claim, spelling in zip(inventory.claims, renames.values, strict=True):
        if not spelling:
            continue
        _, _, start, attribute, value = claim
        if not value and not claim.element.text:
            # ``<param/>`` made to hold the robot's prefix.
            there = spelling[0].affix
            begin, end, opening, close = fillable(source, start)
            head, tail = opening + there.before.encode(), there.after.encode() + close
            edits.append(Edit(begin, end, head, tail))
            continue
        # White space alone would be a part of the prefix: nothing takes it off (component_parser.cpp).
        slot = value_slot(source, start, attribute, value) if value else None
        for *_, (at, before, after) in spelling:
            place = slot and place_in(source, slot, value, at)
            if place is None:
                findings.append(_not_editable(inventory, claim))
                break
            edits.append(Edit(place, place, before.encode(), after.encode()))
    return edits, findings


def _not_editable(inventory: Inventory, claim: Claim) -> Finding:
    hint = "write it as plain text, without escapes, CDATA or comments inside"
    if not claim.value:
        hint = f"write <{claim.element.tag} .../>"
    return finding(
        inventory.document,
        claim.start,
        not_editable.code,
        not_editable.level,
        f"{claim.value.strip()!r} cannot be edited in place",
        hint,
    )
