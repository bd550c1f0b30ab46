# SPDX-License-Identifier: Apache-2.0
"""A snapshot -> a message of the type ``rosgraph_msgs/Graph``, as ``ros2 topic echo`` prints it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.producers.rosgraph.reading import (
    DURABILITY,
    HISTORY,
    LIVELINESS,
    RELIABILITY,
    SEND_GOAL,
    UNKNOWN,
)
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    Qos,
    System,
)

_HASH = re.compile(r"RIHS(\d\d)_([0-9a-f]{64})")
_HASH_BYTES = 32
_LONGEST = 2**31
# The types of an action's parts (rcl_action names.c, rosidl).
_GET_RESULT, _FEEDBACK = "_GetResult", "_FeedbackMessage"
_CANCEL, _STATUS = "action_msgs/srv/CancelGoal", "action_msgs/msg/GoalStatusArray"


def to_yaml(snapshot: System) -> bytes:
    """Return the snapshot as a message in YAML."""
    import yaml

    return str(yaml.safe_dump(to_message(snapshot), sort_keys=False)).encode() + b"---\n"


def to_message(snapshot: System) -> dict[str, object]:
    """Return the snapshot as the fields of a message; what a message cannot hold is left out."""
    ends = lists_by_key((end.node, end) for end in snapshot.ends)
    # Of two nodes with a name the first gets all: a message does not say whose an endpoint is.
    return {"nodes": [_node_message(it.name, ends.pop(it.name, [])) for it in snapshot.nodes]}


def _node_message(name: str, ends: Sequence[End]) -> dict[str, object]:
    actions = {(it.role, it.name) for it in ends if it.kind == ACTION}
    parts = {}
    for end in ends:
        whole, hidden, _ = end.name.partition("/_action/")
        side = SERVES if end.role in (SERVES, PUBLISHES) else CALLS
        if hidden and end.kind != ACTION and (side, whole) in actions:
            parts[end] = side, whole
    plain = [it for it in ends if it not in parts]

    def of(kind: str, role: str) -> list[End]:
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


# A hidden endpoint of an action -> the action's role and name.
_Parts = Mapping[End, tuple[str, str]]


def _action_message(action: End, parts: _Parts) -> dict[str, object]:
    own = {end.name: end for end, whole in parts.items() if whole == (action.role, action.name)}

    def part(kind: str, name: str, type_: str) -> End:
        full = f"{action.name}/_action/{name}"
        return own.get(full, action._replace(kind=kind, name=full, type=type_))

    return {
        "name": action.name,
        "send_goal": _service_message(part(SERVICE, "send_goal", action.type + SEND_GOAL)),
        "get_result": _service_message(part(SERVICE, "get_result", action.type + _GET_RESULT)),
        "cancel_goal": _service_message(part(SERVICE, "cancel_goal", _CANCEL)),
        "feedback": _topic_message(part(TOPIC, "feedback", action.type + _FEEDBACK)),
        "status": _topic_message(part(TOPIC, "status", _STATUS)),
    }


def _type_message(name: str, hash_: str = "") -> dict[str, object]:
    found = _HASH.fullmatch(hash_)
    value = list(bytes.fromhex(found[2])) if found else [0] * _HASH_BYTES
    return {"name": name, "hash": {"version": int(found[1]) if found else 1, "value": value}}


def _topic_message(end: End) -> dict[str, object]:
    type_ = _type_message(end.type, end.type_hash)
    return {"name": end.name, "type": type_, "qos": _qos_message(end.qos)}


def _service_message(end: End) -> dict[str, object]:
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
        "history": _number_of_policy(HISTORY, given.history),
        "reliability": _number_of_policy(RELIABILITY, given.reliability),
        "durability": _number_of_policy(DURABILITY, given.durability),
        "liveliness": _number_of_policy(LIVELINESS, given.liveliness),
        "liveliness_lease_duration": _duration_message(given.liveliness_lease_duration),
    }


def _number_of_policy(known: Sequence[str], word: str) -> int:
    return known.index(word if word in known else UNKNOWN)


def _duration_message(seconds: float) -> dict[str, int]:
    if math.isinf(seconds) or seconds >= _LONGEST:
        return {"sec": 0, "nanosec": 0}
    whole = int(seconds)
    return {"sec": whole, "nanosec": round((seconds - whole) * 1e9)}
