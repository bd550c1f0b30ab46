"""The proof that runs on every rewrite: it reads the output bytes again and compares."""

from __future__ import annotations

from collections import Counter

from lxml import etree

from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.model import Claim, InputError, ProofError
from multibot_rewrite.naming import Naming
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.spelling import ROBOT_SLOT, respelled
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.steps.apply import cut, invert
from multibot_rewrite.steps.collect import Inventory, collect
from multibot_rewrite.steps.document import read_document, slot_values
from multibot_rewrite.steps.inserted import removals
from multibot_rewrite.steps.plan import Plan
from multibot_rewrite.steps.strip import not_inserted, strip_edits


@gc_paused()
def verify(
    inventory: Inventory,
    plan: Plan,
    values: list[str],
    output: bytes,
    robot: str,
    naming: Naming,
    tree: Tree,
    urdf_declarations: Declared,
) -> None:
    """Raise ProofError unless ``output`` is the input with its names renamed and nothing else changed.

    ``values`` are the input's ``slot_values``; ``urdf_declarations`` is what the rewritten URDF
    beside an SRDF declares.
    """
    source, file = inventory.document.source, inventory.document.file
    try:
        result = collect(read_document(output, f"{file} for {robot}"), tree, urdf_declarations)
        inserted = removals(result.document, robot)
    except InputError as error:
        raise ProofError(f"the output does not parse: {error}") from None
    expected = _expected(inventory, plan, robot)
    _same_names(inventory, not_inserted(result.claims, inserted), expected)
    _same_symbols(inventory, result, robot)
    come = Counter(expected)
    for item in plan.insertions:
        come.update(slot_values(etree.fromstring(item.xml.replace(ROBOT_SLOT, robot))))
    _same_values(inventory, values, slot_values(result.document.root), come)
    if b"".join(cut(output, invert(plan.edits, source, robot))) != source:
        raise ProofError(f"{file}: undoing the edits does not give the input back")
    if b"".join(cut(output, strip_edits(result, naming, robot))) != source:
        raise ProofError(f"{file}: stripping {robot} from the output does not give the input back")


def _same_names(inventory: Inventory, found: list[Claim], expected: list[str]) -> None:
    """The same sites in the same order, each with the planned value."""
    file = inventory.document.file
    if len(found) != len(inventory.claims):
        raise ProofError(f"{file}: {len(inventory.claims)} names went in, {len(found)} came out")
    for claim, new, value in zip(inventory.claims, found, expected, strict=True):
        if new.site is not claim.site or new.value != value:
            raise ProofError(f"{file}: {claim.value!r} became {new.value!r}, expected {value!r}")


def _same_symbols(inventory: Inventory, result: Inventory, robot: str) -> None:
    """No two symbols became one: what was declared under so many names still is."""
    for kind, symbols in inventory.declared.items():
        if len(symbols) != len(result.declared[kind]):
            file = inventory.document.file
            raise ProofError(f"{file}: two {kind}s have one name for {robot}")


def _expected(inventory: Inventory, plan: Plan, robot: str) -> list[str]:
    values = [
        respelled(claim.value, spelling, robot) if spelling else claim.value
        for claim, spelling in zip(inventory.claims, plan.renames.values, strict=True)
    ]
    if plan.collisions:
        by_place = {claim.start: new for claim, new in plan.collisions}
        for index, claim in enumerate(inventory.claims):
            if claim.site.form == "collision" and claim.start in by_place:
                values[index] = by_place[claim.start].replace(ROBOT_SLOT, robot)
    return values


def _same_values(
    inventory: Inventory, before: list[str], after: list[str], come: Counter[str]
) -> None:
    """Every value is there as often as planned, claimed or not, inserted text included.

    ``before`` and ``after`` are the values of all slots, ``come`` counts those the claims are to have.
    """
    expected = Counter(before)
    expected.subtract(claim.value for claim in inventory.claims)
    expected.update(come)
    found = Counter(after)
    # An empty text is no slot: what is filled was not there before.
    del expected[""], found[""]
    wrong = next(iter(found - expected), "") or next(iter(expected - found), "")
    if wrong:
        times = f"{found[wrong]} times, expected {expected[wrong]}"
        raise ProofError(f"{inventory.document.file}: {wrong!r} is there {times}")
