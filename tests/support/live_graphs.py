# SPDX-License-Identifier: Apache-2.0
"""A graph of records, played by real nodes: what ``live_fleet`` is told to start for it.

Endpoints whose type is not installed here are left out, and actions: their clients and servers need it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import Any

from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, End, Node, System

LISTS = {PUBLISHES: "publishers", SUBSCRIBES: "subscriptions", SERVES: "services", CALLS: "clients"}
TF = "tf2_msgs/msg/TFMessage"
# Every node of rclpy has them by itself.
_OWN = ("/rosout", "/parameter_events")


def processes(graph: System) -> list[list[dict[str, Any]]]:
    """One process for each first namespace; a second node of a name is in a process of its own."""
    ends: dict[str, list[End]] = defaultdict(list)
    for end in graph.ends:
        if _can_be_played(end):
            ends[end.node].append(end)
    frames = _frames(graph)
    groups: dict[str, list[dict[str, Any]]] = defaultdict(list)
    seen: Counter[str] = Counter()
    for node in graph.nodes:
        seen[node.name] += 1
        space = node.name.split("/")[1] if node.name.count("/") > 1 else ""
        group = f"{space} {seen[node.name]}"
        groups[group].append(_node(node, ends[node.name], frames.get(node.name, [])))
    return list(groups.values())


# Offered so by robot_state_publisher (robot_state_publisher.cpp) and map_server (map_server.cpp).
LATCHED = ("/robot_description", "/map", "/tf_static")


def _can_be_played(end: End) -> bool:
    return end.name not in _OWN and end.kind != "action" and bool(end.type) and _is_there(end.type)


@cache
def _is_there(type_: str) -> bool:
    module, _, name = type_.replace("/", ".").rpartition(".")
    if type_ == TF:
        return True
    try:
        return hasattr(import_module(module), name)
    except ImportError:
        return False


def _node(node: Node, ends: list[End], frames: list[Any]) -> dict[str, Any]:
    space, _, name = node.name.rpartition("/")
    sent = {topic for topic, *_ in frames}
    lists: dict[str, list[Any]] = {it: [] for it in LISTS.values()}
    for end in dict.fromkeys(ends):
        if end.role != PUBLISHES or end.name not in sent:
            lists[LISTS[end.role]].append([end.name, _word(end.type), *_words(end)])
    return {"name": name, "namespace": space or "/", "bare": True, **lists, "frames": frames}


def _word(type_: str) -> str:
    return "TFMessage" if type_ == TF else type_


def _words(end: End) -> Iterator[str]:
    if end.qos and end.qos.reliability == "BEST_EFFORT":
        yield "best_effort"
    # In some layouts the robot's name is behind.
    named = any(it in f"/{end.name}/" for it in (f"{one}/" for one in LATCHED))
    latched = not end.qos and end.role in (PUBLISHES, SUBSCRIBES) and named
    if latched or (end.qos and end.qos.durability == "TRANSIENT_LOCAL"):
        yield "latched"


def _frames(graph: System) -> dict[str, list[list[Any]]]:
    """By node: topic, static or not, edges; the first node on its topic sends a frame, or two do."""
    found: dict[str, dict[tuple[str, bool], list[list[str]]]] = defaultdict(dict)
    for it in graph.edges:
        for sender in it.publishers[: 2 if it.several else 1]:
            found[sender].setdefault((it.topic, it.static), []).append([it.parent, it.child])
    return {
        node: [[topic, static, *edges] for (topic, static), edges in own.items()]
        for node, own in found.items()
    }
