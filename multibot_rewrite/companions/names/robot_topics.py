# SPDX-License-Identifier: Apache-2.0
"""Topics in files for one robot -> the absolute topic that each robot has instead."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from multibot_rewrite.base.naming import NAMESPACE, NOT_PLAIN
from multibot_rewrite.base.rosnames import check_name_in_code, expand
from multibot_rewrite.companions.names.rename_map import CompanionNames
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.spelling.of_runs import asked_alone, target_of
from multibot_rewrite.spelling.records import Table
from multibot_rewrite.system.records import ACTION, TOPIC

NOTHING: Mapping[str, str] = {}


def is_topic(value: str) -> bool:
    """Return whether it is a topic name: not empty, not private, without placeholders."""
    if not value or value.startswith("~") or not NOT_PLAIN.isdisjoint(value):
        return False
    return check_name_in_code(value) is None


def robot_topic(names: CompanionNames, value: str, known: Mapping[str, str] = NOTHING) -> str:
    """Return the robot's absolute topic; ``value`` itself if it is shared or not a topic name.

    ``known`` is ``fleet_topics`` of the robot, for topics that do not follow the general rule.
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
    """Return by the topics of a single robot's nodes those of ``robot`` in a fleet's table."""
    ours = {node.name for node in facts if not node.shared}
    stack = {
        node.full_name: node.node
        for node in table.runs
        if node.robot == robot and node.node in ours
    }
    found: dict[str, str] = {}
    for run, end, name in table.ends:
        if run.robot == robot and run.full_name in stack and end.kind in (TOPIC, ACTION):
            above, _, node = stack[run.full_name].rpartition("/")
            asked = end.remapped or asked_alone(run.fact, end)
            found.setdefault(expand(asked, above, node), name)
    return found
