"""What nodes put before names themselves, by their parameters.

A prefix of joints must have the robot's name where the description's names have it: it adds nothing
twice. Where frames are named at run time, those of nodes with a prefix of frames stay bare.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.naming import Naming
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.fleet.outputs.output_values import OutputText
from multibot_rewrite.knowledge.parameter_entries import PREFIX_KINDS, RUN_TIME
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.evidence.records import GivenNode
from multibot_rewrite.system.records import Place


def at_run_time(naming: Naming, given: Iterable[GivenNode], known: KnownNodes) -> frozenset[str]:
    """The nodes that put the robot's name before their frames, by their files and launch files."""
    if not naming.layout.at_run_time:
        return frozenset()
    return frozenset(
        node.name.rpartition("/")[2]
        for node in given
        if node.known in known.nodes and any(_prefixes(known, node))
    )


def _prefixes(known: KnownNodes, node: GivenNode) -> Iterator[str]:
    params = known.nodes[node.known].params
    for name, given in node.values.items():
        if given.value and name in params and params[name].kind in RUN_TIME:
            yield name


def prefix_lines(
    files: Iterable[OutputText], known: KnownNodes, bare: frozenset[str]
) -> frozenset[Place]:
    """The lines, by the paths of the output, of what a node puts before names, of what is no name of a
    robot, and of the frames of ``bare`` nodes, in the files of one robot."""
    documents = [read_yaml(it.text.encode(), it.path) for it in files if PARAMETERS in it.text]
    return frozenset(
        given.place
        for node in given_nodes(documents, known)
        if node.known in known.nodes
        for name, given in node.values.items()
        if (param := known.nodes[node.known].params.get(name))
        and (
            param.kind in (*PREFIX_KINDS, "keep")
            or (param.kind == "frame" and node.name.rpartition("/")[2] in bare)
        )
    )
