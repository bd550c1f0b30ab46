# SPDX-License-Identifier: Apache-2.0
"""What the rules of any system find in a fleet as it is written, and whether its sources have it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import cast

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Rule
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile, line_in_source
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot
from multibot_rewrite.producers.ends import NEEDS
from multibot_rewrite.rules.check import absences, contradictions
from multibot_rewrite.rules.system.localized import map_not_joined
from multibot_rewrite.rules.system.states import (
    interface_claimed_twice,
    interface_commanded_twice,
    interface_not_exported,
    open_claims,
)
from multibot_rewrite.rules.system.tf_pieces import tf_tree_in_pieces
from multibot_rewrite.rules.system.unsent import frame_not_sent, no_longer_sent, open_ends
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.ownership import ALONE, Whose, whose_by_plan
from multibot_rewrite.system.records import (
    CLAIMS,
    EXPORTS,
    JOINT,
    NOWHERE,
    End,
    Environment,
    Interface,
    System,
)
from multibot_rewrite.system.tf_copies import copying_nodes

Key = tuple[str, ...]
# What is asked of the sources and of what is written apart from the rest.
_ASKED = (tf_tree_in_pieces.code, frame_not_sent.code, interface_not_exported.code)


def contradicted(plan: FleetPlan, whole: System, expected: System) -> Iterator[Finding]:
    """Yield faults between nodes that surely run; in one robot it had them before its rewrite. What
    all robots share on purpose is no fault, nor what tf relays ``expected`` to run send; collisions
    are reported with the table."""
    whose, copies = whose_by_plan(expected), copying_nodes(expected)
    met = {(it.code, name) for it in plan.fleet.table.problems for name in it.names}
    shared = {f"/{it}" for it in plan.fleet.naming.shared_topics}
    robots = {it.spec.namespace: it for it in plan.robots}
    for it in contradictions(index(whole, whose)):
        if it.node in copies or (it.names and shared.issuperset(it.names)):
            continue
        if any((it.code, about) in met for about in (*it.names, it.node)):
            continue
        level = WARNING if it.robot and it.level == ERROR else it.level
        yield _in_file(it._replace(level=level), robots.get(it.robot) or plan.robots[-1])


def left_open(
    robot: RewrittenRobot,
    before: System,
    after: System,
    whose: Whose,
    texts: Sequence[OutputFile] = (),
) -> Iterator[Finding]:
    """Yield what is open in a robot by its sources, and as it is written: an error where only its
    rewrite has opened it. ``texts`` are the files that were made."""
    # As it is written, with the needs that its sources have.
    needed = _by_key(before, (it for it in before.ends if it.role in NEEDS))
    keys = {id(it): key for key, it in _by_key(after, after.ends).items()}
    ends = (it for it in after.ends if it.role not in NEEDS or keys.get(id(it)) in needed)
    old, new = index(before, ALONE), index(after._replace(ends=tuple(ends)), whose)
    in_sources, found = absences(old), absences(new)
    yield from _controlled(robot, before, after, texts)
    # The frames that its files name and nothing of it sends; in a simulator no driver might.
    known = before if robot.spec.simulator == REAL else before._replace(environment=Environment())
    for it in _ask((frame_not_sent,), known):
        yield _in_file(it, robot, by_sources=True)
    yield from _apart(robot, after, in_sources, found)
    was_open = _by_key(before, open_ends(old))
    lost = {
        (it.node, it.name): it
        for key, it in _by_key(after, open_ends(new)).items()
        if key not in was_open
    }
    by_end = {_about(it, before): it for it in in_sources if it.node}
    for it in (it for it in found if it.code not in _ASKED):
        if it.node and (it.node, it.names[0]) in lost:
            del lost[it.node, it.names[0]]
            yield _in_file(it, robot)
            continue
        # Names as the sources have them, where these have both.
        source = by_end.get(_about(it, after)) if it.node else None
        is_placed = source and any(
            end.name == source.names[-1] and end.place != NOWHERE for end in before.ends
        )
        said = source if source and is_placed else it
        level = WARNING if said.level == ERROR else said.level
        # Its drivers, which no file names, send what a localizer waits for.
        real = robot.spec.simulator == REAL and it.code == map_not_joined.code
        level = NOTE if real and len(it.names) == 1 else level
        yield _in_file(said._replace(level=level), robot, by_sources=said is source)
    yield from (_in_file(no_longer_sent(it), robot) for it in lost.values())


def _apart(
    robot: RewrittenRobot, after: System, in_sources: Iterable[Finding], found: Iterable[Finding]
) -> Iterator[Finding]:
    """Yield separate tf trees in the sources, and as errors those that only the rewrite has made."""
    known = {it.name: it.known for it in after.nodes}
    cut = [it for it in in_sources if it.code == tf_tree_in_pieces.code]
    told = {it.node.lstrip("/") for it in cut}
    yield from (_in_file(it, robot, by_sources=True) for it in cut)
    for it in (it for it in found if it.code == tf_tree_in_pieces.code):
        if known.get(it.node, it.node) not in told:
            yield _in_file(it._replace(level=ERROR), robot)


def _controlled(
    robot: RewrittenRobot, before: System, after: System, texts: Sequence[OutputFile]
) -> Iterator[Finding]:
    """Yield faults between a robot's controllers and its hardware, by its sources; an error where
    only its rewrite has made them."""
    for it in _ask(
        (interface_not_exported, interface_claimed_twice, interface_commanded_twice), before
    ):
        # What a rewrite has not made is no error.
        level = NOTE if it.level == NOTE else WARNING
        yield _in_file(it._replace(level=level), robot, by_sources=True)
    was_open = open_claims(before.interfaces)
    old = {key for key, it in _claims(before) if it in was_open}
    left = [it for key, it in _claims(after) if key not in old]
    exports = [it for it in after.interfaces if it.role == EXPORTS]
    opened = after._replace(interfaces=(*exports, *left))
    for it in _ask((interface_not_exported,), opened):
        source = next((text for text in texts if text.path == it.file and text.sources), None)
        file, line = line_in_source(source, it.line) if source else (it.file, it.line)
        hint = SET_PREFIX if robot.needs_prefix else it.hint
        found = it._replace(level=ERROR, file=file, line=line, hint=hint)
        yield _in_file(found, robot, by_sources=True)


def _ask(rules: Iterable[Rule], system: System) -> Iterator[Finding]:
    seen = index(system, ALONE)
    for rule in rules:
        yield from cast(Callable[[Index], Iterator[Finding]], rule.check)(seen)


def _claims(system: System) -> Iterator[tuple[tuple[bool, int], Interface]]:
    """Yield the claims of controllers, and those of MoveIt, each by its number."""
    numbers = {True: count(), False: count()}
    for it in (it for it in system.interfaces if it.role == CLAIMS):
        yield (it.kind == JOINT, next(numbers[it.kind == JOINT])), it


def _by_key(system: System, ends: Iterable[End]) -> Mapping[Key, End]:
    """Return ends by what a rewrite does not change: kind, role, node and the name in its code."""
    known = {it.name: it.known for it in system.nodes}
    return {(it.kind, it.role, known.get(it.node, it.node), it.code_name): it for it in ends}


def _about(finding: Finding, system: System) -> Key | None:
    """Return the key of the end that a finding is about; None without one."""
    ends = (it for it in system.ends if (it.node, it.name) == (finding.node, finding.names[0]))
    return next(iter(_by_key(system, ends)), None)


def _in_file(finding: Finding, robot: RewrittenRobot, by_sources: bool = False) -> Finding:
    """Return the finding at its file, otherwise at the robot's line in the fleet file, with the
    node in the message. The names of the sources have no robot."""
    it, spec = finding, robot.spec
    file, line, column = (it.file, it.line, it.column) if it.file else (spec.file, spec.line, 1)
    who = f"{it.node} of {spec.name} " if by_sources else f"{it.node} "
    message = f"{who}{it.message}" if it.node else it.message
    return it._replace(message=message, node="", robot="", file=file, line=line, column=column)
