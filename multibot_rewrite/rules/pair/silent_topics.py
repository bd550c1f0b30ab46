"""Topics that a robot needs by the plan, and that nothing publishes."""

from __future__ import annotations

from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, Robot


def silent_topics(view: View, robot: Robot, type_: str) -> set[str]:
    """Those of a type that its nodes read, or that a bridge has to publish for it."""
    read = {
        name
        for (node, _, role, name), end in view.planned.items()
        if role == SUBSCRIBES and end.type == type_ and view.robot_of.get(node) == robot.name
    }
    bridged = {
        it.name
        for it in view.plan.topics
        if PUBLISHES in it.bridge
        and it.type == type_
        and view.ownership.robot(it.name) == robot.name
    }
    return (read | bridged) - view.published_topics
