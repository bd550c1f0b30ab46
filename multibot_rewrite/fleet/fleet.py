# SPDX-License-Identifier: Apache-2.0
"""A description, its robots and their node sets -> the remap table and the expected graph."""

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.fleet.file.domains import TOGETHER, Apart
from multibot_rewrite.fleet.robots.member import Member, line_of
from multibot_rewrite.knowledge.node_library import with_included
from multibot_rewrite.knowledge.node_sets import built_in, user_library
from multibot_rewrite.knowledge.nodl.lookup import NodeKnowledge, find_interfaces, nodes_of
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.bridged_topics import AS_ROBOTS, Models
from multibot_rewrite.planning.domain_bridge import with_bridges
from multibot_rewrite.planning.plan import vacuous, words_of
from multibot_rewrite.planning.planned_system import expect, named_frames
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table, joined, plugin_nodes
from multibot_rewrite.planning.transforms import STATE_PUBLISHER, Edges, edges_of, frames_of
from multibot_rewrite.planning.ways import merged
from multibot_rewrite.producers.evidence.hardware import components
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import (
    NOT_KNOWN_PROCESS,
    NOT_READ,
    SIM_TIME,
    Edge,
    End,
    Origin,
    Parameter,
    Place,
    System,
    Topic,
)

NOTHING: Mapping[str, str] = {}
ALIKE: Mapping[str, Inventory] = {}
# The node set of a robot whose description is published by something else.
NO_STATE_PUBLISHER = f"no_{STATE_PUBLISHER}"
FRAME_PREFIX = "frame_prefix"


class Fleet(NamedTuple):
    """A fleet's remap table, the contents of each description, and the nodes' transforms.

    Robots are called by their namespaces: ``tags`` has the prefix or postfix where it differs,
    ``names`` the name. ``facts`` are the nodes of the node sets, ``read`` the files of
    descriptions, ``gaps`` what is open, ``bridged`` what a ros_gz_bridge has to bridge.
    ``maybe_real`` are robots of which nothing says that they are simulated, ``clocks`` the
    ``use_sim_time`` by robot, ``described`` the descriptions if the simulator gets another file,
    ``apart`` the domains, ``models`` the models' names if they differ. ``placed`` are robots
    with a node that sends the drive's transform, too, or on another topic."""

    table: Table
    inventories: dict[str, Inventory]
    naming: Naming
    edges: Edges
    facts: tuple[NodeFacts, ...]
    tags: dict[str, str]
    names: dict[str, str]
    read: tuple[str, ...]
    gaps: tuple[Finding, ...] = ()
    bridged: tuple[Topic, ...] = ()
    maybe_real: frozenset[str] = frozenset()
    clocks: tuple[tuple[str, bool], ...] = ()
    described: Mapping[str, Inventory] = ALIKE
    apart: Apart = TOGETHER
    models: Models = AS_ROBOTS
    placed: frozenset[str] = frozenset()

    @property
    def words(self) -> dict[str, str]:
        """The names, prefixes and postfixes of robots, each with the robot's name."""
        return words_of({self.name(it): (it, self.tags.get(it, it)) for it in self.inventories})

    def name(self, robot: str) -> str:
        """Return the name of the robot with this namespace."""
        return self.names.get(robot, robot)

    @property
    def named_table(self) -> Table:
        """The table with the robots by their names, for people."""
        runs = (it._replace(robot=self.name(it.robot)) for it in self.table.runs)
        return self.table._replace(runs=tuple(runs)) if self.names else self.table


def facts_of(
    node_sets: Sequence[str], nodes: str | None, release: str, nodl: Sequence[str] = ()
) -> tuple[NodeFacts, ...]:
    """Return the nodes of node sets, each once, and robot_state_publisher; raises UsageError."""
    # None is added for the node set ``no_robot_state_publisher``.
    known = known_nodes(nodes, release, nodl)
    library = known.library
    runs = {name: list(nodes_of(known, name)) for name in node_sets}
    named = {node: name for name in reversed(node_sets) for node in runs[name]}
    order = dict.fromkeys(node for name in node_sets for node in runs[name])
    # Without its folder: a plan is the same from every working directory.
    files = ((node, os.path.basename(node.interface)) for node in order)
    said = ((node, f", described in {file}" if file else "") for node, file in files)
    found = [node._replace(origin=Origin(f"{named[node]}{where}")) for node, where in said]
    has_publisher = any(node.package == STATE_PUBLISHER for node in found)
    if not any(NO_STATE_PUBLISHER in with_included(library, name) for name in node_sets):
        added = () if has_publisher else nodes_of(known, STATE_PUBLISHER)
        return (*found, *added)
    if has_publisher:
        hint = f"leave out one of the node sets, {NO_STATE_PUBLISHER} or the one that has it"
        raise UsageError(f"{STATE_PUBLISHER} is asked for and left out; {hint}")
    return tuple(found)


def known_nodes(nodes: str | None, release: str, nodl: Sequence[str]) -> NodeKnowledge:
    """Return what is known of nodes in a release: built in, by NoDL, in the user's file ``nodes``."""
    built = built_in(release)
    library = user_library(nodes, release) if nodes else built
    own = (name for name, node in library.nodes.items() if node != built.nodes.get(name))
    return NodeKnowledge(library, find_interfaces(nodl), frozenset(own))


def assemble(
    members: Sequence[Member],
    facts: tuple[NodeFacts, ...],
    naming: Naming,
    release: str,
    given: Sequence[Run] = (),
) -> Fleet:
    """Return the fleet of robots with the same nodes of a release and the parameters ``given``."""
    inventories = {it.robot: it.inventory for it in members}
    known = built_in(release).nodes
    plugins = {it.robot: [*_plugins(it), *_components(it, known)] for it in members}
    edges: dict[tuple[str, str], list[Edge]] = {}
    for it in members:
        own = [run.fact for run in plugins[it.robot]]
        edges |= edges_of(it.robot, it.described, facts, own, naming, it.tag, it.plain)
    robots = [it.robot for it in members]
    table = build_table(robots, facts, naming, plugins, given, release=release)
    unread = dict.fromkeys(found for it in members for found in it.unread)
    table = table._replace(problems=(*table.problems, *unread))
    return Fleet(
        table,
        inventories,
        naming,
        edges,
        facts,
        {it.robot: it.tag for it in members if it.tag != it.robot},
        {it.robot: it.name for it in members if it.name != it.robot},
        tuple(dict.fromkeys(path for it in members for path in it.read)),
        described={it.robot: it.described for it in members if it.described is not it.inventory},
    )


def _plugins(member: Member) -> list[Run]:
    """Return the plugins' nodes, placed in the source: inserted text moves the lines of the result."""
    runs, source = plugin_nodes(member.reading, member.robot), member.source
    lines = (line_of(source, "plugin", it.number) for it in member.reading.nodes)
    each = zip(runs, lines, strict=True)
    return [run._replace(place=Place(source.file, line)) for run, line in each]


def _components(member: Member, known: Mapping[str, NodeFacts]) -> Iterator[Run]:
    """Yield the nodes of a robot's hardware components, which the table puts next to their manager."""
    source = member.source
    written = components(member.inventory.document.root, source.file, known)
    for it, before in zip(written, components(source.root, source.file, known), strict=True):
        yield Run(member.robot, it.name, "/", it.name, (), it._replace(origin=before.origin))


def merge(fleets: Sequence[Fleet]) -> Fleet:
    """Return robots of different descriptions as one fleet; checks that no names collide."""
    first, *others = fleets
    for other in others:
        first = Fleet(
            joined(first.table, other.table),
            {**first.inventories, **other.inventories},
            first.naming,
            {**first.edges, **other.edges},
            tuple(dict.fromkeys((*first.facts, *other.facts))),
            {**first.tags, **other.tags},
            {**first.names, **other.names},
            tuple(dict.fromkeys((*first.read, *other.read))),
            described={**first.described, **other.described},
        )
    return first


def expected(fleet: Fleet) -> System:
    """Return the graph that the fleet should have; raises UsageError if any graph would fit."""
    plan = planned(fleet)
    nothing = vacuous(plan)
    if nothing:
        hint = f"name a node set of its nodes, or leave out {NO_STATE_PUBLISHER}"
        raise UsageError(f"{nothing}, so every graph would be as planned; {hint}")
    return plan


def planned(fleet: Fleet) -> System:
    """Return the graph that the fleet should have, even one that any graph fits."""
    sent: dict[str, list[Edge]] = {robot: [] for robot in fleet.inventories}
    for (robot, _), edges in fleet.edges.items():
        sent[robot] += edges
    frames = {
        robot: frames_of(found, sent[robot], fleet.naming, fleet.tags.get(robot, robot))
        for robot, found in {**fleet.inventories, **fleet.described}.items()
    }
    named = {robot: named_frames(found) for robot, found in fleet.inventories.items()}
    how = (fleet.table, fleet.naming, frames, named, fleet.tags, fleet.maybe_real)
    plan = expect(*how, fleet.names)
    # What could not be read of launch files: the nodes in it are not in the plan.
    asked = ((NOT_READ, WARNING), (NOT_KNOWN_PROCESS, NOTE))
    not_read = (it for it in fleet.table.problems if (it.code, it.level) in asked)
    # The transforms that nodes' parameters name.
    told = (
        edge._replace(publishers=(it.full_name,))
        for it in fleet.table.runs
        if it.fact.package != STATE_PUBLISHER
        for edge in fleet.edges.get((it.robot, it.node), ())
    )
    whole = plan._replace(
        edges=tuple(told),
        release=fleet.table.release,
        gaps=(*fleet.gaps, *not_read),
        topics=fleet.bridged,
        parameters=tuple(_parameters(fleet)),
        domains=fleet.apart.domains,
    )
    return with_bridges(whole, fleet.apart.crossing) if whole.domains else whole


def _parameters(fleet: Fleet) -> Iterator[Parameter]:
    """Yield the clock of a robot's own nodes, and the prefix for the frames of its description."""
    clocks = dict(fleet.clocks)
    for it in merged(fleet.table.runs):
        given: dict[str, object] = {}
        if it.robot in clocks and not (it.fact.plugin or it.fact.of_hardware):
            given[SIM_TIME] = clocks[it.robot]
        if it.robot and it.fact.package == STATE_PUBLISHER and fleet.naming.layout.at_run_time:
            given[FRAME_PREFIX] = f"{fleet.tags.get(it.robot, it.robot)}/"
        for name, value in given.items():
            yield Parameter(it.full_name, name, parameter_text(value))


def possible(fleet: Fleet) -> tuple[End, ...]:
    """Return every endpoint that the nodes may have, also by parameter."""
    return tuple(
        End(end.kind, end.role, name, end.type, node=run.full_name, code_name=end.name)
        for run, end, name in fleet.table.ends
        if end.role
    )
