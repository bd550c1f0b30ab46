"""A snapshot as a message of the type ``rosgraph_msgs/Graph``, in YAML as ``ros2 topic echo`` prints it.

The messages are those of rcl_interfaces (rosgraph_msgs/msg, since 1.2.3, 2.0.4, 2.3.2 and 2.4.4): a graph
is a list of nodes with their endpoints. Transforms, processes and the environment are not part of it.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, cast

from multibot_rewrite.bounded import load_yaml
from multibot_rewrite.graph.snapshot import (
    QUIET,
    Caveat,
    Environment,
    GraphEndpoint,
    GraphNode,
    Qos,
    Snapshot,
    record_from,
)
from multibot_rewrite.model import InputError
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

_POLICIES = ("SYSTEM_DEFAULT", "RELIABLE", "BEST_EFFORT", "UNKNOWN", "BEST_AVAILABLE")
# The numbers of QoSProfile.msg are places in these lists.
HISTORY = ("SYSTEM_DEFAULT", "KEEP_LAST", "KEEP_ALL", "UNKNOWN")
RELIABILITY = _POLICIES
DURABILITY = ("SYSTEM_DEFAULT", "TRANSIENT_LOCAL", "VOLATILE", "UNKNOWN", "BEST_AVAILABLE")
LIVELINESS = (
    *("SYSTEM_DEFAULT", "AUTOMATIC", "MANUAL_BY_NODE"),
    *("MANUAL_BY_TOPIC", "UNKNOWN", "BEST_AVAILABLE"),
)
UNKNOWN = "UNKNOWN"
# nodl_observe writes no limit as the largest int32, rosgraph_monitor as 0.
_NO_LIMIT = 2**31 - 1
_HASH = re.compile(r"RIHS(\d\d)_([0-9a-f]{64})")
_HASH_BYTES = 32
_CUT_SHORT = re.compile(r"^\s*- '?\.\.\.'?$", re.MULTILINE)
_SEND_GOAL, _REQUEST = "_SendGoal", "_Request"
NO_FRAMES = Caveat(
    "frames-not-read", False, "a rosgraph_msgs/Graph has no transforms: they are not compared"
)
ONLY_TOPICS = Caveat(
    "topics-only",
    True,
    "no service is in this rosgraph_msgs/Graph: its monitor reports topics only",
)


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


class Node(NamedTuple):
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

    nodes: tuple[Node, ...]


def is_message(value: object) -> bool:
    """Is it a message and not a snapshot of ours, which has a schema?"""
    return (
        isinstance(value, dict) and "nodes" in value and not value.keys() & {"schema", "endpoints"}
    )


def from_message(value: dict[str, Any], file: str) -> Snapshot:
    """The snapshot that a message describes; raises InputError with file and key."""
    graph = cast(Graph, record_from(Graph, _without_parameters(value), file))
    nodes, ends = [], []
    for node in graph.nodes:
        nodes.append(GraphNode(_full(node.name, file), ""))
        ends += [end._replace(name=_full(end.name, file)) for end in _endpoints(node, file)]
    caveats = [NO_FRAMES]
    if not any(end.kind == SERVICE for end in ends):
        caveats.append(ONLY_TOPICS)
    around = Environment(0, "", (), "", "", False, 0, QUIET, 0.0, tuple(caveats))
    return Snapshot(tuple(nodes), tuple(ends), (), around)


def from_yaml(text: str, file: str) -> Snapshot:
    """Read what ``ros2 topic echo --once --full-length`` printed; raises InputError."""
    import yaml

    if _CUT_SHORT.search(text):
        hint = "print it with ros2 topic echo --once --full-length"
        raise InputError(f"{file}: the message is cut short by '...'; {hint}")
    last = [part for part in re.split(r"^---\s*$", text, flags=re.MULTILINE) if part.strip()][-1]
    try:
        value = load_yaml(last)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{file}:{mark.line + 1}" if mark else file
        reason = getattr(error, "problem", None) or " ".join(str(error).split())
        raise InputError(f"{place}: not valid YAML: {reason}") from None
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


def _full(name: str, file: str) -> str:
    if not name.startswith("/"):
        raise InputError(f"{file}: {name!r} is not a full name that starts with /")
    return name


def _endpoints(node: Node, file: str) -> Iterator[GraphEndpoint]:
    for role, topics in ((PUBLISHES, node.publishers), (SUBSCRIBES, node.subscriptions)):
        yield from (_topic(it, role, node.name, file) for it in topics)
    for role, services in ((SERVES, node.service_servers), (CALLS, node.service_clients)):
        yield from (_service(it, role, node.name) for it in services)
    for role, actions in ((SERVES, node.action_servers), (CALLS, node.action_clients)):
        for action in actions:
            yield from _action(action, role, node.name, file)


def _topic(topic: Topic, role: str, node: str, file: str) -> GraphEndpoint:
    version, value = topic.type.hash
    if not all(0 <= it < 256 for it in (version, *value)):
        raise InputError(f"{file}: {topic.name}: a byte of the type's hash is not 0 to 255")
    hash_ = f"RIHS{version:02d}_{bytes(value).hex()}" if any(value) else ""
    qos = _qos(topic, file)
    return GraphEndpoint(TOPIC, role, topic.name, topic.type.name, hash_, node, qos, "")


def _service(service: Service, role: str, node: str) -> GraphEndpoint:
    type_ = service.request_type.name.removesuffix(_REQUEST)
    return GraphEndpoint(SERVICE, role, service.name, type_, "", node, None, "")


def _action(action: Action, role: str, node: str, file: str) -> Iterator[GraphEndpoint]:
    """The action, and the services and topics that it is made of, as a snapshot has them."""
    parts = [_service(it, role, node) for it in action[1:4] if isinstance(it, Service) and it.name]
    sent = PUBLISHES if role == SERVES else SUBSCRIBES
    parts += [
        _topic(it, sent, node, file) for it in action[4:] if isinstance(it, Topic) and it.name
    ]
    type_ = action.send_goal.request_type.name.removesuffix(_REQUEST).removesuffix(_SEND_GOAL)
    yield GraphEndpoint(ACTION, role, action.name, type_, "", node, None, "")
    yield from parts


def _qos(topic: Topic, file: str) -> Qos | None:
    qos = topic.qos
    given = (
        (HISTORY, qos.history),
        (RELIABILITY, qos.reliability),
        (DURABILITY, qos.durability),
        (LIVELINESS, qos.liveliness),
    )
    for known, number in given:
        if not 0 <= number < len(known):
            raise InputError(f"{file}: {topic.name}: qos: there is no policy {number}")
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


def _seconds(duration: Duration) -> float:
    if duration.sec == _NO_LIMIT or duration == (0, 0):
        return math.inf
    return duration.sec + duration.nanosec / 1e9


def to_yaml(snapshot: Snapshot) -> bytes:
    """The snapshot as a message; what a message cannot hold is left out."""
    import yaml

    ends: dict[str, list[GraphEndpoint]] = defaultdict(list)
    for end in snapshot.endpoints:
        ends[end.node].append(end)
    # Of two nodes with a name the first gets all: a message does not say whose an endpoint is.
    nodes = [_node(node.name, ends.pop(node.name, [])) for node in snapshot.nodes]
    return cast(str, yaml.safe_dump({"nodes": nodes}, sort_keys=False)).encode() + b"---\n"


def _node(name: str, ends: Sequence[GraphEndpoint]) -> dict[str, object]:
    parts = _action_parts(ends)
    plain = [it for it in ends if it not in parts]

    def of(kind: str, role: str) -> list[GraphEndpoint]:
        return [it for it in plain if (it.kind, it.role) == (kind, role)]

    return {
        "name": name,
        "parameters": [],
        "parameter_values": [],
        "publishers": [_topic_message(it) for it in of(TOPIC, PUBLISHES)],
        "subscriptions": [_topic_message(it) for it in of(TOPIC, SUBSCRIBES)],
        "service_clients": [_service_message(it) for it in of(SERVICE, CALLS)],
        "service_servers": [_service_message(it) for it in of(SERVICE, SERVES)],
        "action_clients": [_action_message(it, parts) for it in of(ACTION, CALLS)],
        "action_servers": [_action_message(it, parts) for it in of(ACTION, SERVES)],
    }


def _side(end: GraphEndpoint) -> str:
    return SERVES if end.role in (SERVES, PUBLISHES) else CALLS


_Parts = Mapping[GraphEndpoint, tuple[str, str, str]]


def _action_parts(ends: Iterable[GraphEndpoint]) -> dict[GraphEndpoint, tuple[str, str, str]]:
    """The hidden endpoints of the actions that are listed: side, action, part."""
    ends = list(ends)
    actions = {(it.role, it.name) for it in ends if it.kind == ACTION}
    found = {}
    for end in ends:
        name, hidden, part = end.name.partition("/_action/")
        if hidden and end.kind != ACTION and (_side(end), name) in actions:
            found[end] = (_side(end), name, part)
    return found


def _action_message(action: GraphEndpoint, parts: _Parts) -> dict[str, object]:
    own = {
        part: end
        for end, (side, name, part) in parts.items()
        if (side, name) == (action.role, action.name)
    }
    message: dict[str, object] = {"name": action.name}
    for part, suffix in (
        ("send_goal", _SEND_GOAL),
        ("get_result", "_GetResult"),
        ("cancel_goal", ""),
    ):
        type_ = f"{action.type}{suffix}" if suffix else "action_msgs/srv/CancelGoal"
        name = f"{action.name}/_action/{part}"
        made = action._replace(kind=SERVICE, name=name, type=type_)
        message[part] = _service_message(own.get(part, made))
    for part, type_ in (
        ("feedback", f"{action.type}_FeedbackMessage"),
        ("status", "action_msgs/msg/GoalStatusArray"),
    ):
        made = action._replace(kind=TOPIC, name=f"{action.name}/_action/{part}", type=type_)
        message[part] = _topic_message(own.get(part, made))
    return message


def _type_message(name: str, hash_: str = "") -> dict[str, object]:
    found = _HASH.fullmatch(hash_)
    value = list(bytes.fromhex(found[2])) if found else [0] * _HASH_BYTES
    return {"name": name, "hash": {"version": int(found[1]) if found else 1, "value": value}}


def _topic_message(end: GraphEndpoint) -> dict[str, object]:
    type_ = _type_message(end.type, end.type_hash)
    return {"name": end.name, "type": type_, "qos": _qos_message(end.qos)}


def _service_message(end: GraphEndpoint) -> dict[str, object]:
    message: dict[str, object] = {"name": end.name}
    for side in ("request", "response"):
        message[f"{side}_type"] = _type_message(end.type)
        message[f"{side}_qos"] = _qos_message(None)
    return message


def _qos_message(qos: Qos | None) -> dict[str, object]:
    given = qos or Qos(UNKNOWN, 0, UNKNOWN, UNKNOWN, math.inf, math.inf, UNKNOWN, math.inf)
    return {
        "depth": given.depth,
        "deadline": _duration_message(given.deadline),
        "lifespan": _duration_message(given.lifespan),
        "history": _number(HISTORY, given.history),
        "reliability": _number(RELIABILITY, given.reliability),
        "durability": _number(DURABILITY, given.durability),
        "liveliness": _number(LIVELINESS, given.liveliness),
        "liveliness_lease_duration": _duration_message(given.liveliness_lease_duration),
    }


def _number(known: Sequence[str], word: str) -> int:
    return known.index(word if word in known else UNKNOWN)


def _duration_message(seconds: float) -> dict[str, int]:
    if math.isinf(seconds) or seconds >= _NO_LIMIT:
        return {"sec": 0, "nanosec": 0}
    whole = int(seconds)
    return {"sec": whole, "nanosec": round((seconds - whole) * 1e9)}
