"""What the graph of a fleet is to look like, made of its remap table and its descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.naming import NAMESPACE, TF_TOPICS, Naming, affix
from multibot_rewrite.remap.records import Name, Table

# What every node has, and what nobody misses.
ALWAYS = ("/rosout", "/parameter_events")


class Wanted(NamedTuple):
    """An endpoint that is to be there; ``node`` and ``name`` are fully qualified.

    ``type`` is empty where it is not known. ``asked`` is the name in the node's code.
    """

    node: str
    kind: str
    role: str
    name: str
    type: str
    asked: str


class WantedRobot(NamedTuple):
    """One robot: its nodes, the frames its description declares, the topic its tf is on."""

    name: str
    nodes: tuple[str, ...]
    frames: tuple[str, ...]
    tf: str


class Expectation(NamedTuple):
    """The plan of a fleet."""

    layout: str
    robots: tuple[WantedRobot, ...]
    shared_nodes: tuple[str, ...]
    shared_topics: tuple[str, ...]
    shared_frames: tuple[str, ...]
    endpoints: tuple[Wanted, ...]


def expect(table: Table, naming: Naming, frames: Mapping[str, Sequence[str]]) -> Expectation:
    """The expectation of a table; ``frames`` are each robot's, as its description declares them."""
    robots = dict.fromkeys(node.robot for node in table.nodes if node.robot)
    return Expectation(
        table.layout,
        tuple(
            WantedRobot(
                name, _nodes(table, name), tuple(frames.get(name, ())), tf_topic(name, naming)
            )
            for name in robots
        ),
        _nodes(table, ""),
        tuple(sorted(f"/{topic}" for topic in naming.shared_topics)),
        tuple(sorted(naming.shared_frames)),
        tuple(dict.fromkeys(_wanted(table.names))),
    )


def _nodes(table: Table, robot: str) -> tuple[str, ...]:
    found = (n for n in table.nodes if n.robot == robot)
    return tuple(f"{node.namespace.rstrip('/')}/{node.name}" for node in found)


def _wanted(names: Iterable[Name]) -> Iterator[Wanted]:
    """Endpoints that are there whatever the parameters say."""
    for name in names:
        asked = name.endpoint
        if not (asked.when or asked.helper) and asked.role and name.name not in ALWAYS:
            yield Wanted(name.node, asked.kind, asked.role, name.name, asked.type, asked.name)


def tf_topic(robot: str, naming: Naming) -> str:
    """The topic that a robot's tf is on under this layout."""
    topic = f"/{TF_TOPICS[0]}"
    if not naming.layout.tf_per_robot:
        return topic
    if naming.topics == NAMESPACE:
        return f"/{robot}{topic}"
    there = affix(naming, "topic", topic)
    return there.spell(topic, robot) if there else topic
