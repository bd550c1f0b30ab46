"""Topics that a robot needs by the plan, and that nothing publishes."""

from __future__ import annotations

from multibot_rewrite.system.index import Index, published
from multibot_rewrite.system.planned import Planned
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, Robot


def silent_topics(plan: Planned, seen: Index, robot: Robot, type_: str) -> set[str]:
    """Those of a type that its nodes read, or that a bridge has to publish for it."""
    read = {
        name
        for (node, _, role, name), end in plan.ends.items()
        if role == SUBSCRIBES and end.type == type_ and plan.robot_of.get(node) == robot.name
    }
    bridged = {
        it.name
        for it in plan.system.topics
        if PUBLISHES in it.bridge and it.type == type_ and plan.names.robot(it.name) == robot.name
    }
    return (read | bridged) - published(seen)
