"""The lines of made parameter files that set what a node puts before names of the description.

Such a prefix must have the robot's name where the description's names have it: it adds nothing twice.
"""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.companions.params.known_nodes import PREFIX_KINDS, KnownNodes
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.parameter_files import given_nodes
from multibot_rewrite.evidence.records import Place
from multibot_rewrite.fleets.output_values import OutputText


def prefix_lines(files: Iterable[OutputText], known: KnownNodes) -> frozenset[Place]:
    """The places, by the paths of the output, in the files of one robot."""
    documents = [read_yaml(it.text.encode(), it.path) for it in files if PARAMETERS in it.text]
    return frozenset(
        given.place
        for node in given_nodes(documents, known)
        if node.known in known.nodes
        for name, given in node.values.items()
        if (param := known.nodes[node.known].params.get(name)) and param.kind in PREFIX_KINDS
    )
