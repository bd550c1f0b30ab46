"""A remap table -> nodes to play: each asks for its names as its code does, rcl gets its rules.

Pure; ``graph.live.play`` plays them. What is not known is not played: parameters are taken to be set as
the layout says, QoS is the usual, and what hangs on a condition is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.graph.expectation import Expectation, Wanted
from multibot_rewrite.graph.transforms import Edge, Edges
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    NodeTable,
    ResolvedName,
    Table,
)
from multibot_rewrite.remap.table import ACTION_PARTS
from multibot_rewrite.remap.table_formats import arguments

TF = "tf2_msgs/msg/TFMessage"
# What is played where a type is not installed.
STAND_INS = {TOPIC: "std_msgs/msg/Empty", SERVICE: "std_srvs/srv/Empty", ACTION: ""}
TF_STAND_IN = "geometry_msgs/msg/TransformStamped"
# What an action's parts have for types that do not hang on the action's own.
PART_TYPES = {
    "_action/cancel_goal": "action_msgs/srv/CancelGoal",
    "_action/status": "action_msgs/msg/GoalStatusArray",
}
# Participants are few under LOCALHOST; so many robots' nodes share one.
PROCESSES = 8


class Part(NamedTuple):
    """A name that a node asks for, as its code writes it; ``helper`` as in ``Endpoint``."""

    kind: str
    role: str
    name: str
    type: str
    helper: bool


class Actor(NamedTuple):
    """A node to play: its name in the code, what rcl is told, what it asks for and sends."""

    name: str
    arguments: tuple[str, ...]
    parts: tuple[Part, ...]
    edges: tuple[Edge, ...]


def cast(table: Table, edges: Edges, rules: bool = True) -> Iterator[tuple[str, Actor]]:
    """The actors, each with its robot (empty for all robots).

    ``edges`` are by robot and node. Without ``rules`` a node keeps its namespace and its name only.
    """
    types = {name.name: name.endpoint.type for name in table.names if name.endpoint.type}
    asked: dict[str, list[Part]] = {}
    for name in table.names:
        if not name.endpoint.when:
            asked.setdefault(name.node, []).append(_part(name, types))
    for node in _once(table.nodes):
        told = node if rules else node._replace(rules=())
        parts = dict.fromkeys(asked.get(_full(node), ()))
        own = tuple(edges.get((node.robot, node.node), ()))
        short = node.node.rpartition("/")[2]
        yield node.robot, Actor(short, tuple(arguments(told)), tuple(parts), own)


def _full(node: NodeTable) -> str:
    return f"{node.namespace.rstrip('/')}/{node.name}"


def _once(nodes: Iterable[NodeTable]) -> Iterable[NodeTable]:
    """A node that a plugin and the stack both bring is one, with the rules of both."""
    found: dict[str, NodeTable] = {}
    for node in nodes:
        before = found.setdefault(_full(node), node)
        if before is not node:
            found[_full(node)] = before._replace(rules=(*before.rules, *node.rules))
    return found.values()


def _part(name: ResolvedName, types: Mapping[str, str]) -> Part:
    kind, role, own, type_, *_ = name.endpoint
    # What only names a topic is a sensor's output nearly always.
    return Part(
        kind, role or PUBLISHES, own, type_ or types.get(name.name, ""), name.endpoint.helper
    )


def dealt(actors: Iterable[tuple[str, Actor]]) -> list[list[Actor]]:
    """The actors by process: one a robot, as long as they are few."""
    hands: dict[int, list[Actor]] = {}
    seats: dict[str, int] = {}
    for robot, actor in actors:
        seat = seats.setdefault(robot, len(seats) % PROCESSES)
        hands.setdefault(seat, []).append(actor)
    return list(hands.values())


def as_played(plan: Expectation, replaced: Mapping[str, str]) -> Expectation:
    """The plan with the types that stand in; an action without its type is known by its parts."""
    endpoints = [part for wanted in plan.endpoints for part in _played(wanted, replaced)]
    return plan._replace(endpoints=tuple(endpoints))


def _played(wanted: Wanted, replaced: Mapping[str, str]) -> Iterator[Wanted]:
    if wanted.kind == ACTION and wanted.type in replaced:
        part = Part(wanted.kind, wanted.role, wanted.name, wanted.type, False)
        for kind, role, name, type_, _ in action_parts(part):
            asked = wanted.asked + name.removeprefix(wanted.name)
            yield Wanted(wanted.node, kind, role, name, type_, asked)
    else:
        also = tuple(replaced.get(type_, type_) for type_ in wanted.also)
        yield wanted._replace(type=replaced.get(wanted.type, wanted.type), also=also)


def action_parts(part: Part) -> Iterator[Part]:
    """The services and topics that an action is, where its type cannot be had."""
    roles = {
        (SERVES, SERVICE): SERVES, (SERVES, TOPIC): PUBLISHES,
        (CALLS, SERVICE): CALLS, (CALLS, TOPIC): SUBSCRIBES,
    }  # fmt: skip
    for suffix, kind in ACTION_PARTS:
        type_ = PART_TYPES.get(suffix, STAND_INS[kind])
        yield Part(kind, roles[part.role, kind], f"{part.name}/{suffix}", type_, part.helper)


def stand_in(kind: str, type_: str) -> str:
    """The type that is played instead of one that is not installed."""
    return TF_STAND_IN if type_ == TF else STAND_INS[kind]


def to_order(actors: Iterable[Actor]) -> tuple[Any, ...]:
    """Actors as plain values."""
    return tuple(actors)


def from_order(value: Sequence[Any]) -> list[Actor]:
    """Read what JSON made of ``to_order``."""
    return [
        Actor(
            name, tuple(words), tuple(Part(*it) for it in parts), tuple(Edge(*it) for it in edges)
        )
        for name, words, parts, edges in value
    ]
