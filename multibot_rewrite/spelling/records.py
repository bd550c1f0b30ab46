# SPDX-License-Identifier: Apache-2.0
"""Records of the remap table: remap rules, and the names that they lead to."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import TypeAlias

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts


class Home(NamedTuple):
    """Where a node runs if not in a process of its own: ``host``, ``container`` and ``plugin`` as in
    ``NodeFacts``, ``apart`` and ``of_hardware``; ``host_name`` is what its host is called. ``written``
    is true for a plugin of a description, ``process_wide`` if its rules hold for its whole process."""

    host: str = ""
    container: str = ""
    plugin: str = ""
    written: bool = False
    process_wide: bool = False
    apart: bool = False
    of_hardware: bool = False
    host_name: str = ""

    @property
    def is_controller(self) -> bool:
        """As in ``NodeFacts``."""
        return self.host == MANAGER and not self.of_hardware


class NodeRule(NamedTuple):
    """One remap rule of one robot's node, as rcl takes it: ``source:=target``.

    ``node`` is its name in the stack, without the robot; ``kind`` is the kind of name that it is for,
    empty if that is not known; ``why`` says what would go wrong without it.
    """

    robot: str
    node: str
    source: str
    target: str
    kind: str
    why: str


class EndpointName(NamedTuple):
    """An endpoint of a robot's node, and its name with the remap rules.

    ``node`` and ``name`` are absolute.
    """

    robot: str
    node: str
    endpoint: Endpoint
    name: str


class NodeTable(NamedTuple):
    """One node of one robot: its namespace, its name, its rules in order, and where it runs."""

    robot: str
    node: str
    namespace: str
    name: str
    rules: tuple[NodeRule, ...]
    home: Home = Home()

    @property
    def full_name(self) -> str:
        """Namespace and name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def code_name(self) -> str:
        """The name in its code."""
        return self.node.rpartition("/")[2]

    @property
    def other_name(self) -> str:
        """Its name if it is another than that in its code, else empty."""
        return self.name if self.name != self.code_name else ""


# Nodes with their tables.
Pairs: TypeAlias = Sequence[tuple[NodeFacts, NodeTable]]


class Table(NamedTuple):
    """The remap table of a fleet for a release of ROS, and what it cannot do or does wrongly."""

    layout: str
    nodes: tuple[NodeTable, ...]
    names: tuple[EndpointName, ...]
    problems: tuple[Finding, ...]
    release: str

    def by_robot(self, robots: Iterable[str]) -> dict[str, Table]:
        """Return the nodes and names of each of the robots as a table without problems."""
        nodes: dict[str, list[NodeTable]] = defaultdict(list)
        names: dict[str, list[EndpointName]] = defaultdict(list)
        for node in self.nodes:
            nodes[node.robot].append(node)
        for name in self.names:
            names[name.robot].append(name)
        return {
            it: self._replace(nodes=tuple(nodes[it]), names=tuple(names[it]), problems=())
            for it in robots
        }
