"""Names and remappings of one robot's nodes, for launch files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.arguments import checked
from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.records import NodeFacts, NodeTable, Table
from multibot_rewrite.remap.yaml_with_lines import unknown

Rules = list[tuple[str, str]]


class NodeNames(NamedTuple):
    """Names and remappings of a robot's nodes, by their names in the stacks.

    ``hosted`` maps a node to those that always run in its process, as costmaps do.
    """

    robot: str
    nodes: Mapping[str, NodeTable]
    hosted: Mapping[str, tuple[str, ...]]

    @checked
    def for_node(self, node: str) -> Rules:
        """The node's remappings, as ``launch_ros.actions.Node`` takes them.

        Rules for nodes that it hosts come first: rcl applies the first rule that matches. Raises
        UsageError for a node that no stack of the fleet has.
        """
        own = self._found(node)
        rules = [
            (f"{self.nodes[it].name}:{rule.source}", rule.target)
            for it in self.hosted.get(node, ())
            for rule in self.nodes[it].rules
        ]
        return [*rules, *((rule.source, rule.target) for rule in own.rules)]

    @checked
    def name(self, node: str) -> str:
        """The name the node runs under, without its namespace; raises as ``for_node``."""
        return self._found(node).name

    @checked
    def namespace(self, node: str) -> str:
        """The namespace the node runs in, from the root; raises as ``for_node``."""
        return self._found(node).namespace

    @checked
    def full_name(self, node: str) -> str:
        """The node's name with its namespace; raises as ``for_node``."""
        return f"{self.namespace(node).rstrip('/')}/{self.name(node)}"

    def _found(self, node: str) -> NodeTable:
        if node in self.nodes:
            return self.nodes[node]
        where = f"robot {self.robot!r}" if self.robot else "nodes for all robots"
        hint = "add its stack to stack: in the fleet file"
        raise UsageError(f"{where}: {unknown('node', node, self.nodes)}; {hint}")


def names_of(table: Table, facts: Iterable[NodeFacts], robot: str) -> NodeNames:
    """The nodes of one robot in a fleet's table; of those for all robots if it is empty."""
    nodes: dict[str, NodeTable] = {}
    for it in table.nodes:
        if it.robot == robot:
            nodes.setdefault(it.node, it)
    hosted: dict[str, tuple[str, ...]] = {}
    for fact in facts:
        if fact.host in nodes and fact.name in nodes:
            hosted[fact.host] = (*hosted.get(fact.host, ()), fact.name)
    return NodeNames(robot, nodes, hosted)
