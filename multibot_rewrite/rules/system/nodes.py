# SPDX-License-Identifier: Apache-2.0
"""Dangers of nodes: two of one name, two managers of one node."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.wording import SEVERAL, and_then, shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system.index import Index, nodes_of
from multibot_rewrite.system.records import SERVICE
from multibot_rewrite.system.tool_nodes import is_tool, is_viewer

# So many doubled nodes are two robots rather than two nodes.
MANY = 3
_CHANGE_STATE = "/change_state"


@system_rule("MG301", "nodes-of-one-name", ERROR)
def nodes_of_one_name(seen: Index) -> Iterator[Finding]:
    """Many of them are one finding: two robots."""
    times = seen.nodes
    twins = [name for name, count in times.items() if count > 1 and _counts(seen, name)]
    by_robot: dict[str, list[str]] = defaultdict(list)
    for name in twins:
        by_robot[seen.robot(name)].append(name)
    for robot, names in by_robot.items():
        if len(names) >= MANY:
            yield _two_robots(robot, names)
            continue
        for name in names:
            message = f"{times[name]} nodes have the name {name}"
            cause = (
                "started twice, or two robots without a namespace of their own; a node that was"
                " killed stays visible for 20 s"
            )
            yield nodes_of_one_name.finding(message, cause, robot=robot, node=name)


def _counts(seen: Index, node: str) -> bool:
    """Tools may run twice. Of two containers each gets the components of the other."""
    return not seen.is_tool(node) or node.endswith("_container")


def _two_robots(robot: str, names: Sequence[str]) -> Finding:
    """``names`` are all there more than once."""
    message = f"{len(names)} nodes run more than once: {shorten(names, SEVERAL)}"
    if robot:
        cause = f"{robot} was started twice, or another robot was started with its namespace"
    else:
        cause = (
            "two robots were started without a namespace: give each its own (namespace:=robot1,"
            " PushRosNamespace in the launch file)"
        )
    return nodes_of_one_name.finding(message, cause, robot=robot, node=names[0], names=tuple(names))


@system_rule("MG302", "managed-twice", ERROR)
def managed_twice(seen: Index) -> Iterator[Finding]:
    """One finding for all nodes that the same managers have; an operator's tool is none."""
    managed: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for (kind, name), ends in seen.by_name.items():
        if kind == SERVICE and name.endswith(_CHANGE_STATE):
            clients = nodes_of(end for end in ends.clients if not _asks_for_a_person(end.node))
            managed[clients].append(name.removesuffix(_CHANGE_STATE))
    for managers, nodes in managed.items():
        if len(managers) > 1:
            message = f"{and_then(managers)} all manage the life cycle of {shorten(sorted(nodes))}"
            cause = "one of them is too many, or its node_names has nodes of another robot"
            services = (f"{node}{end}" for node in nodes for end in (_CHANGE_STATE, "/get_state"))
            yield managed_twice.finding(
                message, cause,
                robot=seen.robot(nodes[0]), node=managers[0], names=(*managers, *services),
            )  # fmt: skip


def _asks_for_a_person(node: str) -> bool:
    return is_viewer(node) or is_tool(node)
