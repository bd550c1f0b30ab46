"""What the graph of a fleet is to look like, made of its remap table and its descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.naming import NAMESPACE, TF_TOPICS, Naming, spelled
from multibot_rewrite.remap.records import Name, NodeFacts, Table
from multibot_rewrite.steps.collect import Inventory

# What every node has, and what nobody misses.
ALWAYS = ("/rosout", "/parameter_events")
# Every node with use_sim_time hears the clock, whatever is called shared.
EVERYWHERE = (*ALWAYS, "/clock")
# Frames that nearly every robot has, whether or not anything here names them (REP 105).
USUAL_FRAMES = ("map", "odom", "base_footprint", "base_link")
NOTHING: Mapping[str, Sequence[str]] = {}
NOWHERE: Mapping[str, str] = {}


class Wanted(NamedTuple):
    """An endpoint that is to be there; ``node`` and ``name`` are fully qualified.

    ``type`` is empty where it is not known; ``also`` are others it may have, by parameter or
    release. ``asked`` is the name in the node's code.
    """

    node: str
    kind: str
    role: str
    name: str
    type: str
    asked: str
    also: tuple[str, ...] = ()


class WantedRobot(NamedTuple):
    """One robot: its nodes, the frames its description declares, the topic its tf is on.

    ``other_frames`` are names its nodes may use besides. ``optional`` are those of its nodes that
    are started under a condition. ``spelled`` stands for the robot in frames, empty for its name.
    """

    name: str
    nodes: tuple[str, ...]
    frames: tuple[str, ...]
    tf: str
    other_frames: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    spelled: str = ""


class Expectation(NamedTuple):
    """The plan of a fleet. ``ignored_nodes`` are patterns of nodes that may come and go, beside the
    usual tools; ``sources`` tell where in its description (``file:line``) a node comes from."""

    layout: str
    robots: tuple[WantedRobot, ...]
    shared_nodes: tuple[str, ...]
    shared_topics: tuple[str, ...]
    shared_frames: tuple[str, ...]
    endpoints: tuple[Wanted, ...]
    ignored_nodes: tuple[str, ...] = ()
    sources: tuple[tuple[str, str], ...] = ()


def expect(
    table: Table,
    naming: Naming,
    frames: Mapping[str, Sequence[str]],
    facts: Iterable[NodeFacts] = (),
    named: Mapping[str, Sequence[str]] = NOTHING,
    sources: Mapping[str, str] = NOWHERE,
    words: Mapping[str, str] = NOWHERE,
) -> Expectation:
    """The expectation of a table; ``frames`` are each robot's, as its description declares them,
    ``named`` those it names besides. ``facts`` are of the nodes that every robot runs. ``words``
    are what stands for a robot in its frames, where that is not its name."""
    known = tuple(facts)
    nodes = _nodes(table)
    optional = {node.name for node in known if node.when}
    usual = dict.fromkeys((*_defaults(known), *USUAL_FRAMES))
    robots = []
    for name in (robot for robot in nodes if robot):
        own = tuple(frames.get(name, ()))
        word = words.get(name, name)
        others = (*named.get(name, ()), *(spelled(naming, word, "frame", frame) for frame in usual))
        left = [f for f in dict.fromkeys(others) if f not in {*own, *naming.shared_frames}]
        perhaps = tuple(full for asked, full in nodes[name] if asked in optional)
        full = tuple(dict.fromkeys(full for _, full in nodes[name]))
        tf = tf_topic(name, naming)
        said = word if word != name else ""
        robots.append(WantedRobot(name, full, own, tf, tuple(left), perhaps, said))
    return Expectation(
        table.layout,
        tuple(robots),
        tuple(full for _, full in nodes.get("", ())),
        tuple(sorted(f"/{topic}" for topic in naming.shared_topics)),
        tuple(sorted(naming.shared_frames)),
        tuple(dict.fromkeys(_wanted(table.names))),
        sources=tuple(sources.items()),
    )


def _nodes(table: Table) -> dict[str, list[tuple[str, str]]]:
    """By robot: the stack's name of each node, and its full name."""
    found: dict[str, list[tuple[str, str]]] = {}
    for node in table.nodes:
        full = f"{node.namespace.rstrip('/')}/{node.name}"
        found.setdefault(node.robot, []).append((node.node, full))
    return found


def _defaults(facts: Iterable[NodeFacts]) -> Iterator[str]:
    """The frames that parameters hold unless they are set; one in <> is another parameter's."""
    for node in facts:
        names = (frame.default.strip("/") for frame in node.frames)
        yield from (name for name in names if name and "<" not in name)


def named_frames(inventory: Inventory) -> tuple[str, ...]:
    """The frames that a description names anywhere, such as those of its plugins' messages."""
    values = (
        claim.value.strip()
        for claim in inventory.claims
        if "frame" in claim.site.kinds and claim.site.form == "whole"
    )
    return tuple(dict.fromkeys(filter(None, values)))


def _wanted(names: Iterable[Name]) -> Iterator[Wanted]:
    """Endpoints that are there whatever the parameters say."""
    for name in names:
        asked = name.endpoint
        if not (asked.when or asked.helper) and asked.role and name.name not in ALWAYS:
            own = (name.node, asked.kind, asked.role, name.name)
            yield Wanted(*own, asked.type, asked.name, asked.also)


def tf_topic(robot: str, naming: Naming) -> str:
    """The topic that a robot's tf is on under this layout."""
    topic = f"/{TF_TOPICS[0]}"
    if not naming.layout.tf_per_robot:
        return topic
    if naming.topics == NAMESPACE:
        return f"/{robot}{topic}"
    return spelled(naming, robot, "topic", topic)
