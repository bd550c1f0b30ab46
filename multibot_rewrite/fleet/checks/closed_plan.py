# SPDX-License-Identifier: Apache-2.0
"""The fleet of a fleet file with what is open in its robots, before and after their rewrite: build,
plan, rehearse and check say it. What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.fleet.checks.across_domains import not_across
from multibot_rewrite.fleet.checks.judged import contradicted, left_open
from multibot_rewrite.fleet.checks.lacking import unmoved
from multibot_rewrite.fleet.checks.robot_system import (
    as_written,
    beside,
    joined,
    of_all_robots,
    of_sources,
    with_controllers,
)
from multibot_rewrite.fleet.checks.shared_names import shared_by_nothing
from multibot_rewrite.fleet.checks.written_files import of_files, written_findings
from multibot_rewrite.fleet.fleet import Fleet, planned
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.bridge_outputs import bridge_outputs
from multibot_rewrite.fleet.outputs.companion_files import companion_files
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import group_robots, split_per_robot
from multibot_rewrite.fleet.robots.simulators import unread_drives
from multibot_rewrite.fleet.robots.start_poses import with_start_pose_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.ends import BRIDGE_FILE, bridge_ends
from multibot_rewrite.producers.evidence.nodes import MANAGER
from multibot_rewrite.producers.launch.bridges import services_in
from multibot_rewrite.spelling.bridged_topics import BOTH, once
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import Topic


def closed_plan(plan: FleetPlan) -> Fleet:
    """Return the fleet with all nodes that are started, and its ``gaps``. Raises InputError for a
    related file that cannot be read or rewritten."""
    with gc_paused():
        fleet = with_start_pose_nodes(plan)
        # The others close as the first one of each that differs in more than its names does.
        few = _of_some(plan, [it.robots[0] for it in group_robots(plan)])
        made = [*companion_files(few), *bridge_outputs(few)]
        gaps = gaps_of(plan, fleet, made)
        rows = [it for it in bridge_outputs(plan) if isinstance(it, OutputFile)]
        return fleet._replace(gaps=gaps, bridged=bridged_by(plan, rows))


def bridged_by(plan: FleetPlan, texts: Iterable[OutputFile]) -> tuple[Topic, ...]:
    """Return what the bridges of these files carry, except those of robots that may be real, and
    the shared one if all may be."""
    maybe = plan.fleet.maybe_real
    real = {it.spec.name for it in plan.robots if it.spec.namespace in maybe}
    left = {f"{it}/{BRIDGE_FILE}" for it in real}
    left |= {BRIDGE_FILE} if len(real) == len(plan.robots) else set()
    bridges = (it for it in texts if it.path.rpartition("/")[2] == BRIDGE_FILE)
    files = [it for it in bridges if it.path not in left]
    rows = (end for it in files for end in bridge_ends(it.yaml))
    topics = [Topic(it.name, bridge=(it.role,) if it.role else BOTH, type=it.type) for it in rows]
    if any(it.path == BRIDGE_FILE for it in files):
        served = (it.end for it in services_in(plan.launched_words).values())
        topics += (Topic(it.name, bridge=(it.role,), type=it.type) for it in served)
    return once(topics)


def gaps_of(
    plan: FleetPlan, fleet: Fleet, made: Iterable[OutputFile | Finding]
) -> tuple[Finding, ...]:
    """Return the gaps in the robots of a fleet, by place; ``made`` are the robots' files, and what
    was found as they were made."""
    texts, found = sorted_out(made)
    known = of_files(found)
    for robot in (group.robots[0] for group in group_robots(plan)):
        known |= {it for it in robot.findings if it.file == robot.spec.srdf and it.level != NOTE}
    known |= {*_gaps(plan, fleet, texts, known), *not_across(fleet), *_shared(plan)}
    return tuple(
        sorted(known, key=lambda it: (it.file, it.line, it.column, it.code, it.message, it))
    )


def _shared(plan: FleetPlan) -> Iterator[Finding]:
    """Yield a finding for each shared name that nothing of the fleet has."""
    specs = [it.spec for it in plan.robots]
    filled = {path: text.encode() for it in specs for path, text in it.filled}
    beside = (path for it in specs for paths in it.companions.values() for path in paths)
    launched = (order.file for it in specs for order in it.launch)
    files = dict.fromkeys((*beside, *launched, *plan.file.files[1:]))
    texts = (filled.get(path) or data_of_file(path) for path in files)
    return shared_by_nothing(plan.fleet, texts, dict(plan.file.shared_places))


def sorted_out(made: Iterable[OutputFile | Finding]) -> tuple[list[OutputFile], list[Finding]]:
    """Return the files, and the findings."""
    both = [*made]
    files = sorted(it for it in both if isinstance(it, OutputFile))
    return files, [it for it in both if isinstance(it, Finding)]


def _gaps(
    plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputFile], known: Collection[Finding]
) -> Iterator[Finding]:
    """Yield what is open; robots of the same sources are judged once, and all of them are named."""
    groups = [*group_robots(plan)]
    # Of robots that differ in their names alone two show where they meet.
    few = _of_some(plan._replace(fleet=fleet), [one for it in groups for one in it.robots[:2]])
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


def _of_some(plan: FleetPlan, robots: Sequence[RewrittenRobot]) -> FleetPlan:
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
