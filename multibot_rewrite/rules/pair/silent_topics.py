# SPDX-License-Identifier: Apache-2.0
"""Topics that a robot needs by the plan, and that nothing publishes."""

from __future__ import annotations

from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, Robot


def silent_topics(plan: Index, seen: Index, robot: Robot, type_: str) -> set[str]:
    """Those of a type that its nodes read, or that a bridge has to publish for it."""
    read = {
        end.name
        for node in plan.own.get(robot.name, ())
        for end in plan.by_node.get(node, ())
        if end.role == SUBSCRIBES and end.type == type_
    }
    bridged = {
        it.name
        for it in plan.system.topics
        if PUBLISHES in it.bridge and it.type == type_ and plan.robot(it.name) == robot.name
    }
    return (read | bridged) - seen.published
