# SPDX-License-Identifier: Apache-2.0
"""Liveliness tokens of rmw_zenoh -> the nodes and endpoints that they announce. Pure.

Source: rmw_zenoh ``rmw_zenoh_cpp/src/detail/liveliness_utils.cpp`` at 3411fde: ``KeyexprIndex`` (the
parts and their order, lines 98 to 113), ``entity_to_str`` (the kinds), ``qos_to_keyexpr`` and
``keyexpr_to_qos`` (a field is empty where it has its default), ``mangle_name`` (``/`` is ``%``),
``Entity::make`` (what is refused); ``qos.cpp`` has the defaults, rmw ``types.h`` the numbers. The
format is one for all releases: what differs is the session id, whose bytes had no leading zeros at
first, and the hash, which is ``TypeHashNotSupported`` in Humble. Neither is taken apart here.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import inf
from typing import NamedTuple

from multibot_rewrite.producers.rosgraph.reading import DURABILITY, HISTORY, LIVELINESS, RELIABILITY
from multibot_rewrite.producers.zenoh import SPACE
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
    Node,
    Qos,
)

NODE = "NN"
_ENDS = {
    "MP": (TOPIC, PUBLISHES),
    "MS": (TOPIC, SUBSCRIBES),
    "SS": (SERVICE, SERVES),
    "SC": (SERVICE, CALLS),
}
_NODE_PARTS, _END_PARTS = 9, 13
# qos.cpp.
_DEFAULT_DEPTH = 42
# RMW_DURATION_INFINITE: the seconds and nanoseconds of the largest int64.
_INFINITE_SECONDS = 9223372036
_INFINITE_NANOSECONDS = 854775807
# rcl_action names.c and graph.c: who publishes the feedback of an action serves it.
_FEEDBACK, _FEEDBACK_TYPE = "/_action/feedback", "_FeedbackMessage"
_ACTION_ROLES = {PUBLISHES: SERVES, SUBSCRIBES: CALLS}


class Token(NamedTuple):
    """What one token announces; ``end`` is None for a node itself.

    ``session`` and ``node_id`` together identify a node, since two may have one name.
    """

    domain: int
    session: str
    node_id: str
    node: str
    enclave: str
    end: End | None


class _Malformed(Exception):
    """A token that rmw_zenoh would not take either."""


def read_token(key: str) -> Token | None:
    """Return the token with this key expression; None for what rmw_zenoh would not take either."""
    try:
        parts = key.split("/")
        if len(parts) < _NODE_PARTS or parts[0] != SPACE or "" in parts:
            raise _Malformed
        domain, session, node_id, _, kind, enclave, namespace, name = parts[1:_NODE_PARTS]
        space = _with_slashes(namespace)
        node = f"{'' if space == '/' else space}/{_with_slashes(name)}"
        if not node.startswith("/"):
            raise _Malformed
        end = None if kind == NODE else _end_of_token(kind, node, session, parts[_NODE_PARTS:])
        return Token(_number(domain), session, node_id, node, _with_slashes(enclave), end)
    except _Malformed:
        return None


def _end_of_token(kind: str, node: str, session: str, rest: Sequence[str]) -> End:
    if kind not in _ENDS or len(rest) < _END_PARTS - _NODE_PARTS:
        raise _Malformed
    name, type_, hash_ = (_with_slashes(part) for part in rest[:3])
    if not name.startswith("/"):
        raise _Malformed
    role = _ENDS[kind]
    known = hash_ if hash_.startswith("RIHS") else ""
    return End(*role, name, ros_type(type_), known, node, read_qos(rest[3]), session)


def _with_slashes(part: str) -> str:
    return part.replace("%", "/")


def ros_type(name: str) -> str:
    """Return ``std_msgs::msg::dds_::String_`` as ``std_msgs/msg/String``, as graph_cache.cpp does."""
    package, found, own = name.partition("dds_::")
    if not found or not own.endswith("_"):
        return name
    return f"{package.replace('::', '/')}{own[:-1]}"


# A fleet has thousands of endpoints and a handful of profiles.
@lru_cache(maxsize=256)
def read_qos(text: str) -> Qos:
    """Return the QoS that a token ends in; raises for what rmw_zenoh would not take.

    It is ``reliability:durability:history,depth:deadline:lifespan:liveliness,lease``; the times are
    ``seconds,nanoseconds``."""
    parts = [part.split(",") for part in text.split(":")]
    if [len(part) for part in parts[2:6]] != [2, 2, 2, 3]:
        raise _Malformed
    reliability, durability, history, deadline, lifespan, liveliness = parts[:6]
    return Qos(
        _text_of_number(HISTORY, history[0], "KEEP_LAST"),
        _number(history[1], _DEFAULT_DEPTH),
        _text_of_number(RELIABILITY, reliability[0], "RELIABLE"),
        _text_of_number(DURABILITY, durability[0], "VOLATILE"),
        _seconds(*deadline),
        _seconds(*lifespan),
        _text_of_number(LIVELINESS, liveliness[0], "AUTOMATIC"),
        _seconds(*liveliness[1:]),
    )


def _text_of_number(known: Sequence[str], text: str, default: str) -> str:
    number = _number(text, known.index(default))
    if number >= len(known):
        raise _Malformed
    return known[number]


def _number(text: str, default: int | None = None) -> int:
    if not text and default is not None:
        return default
    # strtoul takes digits alone here; a longer number overflows there.
    if not (text.isascii() and text.isdigit()) or len(text) > 19:
        raise _Malformed
    return int(text)


def _seconds(whole: str, rest: str) -> float:
    seconds = _number(whole, _INFINITE_SECONDS)
    nanoseconds = _number(rest, _INFINITE_NANOSECONDS)
    if seconds >= _INFINITE_SECONDS or seconds == nanoseconds == 0:
        return inf
    return seconds + nanoseconds / 1e9


def nodes(tokens: Iterable[Token]) -> list[Node]:
    """Return a record for each node or owner of an endpoint (as graph_cache.cpp does), by name."""
    found = {(it.node, it.session, it.node_id, it.enclave.rstrip("/")) for it in tokens}
    return [Node(name, session, enclave) for name, session, _, enclave in sorted(found)]


def endpoints(tokens: Iterable[Token]) -> list[End]:
    """Return the endpoints in order, with the actions that topics of theirs belong to."""
    ends = [it.end for it in tokens if it.end]
    for end in [it for it in ends if it.kind == TOPIC]:
        if end.name.endswith(_FEEDBACK) and end.type.endswith(_FEEDBACK_TYPE):
            role, name = _ACTION_ROLES[end.role], end.name.removesuffix(_FEEDBACK)
            type_ = end.type.removesuffix(_FEEDBACK_TYPE)
            ends.append(End(ACTION, role, name, type_, "", end.node, None, end.process))
    return sorted(ends, key=repr)
