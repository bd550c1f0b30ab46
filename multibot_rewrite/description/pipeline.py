# SPDX-License-Identifier: Apache-2.0
"""The order of the steps, and nothing else: this file is the program in short."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, RewriteRefused
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import TWIN, Naming, overlap
from multibot_rewrite.description.checks import audit, robots as checks
from multibot_rewrite.description.checks.meeting import shared_by_all, shared_by_both, shared_with
from multibot_rewrite.description.checks.mentions import MENTIONED, find_mentions, usual_names
from multibot_rewrite.description.checks.problem import Problem, to_findings
from multibot_rewrite.description.checks.twice import already_rewritten
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.renaming import stripped_names
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.own_names import OF_ALL, OwnSource
from multibot_rewrite.description.steps.apply import Template, cut, fill
from multibot_rewrite.description.steps.collect import NOTHING, SRDF, Inventory, collect
from multibot_rewrite.description.steps.document import read_document, slot_values
from multibot_rewrite.description.steps.plan import make_plan
from multibot_rewrite.description.steps.renames import make_renames
from multibot_rewrite.description.steps.strip import NOWHERE, own_places, strip_edits
from multibot_rewrite.description.steps.verify import verify


@gc_paused()
def prepare(
    source: bytes,
    file: str,
    naming: Naming,
    tree: Tree,
    urdf_declarations: Declared = NOTHING,
    own: OwnSource = OF_ALL,
) -> Template:
    """Return everything that does not depend on a robot's name; raises InputError, RewriteRefused.

    ``urdf_declarations`` is what an SRDF's URDF declares; ``own`` is of a source made for one
    robot."""
    inventory = collect(read_document(source, file), tree, urdf_declarations, naming.read_as)
    check_urdf(inventory, urdf_declarations)
    plan = make_plan(inventory, naming)
    findings = [*audit.audit(inventory, plan.renames, tree), *plan.findings]
    if own.robot:
        from multibot_rewrite.description.checks.references import missed_by_arguments

        missed = missed_by_arguments(inventory, plan.renames, own.plain, own.robot)
        findings += to_findings(inventory.document, missed, WARNING)
    _stop_on_errors(findings)
    mentionable = ((kind, name) for kind in MENTIONED for name in inventory.declared[kind])
    names = {name for kind, name in mentionable if plan.renames.changes(kind, name)}
    values, usual = slot_values(inventory.document.root), usual_names(naming)
    findings += find_mentions(inventory, values, names, tree, usual)
    pieces = cut(source, plan.edits)
    if inventory.format != SRDF:  # it starts nothing
        found = (
            _shared_with_twin(inventory, own.twin, naming, tree)
            if own.twin
            else shared_by_all(inventory.document, pieces, naming, tree.definitions)
        )
        findings += to_findings(inventory.document, found, WARNING)
    return Template(inventory, plan, pieces, findings, naming, tree, urdf_declarations)


def _shared_with_twin(
    inventory: Inventory, twin: bytes, naming: Naming, tree: Tree
) -> Iterator[Problem]:
    """Yield the names that a robot with its own xacro arguments shares with all others."""
    document = inventory.document
    # What the arguments name gets the twin's name once more: only whether it has it matters.
    read = collect(read_document(twin, document.file), tree, layout=naming.read_as)
    edits = make_plan(read, naming).edits
    text = fill(cut(twin, edits), TWIN)
    return shared_with(document, text, TWIN, naming, tree.definitions)


def check_urdf(inventory: Inventory, urdf_declarations: Declared) -> None:
    """Raise InputError unless an SRDF comes with its URDF, and a URDF without an SRDF's."""
    file = inventory.document.file
    if inventory.format == SRDF and not urdf_declarations:
        raise InputError(f"{file}: an SRDF is rewritten with its URDF: add --urdf robot.urdf")
    if inventory.format != SRDF and urdf_declarations:
        raise InputError(f"{file}: only an SRDF needs a URDF: leave out --urdf")


def render(prepared: Template, robots: Sequence[str], again: bool = False) -> Iterator[bytes]:
    """Yield the text for each robot in turn, the first one verified.

    The others differ only in the robot's name at the same places. Before the first is returned, all are
    checked for names that become one.
    """
    inventory, plan, pieces, _, naming, tree, urdf_declarations = prepared
    renames = plan.renames
    document = inventory.document
    at_values = chain(
        checks.taken_names(inventory, renames, robots),
        already_rewritten(inventory, robots, again, renames.naming.own),
    )
    pairs = overlap(naming, robots)
    whole = list(checks.meeting(inventory, renames, pairs))
    # What robots whose names overlap would share in the running system.
    for robot, other, _ in () if whole or inventory.format == SRDF else pairs:
        whole += shared_by_both(document, pieces, (robot, other), naming, tree.definitions)
    at_start = to_findings(document, whole, ERROR, of_file=True)
    _stop_on_errors([*to_findings(document, at_values, ERROR), *at_start])
    for robot in robots[:1]:
        output = fill(pieces, robot)
        verify(inventory, plan, len(pieces) - 1, output, robot, naming, tree, urdf_declarations)
        yield output
    for robot in robots[1:]:
        yield fill(pieces, robot)


def check_new(prepared: Template, robots: Sequence[str], kinds: Collection[str]) -> None:
    """Raise RewriteRefused if names of these kinds contain a robot's name already."""
    inventory, own = prepared.inventory, prepared.naming.own
    found = already_rewritten(inventory, robots, False, own, kinds)
    _stop_on_errors([*to_findings(inventory.document, found, ERROR)])


def check_apart(made: Mapping[str, Template]) -> None:
    """Raise RewriteRefused for names that robots with descriptions of their own both have."""
    first = next(iter(made.values())).inventory.document
    parts = ((robot, it.inventory, it.plan.renames) for robot, it in made.items())
    both = checks.meeting_descriptions(parts)
    _stop_on_errors([*to_findings(first, both, ERROR, of_file=True)])


def strip(
    source: bytes,
    file: str,
    robot: str,
    naming: Naming,
    tree: Tree,
    urdf_declarations: Declared = NOTHING,
    before: bytes = b"",
) -> bytes:
    """Undo a rewrite for ``robot``; the result is verified by rewriting it again.

    ``urdf_declarations`` is what the rewritten URDF of a rewritten SRDF declares. ``before`` is
    what the robot's own xacro arguments make, where the naming has names of these."""
    if b" numbered from " in source:
        from multibot_rewrite.description.own_ports import without_numbers

        source = without_numbers(source, file, robot, tree)
    inventory = collect(read_document(source, file), tree, urdf_declarations, naming.read_as)
    check_urdf(inventory, urdf_declarations)
    renames = make_renames(inventory, naming)
    found = checks.not_rewritten(inventory, renames, robot)
    found += checks.other_urdf(inventory, renames, robot, urdf_declarations)
    _stop_on_errors(found)
    places = NOWHERE
    if before:
        own = collect(read_document(before, file), tree, layout=naming.read_as)
        places = own_places(own, naming)
    stripped = b"".join(cut(source, strip_edits(inventory, naming, robot, places)))
    again = prepare(stripped, file, naming, tree, stripped_names(urdf_declarations, naming, robot))
    if fill(again.pieces, robot) != source:
        _stop_on_errors([checks.other_options(inventory, robot)])
    return stripped


def _stop_on_errors(findings: Sequence[Finding]) -> None:
    if any(finding.level == ERROR for finding in findings):
        raise RewriteRefused(tuple(findings))
