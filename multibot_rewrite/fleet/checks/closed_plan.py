# SPDX-License-Identifier: Apache-2.0
"""The fleet of a fleet file with what is open in its robots, before and after their rewrite: build,
plan, rehearse and check say it. What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.fleet.checks.across_domains import not_across
from multibot_rewrite.fleet.checks.judged import (
    apart,
    contradicted,
    controlled,
    missing,
    not_sent,
    whose_names,
)
from multibot_rewrite.fleet.checks.shared_names import shared_by_nothing
from multibot_rewrite.fleet.checks.written_files import written_findings
from multibot_rewrite.fleet.checks.written_system import of_each_kind, with_robots, written_system
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.bridge_outputs import bridge_outputs
from multibot_rewrite.fleet.outputs.companion_files import companion_files
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.fleet.robots.simulators import unread_drives
from multibot_rewrite.fleet.robots.start_poses import with_start_pose_nodes
from multibot_rewrite.fleet.robots.systems import system_after, system_before
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.ends import BRIDGE_FILE, bridge_ends
from multibot_rewrite.producers.evidence.nodes import MANAGER
from multibot_rewrite.rules.files.judge import codes
from multibot_rewrite.spelling.bridged_topics import BOTH, once
from multibot_rewrite.system.records import Topic


def closed_plan(plan: FleetPlan) -> Fleet:
    """The fleet with all nodes that are started, and its ``gaps``.

    Raises InputError for a companion that cannot be read or rewritten.
    """
    with gc_paused():
        fleet, few = with_start_pose_nodes(plan), _one_of_each(plan)
        made = [*companion_files(few), *bridge_outputs(few)]
        gaps = gaps_of(plan, fleet, made)
        rows = [it for it in bridge_outputs(plan) if isinstance(it, OutputFile)]
        return fleet._replace(gaps=gaps, bridged=bridged_by(demanded(plan, rows)))


def bridged_by(texts: Iterable[OutputFile]) -> tuple[Topic, ...]:
    """What the bridge files among the texts carry."""
    files = [it for it in texts if it.path.rpartition("/")[2] == BRIDGE_FILE]
    rows = (end for it in files for end in bridge_ends(it.yaml))
    return once(
        Topic(end.name, bridge=(end.role,) if end.role else BOTH, type=end.type) for end in rows
    )


def demanded(plan: FleetPlan, texts: Iterable[OutputFile]) -> Iterator[OutputFile]:
    """The files without the bridges of robots that may be real, and without that of what all share
    where all may be."""
    maybe = plan.fleet.maybe_real
    names = {it.spec.name for it in plan.robots if it.spec.namespace in maybe}
    left = {f"{it}/{BRIDGE_FILE}" for it in names}
    left |= {BRIDGE_FILE} if len(names) == len(plan.robots) else set()
    return (it for it in texts if it.path not in left)


def gaps_of(
    plan: FleetPlan, fleet: Fleet, made: Iterable[OutputFile | Finding]
) -> tuple[Finding, ...]:
    """What is open in the robots of a fleet, by place; ``made`` are the files of the robots, and what
    was found as they were made."""
    texts, found = sorted_out(made)
    known = {it for it in found if it.code in codes() and it.level != NOTE}
    for robot in (group.robots[0] for group in group_robots(plan)):
        known |= {it for it in robot.findings if it.file == robot.spec.srdf and it.level != NOTE}
    known |= {*_gaps(plan, fleet, texts, known), *not_across(fleet), *_shared(plan)}
    return tuple(sorted(known, key=lambda it: (it.file, it.line, it.column, it.code, it.message)))


def _shared(plan: FleetPlan) -> Iterator[Finding]:
    """Yield a finding for each shared name that nothing of the fleet has."""
    specs = [it.spec for it in plan.robots]
    filled = {path: text.encode() for it in specs for path, text in it.filled}
    beside = (path for it in specs for paths in it.companions.values() for path in paths)
    launched = (order.file for it in specs for order in it.launch)
    files = dict.fromkeys((*beside, *launched, *plan.file.files[1:]))
    texts = (filled.get(path) or data_of_file(path) for path in files)
    return shared_by_nothing(plan.fleet, texts, dict(plan.file.shared_places))


def sorted_out(
    made: Iterable[OutputFile | Finding],
) -> tuple[list[OutputFile], list[Finding]]:
    """The files, and the findings."""
    both = [*made]
    files = sorted(it for it in both if isinstance(it, OutputFile))
    return files, [it for it in both if isinstance(it, Finding)]


def _gaps(
    plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputFile], known: Collection[Finding]
) -> Iterator[Finding]:
    """Yield what is open; robots of the same sources are judged once, and all of them are named."""
    shown = of_each_kind(plan)
    few = with_robots(fleet, shown)
    whole, whose = written_system(plan, few, shown, texts), whose_names(few)
    yield from contradicted(plan, whole, whose)
    parameters = load_known_nodes(plan.file.nodes, plan.file.distro)
    for group in group_robots(plan):
        robot = group.robots[0]
        evidence = plan.evidence_of(robot)
        before = system_before(robot, evidence, plan.jobs[robot.spec.sources].srdf)
        after = system_after(robot, evidence, texts, parameters, whole)
        loads = any(it.name.endswith(MANAGER) for it in group.facts)
        found = (
            *controlled(robot, before.control, after.control, texts),
            *apart(robot, before.system, after.system, whose),
            *not_sent(robot, before.system),
            *unread_drives(robot, loads),
            *missing(robot, before.system, after.system, whose),
        )
        alike = tuple(it.spec.name for it in group.robots)
        several = alike if len(alike) > 1 else ()
        yield from (it._replace(robots=it.robots or several) for it in found)
        yield from written_findings(plan, group, texts, known)


def _one_of_each(plan: FleetPlan) -> FleetPlan:
    """A plan of one robot for each that differs in more than its names: the others close as it does."""
    robots = tuple(it.robots[0] for it in group_robots(plan))
    own = {it.spec.namespace: plan.fleet.inventories[it.spec.namespace] for it in robots}
    return plan._replace(robots=robots, fleet=plan.fleet._replace(inventories=own))
