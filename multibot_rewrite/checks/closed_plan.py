# SPDX-License-Identifier: Apache-2.0
"""What is open in a fleet before and after the rewrite; what the rewrite opens is an error."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain, count
from typing import cast

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Rule
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.checks.across_domains import not_across
from multibot_rewrite.checks.lacking import unmoved
from multibot_rewrite.checks.meeting import shared_by_nothing
from multibot_rewrite.checks.robot_system import (
    as_written,
    beside,
    of_all_robots,
    of_sources,
    with_controllers,
)
from multibot_rewrite.checks.written_files import checked, of_files, written_findings
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet import Fleet, planned
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.bridge_outputs import bridge_outputs
from multibot_rewrite.fleet.outputs.output_file import OutputFile, line_in_source
from multibot_rewrite.fleet.outputs.related_files import related_files
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import group_robots, split_per_robot
from multibot_rewrite.fleet.robots.simulators import unread_drives
from multibot_rewrite.fleet.robots.start_poses import with_start_pose_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.planning.bridged_topics import BOTH, once
from multibot_rewrite.producers.ends import BRIDGE_FILE, NEEDS, bridge_rows
from multibot_rewrite.producers.evidence.nodes import MANAGER
from multibot_rewrite.producers.launch.bridges import services_in
from multibot_rewrite.rules.check import absences, contradictions
from multibot_rewrite.rules.files.plugin_names import without_input
from multibot_rewrite.rules.system.differing import differs_from_its_likes
from multibot_rewrite.rules.system.states import (
    interface_claimed_twice,
    interface_commanded_twice,
    interface_not_exported,
    open_claims,
)
from multibot_rewrite.rules.system.tf_pieces import tf_tree_in_pieces
from multibot_rewrite.rules.system.unsent import (
    frame_not_sent,
    is_for_driver,
    no_longer_sent,
    open_ends,
)
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.merging import joined
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
    Topic,
)
from multibot_rewrite.system.tf_copies import copying_nodes

Key = tuple[str, ...]
# What is asked of the sources and of what is written apart from the rest.
_ASKED = (tf_tree_in_pieces.code, frame_not_sent.code, interface_not_exported.code)


def contradicted(plan: FleetPlan, whole: System, expected: System) -> Iterator[Finding]:
    """Yield faults between nodes that surely run; a single robot had them before its rewrite."""
    # Not what all share on purpose, nor what tf relays ``expected`` to run send; collisions are
    # reported with the table.
    whose, copies = whose_by_plan(expected), copying_nodes(expected)
    met = {(it.code, name) for it in plan.fleet.table.problems for name in it.names}
    shared = {f"/{it}" for it in plan.fleet.naming.shared_topics}
    robots = {it.spec.name: it for it in plan.robots}
    # A robot with a description of its own is not to be equal to the others.
    kinds = Counter(it.spec.description for it in plan.robots)
    for it in contradictions(index(whole, whose)):
        robot = robots.get(it.robot) or plan.robots[-1]
        if it.code == differs_from_its_likes.code and kinds[robot.spec.description] == 1:
            continue
        if it.node in copies or (it.names and shared.issuperset(it.names)):
            continue
        if any((it.code, about) in met for about in (*it.names, it.node)):
            continue
        level = WARNING if it.robot and it.level == ERROR else it.level
        yield _at_file(it._replace(level=level), robot)


def left_open(
    robot: RewrittenRobot,
    before: System,
    after: System,
    whose: Whose,
    texts: Sequence[OutputFile] = (),
) -> Iterator[Finding]:
    """Yield what a robot lacks: warnings by its sources, errors if only its rewrite lacks it."""
    # As it is written, with the needs that its sources have.
    needed = _ends_by_key(before, (it for it in before.ends if it.role in NEEDS))
    keys = {id(it): key for key, it in _ends_by_key(after, after.ends).items()}
    ends = (it for it in after.ends if it.role not in NEEDS or keys.get(id(it)) in needed)
    old, new = index(before, ALONE), index(after._replace(ends=tuple(ends)), whose)
    in_sources, found = absences(old), absences(new)
    yield from _controller_faults(robot, before, after, texts)
    # What the drivers of a real robot, which no file names, send.
    is_real = robot.spec.simulator == REAL
    for it in _findings_of_rules((frame_not_sent,), before._replace(environment=Environment())):
        level = NOTE if is_real and is_for_driver(old, it) else it.level
        yield _at_file(it._replace(level=level), robot, by_sources=True)
    yield from _separate_trees(robot, after, in_sources, found)
    was_open = _ends_by_key(before, open_ends(old))
    lost = {
        (it.node, it.name): it
        for key, it in _ends_by_key(after, open_ends(new)).items()
        if key not in was_open
    }
    by_end = {_key_of_end(it, before): it for it in in_sources if it.node}
    for it in (it for it in found if it.code not in _ASKED):
        if it.node and (it.node, it.names[0]) in lost:
            del lost[it.node, it.names[0]]
            yield _at_file(it, robot)
            continue
        # Names as the sources have them, where these have both.
        source = by_end.get(_key_of_end(it, after)) if it.node else None
        is_placed = source and any(
            end.name == source.names[-1] and end.place != NOWHERE for end in before.ends
        )
        said = source if source and is_placed else it
        level = WARNING if said.level == ERROR else said.level
        level = NOTE if is_real and is_for_driver(new, it) else level
        yield _at_file(said._replace(level=level), robot, by_sources=said is source)
    yield from (_at_file(no_longer_sent(it), robot) for it in lost.values())


def _separate_trees(
    robot: RewrittenRobot, after: System, in_sources: Iterable[Finding], found: Iterable[Finding]
) -> Iterator[Finding]:
    """Yield separate tf trees in the sources, and as errors those that only the rewrite has made."""
    known = {it.name: it.known for it in after.nodes}
    cut = [it for it in in_sources if it.code == tf_tree_in_pieces.code]
    told = {it.node.lstrip("/") for it in cut}
    yield from (_at_file(it, robot, by_sources=True) for it in cut)
    for it in (it for it in found if it.code == tf_tree_in_pieces.code):
        if known.get(it.node, it.node) not in told:
            yield _at_file(it._replace(level=ERROR), robot)


def _controller_faults(
    robot: RewrittenRobot, before: System, after: System, texts: Sequence[OutputFile]
) -> Iterator[Finding]:
    """Yield faults between controllers and hardware, errors if the rewrite made them."""
    for it in _findings_of_rules(
        (interface_not_exported, interface_claimed_twice, interface_commanded_twice), before
    ):
        # What a rewrite has not made is no error.
        level = NOTE if it.level == NOTE else WARNING
        yield _at_file(it._replace(level=level), robot, by_sources=True)
    was_open = open_claims(before.interfaces)
    old = {key for key, it in _numbered_claims(before) if it in was_open}
    left = [it for key, it in _numbered_claims(after) if key not in old]
    exports = [it for it in after.interfaces if it.role == EXPORTS]
    opened = after._replace(interfaces=(*exports, *left))
    for it in _findings_of_rules((interface_not_exported,), opened):
        source = next((text for text in texts if text.path == it.file and text.sources), None)
        file, line = line_in_source(source, it.line) if source else (it.file, it.line)
        hint = SET_PREFIX if robot.needs_prefix else it.hint
        found = it._replace(level=ERROR, file=file, line=line, hint=hint)
        yield _at_file(found, robot, by_sources=True)


def _findings_of_rules(rules: Iterable[Rule], system: System) -> Iterator[Finding]:
    seen = index(system, ALONE)
    for rule in rules:
        yield from cast(Callable[[Index], Iterator[Finding]], rule.check)(seen)


def _numbered_claims(system: System) -> Iterator[tuple[tuple[bool, int], Interface]]:
    """Yield the claims of controllers, and those of MoveIt, each by its number."""
    numbers = {True: count(), False: count()}
    for it in (it for it in system.interfaces if it.role == CLAIMS):
        yield (it.kind == JOINT, next(numbers[it.kind == JOINT])), it


def _ends_by_key(system: System, ends: Iterable[End]) -> Mapping[Key, End]:
    """Return ends by what a rewrite does not change: kind, role, node and the name in its code."""
    known = {it.name: it.known for it in system.nodes}
    return {(it.kind, it.role, known.get(it.node, it.node), it.code_name): it for it in ends}


def _key_of_end(finding: Finding, system: System) -> Key | None:
    """Return the key of the end that a finding is about; None without one."""
    ends = (it for it in system.ends if (it.node, it.name) == (finding.node, finding.names[0]))
    return next(iter(_ends_by_key(system, ends)), None)


def _at_file(finding: Finding, robot: RewrittenRobot, by_sources: bool = False) -> Finding:
    """Return the finding at its file, or the robot's line, with the node in the message."""
    # The names of the sources have no robot.
    it, spec = finding, robot.spec
    file, line, column = (it.file, it.line, it.column) if it.file else (spec.file, spec.line, 1)
    own = f"{it.node} of {spec.name}" if by_sources and it.node else it.node
    message = it.message if it.message.startswith(it.node) else f"{it.node} {it.message}"
    message = message.replace(it.node, own, 1)
    return it._replace(message=message, node="", robot="", file=file, line=line, column=column)


def closed_plan(plan: FleetPlan) -> Fleet:
    """Return the fleet with all started nodes and its ``gaps``; raises InputError."""
    with gc_paused():
        fleet = with_start_pose_nodes(plan)
        # The others close as the first one of each that differs in more than its names does.
        few = _plan_of_some(plan, [it.robots[0] for it in group_robots(plan)])
        read = chain(related_files(few), bridge_outputs(few))
        gaps = gaps_of(plan, fleet, checked(few, read))
        rows = [it for it in bridge_outputs(plan) if isinstance(it, OutputFile)]
        return fleet._replace(gaps=gaps, bridged=bridged_by(plan, rows))


def bridged_by(plan: FleetPlan, texts: Iterable[OutputFile]) -> tuple[Topic, ...]:
    """Return the topics that bridge files among ``texts`` carry, but of no robot that may be real."""
    # The shared one is left out if all robots may be real.
    maybe = plan.fleet.maybe_real
    real = {it.spec.name for it in plan.robots if it.spec.namespace in maybe}
    left = {f"{it}/{BRIDGE_FILE}" for it in real}
    left |= {BRIDGE_FILE} if len(real) == len(plan.robots) else set()
    bridges = (it for it in texts if it.path.rpartition("/")[2] == BRIDGE_FILE)
    files = [it for it in bridges if it.path not in left]
    rows = (row.end for it in files for row in bridge_rows(it.yaml))
    topics = [Topic(it.name, bridge=(it.role,) if it.role else BOTH, type=it.type) for it in rows]
    if any(it.path == BRIDGE_FILE for it in files):
        served = (it.end for it in services_in(plan.launched_words).values())
        topics += (Topic(it.name, bridge=(it.role,), type=it.type) for it in served)
    return once(topics)


def gaps_of(
    plan: FleetPlan, fleet: Fleet, made: Iterable[OutputFile | Finding]
) -> tuple[Finding, ...]:
    """Return the gaps in the robots of a fleet by place; ``made`` are their files and findings."""
    texts, findings = sorted_out(made)
    known = of_files(findings)
    for robot in (group.robots[0] for group in group_robots(plan)):
        known |= {it for it in robot.findings if it.file == robot.spec.srdf and it.level != NOTE}
    # What a file of the user lacks has been found there.
    said = {(it.code, it.hint) for it in known}
    lacking = without_input(plan.fleet.table.runs, plan.file.distro)
    known |= {_at_file(it, plan.robots[0]) for it in lacking if (it.code, it.hint) not in said}
    known |= {
        *_gaps_of_robots(plan, fleet, texts, known),
        *not_across(fleet),
        *_unused_shared_names(plan),
    }
    return tuple(
        sorted(known, key=lambda it: (it.file, it.line, it.column, it.code, it.message, it))
    )


def _unused_shared_names(plan: FleetPlan) -> Iterator[Finding]:
    """Yield a finding for each shared name that nothing of the fleet has."""
    specs = [it.spec for it in plan.robots]
    filled = {path: text.encode() for it in specs for path, text in it.filled}
    beside = (path for it in specs for paths in it.related_files.values() for path in paths)
    launched = (order.file for it in specs for order in it.launch)
    files = dict.fromkeys((*beside, *launched, *plan.file.files[1:]))
    texts = (filled.get(path) or data_of_file(path) for path in files)
    return shared_by_nothing(plan.fleet, texts, dict(plan.file.shared_places))


def sorted_out(made: Iterable[OutputFile | Finding]) -> tuple[list[OutputFile], list[Finding]]:
    """Return two lists: the files, and the findings."""
    both = [*made]
    files = sorted(it for it in both if isinstance(it, OutputFile))
    return files, [it for it in both if isinstance(it, Finding)]


def _gaps_of_robots(
    plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputFile], known: Collection[Finding]
) -> Iterator[Finding]:
    """Yield what is open in robots; those of the same sources are checked once."""
    groups = [*group_robots(plan)]
    # Of robots that differ in their names alone two show where they meet.
    few = _plan_of_some(plan._replace(fleet=fleet), [one for it in groups for one in it.robots[:2]])
    alone = [(it.robots[0], it.fleet) for it in split_per_robot(few)]
    written = {it.spec.name: as_written(own, it, texts) for it, own in alone}
    shared = of_all_robots((it for it in few.fleet.table.runs if not it.robot), texts)
    expected = planned(few.fleet)
    whose = whose_by_plan(expected)
    yield from contradicted(plan, joined(shared, *written.values()), expected)
    parameters = load_known_nodes(plan.file.nodes, plan.file.distro)
    for group in groups:
        robot = group.robots[0]
        evidence = plan.evidence_of(robot)
        before = of_sources(robot, evidence, plan.jobs[robot.spec.sources].srdf)
        own = beside(written[robot.spec.name], shared)
        after = with_controllers(own, robot, evidence, texts, parameters)
        loads = any(it.name.endswith(MANAGER) for it in group.facts)
        found = (
            *left_open(robot, before, after, whose, texts),
            *unread_drives(robot, loads),
            *unmoved(robot, evidence.nodes, after),
        )
        alike = tuple(it.spec.name for it in group.robots)
        several = alike if len(alike) > 1 else ()
        yield from (it._replace(robots=it.robots or several) for it in found)
        yield from written_findings(plan, group, texts, known)


def _plan_of_some(plan: FleetPlan, robots: Sequence[RewrittenRobot]) -> FleetPlan:
    """Return a plan of some of the robots, with the nodes for all."""
    fleet, kept = plan.fleet, {"", *(it.spec.namespace for it in robots)}
    table = fleet.table._replace(runs=tuple(it for it in fleet.table.runs if it.robot in kept))
    return plan._replace(
        robots=tuple(robots),
        fleet=fleet._replace(
            table=table,
            inventories={name: it for name, it in fleet.inventories.items() if name in kept},
            described={name: it for name, it in fleet.described.items() if name in kept},
            edges={key: it for key, it in fleet.edges.items() if key[0] in kept},
        ),
    )
