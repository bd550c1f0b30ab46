"""The nodes that a robot of a fleet file runs: its stacks, as its own files have them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.companions.params.known_nodes import load_known_nodes
from multibot_rewrite.evidence.nodes import RobotNodes, nodes_of
from multibot_rewrite.evidence.parameter_files import given_nodes
from multibot_rewrite.fleets.fleet import facts_of
from multibot_rewrite.fleets.fleet_file import FleetFile, RobotSpec
from multibot_rewrite.fleets.output_file import yaml_of
from multibot_rewrite.remap.node_library import NodeLibrary
from multibot_rewrite.remap.records import NodeFacts
from multibot_rewrite.remap.stacks import built_in, user_stack

# What decides the nodes of a robot.
NodeSources = tuple[tuple[str, ...], tuple[str, ...]]


def node_sources(spec: RobotSpec) -> NodeSources:
    """Robots for which this is equal run the same nodes."""
    return spec.stacks, spec.companions.get("params", ())


def robot_nodes(spec: RobotSpec, file: FleetFile) -> RobotNodes:
    """The nodes of a robot. Raises InputError for a parameter file that cannot be read."""
    known = load_known_nodes(file.parameters, file.distro)
    documents = [yaml_of(path) for path in spec.companions.get("params", ())]
    return nodes_of(stack_nodes(spec, file), given_nodes(documents, known), library_of(file).nodes)


def library_of(file: FleetFile) -> NodeLibrary:
    """The nodes and stacks that a fleet file knows."""
    return user_stack(file.nodes, file.distro) if file.nodes else built_in(file.distro)


def stack_nodes(spec: RobotSpec, file: FleetFile) -> tuple[NodeFacts, ...]:
    """The nodes of a robot's stacks, as their usual files have them."""
    return facts_of(spec.stacks, file.nodes or None, file.distro)


def companion_nodes(nodes: Sequence[NodeFacts], stack: Sequence[NodeFacts]) -> Iterator[NodeFacts]:
    """The nodes for which companion files are rewritten, with the names of their code: those in
    parameters are what is rewritten."""
    bare: Mapping[str, NodeFacts] = {it.name: it for it in stack}
    yield from (bare.get(it.name, it) for it in nodes if it.name in bare or it.host)
