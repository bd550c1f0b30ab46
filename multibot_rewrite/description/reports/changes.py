# SPDX-License-Identifier: Apache-2.0
"""Plan -> the list of what changed, as ``--form changes`` writes it."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Change, Claim
from multibot_rewrite.description.rewriters.spelling import ROBOT_SLOT, respelled
from multibot_rewrite.description.steps.apply import Template
from multibot_rewrite.description.steps.document import path_of


def list_changes(template: Template, robot: str) -> list[Change]:
    """Every renamed value at its place in the source, then every inserted one at its parent's."""
    inventory, plan = template.inventory, template.plan
    source = inventory.document.source
    changes = []
    for claim, spelling in zip(inventory.claims, plan.renames.values, strict=True):
        if spelling:
            new = respelled(claim.value, spelling, robot)
            changes.append(_change(source, claim, spelling[0].kind, new))
    for claim, text in plan.collisions:
        changes.append(_change(source, claim, "collision", text.replace(ROBOT_SLOT, robot)))
    starts = dict(zip(inventory.document.root.iter("*"), inventory.document.starts, strict=True))
    for item in plan.insertions:
        place = locate(source, starts[item.parent])
        new = item.new.replace(ROBOT_SLOT, robot)
        changes.append(Change(*place, item.kind, path_of(item.parent), item.old, new, "inserted"))
    return sorted(changes)


def _change(source: bytes, claim: Claim, kind: str, new: str) -> Change:
    attribute = f"@{claim.attribute}" if claim.attribute else ""
    path = path_of(claim.element) + attribute
    place = locate(source, claim.start)
    return Change(*place, kind, path, claim.value, new, claim.site.section)
