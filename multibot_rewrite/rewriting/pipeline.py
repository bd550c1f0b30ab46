"""The order of the steps, and nothing else: this file is the program in short."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.model import ERROR, Finding, RewriteRefused
from multibot_rewrite.naming import Naming, overlap
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.rewriting import audit
from multibot_rewrite.rewriting import robots as checks
from multibot_rewrite.rewriting.apply import cut, fill
from multibot_rewrite.rewriting.collect import Inventory, collect
from multibot_rewrite.rewriting.document import read_document
from multibot_rewrite.rewriting.mentions import find_mentions, slot_values
from multibot_rewrite.rewriting.plan import Plan, make_plan
from multibot_rewrite.rewriting.strip import strip_edits
from multibot_rewrite.rewriting.verify import verify

# Kinds whose names are telling enough to be looked for where no site is.
MENTIONED = ("link", "joint")


class Template(NamedTuple):
    """A description ready for any number of robots: one parse, one plan, one cut."""

    inventory: Inventory
    plan: Plan
    values: list[str]
    pieces: list[bytes]
    findings: list[Finding]
    naming: Naming
    tree: Tree


def prepare(source: bytes, file: str, naming: Naming, tree: Tree) -> Template:
    """Everything that does not depend on a robot's name; raises InputError and RewriteRefused."""
    inventory = collect(read_document(source, file), tree)
    plan = make_plan(inventory, naming)
    findings = [*audit.audit(inventory, naming, tree), *plan.findings]
    _stop_on_errors(findings)
    values = slot_values(inventory.document.root)
    findings += find_mentions(inventory, values, _renamed(inventory, plan), tree)
    pieces = cut(source, plan.edits)
    return Template(inventory, plan, values, pieces, findings, naming, tree)


def render(template: Template, robots: Sequence[str], again: bool = False) -> Iterator[bytes]:
    """The text for each robot in turn, the first one proved.

    The others differ from it in nothing but the robot's name in the same holes; that no two names
    meet is checked for all of them before the first is returned.
    """
    inventory, naming = template.inventory, template.naming
    found = checks.collisions(inventory, naming, robots)
    found += checks.meeting(inventory, naming, overlap(naming, robots))
    found += checks.already_rewritten(inventory, naming, robots, again)
    _stop_on_errors(found)
    for number, robot in enumerate(robots):
        output = fill(template.pieces, robot)
        if number == 0:
            _, plan, values, *_ = template
            verify(inventory, plan, values, output, robot, naming, template.tree)
        yield output


def strip(source: bytes, file: str, robot: str, naming: Naming, tree: Tree) -> bytes:
    """Undo a rewrite for ``robot``; the result is proved by rewriting it again."""
    inventory = collect(read_document(source, file), tree)
    found = checks.not_rewritten(inventory, naming, robot)
    _stop_on_errors(found)
    stripped = b"".join(cut(source, strip_edits(inventory, naming, robot)))
    again = prepare(stripped, file, naming, tree)
    if fill(again.pieces, robot) != source:
        _stop_on_errors([checks.other_options(inventory, robot)])
    return stripped


def _renamed(inventory: Inventory, plan: Plan) -> set[str]:
    return {
        claim.value.strip()
        for claim, spelling in zip(inventory.claims, plan.spellings, strict=True)
        if spelling and claim.site.role == "declares" and claim.site.kinds[0] in MENTIONED
    }


def _stop_on_errors(findings: Sequence[Finding]) -> None:
    if any(finding.level == ERROR for finding in findings):
        raise RewriteRefused(tuple(findings))
