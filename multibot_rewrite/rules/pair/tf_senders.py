# SPDX-License-Identifier: Apache-2.0
"""Which node sends a transform, by the plan; a transform itself does not say it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.rules.pair.tf_trees import tf_trees
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER
from multibot_rewrite.system.index import Index, Sent, once
from multibot_rewrite.system.records import Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic


def sent_by_robot(plan: Index, robot: Robot) -> list[Sent]:
    """Those of one robot's nodes."""
    return [*_sent_by_robot(plan).get(robot.name, ())]


@once
def _sent_by_robot(plan: Index) -> Mapping[str, Sequence[Sent]]:
    found: dict[str, list[Sent]] = defaultdict(list)
    for it in plan.sent:
        found[plan.robot_of.get(it.node, "")].append(it)
    return found


def foreign(plan: Index, seen: Index, robot: Robot) -> Iterator[tuple[str, Edge]]:
    """Transforms of other robots, each with its robot, that a node of this one may send: all on a tf
    topic of its own, else what several nodes send."""
    found = _named(plan, seen).get(tree_topic(robot.tf_topic), ())
    return (it for it in found if it[0] != robot.name)


@once
def _named(plan: Index, seen: Index) -> Mapping[str, Sequence[tuple[str, Edge]]]:
    """The transforms with a robot's name on one robot's tf topic, or that several nodes send on one of
    all, by their topic and each with that robot."""
    found: dict[str, list[tuple[str, Edge]]] = defaultdict(list)
    for tree in tf_trees(plan, seen):
        for edge in (it for it in tree.edges if len(tree.home) == 1 or it.several):
            if other := plan.frame_robot(edge.child):
                found[tree.topic].append((other, edge))
    return found


def described_robots(plan: Index, seen: Index, robot: Robot) -> Iterator[str]:
    """The robots whose description a node of this one seems to have, by fixed transforms of theirs."""
    return (other for other, edge in foreign(plan, seen, robot) if edge.static)


def sender_of(plan: Index, robot: Robot, frame: str) -> str:
    """The node that sends a planned frame of the robot: a node of its own, else the description's."""
    found = (it.node for it in sent_by_robot(plan, robot) if frame in (it.parent, it.child))
    return next(found, "") or state_publisher(plan, robot)


def state_publisher(plan: Index, robot: Robot) -> str:
    """The robot's robot_state_publisher by the plan; empty where it has none."""
    return next((it for it in plan.own[robot.name] if STATE_PUBLISHER in it), "")


def where_set(plan: Index, node: str) -> str:
    """The file that holds a node's frames: its plugin's line, or that of its parameters; or empty."""
    planned = plan.node.get(node)
    return str(planned.plugin) or str(planned.place) if planned else ""
