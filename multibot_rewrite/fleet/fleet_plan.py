# SPDX-License-Identifier: Apache-2.0
"""A fleet file -> its rewritten robots and their remap table; all output follows from these."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import Sources
from multibot_rewrite.fleet.file.shape import placed, with_shape
from multibot_rewrite.fleet.file.simulator_switch import with_own_arguments
from multibot_rewrite.fleet.fleet import Fleet, assemble, merge
from multibot_rewrite.fleet.launch.launched_files import (
    with_bridge_namespaces,
    with_launched_files,
    with_one_map,
)
from multibot_rewrite.fleet.launch.launched_simulator import nodes_of_world, with_launched_world
from multibot_rewrite.fleet.outputs.controller_files import with_loaded_files
from multibot_rewrite.fleet.outputs.relays import with_relays
from multibot_rewrite.fleet.robots.rewritten_robots import (
    Jobs,
    RewrittenRobot,
    read_jobs,
    rewrite_robots,
    with_own_ports,
)
from multibot_rewrite.fleet.robots.robot_nodes import (
    NodeSources,
    RobotEvidence,
    check_shared,
    node_sources,
    robot_nodes,
)
from multibot_rewrite.fleet.robots.simulators import (
    may_be_real,
    note,
    with_model,
    without_world_systems,
)
from multibot_rewrite.planning.plan import words_of


class FleetPlan(NamedTuple):
    """A fleet file, its rewritten robots and their fleet; ``jobs`` are the descriptions as read.

    ``evidence`` is what the robots' own files say of their nodes."""

    file: FleetFile
    robots: tuple[RewrittenRobot, ...]
    fleet: Fleet
    jobs: Mapping[Sources, Jobs]
    evidence: Mapping[NodeSources, RobotEvidence]

    def evidence_of(self, robot: RewrittenRobot) -> RobotEvidence:
        """Return what one robot's own files say of its nodes."""
        return self.evidence[node_sources(robot.spec)]

    @property
    def launched_words(self) -> tuple[str, ...]:
        """Return the arguments of all that launch files start."""
        return tuple(word for it in self.evidence.values() for word in it.arguments)

    @property
    def of_rewrites(self) -> list[Finding]:
        """The findings of the rewrites, without those that the fleet reports at the same line."""
        told = {(it.code, it.file, it.line) for it in self.fleet.table.problems}
        every = (it for robot in self.robots for it in robot.findings)
        return [it for it in every if (it.code, it.file, it.line) not in told]

    @property
    def words(self) -> dict[str, str]:
        """The names, prefixes and postfixes of robots, each with the robot's name."""
        specs = (it.spec for it in self.robots)
        return words_of({it.name: (it.namespace, it.tag, it.model) for it in specs})


def make_plan(
    file: FleetFile, jobs: Mapping[Sources, Jobs] | None = None, trust: bool = False
) -> FleetPlan:
    """Rewrite every robot's description and make the table of the whole fleet.

    The parameter files that launch files and descriptions name are rewritten, too.

    ``jobs`` are the descriptions if they have been read already; ``trust`` lets xacro files do
    anything, and launch files run. Raises as ``rewrite_all``, and UsageError for an unknown node
    set."""
    joined: Mapping[str, Sequence[Finding]] = {}
    if any(it.parts for it in file.robots):
        from multibot_rewrite.fleet.robots.joined_robots import with_joined  # few are joined

        file, joined = with_joined(file, trust)
    file, notes = with_launched_files(_with_trust(with_shape(file)) if trust else with_shape(file))
    file = with_launched_world(with_one_map(with_bridge_namespaces(file)))
    with gc_paused():
        naming = make_naming(**file.policy)
        said: Mapping[str, Sequence[Finding]] = {}
        if jobs is None:
            file, said = with_own_arguments(file, naming, trust)
        read = jobs or read_jobs(file.robots, naming, file.definitions, trust, file.distro)
        robots = [
            with_model(
                placed(with_loaded_files(it._replace(findings=(*it.findings, *own))), file.shape)
            )
            for it in without_world_systems(with_own_ports(rewrite_robots(file.robots, read)))
            for own in [(*said.get(it.spec.name, ()), *joined.get(it.spec.name, ()))]
        ]
        file = file._replace(robots=tuple(it.spec for it in robots))
        evidence, maybe = _evidence(file, robots, notes)
        fleet = _joined_fleet(file, robots, naming, evidence)._replace(maybe_real=maybe)
        told = ((it.spec.namespace, it.spec.use_sim_time) for it in robots)
        clocks = tuple((name, clock) for name, clock in told if clock is not None)
        models = {it.spec.namespace: it.spec.model for it in robots}
        by_nodes = frozenset(
            it.spec.namespace for it in robots if evidence[node_sources(it.spec)].is_placed
        )
        fleet = fleet._replace(clocks=clocks, apart=file.apart, models=models, placed=by_nodes)
        table = fleet.table._replace(runs=(*fleet.table.runs, *nodes_of_world(file)))
        fleet = with_relays(fleet._replace(table=table), file)
        return FleetPlan(file, tuple(robots), fleet, read, evidence)


def _evidence(
    file: FleetFile, robots: Sequence[RewrittenRobot], notes: Mapping[str, Sequence[Finding]]
) -> tuple[dict[NodeSources, RobotEvidence], frozenset[str]]:
    """Return what files say of the nodes of each kind of robot; and namespaces that may be real."""
    specs = {node_sources(it): it for it in reversed(file.robots)}
    first = {node_sources(it.spec): it for it in reversed(robots)}
    found = {
        key: robot_nodes(spec, file, notes[spec.name], first[key].member, first[key].names.in_full)
        for key, spec in specs.items()
    }
    nodes = [node.name for it in found.values() for node in it.nodes]
    processes = [one.name for it in found.values() for one in it.processes]
    check_shared(file, dict.fromkeys((*nodes, *processes)))
    real = [it for it in robots if may_be_real(it, found[node_sources(it.spec)])]
    for it in real[:1]:
        key = node_sources(it.spec)
        found[key] = found[key]._replace(findings=(*found[key].findings, note(it)))
    return found, frozenset(it.spec.namespace for it in real)


def _with_trust(file: FleetFile) -> FleetFile:
    robots = (
        it._replace(launch=tuple(order._replace(trusted=True) for order in it.launch))
        for it in file.robots
    )
    return file._replace(robots=tuple(robots))


def _joined_fleet(
    file: FleetFile,
    robots: Sequence[RewrittenRobot],
    naming: Naming,
    evidence: Mapping[NodeSources, RobotEvidence],
) -> Fleet:
    """Return one fleet of robots that run different nodes, with the findings about them."""
    fleets: list[Fleet] = []
    notes: list[Finding] = []
    for key, group in lists_by_key((node_sources(it.spec), it.member) for it in robots).items():
        found = evidence[key]
        fleets.append(assemble(group, found.nodes, naming, file.distro, found.given))
        notes += found.findings
    fleet = merge(fleets)
    problems = tuple(dict.fromkeys((*fleet.table.problems, *notes)))
    return fleet._replace(table=fleet.table._replace(problems=problems))
