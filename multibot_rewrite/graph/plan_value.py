"""The plan of a fleet as plain values, as its YAML and JSON files have them, and back."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from sys import intern
from typing import Any

from multibot_rewrite.graph.expectation import (
    Expectation,
    PlannedEndpoint,
    PlannedRobot,
    PlannedTopic,
    vacuous,
)
from multibot_rewrite.graph.plan_gaps import gap_value, read_gaps
from multibot_rewrite.graph.plan_states import read_states, state_value
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.model import InputError
from multibot_rewrite.releases import RELEASES
from multibot_rewrite.system.records import KINDS, PUBLISHES, ROLES, SUBSCRIBES

KEYS = ("layout", "shared_nodes", "shared_topics", "shared_frames", "robots")
ROBOT_KEYS = ("tf", "frames", "nodes")
TOPIC_KEYS = ("senders", "one_sender", "qos", "bridge", "type")
# Policies whose value is a word.
QOS_KEYS = ("history", "reliability", "durability", "liveliness")
OPEN, SENDS, STATES = "open", "sends", "states"
# Node -> text; key -> field of Expectation. "ways" is how a node gets rules, if not by --ros-args.
BY_NODE = {"sources": "sources", "from": "origins", "ways": "ways", SENDS: "sends"}
OPTIONAL_KEYS = ("distro", "ignored_nodes", "topics", "one_of", STATES, *BY_NODE, OPEN)
# Key -> field of PlannedRobot.
OPTIONAL_ROBOT_KEYS = {
    "other_frames": "other_frames",
    "optional": "optional",
    "spelled": "frame_tag",
}
FIELDS = 5
_TEXTS = {str}
_ROLE_WORDS, _KIND_WORDS = frozenset(ROLES), frozenset(KINDS)
# Between several types of an endpoint.
OR = " | "
REMEDY = "use the file that multibot plan wrote"
# The endpoints of a node, a row each.
Rows = Mapping[str, list[list[str]]]


def value_of(plan: Expectation) -> dict[str, object]:
    """The keys of a file, in their order, with their values."""
    rows: dict[str, list[list[str]]] = defaultdict(list)
    for end in plan.endpoints:
        types = OR.join((end.type, *end.also))
        rows[end.node].append([end.role, end.kind, end.name, types, end.code_name])
    more = {
        "topics": {it.name: _topic_value(it) for it in plan.topics},
        "one_of": plan.one_of,
        STATES: {it.node: own for it in plan.states if (own := state_value(it))},
        **{key: dict(getattr(plan, field)) for key, field in BY_NODE.items()},
        OPEN: [gap_value(it) for it in plan.gaps],
    }
    return {
        **({"distro": plan.release} if plan.release else {}),
        "layout": plan.layout,
        "shared_nodes": {node: rows.get(node, []) for node in plan.shared_nodes},
        "shared_topics": plan.shared_topics,
        "shared_frames": plan.shared_frames,
        "ignored_nodes": plan.ignored_nodes,
        "robots": {it.name: _robot_value(it, rows) for it in plan.robots},
        **{key: value for key, value in more.items() if value},
    }


def _robot_value(robot: PlannedRobot, rows: Rows) -> dict[str, object]:
    fields = {key: getattr(robot, field) for key, field in OPTIONAL_ROBOT_KEYS.items()}
    given = {key: value for key, value in fields.items() if value}
    nodes = {node: rows.get(node, []) for node in robot.nodes}
    return {"tf": robot.tf, "frames": robot.frames, **given, "nodes": nodes}


def _topic_value(topic: PlannedTopic) -> dict[str, object]:
    given = {key: getattr(topic, key) for key in TOPIC_KEYS} | {"qos": dict(topic.qos)}
    return {key: value for key, value in given.items() if value}


def from_value(value: object, file: str) -> Expectation:
    """The plan that a value of YAML or JSON holds; raises InputError."""
    top = _mapping(value, KEYS, file, "the plan", OPTIONAL_KEYS)
    shared, endpoints = _read_nodes(_named(top["shared_nodes"]), f"{file}: shared_nodes")
    topics, frames = (_texts(top[key], f"{file}: {key}") for key in KEYS[2:4])
    robots: list[PlannedRobot] = []
    for name, given in _mapping(top["robots"], (), file, "robots").items():
        robot, ends = _read_robot(str(name), given, file)
        robots.append(robot)
        endpoints += ends
    sources, origins, ways, sends = (
        tuple(_by_node(top.get(key, {}), file, key)) for key in BY_NODE
    )
    plan = Expectation(
        str(top["layout"]),
        tuple(robots),
        shared,
        topics,
        frames,
        tuple(endpoints),
        _texts(top.get("ignored_nodes", []), f"{file}: ignored_nodes"),
        sources,
        origins,
        _release(top.get("distro", ""), file),
        ways,
        tuple(_read_topics(top.get("topics", {}), file)),
        tuple(_read_groups(top.get("one_of", []), file)),
        tuple(read_gaps(top.get(OPEN), f"{file}: {OPEN}")),
        sends,
        tuple(read_states(top.get(STATES), file)),
    )
    nothing = vacuous(plan)
    if nothing:
        raise InputError(f"{file}: {nothing}, so every graph would be as planned; {REMEDY}")
    return plan


def _release(value: object, file: str) -> str:
    """A plan of an earlier version has none."""
    if value and value not in RELEASES:
        raise InputError(f"{file}: distro: {unknown('release', str(value), RELEASES)}")
    return str(value)


def _read_robot(name: str, given: object, file: str) -> tuple[PlannedRobot, list[PlannedEndpoint]]:
    place = f"robots.{name}"
    robot = _mapping(given, ROBOT_KEYS, file, place, (*OPTIONAL_ROBOT_KEYS,))
    keys = ("frames", "other_frames", "optional")
    frames, others, optional = (
        _texts(robot.get(key, []), f"{file}: {place}.{key}") for key in keys
    )
    names, endpoints = _read_nodes(robot["nodes"] or {}, f"{file}: {place}.nodes")
    tf = _full_name(robot["tf"], f"{file}: {place}.tf")
    frame_tag = robot.get("spelled", "")
    if not isinstance(frame_tag, str):
        raise InputError(f"{file}: {place}.spelled: write one word")
    return PlannedRobot(name, names, frames, tf, others, optional, frame_tag), endpoints


def _named(value: object) -> object:
    """Names alone, as a list, are nodes without planned endpoints."""
    return dict.fromkeys(map(str, value)) if isinstance(value, list) else value or {}


def _read_nodes(given: object, place: str) -> tuple[tuple[str, ...], list[PlannedEndpoint]]:
    """The names of nodes and their endpoints."""
    file, _, what = place.rpartition(": ")
    endpoints: list[PlannedEndpoint] = []
    nodes = _mapping(given, (), file, what)
    for node, rows in nodes.items():
        endpoints += _read_endpoints(_full_name(node, place), rows, f"{place}.{node}")
    return tuple(nodes), endpoints


def _read_topics(given: object, file: str) -> Iterator[PlannedTopic]:
    for name, value in _mapping(given or {}, (), file, "topics").items():
        place = f"{file}: topics.{name}"
        topic = _mapping(value, (), file, f"topics.{name}")
        _known(topic, TOPIC_KEYS, place)
        qos = topic.get("qos", {})
        for key, right in _RIGHT.items():
            if key in topic and not right(topic[key]):
                raise InputError(f"{place}.{key}: write {_FORMS[key]}")
        _known(qos, QOS_KEYS, f"{place}.qos")
        yield PlannedTopic(
            _full_name(name, f"{file}: topics"),
            _texts(topic.get("senders", []), f"{place}.senders"),
            topic.get("one_sender", False),
            tuple((policy, word.upper()) for policy, word in qos.items()),
            tuple(topic.get("bridge", ())),
            topic.get("type", ""),
        )


_ENDS = [[PUBLISHES], [SUBSCRIBES], [PUBLISHES, SUBSCRIBES]]
_RIGHT: Mapping[str, Callable[[Any], bool]] = {
    "one_sender": lambda it: isinstance(it, bool),
    "qos": lambda it: isinstance(it, dict) and all(isinstance(word, str) for word in it.values()),
    "bridge": lambda it: it in _ENDS,
    "type": lambda it: isinstance(it, str),
}
_FORMS = {
    "one_sender": "true or false",
    "qos": "words, as {durability: transient_local}",
    "bridge": "[publishes], [subscribes] or both",
    "type": "a type, as sensor_msgs/msg/LaserScan",
}


def _known(given: Mapping[str, Any], keys: tuple[str, ...], place: str) -> None:
    for key in given:
        if key not in keys:
            raise InputError(f"{place}: {unknown('key', str(key), keys)}")


def _read_groups(given: object, file: str) -> Iterator[tuple[str, ...]]:
    if not isinstance(given, list):
        raise InputError(f"{file}: one_of is not a list; write [[NODE, NODE]]")
    for at, group in enumerate(given):
        place = f"{file}: one_of[{at}]"
        yield tuple(_full_name(node, place) for node in _texts(group, place))


def _full_name(value: object, place: str) -> str:
    if not isinstance(value, str) or not value.startswith("/"):
        raise InputError(f"{place}: {_not_full(value)}")
    return intern(value)


def _not_full(value: object) -> str:
    return f"{value!r} is not a full name; write it with a / in front"


def _by_node(value: object, file: str, key: str) -> Iterator[tuple[str, str]]:
    for node, place in _mapping(value or {}, (), file, key).items():
        if not isinstance(place, str):
            raise InputError(f"{file}: {key}.{node}: write a text")
        if key == SENDS and not all(" -> " in it for it in place.split(", ")):
            raise InputError(f"{file}: {key}.{node}: write parent -> child, not {place!r}")
        yield str(node), place


def _mapping(
    value: object, keys: tuple[str, ...], file: str, what: str, more: tuple[str, ...] = ()
) -> Mapping[str, Any]:
    """``value``, checked to have all of ``keys`` and otherwise only ``more``; any without ``keys``."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: {what} is not a mapping; write it as multibot plan does")
    missing = [key for key in keys if key not in value]
    unknown = [key for key in value if keys and key not in (*keys, *more)]
    if missing or unknown:
        wrong = f"key {missing[0]!r} is missing" if missing else f"unknown key {unknown[0]!r}"
        raise InputError(f"{file}: {what}: {wrong}; the keys are {', '.join((*keys, *more))}")
    return value


def _texts(value: object, place: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
        raise InputError(f"{place} is not a list of names")
    return tuple(value)


def _read_endpoints(node: str, rows: object, place: str) -> Iterator[PlannedEndpoint]:
    if rows is not None and not isinstance(rows, list):
        raise InputError(f"{place} is not a list; write [] for a node without planned endpoints")
    for at, row in enumerate(rows or ()):
        wrong = _wrong_row(row)
        if wrong:
            raise InputError(f"{place}[{at}]: {wrong}")
        # Many nodes have the same names, types and words.
        role, kind, name, types, code_name = map(intern, row)
        also: tuple[str, ...] = ()
        if OR in types:
            types, *others = types.split(OR)
            also = (*others,)
        yield PlannedEndpoint(node, kind, role, name, types, code_name, also)


def _wrong_row(row: object) -> str:
    """What is wrong with a row of the plan; empty for an endpoint."""
    if type(row) is not list or len(row) != FIELDS or {*map(type, row)} != _TEXTS:
        return "write [role, kind, name, type, name in the node's code]"
    role, kind, name, _, _ = row
    if role not in _ROLE_WORDS or kind not in _KIND_WORDS:
        allowed = f"a role ({', '.join(ROLES)}) and a kind ({', '.join(KINDS)})"
        return f"{role!r}, {kind!r}: write {allowed}"
    return "" if name.startswith("/") else _not_full(name)
