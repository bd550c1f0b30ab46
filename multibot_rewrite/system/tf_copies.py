# SPDX-License-Identifier: Apache-2.0
"""What a plan's relays and bridges send on ``/tf``, so that one RViz shows all robots: copies."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping

from multibot_rewrite.system.records import (
    PUBLISHES,
    RUNS,
    SUBSCRIBES,
    Edge,
    System,
    nodes_by_robot,
    surely,
)

_TF, _GLOBAL = "/tf", ("/tf", "/tf_static")


def tree_topic(topic: str) -> str:
    """Return the topic that names a tree: tf and tf_static of one robot are one tree, ``tf``."""
    return "/".join("tf" if word == "tf_static" else word for word in topic.split("/"))


def static_topic(topic: str) -> str:
    """Return the topic of static transforms that belongs to a tf topic."""
    return "/".join("tf_static" if word == "tf" else word for word in topic.split("/"))


def copying_nodes(plan: System) -> Mapping[str, str]:
    """Return by node the robot whose tf it copies to ``/tf``, or sends a transform for."""
    home = {
        it.name: tree_topic(it.tf_topic) for it in plan.robots if tree_topic(it.tf_topic) != _TF
    }
    if not home:
        return {}
    here = [it for it in plan.ends if it.name in _GLOBAL and it.role == PUBLISHES]
    senders = {it.node for it in here if it.sure == RUNS}
    if not senders:
        return {}
    trees: dict[str, set[tuple[str, str]]] = defaultdict(set)
    for end in surely(plan).ends:
        if end.node in senders:
            trees[end.node].add((end.role, tree_topic(end.name)))
    writes, nodes = {(PUBLISHES, _TF)}, nodes_by_robot(plan)
    found: dict[str, str] = {}
    for robot in plan.robots:
        copies = {(SUBSCRIBES, home.get(robot.name, "")), *writes}
        own = [node for node in nodes[robot.name] if trees.get(node) in (copies, writes)]
        if any(trees[node] == copies for node in own):
            found |= dict.fromkeys(own, robot.name)
    return found


def without_bridged(plan: System, frames: Iterable[Edge]) -> tuple[Edge, ...]:
    """Return the transforms without copies on ``/tf`` and those from a robot's world to the fleet's."""
    seen, copied = tuple(frames), set(copying_nodes(plan).values())
    # tf_namespace_bridge src/tf_namespace_bridge.cpp
    home = {
        tree_topic(it.tf_topic): it.tf_topic.removesuffix("tf").lstrip("/")
        for it in plan.robots
        if it.name in copied
    }
    if not home:
        return seen
    known = {(f"{above}{world}", world) for above in home.values() for world in plan.shared_frames}
    for edge in seen:
        above = home.get(tree_topic(edge.topic))
        if above:
            known.add((f"{above}{edge.child}", f"{above}{edge.parent}"))
    return tuple(
        edge
        for edge in seen
        if tree_topic(edge.topic) != _TF or (edge.child, edge.parent) not in known
    )
