"""Inventory + naming -> plan: what each claimed value becomes, as edits of the source bytes.

A plan holds for every robot: the robot's name is a hole in its edits.
"""

from __future__ import annotations

from collections.abc import Iterator
from operator import itemgetter
from typing import NamedTuple

from multibot_rewrite.findings.rule import declare
from multibot_rewrite.model import ERROR, Claim, Edit, Finding
from multibot_rewrite.naming import Affix, Naming, affix
from multibot_rewrite.rewriters.contact import Respell, respell_collisions
from multibot_rewrite.rewriters.insert import Insertion, insertions
from multibot_rewrite.rewriters.spelling import HOLE, Spelling, spell, spelling_key
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import fillable, finding, value_slot
from multibot_rewrite.steps.inserted import hole_edits, insertion_edits

_START = itemgetter(0)
LAST = "~"

not_editable = declare(
    "MB104",
    "not-editable",
    ERROR,
    what="A name cannot be edited in place: it is in a CDATA section, or there are escapes or "
    "comments in it.",
    why="A rewrite replaces the bytes of a name and leaves everything else as it is; here the bytes "
    "are not those of the name.",
    fix="Write the name as plain text.",
    bad='<link name="base"/>\n'
    "<gazebo>\n"
    "  <canonicalBody><![CDATA[base]]></canonicalBody>\n"
    "</gazebo>\n",
    good='<link name="base"/>\n<gazebo>\n  <canonicalBody>base</canonicalBody>\n</gazebo>\n',
    line=3,
    formats=("rewrite",),
)


class Plan(NamedTuple):
    """Edits in source order, what they mean, and what prevents them.

    ``spellings`` are aligned with the inventory's claims. ``collisions`` are the recomputed contact
    collisions with their new text.
    """

    edits: list[Edit]
    spellings: list[Spelling]
    collisions: list[tuple[Claim, str]]
    insertions: list[Insertion]
    findings: list[Finding]


def make_plan(inventory: Inventory, naming: Naming) -> Plan:
    """Apply ``naming`` once to every distinct name and place the results."""
    spellings = _spellings(inventory, naming)
    edits, findings = _edits(inventory, spellings)
    document, claims, hosts, declared, _ = inventory
    collisions = respell_collisions(document.root, claims, declared, respeller(naming, HOLE))
    findings += _unstable(inventory, naming, collisions)
    for claim, new in collisions:
        slot = value_slot(document.source, *claim[2:])
        if slot is None:
            findings.append(_not_editable(inventory, claim))
        else:
            edits += hole_edits(*slot, new)
    added = [
        item
        for host in hosts
        if host.node.rewriter is not None
        for item in insertions(host.element, host.node.rewriter, declared, naming)
    ]
    edits += insertion_edits(document, added)
    # Stable: several edits at one place stay in the order they were made.
    edits.sort(key=_START)
    return Plan(edits, spellings, collisions, added, findings)


def _unstable(
    inventory: Inventory, naming: Naming, collisions: list[tuple[Claim, str]]
) -> list[Finding]:
    """Contacts whose collision is numbered by how the robot's name sorts: no plan holds for all."""
    document, claims, _, declared, _ = inventory
    # HOLE sorts before every letter, this after.
    respell = respeller(naming, LAST)
    last = respell_collisions(document.root, claims, declared, respell) if collisions else []
    return [
        finding(
            document,
            claim.start,
            "MB424",
            ERROR,
            f"the number in {claim.value!r} would depend on how the robot's name sorts",
            "use --affix prefix, or keep the fixed joints apart with preserveFixedJoint",
        )
        for (claim, text), (_, other) in zip(collisions, last, strict=False)
        if text != other.replace(LAST, HOLE)
    ]


def respeller(naming: Naming, robot: str) -> Respell:
    """The new spelling of a link or joint for ``robot``."""

    def respell(kind: str, name: str) -> str:
        there = affix(naming, kind, name) if name else None
        return there.spell(name, robot) if there else name

    return respell


def _spellings(inventory: Inventory, naming: Naming) -> list[Spelling]:
    declared = inventory.declared
    known: dict[tuple[object, str], Spelling] = {}
    result = []
    for claim in inventory.claims:
        key = spelling_key(claim)
        spelling = known.get(key)
        if spelling is None:
            spelling = known[key] = spell(claim, declared, naming)
        result.append(spelling)
    return result


def _edits(inventory: Inventory, spellings: list[Spelling]) -> tuple[list[Edit], list[Finding]]:
    source = inventory.document.source
    edits: list[Edit] = []
    findings: list[Finding] = []
    for claim, spelling in zip(inventory.claims, spellings, strict=True):
        if not spelling:
            continue
        _, _, start, attribute, value = claim
        if not value:
            edits += _filled(inventory, claim, spelling[0][1], findings)
            continue
        slot = value_slot(source, start, attribute, value)
        for _, (at, before, after) in spelling:
            place = value_place(source, slot, value, at) if slot else None
            if place is None:
                findings.append(_not_editable(inventory, claim))
                break
            edits.append(Edit(place, place, before.encode(), after.encode()))
    return edits, findings


def _filled(
    inventory: Inventory, claim: Claim, there: Affix, findings: list[Finding]
) -> Iterator[Edit]:
    """``<param/>`` made to hold the robot's prefix."""
    place = fillable(inventory.document.source, claim.start)
    if place is None:
        findings.append(_not_editable(inventory, claim))
    else:
        start, end, opening, close = place
        yield Edit(start, end, opening + there.before.encode(), there.after.encode() + close)


def value_place(source: bytes, slot: tuple[int, int], value: str, at: int) -> int | None:
    """The byte offset of character ``at`` of the value in ``slot``; None where escapes hide it."""
    begin, end = slot
    # As many bytes as characters: nothing is escaped, each stands for itself.
    if end - begin == len(value):
        return begin + at
    raw = source[begin:end]
    head, tail = value[:at].encode(), value[at:].encode()
    if raw.endswith(tail) and b";" not in tail:
        return end - len(tail)
    for written in (head, head.replace(b"\n", b"\r\n")):
        if raw.startswith(written):
            return begin + len(written)
    return None


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
