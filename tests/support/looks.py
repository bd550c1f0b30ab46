# SPDX-License-Identifier: Apache-2.0
"""Small snapshots, as one machine or another sees them."""

from __future__ import annotations

from typing import Any

from graph_cases import environment

from multibot_rewrite.system.records import End, Node, Qos, System

INF = float("inf")
QOS = Qos("KEEP_LAST", 1, "RELIABLE", "VOLATILE", INF, INF, "AUTOMATIC", INF)
ONE, TWO = "010f1111aaaaaaaaaaaaaaaa", "010f2222bbbbbbbbbbbbbbbb"
TEXT = "std_msgs/msg/String"


def node(robot: str, process: str = "") -> Node:
    return Node(f"/{robot}/drive", process)


def end(robot: str, name: str, process: str = "", **more: Any) -> End:
    made = End("topic", "publishes", name, TEXT, "", f"/{robot}/drive", None, process)
    return made._replace(**more)


def look(*nodes: Node, ends: tuple[End, ...] = (), **around: Any) -> System:
    known = {it.node for it in ends}
    more = tuple(
        end(it.name.split("/")[1], f"{it.name}/x", it.process)
        for it in nodes
        if it.name not in known
    )
    where = environment()._replace(**around)
    return System(nodes, (*ends, *more), (), where)
