"""Nodes whose names are made at run time: a plan holds them as patterns, with a ``*``."""

from __future__ import annotations

import re

from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.snapshot import Snapshot


def with_patterns(plan: Expectation, graph: Snapshot) -> Snapshot:
    """The graph, with a pattern of the plan in place of each node name that it stands for.

    Two nodes of one process that a pattern stands for are one node of the plan.
    """
    patterns = {it: _compiled(it) for robot in plan.robots for it in robot.nodes if "*" in it}
    if not patterns:
        return graph
    names = {
        node.name: pattern
        for node in graph.nodes
        for pattern, found in patterns.items()
        if found.fullmatch(node.name)
    }
    nodes = (it._replace(name=names[it.name]) for it in graph.nodes if it.name in names)
    others = (it for it in graph.nodes if it.name not in names)
    endpoints = (it._replace(node=names.get(it.node, it.node)) for it in graph.endpoints)
    return graph._replace(
        nodes=(*others, *dict.fromkeys(nodes)), endpoints=tuple(dict.fromkeys(endpoints))
    )


def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(re.escape(pattern).replace(r"\*", "[^/]+"))
