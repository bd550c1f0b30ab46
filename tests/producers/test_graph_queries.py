# SPDX-License-Identifier: Apache-2.0
"""What is asked of a graph through an rclpy node, and what becomes of the answers.

The node here answers from a table, as rclpy's ``Node`` does: names and types by node, and records with
``node_name``, ``node_namespace``, ``topic_type``, ``topic_type_hash``, ``endpoint_gid`` and
``qos_profile`` by topic (rclpy node.py, topic_endpoint_info.py). Requests of a service are the topic
``rq<service>Request`` (rmw_fastrtps, rmw_cyclonedds).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.producers.ros import queries
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

WORDS = Enum("WORDS", ["KEEP_LAST", "RELIABLE", "VOLATILE", "AUTOMATIC"])
NONE = float("inf")
USUAL = Qos("KEEP_LAST", 10, "RELIABLE", "VOLATILE", NONE, NONE, "AUTOMATIC", NONE)
STRING, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"


class Hash:
    """``TypeHash`` of rclpy: version -1 where none is known."""

    def __init__(self, version: int) -> None:
        self.version = version

    def __str__(self) -> str:
        return "RIHS01_aa"


def lasting(nanoseconds: int) -> Any:
    return SimpleNamespace(nanoseconds=nanoseconds)


def info(owner: str, process: int, type_: str = STRING, version: int = 1, deadline: int = 0) -> Any:
    """Return an endpoint of a node by its full name, in a process by its number."""
    space, _, name = owner.rpartition("/")
    profile = SimpleNamespace(
        history=WORDS["KEEP_LAST"], depth=10, reliability=WORDS["RELIABLE"],
        durability=WORDS["VOLATILE"], liveliness=WORDS["AUTOMATIC"], deadline=lasting(deadline),
        lifespan=lasting(2**63 - 1), liveliness_lease_duration=lasting(0),
    )  # fmt: skip
    return SimpleNamespace(
        node_name=name, node_namespace=space or "/", topic_type=type_, topic_type_hash=Hash(version),
        endpoint_gid=[process] * 12 + [7] * 12, qos_profile=profile,
    )  # fmt: skip


class GraphNode:
    """The asking node ``/me``; ``asked`` are the topics that were looked up."""

    def __init__(
        self, names: Sequence[tuple[str, str]] = (), infos: Mapping[str, Sequence[Any]] = {}
    ) -> None:
        self.names, self.infos = names, infos
        self.asked: list[str] = []

    def get_fully_qualified_name(self) -> str:
        return "/me"

    def get_name(self) -> str:
        return "me"

    def get_node_names_and_namespaces(self) -> Sequence[tuple[str, str]]:
        return self.names

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        return [(*it, "/" if it[1] == "/" else f"{it[1]}/") for it in self.names]

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Those that some node publishes or subscribes to in ``infos``; no requests of services."""
        return [(it.partition(" ")[2], [STRING]) for it in self.infos if "rq/" not in it]

    def get_publishers_info_by_topic(self, topic: str, no_mangle: bool = False) -> Sequence[Any]:
        self.asked.append(topic)
        return self.infos.get(f"publishes {topic}", ())

    def get_subscriptions_info_by_topic(self, topic: str, no_mangle: bool = False) -> Sequence[Any]:
        assert no_mangle == topic.startswith("rq/"), topic
        return self.infos.get(f"subscribes {topic}", ())


def end(owner: str, role: str, name: str, kind: str = TOPIC, type_: str = STRING) -> End:
    """As a query by node gives it: without QoS and process."""
    return End(kind, role, name, type_, "", owner, None, "")


def whole(owner: str, role: str, name: str, process: int) -> End:
    return End(TOPIC, role, name, STRING, "RIHS01_aa", owner, USUAL, f"{process:02x}" * 12)


def details(node: GraphNode, *found: End, over: bool = False, **asked: Any) -> list[End]:
    names = asked.pop("names", sorted({it.node for it in found}))
    wanted = queries.TopicQueries(asked.get("requested", ()), asked.get("cache", {}), lambda: over)
    return queries.with_topic_details(node, names, list(found), wanted)


def test_names_are_full_and_without_the_one_who_asks() -> None:
    unknown = (UNKNOWN_NODE, "_NODE_NAMESPACE_UNKNOWN_")
    node = GraphNode([("b", "/robot1"), ("a", "/"), ("me", "/"), ("b", "/robot1"), unknown])
    assert queries.node_names(node) == sorted(["/a", "/robot1/b", "/robot1/b", f"/{UNKNOWN_NODE}"])
    assert queries.enclaves(GraphNode([("b", "/r"), ("a", "/")])) == {"/r/b": "/r", "/a": ""}


def test_a_participant_whose_nodes_are_not_known_yet_is_announced_without_nodes() -> None:
    announced = [info(f"/{UNKNOWN_NODE}", it) for it in (1, 2, 9)]
    own = [info("/me", 9), info("/a", 1)]
    node = GraphNode(
        (), {"publishes ros_discovery_info": announced, "publishes /parameter_events": own}
    )
    seen = [whole("/a", PUBLISHES, "/t", 1)]
    assert queries.without_nodes(node, seen) == {"02" * 12}
    assert not queries.without_nodes(node, [*seen, whole("/b", PUBLISHES, "/t", 2)])


def test_a_node_that_leaves_has_what_it_had_until_then() -> None:
    class Gone(Exception):
        pass

    def topics(node: Any, name: str, space: str) -> list[tuple[str, list[str]]]:
        return [(f"{space}|{name}", ["a/msg/A", "b/msg/B"])]

    def services(node: Any, name: str, space: str) -> list[tuple[str, list[str]]]:
        if name == "gone":
            raise Gone
        return [("/s", [TRIGGER])]

    asked = ((TOPIC, PUBLISHES, topics), (SERVICE, SERVES, services))
    found = queries.endpoints_by_node(None, ["/r/gone", "/here", "/here"], asked, Gone)
    assert [(it.node, it.kind, it.role, it.name, it.type) for it in found] == [
        ("/here", TOPIC, PUBLISHES, "/|here", "a/msg/A"),
        ("/here", TOPIC, PUBLISHES, "/|here", "b/msg/B"),
        ("/here", SERVICE, SERVES, "/s", TRIGGER),
        ("/r/gone", TOPIC, PUBLISHES, "/r|gone", "a/msg/A"),
        ("/r/gone", TOPIC, PUBLISHES, "/r|gone", "b/msg/B"),
    ]


@pytest.mark.parametrize(
    ("at", "method", "kind", "role"),
    [
        (0, "get_publisher_names_and_types_by_node", TOPIC, PUBLISHES),
        (1, "get_subscriber_names_and_types_by_node", TOPIC, SUBSCRIBES),
        (2, "get_service_names_and_types_by_node", SERVICE, SERVES),
        (3, "get_client_names_and_types_by_node", SERVICE, CALLS),
    ],
)
def test_each_query_is_the_one_of_its_role(at: int, method: str, kind: str, role: str) -> None:
    node = SimpleNamespace(**{method: lambda name, space: [name, space]})
    assert queries.NODE_QUERIES[at][:2] == (kind, role)
    assert queries.NODE_QUERIES[at][2](node, "a", "/") == ["a", "/"]


def test_no_time_is_given_where_there_is_no_limit() -> None:
    infos = {"publishes /t": [info("/a", 1, version=-1, deadline=1_500_000_000)]}
    (found,) = details(GraphNode((), infos), end("/a", PUBLISHES, "/t"), requested=["/t"])
    assert found.qos == USUAL._replace(deadline=1.5) and found.type_hash == ""


ALONE = {"publishes /alone": [info("/b", 4), info("/a", 3)]}
SERVED = {
    "subscribes rq/sRequest": [info("/a", 3, "std_srvs/srv/Trigger_Request")],
    "publishes rq/sRequest": [info("/a", 3, "std_srvs/srv/Trigger_Request")],
}


@pytest.mark.parametrize(
    ("found", "infos", "process"),
    [
        (end("/a", PUBLISHES, "/alone"), ALONE, "03" * 12),
        (end("/a", SERVES, "/s", SERVICE, TRIGGER), SERVED, "03" * 12),
        (end("/a", CALLS, "/s", SERVICE, TRIGGER), SERVED, "03" * 12),
        # What is asked in vain stays as it was; an action is not asked.
        (end("/a", SUBSCRIBES, "/alone"), ALONE, ""),
        (end("/c", PUBLISHES, "/alone"), ALONE, ""),
        (end("/a", SERVES, "/act", ACTION), SERVED, ""),
    ],
)
def test_one_endpoint_of_each_node_is_asked_for_its_process(
    found: End, infos: dict[str, Any], process: str
) -> None:
    (seen,) = details(GraphNode((), infos), found)
    assert (seen.node, seen.role, seen.name, seen.type) == found[5:6] + found[1:4]
    assert (seen.process, seen.qos) == (process, USUAL if process else None)
    assert details(GraphNode((), infos), found, over=True) == [found]


def test_an_answer_is_kept_while_it_fits_the_nodes() -> None:
    infos = {"publishes /t": [info("/a", 1)], "subscribes /t": [info("/b", 2)]}
    both = end("/a", PUBLISHES, "/t"), end("/b", SUBSCRIBES, "/t")
    node, cache = GraphNode((), infos), dict[str, Any]()
    first = details(node, *both, cache=cache)
    assert details(node, *both, cache=cache) == first and node.asked == ["/t"]
    # Two nodes with one name: what is hidden may have changed.
    details(node, *both, cache=cache, names=["/a", "/a", "/b"])
    assert node.asked == ["/t", "/t"]


def test_an_answer_that_lacks_a_node_is_used_and_asked_for_again() -> None:
    """Discovery is not finished for the topic."""
    both = end("/a", PUBLISHES, "/t"), end("/b", SUBSCRIBES, "/t")
    node, cache = GraphNode((), {"publishes /t": [info("/a", 1)]}), dict[str, Any]()
    assert details(node, *both, cache=cache) == [whole("/a", PUBLISHES, "/t", 1)]
    asked = len(node.asked)
    assert cache == {} and details(node, *both, cache=cache) and len(node.asked) == 2 * asked
