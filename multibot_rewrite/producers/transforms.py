# SPDX-License-Identifier: Apache-2.0
"""The transforms that a robot's sources name, and those that they tell nodes not to send."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from multibot_rewrite.knowledge.conditions import AND, holds, parse_condition
from multibot_rewrite.knowledge.records import MOVE_GROUP, NodeFacts
from multibot_rewrite.producers.evidence.filling import filled, lookup
from multibot_rewrite.producers.evidence.semantics import FIXED, Semantics
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import (
    NOWHERE,
    OFF,
    RUNS,
    Edge,
    Lookup,
    Place,
    Sure,
    edge_of,
)

TOPIC = "/tf"


def edge(
    pair: Edge, node: str, place: Place = NOWHERE, topic: str = TOPIC, sure: Sure = RUNS
) -> Edge:
    """A transform on the tf topic of its robot, or on the static one beside it."""
    on = "/".join("tf_static" if it == "tf" and pair.static else it for it in topic.split("/"))
    return pair._replace(topic=on, publishers=(node,), sure=sure, place=place)


def virtual_lookups(semantics: Semantics) -> Iterator[Lookup]:
    """The transforms that are the state of virtual joints: current_state_monitor.cpp of moveit2."""
    for it in semantics.virtual:
        if it.type != FIXED:
            yield Lookup(f"/{MOVE_GROUP}", it.child, it.parent, it.place)


def edges_off(given: Iterable[Run], known: Mapping[str, NodeFacts]) -> Iterator[Edge]:
    """What nodes would send, with the parameter that alone switches it off."""
    for it in given:
        node = known.get(it.fact.known)
        runs = filled(node, it) if node and node.sends else None
        if node is None or runs is None or runs.sends:
            continue
        frames = {frame.parameter: frame.default for frame in runs.frames}
        for send in node.sends:
            place = _switch(send.condition, runs, it)
            if place:
                pair = edge_of(frames[send.parent], frames[send.child])
                yield edge(pair, f"/{it.node}", place, sure=OFF)


def _switch(condition: str, runs: NodeFacts, given: Run) -> Place | None:
    """Where the parameter is that alone switches it off."""
    value_of = lookup(runs, given.values)
    off = [it for it in condition.split(AND) if not holds(it, value_of)]
    parts = chain(*parse_condition(off[0])) if len(off) == 1 else ()
    found = (given.values[it.parameter] for it in parts if it.parameter in given.values)
    return next((it.place for it in found), None)
