# SPDX-License-Identifier: Apache-2.0
"""Makes the plan of a fleet file or of robots, with what is wrong in them and between them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from typing import Any

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.naming import Policy, make_naming
from multibot_rewrite.checks.described import wrong_in_descriptions
from multibot_rewrite.checks.meeting import (
    declared_twice,
    other_manager,
    robots_meet,
    shared_by_nothing,
)
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
from multibot_rewrite.fleet.outputs.bridge_outputs import given_once
from multibot_rewrite.fleet.robots.member import Member, is_for_simulator, member
from multibot_rewrite.fleet.robots.rewritten_robots import Jobs
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.fleet.robots.simulators import is_said, is_simulated
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.bridged_topics import bridged_as, bridged_topics
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.way_checks import UNREACHABLE_NAME
from multibot_rewrite.producers.evidence.hardware import with_hardware
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.rules.declaration import at
from multibot_rewrite.rules.launch.started import (
    bond_message,
    is_managed,
    keeps_no_bond,
    moves_nothing,
    no_joints,
    not_listed,
)


def plan_fleet(
    file: FleetFile, jobs: Mapping[Sources, Jobs] | None = None, trust: bool = False
) -> FleetPlan:
    """Return the plan of a fleet file with all problems of its table; raises as ``make_plan``."""
    plan = make_plan(file, jobs, trust)
    if topics := given_once(plan):
        shared = (*file.policy.get("shared_topics", SHARED_TOPICS), *topics)
        file = file._replace(policy={**file.policy, "shared_topics": shared})
        plan = make_plan(file, None, trust)
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


def left_idle(
    nodes: Sequence[NodeFacts], given: Iterable[Run], known: Mapping[str, NodeFacts]
) -> Iterator[Finding]:
    """Yield findings about nodes that start and do nothing, by the robot's own parameter files."""
    own = {it.node: it for it in given}
    yield from _unlisted(nodes, own)
    yield from _without_bond(nodes, own)
    running = {it.name for it in nodes if not it.when}
    for it in own.values():
        facts = known.get(it.fact.known)
        if it.host_name and it.node in running and facts and moves_nothing(facts, it):
            message = f"controller {it.node} gets no parameter that names a joint"
            yield at(
                no_joints, it.place, message, "write them into a section of its name", level=WARNING
            )


def _unlisted(nodes: Sequence[NodeFacts], own: Mapping[str, Run]) -> Iterator[Finding]:
    """Report managed nodes that no lifecycle manager lists, if a file has the list."""
    managers = [it for it in nodes if it.kind == LIFECYCLE_MANAGER]
    place = next((own[it.name].place for it in managers if it.name in own), None)
    listed = _listed_nodes(managers)
    for it in nodes if place else ():
        idle = is_managed(it.kind) and it.name not in listed and not (it.when or it.shared)
        if idle and place:
            message = f"{it.name} is in the list of no lifecycle manager"
            yield at(not_listed, place, message, "add it to node_names", level=WARNING)


def _without_bond(nodes: Sequence[NodeFacts], own: Mapping[str, Run]) -> Iterator[Finding]:
    """Report nodes that keep no bond with the manager that lists them, if a file has the list."""
    for manager in (it for it in nodes if it.kind == LIFECYCLE_MANAGER and it.name in own):
        given, listed = own[manager.name], _listed_nodes([manager])
        timeout = given.values.get("bond_timeout")
        for it in nodes if timeout is None or timeout.value != 0 else ():
            if it.name in listed and keeps_no_bond(it):
                said = bond_message(manager.name, it.name)
                yield at(not_listed, given.place, *said, level=WARNING)


def _listed_nodes(managers: Sequence[NodeFacts]) -> Set[str]:
    """Return the nodes whose services managers call."""
    return {end.name.strip("/").partition("/")[0] for it in managers for end in it.endpoints}
