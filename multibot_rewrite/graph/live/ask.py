"""What a node of rclpy is asked about the graph, and its answers as records.

The node is handed in: rclpy itself is imported in ``graph.live.ros`` alone.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from functools import lru_cache
from typing import Any

from multibot_rewrite.graph.live import gather
from multibot_rewrite.graph.snapshot import UNKNOWN_NODE, GraphEndpoint, Qos
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

# Kind and role of the answer, and how a node is asked: (node, name, namespace) -> names and types.
Question = tuple[str, str, Callable[..., Any]]
# rmw's word for no limit: the largest 64 bit number of nanoseconds.
_ENDLESS = 2**63 - 1


def names_in(node: Any) -> list[str]:
    """Full names of all nodes but the looking one, duplicates kept."""
    there = (_full(name, space) for name, space in node.get_node_names_and_namespaces())
    return sorted(name for name in there if name != node.get_fully_qualified_name())


def _full(name: str, namespace: str) -> str:
    if name == UNKNOWN_NODE:
        # Its namespace is a word of that kind, too, without a slash.
        return f"/{name}"
    return f"{namespace.rstrip('/')}/{name}"


# Enough to see whether anything changes.
QUESTIONS: tuple[Question, ...] = (
    (TOPIC, PUBLISHES, lambda node, *who: node.get_publisher_names_and_types_by_node(*who)),
    (TOPIC, SUBSCRIBES, lambda node, *who: node.get_subscriber_names_and_types_by_node(*who)),
    (SERVICE, SERVES, lambda node, *who: node.get_service_names_and_types_by_node(*who)),
    (SERVICE, CALLS, lambda node, *who: node.get_client_names_and_types_by_node(*who)),
)


def by_node(
    node: Any, names: Iterable[str], questions: Iterable[Question], gone: type[Exception]
) -> Iterator[GraphEndpoint]:
    """What each node has; of two nodes with one name rcl shows the first.

    ``gone`` is what ``node`` raises for a node that is not there.
    """
    for name in sorted(set(names)):
        space, _, own = name.rpartition("/")
        # It went away between two questions.
        with suppress(gone):
            for kind, role, ask in questions:
                for thing, types in ask(node, own, space or "/"):
                    for type_ in types:
                        yield GraphEndpoint(kind, role, thing, type_, "", name, None, "")


# What was told of a topic, and what its nodes had of it then.
Memory = dict[str, tuple[frozenset[GraphEndpoint], list[GraphEndpoint]]]


def endpoints_of(
    node: Any,
    names: list[str],
    found: list[GraphEndpoint],
    asked: Collection[str],
    memory: Memory,
) -> list[GraphEndpoint]:
    """``found`` by node, with QoS and process where it is worth asking by topic.

    ``asked`` are topics whose QoS is wanted in any case. A topic in ``memory`` whose nodes have the
    same ends of it as before is not asked for again; memory grows.
    """
    topics = dict(node.get_topic_names_and_types())
    wanted = gather.topics_to_ask(names, found, topics, asked)
    if len(set(names)) < len(names):
        # One of two nodes of a name is hidden, and so are its ends.
        memory.clear()
    told = _told_of(node, wanted, found, memory)
    endpoints = gather.merged(found, told)
    known = gather.processes(endpoints)
    homeless = {end.node: end for end in found if end.node not in known and end.kind != ACTION}
    return [*endpoints, *_replaced(node, endpoints, homeless)] if homeless else endpoints


def _told_of(
    node: Any, topics: Iterable[str], found: Iterable[GraphEndpoint], memory: Memory
) -> dict[str, list[GraphEndpoint]]:
    ends: dict[str, list[GraphEndpoint]] = {}
    for end in found:
        ends.setdefault(end.name, []).append(end)
    result = {}
    for topic in topics:
        now = frozenset(ends.get(topic, ()))
        before, told = memory.get(topic, (None, []))
        if before != now:
            told = _by_topic(node, topic)
            # Else a part of it is still on its way.
            if {(end.role, end.node) for end in told} == {(end.role, end.node) for end in now}:
                memory[topic] = now, told
        result[topic] = told
    return result


def _replaced(
    node: Any, endpoints: list[GraphEndpoint], homeless: Mapping[str, GraphEndpoint]
) -> Iterator[GraphEndpoint]:
    """One endpoint of each node without a known process, again and with its process.

    Takes what it tells anew out of ``endpoints``.
    """
    for name, end in homeless.items():
        told = _by_topic(node, end.name) if end.kind == TOPIC else _by_service(node, end)
        for better in told:
            if better.node == name and better.role == end.role and end in endpoints:
                endpoints.remove(end)
                yield better


def _by_topic(node: Any, topic: str) -> list[GraphEndpoint]:
    own = node.get_fully_qualified_name()
    found = [_told(TOPIC, PUBLISHES, topic, it) for it in node.get_publishers_info_by_topic(topic)]
    found += [
        _told(TOPIC, SUBSCRIBES, topic, it) for it in node.get_subscriptions_info_by_topic(topic)
    ]
    return [end for end in found if end.node != own]


def _by_service(node: Any, end: GraphEndpoint) -> list[GraphEndpoint]:
    """The endpoint behind a service as DDS has it: a server reads requests, a client writes."""
    asking = "publishers" if end.role == CALLS else "subscriptions"
    question = getattr(node, f"get_{asking}_info_by_topic")
    infos = question(f"rq{end.name}Request", no_mangle=True)
    found = (_told(SERVICE, end.role, end.name, info) for info in infos)
    # The type and hash told are those of the request alone.
    return [it._replace(type=end.type, type_hash="") for it in found]


def _told(kind: str, role: str, name: str, info: Any) -> GraphEndpoint:
    hash_ = str(info.topic_type_hash) if info.topic_type_hash.version > 0 else ""
    # The first 12 bytes of a DDS gid are its participant.
    process = bytes(info.endpoint_gid[:12]).hex()
    owner = _full(info.node_name, info.node_namespace)
    qos = _qos(info.qos_profile)
    return GraphEndpoint(kind, role, name, info.topic_type, hash_, owner, qos, process)


def _qos(profile: Any) -> Qos:
    return _shared_qos(
        profile.history,
        profile.depth,
        profile.reliability,
        profile.durability,
        profile.deadline.nanoseconds,
        profile.lifespan.nanoseconds,
        profile.liveliness,
        profile.liveliness_lease_duration.nanoseconds,
    )


# A fleet has thousands of endpoints and a handful of profiles.
@lru_cache(maxsize=256)
def _shared_qos(
    history: Any,
    depth: int,
    reliability: Any,
    durability: Any,
    deadline: int,
    lifespan: int,
    liveliness: Any,
    lease: int,
) -> Qos:
    return Qos(
        history.name,
        depth,
        reliability.name,
        durability.name,
        _seconds(deadline),
        _seconds(lifespan),
        liveliness.name,
        _seconds(lease),
    )


def _seconds(nanoseconds: int) -> float:
    return float("inf") if nanoseconds >= _ENDLESS or nanoseconds == 0 else nanoseconds / 1e9
