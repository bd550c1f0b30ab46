"""What a ROS graph looks like: frozen records, and JSON both ways. Pure, no ROS needed.

Field names follow ``rosgraph_msgs`` (rcl_interfaces) where it has them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from types import NoneType
from typing import Any, NamedTuple, cast, get_args, get_origin, get_type_hints

from multibot_rewrite.model import InputError
from multibot_rewrite.remap.records import KINDS, ROLES

SCHEMA = 1
# Why the looking ended: everything expected was there, nothing changed any more, time was up.
EXPECTED, QUIET, TIMEOUT = "expected", "quiet", "timeout"
# What rmw says of an endpoint whose participant has not told its nodes yet.
UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"


class Qos(NamedTuple):
    """The quality of service an endpoint offers or asks for; words as in ``rosgraph_msgs``.

    Times are seconds, ``inf`` (null in JSON) is no limit. Fast DDS does not tell history and
    depth of other processes: they are ``UNKNOWN`` and 0 then.
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
    """One node. Two nodes of one name are two records.

    ``name`` is fully qualified. ``process`` is the group of endpoints it shares a DDS participant
    with, empty where no endpoint of it told.
    """

    name: str
    process: str


class GraphEndpoint(NamedTuple):
    """A node's end of a topic, service or action.

    ``kind`` and ``role`` are the words of ``remap.records``. ``name`` and ``node`` are fully
    qualified. ``type_hash``, ``qos`` and the endpoint's own ``process`` are known only where the
    topic was asked for; else they are empty, None and what is known of the node.
    """

    kind: str
    role: str
    name: str
    type: str
    type_hash: str
    node: str
    qos: Qos | None
    process: str


class Frame(NamedTuple):
    """An edge of a tf tree as heard on ``topic``; ``publishers`` are all nodes that publish there.

    tf messages do not tell who sent them.
    """

    child: str
    parent: str
    topic: str
    static: bool
    publishers: tuple[str, ...]


class Caveat(NamedTuple):
    """What to know about the view; ``incomplete`` tells that something may be missing in it."""

    code: str
    incomplete: bool
    message: str


class Environment(NamedTuple):
    """How the graph was looked at, and how far that can be trusted.

    ``participants`` counts the DDS participants seen, the looking one not. ``settled`` is
    ``EXPECTED``, ``QUIET`` or ``TIMEOUT``, reached after ``seconds``.
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
    """The graph at one moment."""

    nodes: tuple[GraphNode, ...]
    endpoints: tuple[GraphEndpoint, ...]
    frames: tuple[Frame, ...]
    environment: Environment


_WORDS: Mapping[tuple[type, str], tuple[str, ...]] = {
    (GraphEndpoint, "kind"): KINDS,
    (GraphEndpoint, "role"): ROLES,
    (Environment, "settled"): (EXPECTED, QUIET, TIMEOUT),
}
_FULL_NAMES = {
    (GraphNode, "name"),
    (GraphEndpoint, "name"),
    (GraphEndpoint, "node"),
    (Frame, "topic"),
}
_CALLED = {str: "text", int: "a whole number", float: "a number or null", bool: "true or false"}


def incomplete(snapshot: Snapshot) -> tuple[Caveat, ...]:
    """Why something may be missing in the view; empty where it can be trusted."""
    return tuple(caveat for caveat in snapshot.environment.caveats if caveat.incomplete)


def to_json(snapshot: Snapshot) -> bytes:
    """The snapshot as JSON, one record a line, in the order of the records."""
    parts = [f'"schema": {SCHEMA}']
    for name in ("nodes", "endpoints", "frames"):
        lines = ",\n  ".join(_line(record) for record in getattr(snapshot, name))
        parts.append(f'"{name}": [\n  {lines}\n ]' if lines else f'"{name}": []')
    environment = json.dumps(_plain(snapshot.environment), indent=1, ensure_ascii=False)
    parts.append('"environment": ' + environment.replace("\n", "\n "))
    return ("{\n " + ",\n ".join(parts) + "\n}\n").encode("utf-8", "backslashreplace")


def _line(record: object) -> str:
    return json.dumps(_plain(record), ensure_ascii=False)


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        fields = getattr(value, "_fields", None)
        if fields is None:
            return [_plain(item) for item in value]
        return {name: _plain(item) for name, item in zip(fields, value, strict=True)}
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def from_json(data: bytes, file: str) -> Snapshot:
    """Read what ``to_json`` wrote; raises InputError with file, key, what is wrong and what to do."""
    try:
        value = json.loads(data)
    except (UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}") from None
    except json.JSONDecodeError as error:
        place = f"{file}:{error.lineno}:{error.colno}"
        raise InputError(
            f"{place}: not JSON: {error.msg}; use what multibot snapshot -o wrote"
        ) from None
    if not isinstance(value, dict):
        raise InputError(f"{file}: not a snapshot, but {_shown(value)}")
    schema = value.pop("schema", None)
    if schema != SCHEMA or isinstance(schema, bool):
        hint = "take the snapshot again with this version"
        raise InputError(f"{file}: schema: expected {SCHEMA}, not {_shown(schema)}; {hint}")
    return cast(Snapshot, _read(Snapshot, value, f"{file}: ", ""))


def _read(expected: Any, value: object, file: str, key: str) -> object:
    """``value`` as the type ``expected``; ``key`` says where in the file it stands."""
    options = get_args(expected)
    if NoneType in options:
        return None if value is None else _read(options[0], value, file, key)
    if get_origin(expected) is tuple:
        if not isinstance(value, list):
            raise _wrong(file, key, "a list", value)
        return tuple(_read(options[0], v, file, f"{key}[{i}]") for i, v in enumerate(value))
    if hasattr(expected, "_fields"):
        return _record(expected, value, file, key)
    if expected is float:
        return _seconds(value, file, key)
    if not isinstance(value, expected) or isinstance(value, bool) is not (expected is bool):
        raise _wrong(file, key, _CALLED[expected], value)
    return value


def _record(kind: Any, value: object, file: str, key: str) -> object:
    if not isinstance(value, dict):
        raise _wrong(file, key, "an object", value)
    hints = _hints(kind)
    for name in _missing(hints, value):
        raise InputError(f"{file}{_join(key, name)}: missing; it is needed")
    for name in _missing(value, hints):
        known = ", ".join(hints)
        raise InputError(f"{file}{_join(key, name)}: not a key of a snapshot; here are {known}")
    fields = {
        name: _read(hint, value[name], file, _join(key, name)) for name, hint in hints.items()
    }
    for name, field in fields.items():
        _check_field(kind, name, field, file, key)
    return kind(**fields)


@lru_cache
def _hints(kind: Any) -> Mapping[str, Any]:
    return get_type_hints(kind)


def _missing(names: Mapping[str, Any], there: Mapping[str, Any]) -> Iterator[str]:
    return (name for name in names if name not in there)


def _check_field(kind: type, name: str, value: object, file: str, key: str) -> None:
    words = _WORDS.get((kind, name))
    if words and value not in words:
        raise _wrong(file, _join(key, name), f"one of {', '.join(words)}", value)
    if (kind, name) in _FULL_NAMES and not str(value).startswith("/"):
        raise _wrong(file, _join(key, name), "a full name that starts with /", value)


def _seconds(value: object, file: str, key: str) -> float:
    if value is None:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise _wrong(file, key, _CALLED[float], value)
    return float(value)


def _join(key: str, name: str) -> str:
    return f"{key}.{name}" if key else name


def _wrong(file: str, key: str, expected: str, value: object) -> InputError:
    return InputError(f"{file}{key}: expected {expected}, not {_shown(value)}")


def _shown(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else f"{text[:39]}…"
