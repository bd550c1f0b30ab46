# SPDX-License-Identifier: Apache-2.0
"""Names and remappings of one robot's nodes, for launch files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.ways import Started, launch_arguments, started
from multibot_rewrite.system.records import CALLS, COMPONENT, SPAWNER

# What a lifecycle manager calls of each node that it manages (nav2_util lifecycle_service_client.cpp).
CHANGE_STATE = "change_state"
Rules = list[tuple[str, str]]
SPAWNED = "is a controller: its spawner takes its remappings, robot.spawner({node!r})"


class NodeNames(NamedTuple):
    """Names and remappings of a robot's nodes, by their names in the node sets.

    ``started`` is what is started for the nodes, with all rules that it takes; ``managed`` are the
    nodes whose life cycle each of them manages, in their order.
    """

    robot: str
    nodes: Mapping[str, Run]
    started: Mapping[str, Started]
    managed: Mapping[str, tuple[str, ...]]

    @checked
    def for_node(self, node: str) -> Rules:
        """Return the node's remap rules as launch_ros takes them; those of other nodes come first.

        rcl applies the first rule that matches. Raises UsageError for a node that no node set of
        the fleet has, and for a controller."""
        own = self._node_of(node)
        it = self.started.get(node)
        if it is None:
            return list(own.rules)
        if it.way == SPAWNER:
            raise UsageError(f"node {node!r} {SPAWNED.format(node=node)}")
        return list(it.rules)

    @checked
    def spawner(self, node: str) -> dict[str, Any]:
        """Return what launch_ros's ``Node`` takes to load a controller; or raises UsageError."""
        self._node_of(node)
        it = self.started.get(node)
        if it is None or it.way != SPAWNER:
            controllers = [name for name, it in self.started.items() if it.way == SPAWNER]
            raise UsageError(f"{unknown('controller', node, controllers)}")
        return launch_arguments(it)

    def is_controller(self, node: str) -> bool:
        """Return whether this node is a controller, which a spawner loads. Raises nothing."""
        return node in self.started and self.started[node].way == SPAWNER

    def container(self, node: str) -> str:
        """Return the full name of the container of this node, empty for other nodes; raises nothing."""
        it = self.started.get(node)
        return self.full_name(it.node.fact.container) if it and it.way == COMPONENT else ""

    def inside(self, node: str) -> list[str]:
        """Return the other nodes in this one's process: costmaps, components; raises nothing."""
        homes = {it.node: it.fact.host or it.fact.container for it in self.nodes.values()}
        found = []
        for name in homes:
            # The nodes whose process this one is in, nearest first.
            above = homes.get(name, "")
            while above and above != node:
                above = homes.get(above, "")
            found += [name] if above else []
        return found

    @checked
    def name(self, node: str) -> str:
        """Return the name the node runs under, without its namespace; raises as ``for_node``."""
        return self._node_of(node).name

    @checked
    def namespace(self, node: str) -> str:
        """Return the namespace the node runs in, from the root; raises as ``for_node``."""
        return self._node_of(node).namespace

    @checked
    def full_name(self, node: str) -> str:
        """Return the node's name with its namespace; raises as ``for_node``."""
        return f"{self.namespace(node).rstrip('/')}/{self.name(node)}"

    def _node_of(self, node: str) -> Run:
        if node in self.nodes:
            return self.nodes[node]
        where = f"robot {self.robot!r}" if self.robot else "nodes for all robots"
        hint = "add its node set to node_sets: in the fleet file"
        raise UsageError(f"{where}: {unknown('node', node, self.nodes)}; {hint}")


def names_of(table: Table, robot: str) -> NodeNames:
    """Return the nodes of one robot in a fleet's table; of those for all robots if it is empty."""
    nodes: dict[str, Run] = {}
    own = [it for it in table.runs if it.robot == robot]
    for it in own:
        nodes.setdefault(it.node, it)
    found = started(table._replace(runs=tuple(own)))
    managed = {}
    for it in own:
        called = (end.name.rpartition("/") for end, _ in it.names if end.role == CALLS)
        managed[it.node] = tuple(name for name, _, last in called if last == CHANGE_STATE)
    return NodeNames(robot, nodes, {it.node.node: it for it in found}, managed)
