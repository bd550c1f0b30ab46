"""Small snapshots, as one machine or another sees them."""

from __future__ import annotations

from typing import Any

from graph_cases import environment

from multibot_rewrite.graph.snapshot import GraphEndpoint, GraphNode, Qos, Snapshot

INF = float("inf")
QOS = Qos("KEEP_LAST", 1, "RELIABLE", "VOLATILE", INF, INF, "AUTOMATIC", INF)
ONE, TWO = "010f1111aaaaaaaaaaaaaaaa", "010f2222bbbbbbbbbbbbbbbb"
TEXT = "std_msgs/msg/String"


def node(robot: str, process: str = "") -> GraphNode:
    return GraphNode(f"/{robot}/drive", process)


def end(robot: str, name: str, process: str = "", **more: Any) -> GraphEndpoint:
    made = GraphEndpoint("topic", "publishes", name, TEXT, "", f"/{robot}/drive", None, process)
    return made._replace(**more)


def look(*nodes: GraphNode, ends: tuple[GraphEndpoint, ...] = (), **around: Any) -> Snapshot:
    known = {it.node for it in ends}
    more = tuple(
        end(it.name.split("/")[1], f"{it.name}/x", it.process)
        for it in nodes
        if it.name not in known
    )
    where = environment()._replace(**around)
    return Snapshot(nodes, (*ends, *more), (), where)
