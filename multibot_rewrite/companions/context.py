"""What a companion file is rewritten with: the same for every robot of one description."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.companions.names.rename_map import RenameMap
from multibot_rewrite.companions.template import NAMESPACE_SLOT, TAG_SLOT, FileTemplate
from multibot_rewrite.model import Finding
from multibot_rewrite.naming import Naming
from multibot_rewrite.remap.records import NodeFacts
from multibot_rewrite.remap.table import placed
from multibot_rewrite.rewriters.forms import Declared

JAZZY, KILTED = "jazzy", "kilted"


class Context(NamedTuple):
    """``names`` spells links, joints and frames, ``topics`` the names of the ROS graph, both with a
    hole for the robot. ``nodes`` maps the stack's name of a node to the full name it runs under;
    nodes that one runs of for all robots keep theirs. ``distro`` is the ROS release.
    """

    names: RenameMap
    topics: RenameMap
    nodes: Mapping[str, str]
    distro: str = JAZZY


class Companion(NamedTuple):
    """A companion file ready for any number of robots, and what a person should know about it."""

    template: FileTemplate
    findings: tuple[Finding, ...]


def make_context(
    declared: Declared, naming: Naming, facts: Iterable[NodeFacts], distro: str = JAZZY
) -> Context:
    """The context of a description (not rewritten) and the nodes that its robots run."""
    nodes = {it.name: f"/{it.name}" if it.shared else full_name(it.name, naming) for it in facts}
    names, topics = (RenameMap(declared, naming, hole) for hole in (TAG_SLOT, NAMESPACE_SLOT))
    return Context(names, topics, nodes, distro)


def full_name(node: str, naming: Naming) -> str:
    """The full name that a robot's node runs under, with a hole for the robot."""
    namespace, name = placed(NAMESPACE_SLOT, node, naming)
    return f"{namespace.rstrip('/')}/{name}"
