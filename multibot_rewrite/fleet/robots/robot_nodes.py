"""The nodes that a robot of a fleet file runs: its stacks, as its own files have them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.file.fleet_file import FleetFile, RobotSpec, Sources
from multibot_rewrite.fleet.fleet import facts_of, known_nodes
from multibot_rewrite.fleet.launch.launched_robot import (
    given_with,
    launched_robot,
    nodes_with,
    under_plugins,
)
from multibot_rewrite.fleet.outputs.output_file import params_of
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.fleet.robots.shared_nodes import apart
from multibot_rewrite.knowledge.nodl.facts import declared
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.records import MANAGER, NodeFacts
from multibot_rewrite.producers.evidence.hardware import with_hardware
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.evidence.records import GivenNode
from multibot_rewrite.producers.launch.of_robot import without_robot
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.producers.launch.spawners import Spawned

MOVE_GROUP, WORLD = "move_group", "world"
# What decides the nodes of a robot.
NodeSources = tuple[tuple[str, ...], tuple[str, ...], tuple[LaunchOrder, ...], str, str, Sources]


def node_sources(spec: RobotSpec) -> NodeSources:
    """Robots for which this is equal run the same nodes."""
    params = spec.companions.get("params", ())
    return spec.stacks, params, spec.launch, spec.srdf, spec.simulator, spec.sources


class RobotEvidence(NamedTuple):
    """What a robot's files set for nodes, the nodes that are known by name, those that it runs,
    where its files and stacks disagree, the controllers that its launch files spawn, whether these
    start all of its nodes and no simulator, and the arguments of all that they start."""

    given: tuple[GivenNode, ...]
    known: Mapping[str, NodeFacts]
    nodes: tuple[NodeFacts, ...]
    findings: tuple[Finding, ...]
    spawned: Mapping[str, Spawned]
    unsimulated: bool = False
    arguments: tuple[str, ...] = ()


def robot_nodes(
    spec: RobotSpec, file: FleetFile, notes: Sequence[Finding], member: Member
) -> RobotEvidence:
    """The nodes of a robot with this description; ``notes`` are findings about its files.

    Raises InputError for a parameter file that cannot be read.
    """
    parameters = load_known_nodes(file.nodes, file.distro)
    read = given_nodes(params_of(spec).values(), parameters)
    own = tuple(without_robot(it, spec.words) for it in read)
    known, stack = _known(own, file), stack_nodes(spec, file)
    launched = launched_robot(stack, spec.launch, known, spec.words, parameters, file.distro)
    given = given_with(launched, own)
    spawned = launched.spawned if launched else {}
    without, findings = nodes_with(launched, stack, given, known)
    source = member.source
    standing = _standing(without, given) if _is_mounted(source.root) else without
    wired = under_plugins(standing, launched, member.handed_on, file.distro)
    nodes = with_hardware(wired, source.root, source.file, known)
    whole = launched is not None and launched.whole
    nodes = nodes if whole else (*nodes, *_of_srdf(spec, nodes, known))
    marked, shared = apart(nodes, file)
    unsimulated = launched is not None and launched.whole and not launched.simulated
    said = (*notes, *findings, *shared)
    started = launched.started.values() if launched else ()
    arguments = tuple(word for it in started for word in it.arguments)
    return RobotEvidence(given, known, marked, said, spawned, unsimulated, arguments)


def _is_mounted(root: _Element) -> bool:
    """Does a joint hold the robot on its link world?"""
    joints = root.iterfind("joint[@type='fixed']/parent")
    return any(it.get("link") == WORLD for it in joints)


def _standing(nodes: Iterable[NodeFacts], given: Iterable[GivenNode]) -> tuple[NodeFacts, ...]:
    """The nodes without controllers of wheels that a stack has for robots that drive."""
    named = {it.name for it in given}
    return tuple(
        it for it in nodes if it.name in named or not (it.host == MANAGER and it.when and it.sends)
    )


def _of_srdf(
    spec: RobotSpec, nodes: Iterable[NodeFacts], known: Mapping[str, NodeFacts]
) -> Iterator[NodeFacts]:
    """The node that reads an SRDF may run, where neither a stack nor a launch file says so."""
    if spec.srdf and MOVE_GROUP not in {it.known or it.name for it in nodes}:
        file = os.path.basename(spec.srdf)
        yield known[MOVE_GROUP]._replace(when=f"its SRDF is {file}", origin=f"{spec.srdf}:1")


def _known(given: Iterable[GivenNode], file: FleetFile) -> dict[str, NodeFacts]:
    """The known nodes; those that the robot's files name as their installed packages declare them."""
    facts = known_nodes(file.nodes, file.distro, file.nodl)
    nodes = dict(facts.library.nodes)
    named = {it.known for it in given} & nodes.keys()
    return nodes | {name: declared(facts, nodes[name]) for name in named}


def stack_nodes(spec: RobotSpec, file: FleetFile) -> tuple[NodeFacts, ...]:
    """The nodes of a robot's stacks, as their usual files have them."""
    return facts_of(spec.stacks, file.nodes or None, file.distro, file.nodl)


def companion_nodes(nodes: Sequence[NodeFacts], stack: Sequence[NodeFacts]) -> Iterator[NodeFacts]:
    """The nodes for which companion files are rewritten, with the names of their code: those in
    parameters are what is rewritten."""
    bare: Mapping[str, NodeFacts] = {it.name: it for it in stack}
    # A section for a node in a namespace below the robot's is known to be right if the node runs there.
    mine = (it for it in nodes if it.name in bare or it.host or "/" in it.name)
    yield from (bare.get(it.name, it) for it in mine)
