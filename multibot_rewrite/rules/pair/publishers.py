# SPDX-License-Identifier: Apache-2.0
"""By a plan: a relative topic below the node's own namespace, where nothing publishes it."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.declaration import found_by_plan
from multibot_rewrite.rules.pair.causes import use_absolute
from multibot_rewrite.rules.pair.meeting import unplanned_ends, unplanned_nodes
from multibot_rewrite.rules.system.names import topic_names_miss
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC, End
from multibot_rewrite.system.tool_nodes import in_namespaces_above

# In the names of Nav2's costmap nodes.
COSTMAP = "costmap"


@found_by_plan(topic_names_miss)
def topic_below_node_namespace(plan: Index, seen: Index) -> Iterator[Finding]:
    """The usual case are the sensor topics of a costmap."""
    waiting = [
        (robot, end)
        for node, robot in _nodes_with_own_namespace(plan, seen)
        for end in _without_publisher(plan, seen, node)
    ]
    known = {name for _, _, _, name in plan.by_key} if waiting else set()
    for robot, end in waiting:
        node = end.node
        own = (it for it in in_namespaces_above(node, end.name) if plan.robot(it) == robot)
        planned = (node, end.kind, end.role, end.name) in plan.by_key
        allowed = (it for it in own if it in seen.published or (it in known and not planned))
        meant = next(allowed, "")
        if meant:
            message = f"subscribes to {end.name}, which no node publishes; did you mean {meant}?"
            yield topic_names_miss.finding(
                message, use_absolute(meant), robot=robot, node=node, names=(end.name, meant)
            )


def _nodes_with_own_namespace(plan: Index, seen: Index) -> Iterator[tuple[str, str]]:
    """The nodes in a namespace below their robot's, with the robot: planned nodes, and costmaps."""
    for node, robot in plan.robot_of.items():
        if plan.of_names.without_robot(node, robot).count("/") > 1:
            yield node, robot
    for node in unplanned_nodes(plan, seen):
        robot = plan.robot(node) if COSTMAP in node.rpartition("/")[2] else ""
        if robot:
            yield node, robot


def _without_publisher(plan: Index, seen: Index, node: str) -> Iterator[End]:
    """A node's subscriptions without a publisher, each topic once. A costmap reads its robot's sensors;
    for other nodes the plan is right."""
    costmap = COSTMAP in node.rpartition("/")[2]
    endpoints = seen.by_node if costmap else unplanned_ends(plan, seen)
    topics = {
        end.name: end
        for end in endpoints.get(node, ())
        if (end.kind, end.role) == (TOPIC, SUBSCRIBES) and end.name not in seen.published
    }
    return iter(topics.values())
