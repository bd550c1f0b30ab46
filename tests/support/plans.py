# SPDX-License-Identifier: Apache-2.0
"""Plans in short: a robot with its nodes, and a system of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.system.records import (
    MAY,
    RUNS,
    End,
    Node,
    Robot,
    System,
    nodes_by_robot,
    place_of,
)


class PlannedRobot(NamedTuple):
    """A robot with its nodes, of which the ``optional`` ones may be missing."""

    name: str
    nodes: Sequence[str]
    frames: tuple[str, ...]
    tf: str
    other_frames: tuple[str, ...] = ()
    optional: Sequence[str] = ()
    tag: str = ""


def planned(
    layout: str,
    robots: Iterable[PlannedRobot],
    shared_nodes: Iterable[str],
    shared_topics: tuple[str, ...],
    shared_frames: tuple[str, ...],
    ends: tuple[End, ...],
    one_of: Iterable[tuple[str, ...]] = (),
    **more: Any,
) -> System:
    """Return the plan that has all this."""
    groups = {node: group for group in one_of for node in group}
    fleet = tuple(robots)
    every = [
        Node(node, robot=it.name, sure=MAY if node in it.optional else RUNS)
        for it in fleet
        for node in it.nodes
    ]
    every += [Node(node) for node in shared_nodes]
    return System(
        tuple(it._replace(sure=it.sure._replace(instead=groups.get(it.name, ()))) for it in every),
        ends,
        robots=tuple(Robot(it.name, it.frames, it.tf, it.other_frames, it.tag) for it in fleet),
        layout=layout,
        shared_topics=shared_topics,
        shared_frames=shared_frames,
        **more,
    )


def planned_end(
    node: str,
    kind: str,
    role: str,
    name: str,
    type_: str = "",
    code_name: str = "",
    also: tuple[str, ...] = (),
) -> End:
    """Return an end of which nothing is known that only a running system shows."""
    return End(kind, role, name, type_, node=node, code_name=code_name, also=also)


def own(plan: System, robot: str = "") -> tuple[str, ...]:
    """Return the names of a robot's nodes, or of those for all robots."""
    return tuple(nodes_by_robot(plan)[robot])


def optional(plan: System, robot: str) -> tuple[str, ...]:
    """Return the nodes of a robot that may be missing."""
    return tuple(it.name for it in plan.nodes if it.robot == robot and it.sure.word == MAY.word)


def robot_named(plan: System, name: str) -> Robot:
    """Return the robot of that name; raises StopIteration."""
    return next(it for it in plan.robots if it.name == name)


def ends_of(plan: System, node: str) -> list[End]:
    """Return the ends of a node; raises AssertionError for a node that is not planned."""
    assert node in {it.name for it in plan.nodes}
    return [it for it in plan.ends if it.node == node]


def places(plan: System) -> dict[str, str]:
    """By node: where its plugin is."""
    return {it.name: str(it.plugin) for it in plan.nodes if it.plugin.file}


def sends(plan: System) -> dict[str, str]:
    """By node: the transforms that it sends."""
    found: dict[str, list[str]] = {}
    for edge in plan.edges:
        found.setdefault(edge.publishers[0], []).append(f"{edge.parent} -> {edge.child}")
    return {node: ", ".join(edges) for node, edges in found.items()}


def from_plugin(plan: System, node: str, place: str) -> System:
    """Return the plan where a plugin at ``place`` starts the node."""
    return told(plan, node, plugin=place_of(place))


def told(plan: System, *names: str, **fields: object) -> System:
    """Return the plan with other fields of some nodes."""
    return plan._replace(
        nodes=tuple(it._replace(**fields) if it.name in names else it for it in plan.nodes)
    )


def more(plan: System, robot: str, *names: str) -> System:
    """Return the plan with further nodes of a robot."""
    return plan._replace(nodes=(*plan.nodes, *(Node(it, robot=robot) for it in names)))


def without(plan: System, *robots: str) -> System:
    """Return the plan without the nodes of these robots."""
    return plan._replace(nodes=tuple(it for it in plan.nodes if it.robot not in robots))
