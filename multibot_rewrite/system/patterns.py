# SPDX-License-Identifier: Apache-2.0
"""Names that are made at run time: a plan holds nodes and their endpoints as patterns, with a ``*``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import with_gaps
from multibot_rewrite.system.records import End, System

ANY = "*"


def fitted(plan: System, graph: System) -> tuple[System, System]:
    """Return plan and graph with the same words for what is made at run time."""
    known = with_patterns(plan, graph)
    return with_names(plan, known), known


def with_patterns(plan: System, graph: System) -> System:
    """Return the graph, with a pattern of the plan in place of each node name that fits it. Two
    nodes of one process that a pattern fits are one node of the plan."""
    patterns = {it.name: _compiled(it.name) for it in plan.nodes if ANY in it.name}
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
    endpoints = (it._replace(node=names.get(it.node, it.node)) for it in graph.ends)
    return graph._replace(
        nodes=(*others, *dict.fromkeys(nodes)), ends=tuple(dict.fromkeys(endpoints))
    )


def with_names(plan: System, graph: System) -> System:
    """Return the plan, with what runs in place of each pattern of an end's name; a pattern that
    nothing fits stays, and is missing. ``graph`` has its nodes as the plan calls them."""
    if not any(ANY in it.name for it in plan.ends):
        return plan
    by_node = lists_by_key((end.node, end) for end in graph.ends)
    found = (end for it in plan.ends for end in _matching_ends(it, by_node))
    return plan._replace(ends=tuple(dict.fromkeys(found)))


def _matching_ends(planned: End, by_node: Mapping[str, Sequence[End]]) -> Iterator[End]:
    if ANY not in planned.name:
        yield planned
        return
    pattern, kind = _compiled(planned.name), (planned.kind, planned.role)
    own = [it.name for it in by_node.get(planned.node, ()) if (it.kind, it.role) == kind]
    fitting = [name for name in own if pattern.fullmatch(name)]
    yield from (planned._replace(name=name) for name in fitting or [planned.name])


def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(with_gaps(pattern.split(ANY), "[^/]"))
