# SPDX-License-Identifier: Apache-2.0
"""Robots that share everything but their names: what they have in common is read and planned once."""

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import grouped
from multibot_rewrite.base.grouping import dicts_by_key, lists_by_key
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.world_file import names_of_world
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_nodes import (
    launched_nodes,
    node_sources,
    nodes_of_sets,
    related_file_nodes,
)
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.related_files.context import Context, make_context


class RobotGroup(NamedTuple):
    """Robots of one description, with the same nodes and related files."""

    robots: tuple[RewrittenRobot, ...]
    facts: tuple[NodeFacts, ...]
    context: Context

    @property
    def related_files(self) -> dict[str, tuple[str, ...]]:
        """The related files that all robots of the group have, by kind."""
        return dict(self.robots[0].spec.related_files)


def group_robots(plan: FleetPlan) -> Iterator[RobotGroup]:
    """Yield the groups of a fleet, in the order of their first robots."""
    has_bridge = any(it.spec.related_files.get("bridge") for it in plan.robots)
    of_world = names_of_world(plan.file.simulator_world if has_bridge else "", plan.robots)
    for robots in lists_by_key((_key(it.spec), it) for it in plan.robots).values():
        spec = robots[0].spec
        evidence = plan.evidence_of(robots[0])
        facts = tuple(related_file_nodes(evidence.nodes, nodes_of_sets(spec, plan.file)))
        declared, naming, _, own, words, given = robots[0].names
        context = make_context(declared, naming, facts, plan.file.distro, own, words, given)
        others = launched_nodes(evidence, facts)
        every = (*facts, *others)
        context = context._replace(frames=evidence.frames, of_world=of_world)
        yield RobotGroup(tuple(robots), every, context)


def _key(spec: RobotSpec) -> object:
    """Return a key; robots with equal keys have the same files."""
    return node_sources(spec), tuple(spec.related_files.items()), spec.use_sim_time


def split_per_robot(plan: FleetPlan) -> Iterator[FleetPlan]:
    """Yield each robot as a fleet of its own, so that steps about one need not search all others."""
    fleet = plan.fleet
    tables = fleet.table.by_robot(it.spec.namespace for it in plan.robots)
    edges = dicts_by_key((key[0], key, sent) for key, sent in fleet.edges.items())
    for robot in plan.robots:
        own = robot.spec.namespace
        alone = fleet._replace(table=tables[own], edges=edges[own])
        yield plan._replace(robots=(robot,), fleet=alone)


def said_once(plan: FleetPlan, findings: Iterable[Finding]) -> list[Finding]:
    """Return findings sorted by place, equal ones of many robots as one."""
    specs = [it.spec for it in plan.robots]
    ordered = sorted(
        set(findings), key=lambda it: (it.file, it.line, it.column, it.code, it.message, it)
    )
    # Lines of robots in the fleet file: that they differ is no difference. One for several tells none.
    count = Counter((it.file, it.line) for it in specs)
    names = {key: it.name for it in specs if count[key := (it.file, it.line)] == 1}
    lines = {name: line for (_, line), name in names.items()}
    alike = []
    for it in ordered:
        robot = names.get((it.file, it.line), "")
        alike.append(it._replace(robot=robot, line=0) if robot else it)
    return [
        it._replace(robot="", robots=it.robots or (it.robot,), line=lines[it.robot])
        if it.robot
        else it
        for it in grouped(alike, plan.words)
    ]
