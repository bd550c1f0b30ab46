# SPDX-License-Identifier: Apache-2.0
"""Lifecycle nodes: each is asked for by a manager that starts by itself, or by its launch file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

CONFIGURE, ACTIVATE = 1, 3
CHANGE = "/change_state"


def faults(given: Any, nodes: list[Any]) -> Iterator[tuple[str, str]]:
    """Yield managers that wait for nodes, and nodes that wait for a manager."""
    there = {it.fqn for it in nodes}
    asked = {(it.fqn, name) for it in nodes for name in managed(it)}
    for it in nodes:
        for name in sorted(name for manager, name in asked if manager == it.fqn):
            if name not in there:
                short = name.rpartition("/")[2]
                yield it.robot, f"{it.fqn} waits for {short}, which is not started"
        if it.what == "lifecycle_manager" and it.values.get("autostart") is not True:
            yield it.robot, f"{it.fqn} starts nothing by itself: autostart is not true"
    names = {name for _, name in asked}
    for it in nodes:
        if is_managed(it) and it.fqn not in names and changed(given, it) != {CONFIGURE, ACTIVATE}:
            yield it.robot, f"{it.fqn} waits for a lifecycle manager: none asks for it"


def managed(node: Any) -> list[str]:
    """Return the full names of the nodes whose service a manager calls (nav2_lifecycle_manager:
    relative to its namespace; nav2_util lifecycle_service_client.cpp: as its own rules rename
    the service)."""
    if node.what != "lifecycle_manager":
        return []
    # The first rule that matches counts.
    rules = {below(node, old): below(node, new) for old, new in reversed(node.rules)}
    calls = [below(node, f"{it}{CHANGE}") for it in node.values.get("node_names", ())]
    return [rules.get(it, it).removesuffix(CHANGE) for it in calls]


def below(node: Any, name: str) -> str:
    return name if name.startswith("/") else f"{node.namespace.rstrip('/')}/{name}"


def is_managed(node: Any) -> bool:
    """Return whether a node has a bond to its manager; a server changes its costmaps itself."""
    bonds = any(it.type == "bond/msg/Status" and it.role == "publishes" for it in node.ends)
    return bonds and node.what != "lifecycle_manager" and not node.inside


def changed(given: Any, node: Any) -> set[int]:
    """Return the transitions that the launch file itself asks for."""
    return {
        int(it["change"])
        for _, it in given.starts
        if "change" in it
        and f"/{it['namespace'].strip('/')}/{it['node']}".replace("//", "/") == node.fqn
    }
