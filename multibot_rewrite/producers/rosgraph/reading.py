# SPDX-License-Identifier: Apache-2.0
"""A message of the type ``rosgraph_msgs/Graph``, what its numbers mean, and the snapshot that it is.

The messages are those of ros2/rcl_interfaces, rosgraph_msgs/msg: since 1.2.3 in Humble, 2.3.2 in Kilted
and 2.4.4 in Rolling. A graph is a list of nodes with their endpoints, without transforms and processes.
"""

import math
import re
from collections.abc import Iterator
from typing import Any, NamedTuple, cast

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.system.record_values import record_from
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    QUIET,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    End,
    Environment,
    Node,
    Qos,
    System,
)

# nodl_observe writes no limit as the largest int32, rosgraph_monitor as 0.
_NO_LIMIT = 2**31 - 1
_CUT_SHORT = lazy_compile(r"^[^\S\n]*- '?\.\.\.'?$", re.MULTILINE)
_REQUEST = "_Request"
# The numbers of QoSProfile.msg, and of rmw types.h, are places in these lists.
HISTORY = ("SYSTEM_DEFAULT", "KEEP_LAST", "KEEP_ALL", "UNKNOWN")
RELIABILITY = ("SYSTEM_DEFAULT", "RELIABLE", "BEST_EFFORT", "UNKNOWN", "BEST_AVAILABLE")
DURABILITY = ("SYSTEM_DEFAULT", "TRANSIENT_LOCAL", "VOLATILE", "UNKNOWN", "BEST_AVAILABLE")
LIVELINESS = (
    *("SYSTEM_DEFAULT", "AUTOMATIC", "MANUAL_BY_NODE"),
    *("MANUAL_BY_TOPIC", "UNKNOWN", "BEST_AVAILABLE"),
)
UNKNOWN = "UNKNOWN"
SEND_GOAL = "_SendGoal"
NO_FRAMES = Caveat(
    "frames-not-read", False, "a rosgraph_msgs/Graph has no transforms: they are not compared"
)
_NO_SERVICE = "no service is in this rosgraph_msgs/Graph: its monitor reports topics only"
ONLY_TOPICS = Caveat("topics-only", True, _NO_SERVICE)


def is_message(value: object) -> bool:
    """Return whether a value is a message and not a snapshot of ours, which has a schema."""
    return (
        isinstance(value, dict) and "nodes" in value and not value.keys() & {"schema", "endpoints"}
    )


def from_message(value: dict[str, Any], file: str) -> System:
    """Return the snapshot that a message describes; raises InputError with file and key."""
    graph = cast(Graph, record_from(Graph, _without_parameters(value), file))
    nodes, ends = [], []
    for node in graph.nodes:
        nodes.append(Node(_checked_name(node.name, file), ""))
        ends += [end._replace(name=_checked_name(end.name, file)) for end in _ends_of(node, file)]
    caveats = [NO_FRAMES]
    if not any(end.kind == SERVICE for end in ends):
        caveats.append(ONLY_TOPICS)
    around = Environment(0, "", (), "", "", False, 0, QUIET, 0.0, tuple(caveats))
    return System(tuple(nodes), tuple(ends), (), around)


def from_yaml(text: str, file: str) -> System:
    """Return the snapshot in what ``ros2 topic echo --once --full-length`` printed; or InputError."""
    if _CUT_SHORT.search(text):
        hint = "print it with ros2 topic echo --once --full-length"
        raise InputError(f"{file}: the message is cut short by '...'; {hint}")
    last = [part for part in re.split(r"^---\s*$", text, flags=re.MULTILINE) if part.strip()][-1]
    value = load_yaml(last, file, "print it with ros2 topic echo --once --full-length")
    if not is_message(value):
        raise InputError(f"{file}: not a rosgraph_msgs/Graph; it has no list of nodes")
    return from_message(value, file)


def _without_parameters(value: dict[str, Any]) -> dict[str, Any]:
    nodes = value["nodes"]
    if not isinstance(nodes, list):
        return value
    left = ("parameters", "parameter_values")
    kept = [
        {key: it for key, it in node.items() if key not in left} if isinstance(node, dict) else node
        for node in nodes
    ]
    return {**value, "nodes": kept}


def _checked_name(name: str, file: str) -> str:
    """Return a full name; raises InputError for another one."""
    if not name.startswith("/"):
        raise InputError(f"{file}: {name!r} is not a full name, write a slash in front")
    return name


def _ends_of(node: "NodeMessage", file: str) -> Iterator[End]:
    for role, topics in ((PUBLISHES, node.publishers), (SUBSCRIBES, node.subscriptions)):
        yield from (_topic(it, role, node.name, file) for it in topics)
    for role, services in ((SERVES, node.service_servers), (CALLS, node.service_clients)):
        yield from (_service(it, role, node.name) for it in services)
    for role, actions in ((SERVES, node.action_servers), (CALLS, node.action_clients)):
        for action in actions:
            yield from _action(action, role, node.name, file)


def _topic(topic: "Topic", role: str, node: str, file: str) -> End:
    version, value = topic.type.hash
    if not all(0 <= it < 256 for it in (version, *value)):
        what = "type.hash has a number that is not 0 to 255; record the graph again"
        raise InputError(f"{file}: topic {topic.name}: {what}")
    hash_ = f"RIHS{version:02d}_{bytes(value).hex()}" if any(value) else ""
    qos = _qos(topic, file)
    return End(TOPIC, role, topic.name, topic.type.name, hash_, node, qos, "")


def _service(service: "Service", role: str, node: str) -> End:
    type_ = service.request_type.name.removesuffix(_REQUEST)
    return End(SERVICE, role, service.name, type_, "", node, None, "")


def _action(action: "Action", role: str, node: str, file: str) -> Iterator[End]:
    """Yield the action, and the services and topics that it is made of, as a snapshot has them."""
    parts = [_service(it, role, node) for it in action[1:4] if isinstance(it, Service) and it.name]
    sent = PUBLISHES if role == SERVES else SUBSCRIBES
    parts += [
        _topic(it, sent, node, file) for it in action[4:] if isinstance(it, Topic) and it.name
    ]
    type_ = action.send_goal.request_type.name.removesuffix(_REQUEST).removesuffix(SEND_GOAL)
    yield End(ACTION, role, action.name, type_, "", node, None, "")
    yield from parts


def _qos(topic: "Topic", file: str) -> Qos | None:
    qos = topic.qos
    given = (
        (HISTORY, qos.history),
        (RELIABILITY, qos.reliability),
        (DURABILITY, qos.durability),
        (LIVELINESS, qos.liveliness),
    )
    for known, number in given:
        if not 0 <= number < len(known):
            raise InputError(
                f"{file}: {topic.name}: QoS has no policy {number}; record the graph again"
            )
    history, reliability, durability, liveliness = (known[number] for known, number in given)
    if {reliability, durability} == {UNKNOWN}:
        return None
    return Qos(
        history,
        qos.depth,
        reliability,
        durability,
        _seconds(qos.deadline),
        _seconds(qos.lifespan),
        liveliness,
        _seconds(qos.liveliness_lease_duration),
    )


def _seconds(duration: "Duration") -> float:
    if duration.sec == _NO_LIMIT or duration == (0, 0):
        return math.inf
    return duration.sec + duration.nanosec / 1e9


class Hash(NamedTuple):
    """TypeHash.msg."""

    version: int
    value: tuple[int, ...]


class InterfaceType(NamedTuple):
    """InterfaceType.msg."""

    name: str
    hash: Hash


class Duration(NamedTuple):
    """builtin_interfaces/Duration."""

    sec: int
    nanosec: int


class QosProfile(NamedTuple):
    """QoSProfile.msg."""

    depth: int
    deadline: Duration
    lifespan: Duration
    history: int
    reliability: int
    durability: int
    liveliness: int
    liveliness_lease_duration: Duration


class Topic(NamedTuple):
    """Topic.msg."""

    name: str
    type: InterfaceType
    qos: QosProfile


class Service(NamedTuple):
    """Service.msg."""

    name: str
    request_type: InterfaceType
    request_qos: QosProfile
    response_type: InterfaceType
    response_qos: QosProfile


class Action(NamedTuple):
    """Action.msg."""

    name: str
    send_goal: Service
    get_result: Service
    cancel_goal: Service
    feedback: Topic
    status: Topic


class NodeMessage(NamedTuple):
    """Node.msg without its parameters."""

    name: str
    publishers: tuple[Topic, ...]
    subscriptions: tuple[Topic, ...]
    service_clients: tuple[Service, ...]
    service_servers: tuple[Service, ...]
    action_clients: tuple[Action, ...]
    action_servers: tuple[Action, ...]


class Graph(NamedTuple):
    """Graph.msg."""

    nodes: tuple[NodeMessage, ...]
