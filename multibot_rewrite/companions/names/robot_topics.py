"""Names of the ROS graph as files for one robot give them -> a robot's own, written in full."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from multibot_rewrite.companions.names.rename_map import RenameMap
from multibot_rewrite.naming import NAMESPACE, NOT_PLAIN
from multibot_rewrite.remap.records import ACTION, TOPIC, NodeFacts, Table
from multibot_rewrite.remap.table import target_of
from multibot_rewrite.rosnames import check_topic_name, expand

NOTHING: Mapping[str, str] = {}


def is_topic(value: str) -> bool:
    """A topic's name, and not a placeholder, a private name or nothing at all."""
    if not value or value.startswith("~") or not NOT_PLAIN.isdisjoint(value):
        return False
    return "//" not in value and check_topic_name(value) is None


def robot_topic(names: RenameMap, value: str, known: Mapping[str, str] = NOTHING) -> str:
    """The robot's full name of a topic; ``value`` itself where it is shared or is none.

    ``known`` is ``fleet_topics`` of the robot, for names that its nodes do not follow the rule in.
    """
    if not is_topic(value):
        return value
    full = f"/{value.lstrip('/')}"
    if full in known:
        return value if known[full] == full else known[full]
    target = target_of(full, TOPIC, names.robot, names.naming)
    if not target:
        return value
    return f"/{names.robot}/{target}" if names.naming.topics == NAMESPACE else target


def fleet_topics(table: Table, facts: Iterable[NodeFacts], robot: str) -> dict[str, str]:
    """What one robot alone calls its nodes' topics -> what they are in a fleet's table."""
    ours = {node.name for node in facts if not node.shared}
    stack = {
        f"{node.namespace.rstrip('/')}/{node.name}": node.node
        for node in table.nodes
        if node.robot == robot and node.node in ours
    }
    found: dict[str, str] = {}
    for name in table.names:
        if name.robot == robot and name.node in stack and name.endpoint.kind in (TOPIC, ACTION):
            above, _, node = stack[name.node].rpartition("/")
            asked = name.endpoint.remapped or name.endpoint.name
            found.setdefault(expand(asked, above, node), name.name)
    return found
