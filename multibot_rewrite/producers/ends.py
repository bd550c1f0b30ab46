# SPDX-License-Identifier: Apache-2.0
"""The ends that a robot's sources name: its stacks with their parameters, plugins, bridges."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from multibot_rewrite.companions.bridge_entry import (
    BOTH,
    FRAME,
    GZ,
    ROS,
    SERVICE as SERVICE_ROW,
    below,
)
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.spelling.of_runs import asked_alone, with_names
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.spelling.targets import expanded
from multibot_rewrite.system.records import (
    CALLS,
    MAY,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    Place,
)

NEEDS = (SUBSCRIBES, CALLS)
BRIDGE_FILE, BRIDGE_NODE = "bridge.yaml", "ros_gz_bridge"
_ROLES = {"GZ_TO_ROS": PUBLISHES, "ROS_TO_GZ": SUBSCRIBES}


def either_way(end: End) -> Iterator[End]:
    """The end; one of which the role is not known may be on both sides."""
    if end.role:
        yield end
        return
    yield from (end._replace(role=it, sure=MAY) for it in (PUBLISHES, SUBSCRIBES))


def run_alone(node: NodeFacts, section: Run | None) -> Run:
    """A node of a robot without a name, under the rules of the usual launch files alone; ``section`` is
    what a file sets for it."""
    above, _, name = f"/{node.name}".rpartition("/")
    rules = tuple(it for end in node.endpoints if end.remapped for it in _usual_rules(node, end))
    run = Run("", node.name, above or "/", name, rules, node)
    run = run._replace(values=section.values, place=section.place) if section else run
    return with_names(run)


def _usual_rules(node: NodeFacts, end: Endpoint) -> Iterator[tuple[str, str]]:
    asked, meant = (end._replace(name=it) for it in (asked_alone(node, end), end.remapped))
    for (_, source), (_, target) in zip(expanded(asked), expanded(meant), strict=True):
        yield source, target


class BridgeRow(NamedTuple):
    """A row of a ros_gz_bridge file: its end in ROS, its name in the simulator, and the frame that it
    puts in place of the message's, empty for none."""

    end: End
    inside: str
    frame: str


def bridge_ends(document: YamlText, above: str = "") -> Iterator[End]:
    """The ROS ends of the rows of a ros_gz_bridge file."""
    yield from (it.end for it in bridge_rows(document, above))


def bridge_rows(document: YamlText, above: str = "") -> Iterator[BridgeRow]:
    """The rows of a ros_gz_bridge file that runs in the namespace ``above``; the end of a row for both
    ways has no role, that of a service serves it."""
    for row in items(document.root):
        values = {key.value: value for key, value in pairs(row)}
        # A row with one name has it on both sides (ros_gz_bridge bridge_config.cpp).
        service = values.get(SERVICE_ROW)
        name = service or values.get(BOTH) or values.get(ROS) or values.get(GZ)
        if name is None:
            continue
        words = {key: str(value.value) for key, value in values.items()}
        full = f"/{below(str(name.value), above).lstrip('/')}"
        role = SERVES if service else _ROLES.get(words.get("direction", ""), "")
        own = (role, full, words.get("ros_type_name", ""), "", f"/{BRIDGE_NODE}", None, "")
        kind, place = SERVICE if service else TOPIC, Place(document.file, line_of(name))
        inside = words.get(GZ) or words.get(BOTH) or str(name.value)
        yield BridgeRow(End(kind, *own, full, place=place), inside, words.get(FRAME, ""))
