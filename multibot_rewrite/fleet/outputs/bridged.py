"""What a ros_gz_bridge has to carry, as what a plan says of topics."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.spelling.bridged_topics import BridgedTopic
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, Topic

# With nothing said, a row goes both ways.
BOTH = (PUBLISHES, SUBSCRIBES)
_ROLES = {"GZ_TO_ROS": (PUBLISHES,), "ROS_TO_GZ": (SUBSCRIBES,)}


def bridged_as(topics: Iterable[BridgedTopic]) -> tuple[Topic, ...]:
    """The topics that descriptions have, each once."""
    return once(
        Topic(it.ros, bridge=_ROLES.get(it.direction, BOTH), type=it.ros_type) for it in topics
    )


def once(topics: Iterable[Topic]) -> tuple[Topic, ...]:
    """Each topic once, with all that a bridge does with it."""
    found: dict[str, Topic] = {}
    for topic in topics:
        first = found.setdefault(topic.name, topic)
        roles = tuple(it for it in BOTH if it in {*first.bridge, *topic.bridge})
        found[topic.name] = first._replace(bridge=roles)
    return tuple(found.values())
