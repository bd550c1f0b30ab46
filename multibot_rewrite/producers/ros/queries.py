# SPDX-License-Identifier: Apache-2.0
"""Queries about the graph through an rclpy node, with the answers as records.

The node is passed in: only ``graph.live.ros`` imports rclpy.
"""

from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from functools import lru_cache
from typing import Any, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.producers.ros import assemble
from multibot_rewrite.system.environment import machine
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    UNKNOWN_NODE,
    End,
    Qos,
)

# Kind and role of the answer, and the query: (node, name, namespace) -> names and types.
NodeQuery = tuple[str, str, Callable[..., Any]]
# No limit in rmw: the largest 64 bit number of nanoseconds.
_NO_LIMIT = 2**63 - 1
# Source: rmw_dds_common; a GID of DDS begins with its participant.
_OF_PARTICIPANTS, _GUID_PREFIX = "ros_discovery_info", 12
# Every node of rclcpp and rclpy publishes it.
PARAMETER_EVENTS = "/parameter_events"


def node_names(node: Any) -> list[str]:
    """Return full names of all nodes but ``node``; two nodes with one name are there twice."""
    found = (_full_name(name, space) for name, space in node.get_node_names_and_namespaces())
    return sorted(name for name in found if name != node.get_fully_qualified_name())


def participants(node: Any) -> frozenset[str]:
    """Return the participants that announced themselves: each writes which nodes it has."""
    return _participants_of(node.get_publishers_info_by_topic(_OF_PARTICIPANTS, no_mangle=True))


def participants_with_topics(node: Any) -> frozenset[str]:
    """Return the participants that publish or subscribe to any topic."""
    topics = [name for name, _ in node.get_topic_names_and_types()]
    sides = node.get_publishers_info_by_topic, node.get_subscriptions_info_by_topic
    return frozenset().union(*(_participants_of(side(it)) for it in topics for side in sides))


def without_nodes(node: Any, ends: Iterable[End]) -> frozenset[str]:
    """Return the announced participants of others without nodes: their names have not come yet."""
    return participants(node) - _own_participants(node) - {it.process for it in ends}


def on_this_machine(node: Any, found: Iterable[str]) -> list[str]:
    """Return those of the participants on the machine of ``node``, as far as their GUIDs tell."""
    machines = set(map(machine, _own_participants(node)))
    return [it for it in found if machine(it) in machines]


def _own_participants(node: Any) -> frozenset[str]:
    events = node.get_publishers_info_by_topic(PARAMETER_EVENTS)
    return _participants_of(it for it in events if it.node_name == node.get_name())


def _participants_of(infos: Iterable[Any]) -> frozenset[str]:
    return frozenset(bytes(it.endpoint_gid)[:_GUID_PREFIX].hex() for it in infos)


def enclaves(node: Any) -> dict[str, str]:
    """Return the enclave of each node by its full name; a node in the enclave ``/`` is in none."""
    found = node.get_node_names_and_namespaces_with_enclaves()
    return {_full_name(name, space): enclave.rstrip("/") for name, space, enclave in found}


def _full_name(name: str, namespace: str) -> str:
    if name == UNKNOWN_NODE:
        # Its namespace is such a word too, without a slash.
        return f"/{name}"
    return f"{namespace.rstrip('/')}/{name}"


# Enough to see whether anything changes.
NODE_QUERIES: tuple[NodeQuery, ...] = (
    (TOPIC, PUBLISHES, lambda node, *who: node.get_publisher_names_and_types_by_node(*who)),
    (TOPIC, SUBSCRIBES, lambda node, *who: node.get_subscriber_names_and_types_by_node(*who)),
    (SERVICE, SERVES, lambda node, *who: node.get_service_names_and_types_by_node(*who)),
    (SERVICE, CALLS, lambda node, *who: node.get_client_names_and_types_by_node(*who)),
)


def endpoints_by_node(
    node: Any, names: Iterable[str], queries: Iterable[NodeQuery], gone: type[Exception]
) -> Iterator[End]:
    """Yield each node's endpoints, until it is ``gone``; rcl shows the first of two with one name."""
    for name in sorted(set(names)):
        space, _, own = name.rpartition("/")
        # The node may leave the graph between two queries.
        with suppress(gone):
            for kind, role, query in queries:
                for topic, types in query(node, own, space or "/"):
                    for type_ in types:
                        yield End(kind, role, topic, type_, "", name, None, "")


# For each topic its endpoints by node at the time of the query, and the answer.
TopicCache = dict[str, tuple[frozenset[End], list[End]]]


class TopicQueries(NamedTuple):
    """Which topics are always queried, the answers so far, and whether there is no time for more.

    A topic in ``cache`` is not queried again while the endpoints of its nodes are the same; it
    grows."""

    requested: Collection[str]
    cache: TopicCache
    over: Callable[[], bool]


def with_topic_details(
    node: Any, names: list[str], found: list[End], asked: TopicQueries
) -> list[End]:
    """Return the endpoints ``found`` by node, with QoS and process for topics worth a query."""
    topics = dict(node.get_topic_names_and_types())
    wanted = assemble.topics_to_query(names, found, topics, asked.requested)
    if len(set(names)) < len(names):
        # One of two nodes with one name is hidden, and so are its endpoints.
        asked.cache.clear()
    details = _query_topics(node, wanted, found, asked)
    endpoints = assemble.merged(found, details)
    known = assemble.processes_by_node(endpoints)
    unknown = {end.node: end for end in found if end.node not in known and end.kind != ACTION}
    if not unknown or asked.over():
        return endpoints
    # Of each node without a known process one of its endpoints, and the same with its process.
    better: dict[End, End] = {}
    for name, end in unknown.items():
        topic = end.kind == TOPIC
        seen = _topic_endpoints(node, end.name) if topic else _service_endpoints(node, end)
        same = (it for it in seen if it.node == name and it.role == end.role)
        if end in endpoints and (other := next(same, None)):
            better[end] = other
    return [*(it for it in endpoints if it not in better), *better.values()]


def _query_topics(
    node: Any, topics: Iterable[str], found: Iterable[End], asked: TopicQueries
) -> dict[str, list[End]]:
    """Return the endpoints of topics as queried now or before."""
    ends = lists_by_key((end.name, end) for end in found)
    result = {}
    for topic in topics:
        now = frozenset(ends.get(topic, ()))
        before, details = asked.cache.get(topic, (None, []))
        if before != now:
            if asked.over():
                continue
            details = _topic_endpoints(node, topic)
            # Otherwise discovery is not finished for this topic.
            if {(end.role, end.node) for end in details} == {(end.role, end.node) for end in now}:
                asked.cache[topic] = now, details
        result[topic] = details
    return result


def _topic_endpoints(node: Any, topic: str) -> list[End]:
    own = node.get_fully_qualified_name()
    found = [
        _endpoint(TOPIC, PUBLISHES, topic, it) for it in node.get_publishers_info_by_topic(topic)
    ]
    found += [
        _endpoint(TOPIC, SUBSCRIBES, topic, it)
        for it in node.get_subscriptions_info_by_topic(topic)
    ]
    return [end for end in found if end.node != own]


def _service_endpoints(node: Any, end: End) -> list[End]:
    """Return the DDS endpoints of a service: a server reads requests, a client writes them."""
    side = "publishers" if end.role == CALLS else "subscriptions"
    query = getattr(node, f"get_{side}_info_by_topic")
    infos = query(f"rq{end.name}Request", no_mangle=True)
    found = (_endpoint(SERVICE, end.role, end.name, info) for info in infos)
    # The type and hash in the answer are those of the request only.
    return [it._replace(type=end.type, type_hash="") for it in found]


def _endpoint(kind: str, role: str, name: str, info: Any) -> End:
    hash_ = str(info.topic_type_hash) if info.topic_type_hash.version > 0 else ""
    # The first 12 bytes of a DDS gid are its participant.
    process = bytes(info.endpoint_gid[:12]).hex()
    owner = _full_name(info.node_name, info.node_namespace)
    qos = _qos(info.qos_profile)
    return End(kind, role, name, info.topic_type, hash_, owner, qos, process)


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
    """Return the record of a profile, one object for equal ones."""
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
    return float("inf") if nanoseconds >= _NO_LIMIT or nanoseconds == 0 else nanoseconds / 1e9
