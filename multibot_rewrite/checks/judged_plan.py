# SPDX-License-Identifier: Apache-2.0
"""Makes the plan of a fleet file or of robots, with what is wrong between and in them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.naming import Policy, make_naming
from multibot_rewrite.checks.described import wrong_in_descriptions
from multibot_rewrite.checks.left_idle import left_idle
from multibot_rewrite.checks.meeting import robots_meet, shared_by_nothing
from multibot_rewrite.checks.named_twice import declared_twice, other_manager
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.sources.read import Source
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import Sources
from multibot_rewrite.fleet.fleet import NOTHING, Fleet, assemble, facts_of, known_nodes
from multibot_rewrite.fleet.fleet_plan import FleetPlan, make_plan
from multibot_rewrite.fleet.launch.launched_robot import (
    given_with,
    known_here,
    launched_robot,
    nodes_with,
    under_plugins,
)
from multibot_rewrite.fleet.robots.member import Member, is_for_simulator, member
from multibot_rewrite.fleet.robots.rewritten_robots import Jobs
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.fleet.robots.simulators import is_said, is_simulated
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.planning.bridged_topics import bridged_as, bridged_topics
from multibot_rewrite.planning.way_checks import UNREACHABLE_NAME
from multibot_rewrite.producers.evidence.hardware import with_hardware
from multibot_rewrite.producers.launch.records import LaunchOrder


def plan_fleet(
    file: FleetFile, jobs: Mapping[Sources, Jobs] | None = None, trust: bool = False
) -> FleetPlan:
    """Return the plan of a fleet file with all problems of its table; raises as ``make_plan``."""
    plan = make_plan(file, jobs, trust)
    with gc_paused():
        file, table, robots = plan.file, plan.fleet.table, plan.robots
        naming = plan.fleet.naming
        members = [it.member for it in robots]
        written = {it.spec.namespace: it.written for it in robots}
        domains = file.apart.numbers
        own_domains = [number for robot, number in domains.items() if robot]
        never_meet = bool(own_domains) and len({*own_domains}) == len(own_domains)
        named = (it._replace(robot=plan.fleet.name(it.robot)) for it in table.problems)
        met = (*named, *robots_meet(table, members, naming, written, domains))
        every = (it for it in met if it.code != UNREACHABLE_NAME.code or not never_meet)
        simulated = [it.member for it in robots if is_simulated(it)]
        said = [it.member for it in robots if is_said(it)]
        own = [it.member for it in robots if it.spec.launch]
        unplaced = [it.member for it in robots if not plan.evidence_of(it).placing]
        wrong = wrong_in_descriptions(members, file.definitions, simulated, said, own, unplaced)
        specs = {node_sources(it.spec): it.spec for it in robots}
        idle = [
            one
            for key, it in plan.evidence.items()
            if not specs[key].launch
            for one in left_idle(it.nodes, it.given, it.known)
        ]
        found = (
            *idle,
            *every,
            *declared_twice(robots, naming, met),
            *other_manager(robots, table),
            *wrong,
        )
        table = table._replace(problems=tuple(dict.fromkeys(found)))
        return plan._replace(fleet=plan.fleet._replace(table=table))


def make_fleet(
    source: Source,
    robots: Sequence[str],
    node_sets: Sequence[str],
    policy: Policy,
    *,
    nodes: str | None = None,
    nodl: Sequence[str] = (),
    definitions: Sequence[str] = (),
    xacro_args: Mapping[str, str] = NOTHING,
    trust: bool = False,
    launch: Sequence[LaunchOrder] = (),
    release: str,
) -> Fleet:
    """Rewrite a description for every robot and return the fleet with its table.

    An empty ``release`` is that which ``rewrite_all`` takes. ``nodes`` is a file with more nodes
    and node sets, ``nodl`` are NoDL files, see ``find_interfaces``; ``launch`` are the launch
    files that start each robot's nodes. Raises as ``rewrite_all``, and UsageError for an unknown
    node set."""
    how: dict[str, Any] = {
        "definitions": definitions,
        "xacro_args": xacro_args,
        "trust": trust,
        "distro": release,
    }
    found = list(rewrite_all(source, robots, **how, **policy))
    release = found[0].prepared.job.release
    library = known_nodes(nodes, release, nodl).library
    known = known_here(library.nodes, launch, robots[0], release)
    facts = facts_of(node_sets, nodes, release, nodl)
    usual = load_known_nodes(nodes or "", release)
    launched = launched_robot(facts, launch, known, robots[:1], usual, release)
    runs = nodes_with(launched, facts, given_with(launched, ()), known)
    members = [member(it, it.data, it.robot) for it in found]
    wired = under_plugins(runs.nodes, launched, members[0].handed_on, release)
    every = with_hardware(wired, members[0].source.root, members[0].source.file, known)
    fleet = assemble(members, every, make_naming(**policy), release)
    return _with_bridge_and_findings(fleet, members, tuple(definitions), runs.findings)


def _with_bridge_and_findings(
    fleet: Fleet,
    members: Sequence[Member],
    definitions: tuple[str, ...],
    findings: Iterable[Finding],
) -> Fleet:
    """Return the fleet with its robots' collisions, findings about their nodes, and bridged topics."""
    table = fleet.table
    met = dict.fromkeys(robots_meet(table, members, fleet.naming))
    simulated = filter(is_for_simulator, members)
    found = wrong_in_descriptions(members, definitions, simulated, members)
    # Nothing is started, and nothing says that they are simulated.
    wrong = (it._replace(level=WARNING) for it in found)
    table = table._replace(problems=(*table.problems, *met, *wrong, *findings))
    topics, _ = bridged_topics(fleet.inventories, fleet.naming, fleet.models, table.runs)
    own = topics if any(it.robot for it in topics) else ()
    gaps = tuple(shared_by_nothing(fleet))
    return fleet._replace(table=table, bridged=bridged_as(own), gaps=gaps)
