"""The pure half of looking at a graph: when to stop, what to ask, how the answers fit together."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.snapshot import (
    EXPECTED,
    QUIET,
    TIMEOUT,
    Frame,
    GraphEndpoint,
    GraphNode,
)
from multibot_rewrite.remap.records import PUBLISHES, TOPIC

# Participants announce themselves every 3 s: less quiet than that says nothing.
QUIET_SECONDS = 3.5
# A look that comes later than this was held up.
HELD_UP_SECONDS = 0.5
# The endpoints of one participant come in a burst; a busy machine may pause in it.
BURST_SECONDS = 0.5
# The second stands in for the first in a rehearsal on a machine without tf2_msgs.
TF_TYPES = ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/TransformStamped")
# Almost every node publishes one of these, so few questions tell who shares a process.
COMMON_TOPICS = ("/parameter_events", "/rosout")


class Heard(NamedTuple):
    """A transform heard on ``topic``; ``latched`` by a subscription to what is kept for latecomers."""

    topic: str
    latched: bool
    parent: str
    child: str


class Changes(NamedTuple):
    """When the view last changed, all of it and that of the expected nodes; in seconds."""

    all: float
    expected: float


class Clock(NamedTuple):
    """Seconds of looking, and when the last look was.

    A pause of this process or of the machine is no quiet of the graph: what came meanwhile has not
    been read yet.
    """

    looked: float = 0.0
    last: float = 0.0

    def after(self, now: float, waited: float) -> Clock:
        """The clock at a look, which came ``waited`` seconds after the last one by intention."""
        return Clock(self.looked + min(now - self.last, waited + HELD_UP_SECONDS), now)


def settled(
    now: float,
    changed: Changes,
    seen: Collection[str],
    expected: Collection[str],
    timeout: float,
) -> str:
    """Why to stop looking, or an empty string; times are seconds since the looking began.

    ``seen`` are the nodes with endpoints.
    """
    there = expected and set(expected) <= set(seen)
    if there and now - changed.expected >= BURST_SECONDS:
        return EXPECTED
    if now - changed.all >= QUIET_SECONDS:
        return QUIET
    return TIMEOUT if now >= timeout else ""


def topics_to_ask(
    names: Sequence[str],
    endpoints: Iterable[GraphEndpoint],
    topics: Mapping[str, Sequence[str]],
    asked: Collection[str],
) -> list[str]:
    """The topics whose endpoints are worth the dear question who is there with which QoS.

    ``topics`` are all topics of the graph with their types. Two nodes of one name hide each
    other's topics, so then all are asked for.
    """
    if len(set(names)) < len(names):
        return sorted(topics)
    sides = defaultdict(set)
    for end in endpoints:
        if end.kind == TOPIC:
            sides[end.name].add(end.role)
    wanted = {*COMMON_TOPICS, *asked}
    return sorted(
        topic
        for topic, types in topics.items()
        if len(sides[topic]) != 1 or topic in wanted or not set(TF_TYPES).isdisjoint(types)
    )


def merged(
    by_node: Iterable[GraphEndpoint], by_topic: Mapping[str, Iterable[GraphEndpoint]]
) -> list[GraphEndpoint]:
    """What the nodes told, replaced by what is known better of the topics that were asked for."""
    kept = [end for end in by_node if end.kind != TOPIC or end.name not in by_topic]
    return kept + [end for ends in by_topic.values() for end in ends]


def processes(endpoints: Iterable[GraphEndpoint]) -> dict[str, list[str]]:
    """The process groups seen for each node name."""
    found: dict[str, set[str]] = defaultdict(set)
    for end in endpoints:
        if end.process:
            found[end.node].add(end.process)
    return {node: sorted(groups) for node, groups in found.items()}


def placed_nodes(names: Sequence[str], groups: Mapping[str, Sequence[str]]) -> list[GraphNode]:
    """One record a node; nodes of one name are spread over the processes the name was seen in."""
    result = []
    for name, times in sorted(Counter(names).items()):
        there = groups.get(name) or [""]
        result += [GraphNode(name, there[at % len(there)]) for at in range(times)]
    return result


def placed_endpoints(
    endpoints: Iterable[GraphEndpoint], groups: Mapping[str, Sequence[str]]
) -> list[GraphEndpoint]:
    """Sorted, each with the process of its node where that is beyond doubt."""
    return sorted((_placed(end, groups.get(end.node, ())) for end in endpoints), key=_order)


def _placed(end: GraphEndpoint, there: Sequence[str]) -> GraphEndpoint:
    return end._replace(process=there[0]) if not end.process and len(there) == 1 else end


def _order(end: GraphEndpoint) -> tuple[str, ...]:
    return (end.kind, end.name, end.role, end.node, end.process, end.type, repr(end.qos))


def frames(heard: Iterable[Heard], endpoints: Iterable[GraphEndpoint]) -> Iterator[Frame]:
    """The edges heard, once a topic; static where a latched subscription heard it."""
    publishers = defaultdict(set)
    for end in endpoints:
        if end.kind == TOPIC and end.role == PUBLISHES:
            publishers[end.name].add(end.node)
    latched: dict[tuple[str, str, str], bool] = {}
    for topic, kept, parent, child in heard:
        edge = (topic, parent, child)
        latched[edge] = kept or latched.get(edge, False)
    for (topic, parent, child), static in sorted(latched.items()):
        yield Frame(child, parent, topic, static, tuple(sorted(publishers[topic])))
