"""What a ROS graph looks like: frozen records, and how they are read and written as JSON.

Pure, needs no ROS. Field names follow ``rosgraph_msgs`` (rcl_interfaces) where it has them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from functools import cache, lru_cache, partial
from sys import intern
from types import NoneType
from typing import Any, cast, get_args, get_origin, get_type_hints

from multibot_rewrite.bounded import load_json
from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.json_values import (
    Reader,
    WrongValue,
    read_full_name,
    read_list,
    read_plain,
    read_seconds,
    read_transform,
    read_word,
    shown,
    unexpected,
)
from multibot_rewrite.graph.states import NodeState
from multibot_rewrite.model import InputError
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.system.records import KINDS, ROLES

SCHEMA = 1
# Why the observation ended: all expected nodes are there, the graph no longer changes, the timeout
# is over. CHANGING: it has not ended, the graph is being watched.
EXPECTED, QUIET, TIMEOUT, CHANGING = "expected", "quiet", "timeout", "changing"
# The node name in rmw of an endpoint whose participant has not announced its nodes yet.
UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"
# The RMW of a view from a Zenoh router.
ZENOH = "rmw_zenoh_cpp"
# How the names of tf2's listener nodes start; the rest is an address.
LISTENER = "transform_listener_impl_"


class Qos(NamedTuple):
    """The quality of service an endpoint offers or requests; words as in ``rosgraph_msgs``.

    Times are seconds, ``inf`` (null in JSON) is no limit. Fast DDS does not announce history and
    depth to other processes: they are ``UNKNOWN`` and 0 then.
    """

    history: str
    depth: int
    reliability: str
    durability: str
    deadline: float
    lifespan: float
    liveliness: str
    liveliness_lease_duration: float


class GraphNode(NamedTuple):
    """One node. Two nodes with one name are two records.

    ``name`` is fully qualified. ``process`` identifies the DDS participant of the node, empty
    where it is not known. ``enclave`` is that of its process (SROS2), empty for none.
    """

    name: str
    process: str
    enclave: str = ""


class GraphEndpoint(NamedTuple):
    """A node's end of a topic, service or action.

    ``kind`` and ``role`` are the words of ``remap.records``. ``name`` and ``node`` are fully
    qualified. ``type_hash``, ``qos`` and the endpoint's own ``process`` are known only where the
    topic was queried; otherwise they are empty, None and the process of the node.
    """

    kind: str
    role: str
    name: str
    type: str
    type_hash: str
    node: str
    qos: Qos | None
    process: str


class GraphFrame(NamedTuple):
    """A transform received on ``topic``; ``publishers`` are all nodes that publish there.

    tf messages do not say which node sent them; ``several`` is whether more than one did.
    ``transform`` is the last one: x, y, z in metres and a quaternion x, y, z, w; empty if not known.
    """

    child: str
    parent: str
    topic: str
    static: bool
    publishers: tuple[str, ...]
    several: bool = False
    transform: tuple[float, ...] = ()


class HeardFrame(NamedTuple):
    """The ``header.frame_id`` of a message that was received on ``topic``, as it is written there."""

    topic: str
    frame: str


class Caveat(NamedTuple):
    """What to know about a view; with ``incomplete`` something may be missing in it."""

    code: str
    incomplete: bool
    message: str


class Environment(NamedTuple):
    """How the graph was observed, and how complete the view is.

    ``participants`` counts the DDS participants without the observer's own. ``settled`` is
    ``EXPECTED``, ``QUIET``, ``TIMEOUT`` or ``CHANGING``, reached after ``seconds``.
    """

    domain: int
    range: str
    static_peers: tuple[str, ...]
    rmw: str
    discovery_server: str
    super_client: bool
    participants: int
    settled: str
    seconds: float
    caveats: tuple[Caveat, ...]


class Snapshot(NamedTuple):
    """The graph at one moment.

    ``heard`` are frames that messages name, one message a topic; ``states`` what nodes answered. Both
    are empty where nobody listened or asked.
    """

    nodes: tuple[GraphNode, ...]
    endpoints: tuple[GraphEndpoint, ...]
    frames: tuple[GraphFrame, ...]
    environment: Environment
    heard: tuple[HeardFrame, ...] = ()
    states: tuple[NodeState, ...] = ()


_ALLOWED_WORDS: Mapping[tuple[type, str], tuple[str, ...]] = {
    (GraphEndpoint, "kind"): KINDS,
    (GraphEndpoint, "role"): ROLES,
    (Environment, "settled"): (EXPECTED, QUIET, TIMEOUT, CHANGING),
}
_FULL_NAMES = {
    (GraphNode, "name"),
    (GraphEndpoint, "name"),
    (GraphEndpoint, "node"),
    (GraphFrame, "topic"),
    (HeardFrame, "topic"),
    (NodeState, "node"),
}
_TRANSFORM = (GraphFrame, "transform")


def incomplete(snapshot: Snapshot) -> tuple[Caveat, ...]:
    """Why something may be missing in the view; empty for a complete one."""
    return tuple(caveat for caveat in snapshot.environment.caveats if caveat.incomplete)


def to_json(snapshot: Snapshot) -> bytes:
    """The snapshot as JSON, one record on each line, in the order of the records."""
    parts = [f'"schema": {SCHEMA}']
    for name in ("nodes", "endpoints", "frames", "heard", "states"):
        lines = ",\n  ".join(_line(record) for record in getattr(snapshot, name))
        if lines or name not in Snapshot._field_defaults:
            parts.append(f'"{name}": [\n  {lines}\n ]' if lines else f'"{name}": []')
    environment = json.dumps(plain_value(snapshot.environment), indent=1, ensure_ascii=False)
    parts.append('"environment": ' + environment.replace("\n", "\n "))
    return ("{\n " + ",\n ".join(parts) + "\n}\n").encode("utf-8", "backslashreplace")


def _line(record: object) -> str:
    return json.dumps(plain_value(record), ensure_ascii=False)


def plain_value(value: object) -> object:
    """A record as JSON has it, without what is as usual."""
    if isinstance(value, tuple):
        fields = getattr(value, "_fields", None)
        if fields is None:
            return [plain_value(item) for item in value]
        usual = type(value)._field_defaults  # type: ignore[attr-defined]
        pairs = zip(fields, value, strict=True)
        return {name: plain_value(it) for name, it in pairs if usual.get(name, ...) != it}
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def from_json(data: bytes, file: str) -> Snapshot:
    """Read what ``to_json`` wrote; raises InputError with file, key, what is wrong, what to do."""
    return from_value(json_value(data, file), file)


def json_value(data: bytes, file: str) -> object:
    """The value of a JSON file, with the records of a snapshot that are as they have to be; raises
    InputError with file, what is wrong, what to do."""
    try:
        with gc_paused():
            return load_json(data, _record_or_object)
    except json.JSONDecodeError as error:
        place = f"{file}:{error.lineno}:{error.colno}"
        hint = "use the file that multibot snapshot -o wrote"
        raise InputError(f"{place}: not valid JSON: {error.msg}; {hint}") from None
    except ValueError as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}") from None


def _record_or_object(value: dict[str, object]) -> object:
    """The node or endpoint that an object of JSON is; else the object, whose reader says what is wrong.

    A large fleet has hundreds of thousands, and records with shared texts need a fifth of the memory.
    """
    made = _FREQUENT.get(tuple(value))
    try:
        return made(*value.values()) if made else value
    # A TypeError also for what is no text: it cannot be interned.
    except (TypeError, WrongValue):
        return value


def _node(*fields: Any) -> GraphNode:
    record = GraphNode(*map(intern, fields))
    if not record.name.startswith("/"):
        raise TypeError
    return record


def _endpoint(*fields: Any) -> GraphEndpoint:
    *texts, qos, process = fields
    kind, role, name, type_, hash_, node = map(intern, texts)
    known = kind in KINDS and role in ROLES and type(qos) in (Qos, NoneType)
    if not (known and name.startswith("/") and node.startswith("/")):
        raise TypeError
    return GraphEndpoint(kind, role, name, type_, hash_, node, qos, intern(process))


def _qos(*fields: Any) -> Qos:
    return _one_of_equal(cast(Qos, _reader(Qos)(dict(zip(Qos._fields, fields, strict=True)))))


# By their keys.
_FREQUENT: Mapping[tuple[str, ...], Callable[..., object]] = {
    ("name", "process"): _node,
    GraphNode._fields: _node,
    GraphEndpoint._fields: _endpoint,
    Qos._fields: _qos,
}


@lru_cache(1000)
def _one_of_equal(record: Qos) -> Qos:
    """A fleet has a handful of profiles."""
    return record


def from_value(value: object, file: str) -> Snapshot:
    """The snapshot that a JSON value holds; raises InputError with file, key and what is wrong."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: not a snapshot, but {shown(value)}")
    schema = value.pop("schema", None)
    if schema != SCHEMA or isinstance(schema, bool):
        hint = "take the snapshot again with this version"
        raise InputError(f"{file}: schema: expected {SCHEMA}, not {shown(schema)}; {hint}")
    return cast(Snapshot, record_from(Snapshot, value, file))


def record_from(kind: type, value: object, file: str) -> object:
    """A value as the record ``kind``; raises InputError with file, key and what is wrong."""
    try:
        return _reader(kind)(value)
    except WrongValue as wrong:
        key = "".join(reversed(wrong.keys)).lstrip(".")
        raise InputError(f"{file}: {key}: {wrong.reason}") from None


# Each reader is made once: a snapshot of 1,000 robots has half a million values.
@cache
def _reader(expected: Any) -> Reader:
    """A function that reads a JSON value as the type ``expected``, or raises WrongValue."""
    options = get_args(expected)
    if NoneType in options:
        inner = _reader(options[0])
        return lambda value: None if value is None else inner(value)
    if get_origin(expected) is tuple:
        return partial(read_list, _reader(options[0]))
    if hasattr(expected, "_fields"):
        hints = get_type_hints(expected)
        readers = {name: _field_reader(expected, name, hint) for name, hint in hints.items()}
        return partial(_read_record, expected, readers)
    return read_seconds if expected is float else partial(read_plain, expected)


def _field_reader(kind: type, name: str, hint: Any) -> Reader:
    words = _ALLOWED_WORDS.get((kind, name))
    if words:
        return partial(read_word, words)
    if (kind, name) == _TRANSFORM:
        return read_transform
    return read_full_name if (kind, name) in _FULL_NAMES else _reader(hint)


def _read_record(kind: Any, readers: Mapping[str, Reader], value: object) -> object:
    if type(value) is kind:
        return value
    if type(value) in (GraphNode, GraphEndpoint, Qos):
        value = cast(Any, value)._asdict()
    if not isinstance(value, dict):
        raise unexpected("an object", value)
    if value.keys() != readers.keys():
        value = {**kind._field_defaults, **value}
    if value.keys() != readers.keys():
        raise _wrong_key(readers, value)
    name = ""
    try:
        fields = []
        for name, reader in readers.items():
            fields.append(reader(value[name]))
    except WrongValue as wrong:
        wrong.keys.append(f".{name}")
        raise
    return kind._make(fields)


def _wrong_key(readers: Mapping[str, Reader], value: Mapping[str, object]) -> WrongValue:
    for name in readers:
        if name not in value:
            return WrongValue("missing; it is needed", f".{name}")
    name = next(name for name in value if name not in readers)
    return WrongValue(f"unknown key; the keys are {', '.join(readers)}", f".{name}")
