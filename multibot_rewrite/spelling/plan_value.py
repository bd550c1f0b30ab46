# SPDX-License-Identifier: Apache-2.0
"""The plan of a fleet as plain values, as its YAML and JSON files have them, and back."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from typing import Any

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.spelling.plan import vacuous
from multibot_rewrite.spelling.plan_rows import (
    OR,
    check_keys,
    full_name,
    mapping,
    read_endpoints,
    texts,
)
from multibot_rewrite.spelling.plan_states import (
    NodeDemand,
    gap_value,
    read_gaps,
    read_states,
    state_value,
)
from multibot_rewrite.system.environment import MAX_DOMAIN
from multibot_rewrite.system.records import (
    MAY,
    PUBLISHES,
    RUNS,
    SERVES,
    SUBSCRIBES,
    Domain,
    Edge,
    End,
    Node,
    Origin,
    Parameter,
    Robot,
    System,
    Topic,
    alternatives,
    nodes_by_robot,
    origin_of,
    place_of,
)

KEYS = ("layout", "shared_nodes", "shared_topics", "shared_frames", "robots")
ROBOT_KEYS = ("tf", "frames", "nodes")
TOPIC_KEYS = ("senders", "one_sender", "qos", "bridge", "type")
# Policies whose value is a word.
QOS_KEYS = ("history", "reliability", "durability", "liveliness")
OPEN, SENDS, STATES, DOMAINS = "open", "sends", "states", "domains"
# Node -> text. "ways" is how a node gets rules, if not by --ros-args.
SOURCES, FROM, WAYS = "sources", "from", "ways"
BY_NODE = (SOURCES, FROM, WAYS, SENDS)
OPTIONAL_KEYS = ("distro", "ignored_nodes", DOMAINS, "topics", "one_of", STATES, *BY_NODE, OPEN)
OPTIONAL_ROBOT_KEYS = ("other_frames", "optional", "spelled")
REMEDY = "use the file that multibot plan wrote"
# The endpoints of a node, a row each.
Rows = Mapping[str, list[list[str]]]


def value_of(plan: System) -> dict[str, object]:
    """The keys of a file, in their order, with their values."""
    rows: dict[str, list[list[str]]] = defaultdict(list)
    for end in plan.ends:
        types = OR.join((end.type, *end.also))
        rows[end.node].append([end.role, end.kind, end.name, types, end.code_name])
    nodes = nodes_by_robot(plan)
    optional = {it.name for it in plan.nodes if it.sure.word == MAY.word}
    more = {
        DOMAINS: {it.robot or KEYS[1]: it.number for it in plan.domains},
        "topics": {it.name: _topic_value(it) for it in plan.topics},
        "one_of": alternatives(plan),
        STATES: dict(_states(plan)),
        **_by_node_value(plan),
        OPEN: [gap_value(it) for it in plan.gaps],
    }
    return {
        **({"distro": plan.release} if plan.release else {}),
        "layout": plan.layout,
        "shared_nodes": {node: rows.get(node, []) for node in nodes[""] if node not in optional},
        "shared_topics": plan.shared_topics,
        "shared_frames": plan.shared_frames,
        "ignored_nodes": plan.ignored_nodes,
        "robots": {it.name: _robot_value(it, nodes[it.name], optional, rows) for it in plan.robots},
        **{key: value for key, value in more.items() if value},
    }


def _robot_value(
    robot: Robot, nodes: Iterable[str], optional: Set[str], rows: Rows
) -> dict[str, object]:
    may_miss = tuple(it for it in nodes if it in optional)
    fields = dict(zip(OPTIONAL_ROBOT_KEYS, (robot.other_frames, may_miss, robot.tag), strict=True))
    given = {key: value for key, value in fields.items() if value}
    own = {node: rows.get(node, []) for node in nodes}
    return {"tf": robot.tf_topic, "frames": robot.frames, **given, "nodes": own}


def _states(plan: System) -> Iterator[tuple[str, dict[str, object]]]:
    parameters: dict[str, list[Parameter]] = defaultdict(list)
    for it in plan.parameters:
        parameters[it.node].append(it)
    known = {it.name: it for it in plan.nodes if it.lifecycle or it.host}
    for name in dict.fromkeys((*known, *parameters)):
        value = state_value(known.get(name, Node(name)), parameters.get(name, ()))
        if value:
            yield name, value


def _by_node_value(plan: System) -> dict[str, dict[str, str]]:
    sends: dict[str, list[str]] = defaultdict(list)
    for edge in plan.edges:
        for node in edge.publishers:
            sends[node].append(f"{edge.parent} -> {edge.child}")
    return {
        SOURCES: {it.name: str(it.plugin) for it in plan.nodes if it.plugin.file},
        FROM: {
            it.name: str(Origin(it.stack, it.place))
            for it in plan.nodes
            if it.stack or it.place.file
        },
        WAYS: {it.name: f"{it.way} {it.taker}".rstrip() for it in plan.nodes if it.way},
        SENDS: {node: ", ".join(own) for node, own in sends.items()},
    }


def _topic_value(topic: Topic) -> dict[str, object]:
    given = {key: getattr(topic, key) for key in TOPIC_KEYS} | {"qos": dict(topic.qos)}
    return {key: value for key, value in given.items() if value}


def from_value(value: object, file: str) -> System:
    """The plan that a value of YAML or JSON holds; raises InputError."""
    top = mapping(value, KEYS, file, "the plan", OPTIONAL_KEYS)
    names, ends = _read_nodes(_named(top["shared_nodes"]), f"{file}: shared_nodes")
    topics, frames = (texts(top[key], f"{file}: {key}") for key in KEYS[2:4])
    robots: list[Robot] = []
    nodes: list[Node] = []
    for name, given in mapping(top["robots"], (), file, "robots").items():
        robot, own, its_ends = _read_robot(str(name), given, file)
        robots.append(robot)
        nodes += own
        ends += its_ends
    nodes += [Node(name) for name in names]
    by_node = {key: dict(_by_node(top.get(key, {}), file, key)) for key in BY_NODE}
    demands = {it.node: it for it in read_states(top.get(STATES), file)}
    groups = dict(_in_groups(top.get("one_of", []), file))
    plan = System(
        tuple(_told(_with_more(nodes, (*demands, *groups), robots), by_node, demands, groups)),
        tuple(ends),
        tuple(_sent(by_node[SENDS])),
        parameters=tuple(own for it in demands.values() for own in it.parameters),
        robots=tuple(robots),
        topics=tuple(_read_topics(top.get("topics", {}), file)),
        layout=str(top["layout"]),
        release=_release(top.get("distro", ""), file),
        shared_topics=topics,
        shared_frames=frames,
        ignored_nodes=texts(top.get("ignored_nodes", []), f"{file}: ignored_nodes"),
        gaps=tuple(read_gaps(top.get(OPEN), f"{file}: {OPEN}")),
        domains=tuple(_read_domains(top.get(DOMAINS, {}), [it.name for it in robots], file)),
    )
    nothing = vacuous(plan)
    if nothing:
        raise InputError(f"{file}: {nothing}, so every graph would be as planned; {REMEDY}")
    return plan


def _with_more(nodes: list[Node], told: Iterable[str], robots: Iterable[Robot]) -> Iterator[Node]:
    """And nodes of which the plan says something besides: they may run, and are whose namespace they
    are in."""
    known = {it.name for it in nodes}
    yield from nodes
    for name in (it for it in dict.fromkeys(told) if it not in known):
        whose = (it.name for it in robots if name.startswith(f"/{it.name}/"))
        yield Node(name, robot=next(whose, ""), sure=MAY)


def _told(
    nodes: Iterable[Node],
    by_node: Mapping[str, Mapping[str, str]],
    demands: Mapping[str, NodeDemand],
    groups: Mapping[str, tuple[str, ...]],
) -> Iterator[Node]:
    """The nodes with what other keys say of them."""
    sources, origins, ways, _ = by_node.values()
    about = {*sources, *origins, *ways, *demands, *groups}
    for it in nodes:
        if it.name not in about:
            yield it
            continue
        way, _, taker = ways.get(it.name, "").partition(" ")
        demand = demands.get(it.name)
        origin = origin_of(origins.get(it.name, ""))
        yield it._replace(
            **origin._asdict(),
            lifecycle=demand.lifecycle if demand else "",
            host=demand.host if demand else "",
            way=way,
            taker=taker,
            sure=it.sure._replace(instead=groups.get(it.name, ())),
            plugin=place_of(sources.get(it.name, "")),
        )


def _sent(sends: Mapping[str, str]) -> Iterator[Edge]:
    for node, text in sends.items():
        for edge in text.split(", "):
            parent, _, child = edge.partition(" -> ")
            yield Edge(child, parent, "", False, (node,))


def _release(value: object, file: str) -> str:
    """A plan of an earlier version has none."""
    if value and value not in RELEASES:
        raise InputError(f"{file}: distro: {unknown('release', str(value), RELEASES)}")
    return str(value)


def _read_robot(name: str, given: object, file: str) -> tuple[Robot, list[Node], list[End]]:
    place = f"robots.{name}"
    robot = mapping(given, ROBOT_KEYS, file, place, OPTIONAL_ROBOT_KEYS)
    keys = ("frames", "other_frames", "optional")
    frames, others, optional = (texts(robot.get(key, []), f"{file}: {place}.{key}") for key in keys)
    names, ends = _read_nodes(robot["nodes"] or {}, f"{file}: {place}.nodes")
    tf = full_name(robot["tf"], f"{file}: {place}.tf")
    tag = robot.get("spelled", "")
    if not isinstance(tag, str):
        raise InputError(f"{file}: {place}.spelled: write one word")
    may_miss = frozenset(optional)
    nodes = [Node(it, robot=name, sure=MAY if it in may_miss else RUNS) for it in names]
    return Robot(name, frames, tf, others, tag), nodes, ends


def _named(value: object) -> object:
    """Names alone, as a list, are nodes without planned endpoints."""
    return dict.fromkeys(map(str, value)) if isinstance(value, list) else value or {}


def _read_nodes(given: object, place: str) -> tuple[tuple[str, ...], list[End]]:
    """The names of nodes and their endpoints."""
    file, _, what = place.rpartition(": ")
    endpoints: list[End] = []
    nodes = mapping(given, (), file, what)
    for node, rows in nodes.items():
        endpoints += read_endpoints(full_name(node, place), rows, f"{place}.{node}")
    return tuple(nodes), endpoints


def _read_topics(given: object, file: str) -> Iterator[Topic]:
    for name, value in mapping(given or {}, (), file, "topics").items():
        place = f"{file}: topics.{name}"
        topic = mapping(value, (), file, f"topics.{name}")
        check_keys(topic, TOPIC_KEYS, place)
        qos = topic.get("qos", {})
        for key, right in _RIGHT.items():
            if key in topic and not right(topic[key]):
                raise InputError(f"{place}.{key}: write {_FORMS[key]}")
        check_keys(qos, QOS_KEYS, f"{place}.qos")
        yield Topic(
            full_name(name, f"{file}: topics"),
            texts(topic.get("senders", []), f"{place}.senders"),
            topic.get("one_sender", False),
            tuple((policy, word.upper()) for policy, word in qos.items()),
            tuple(topic.get("bridge", ())),
            topic.get("type", ""),
        )


def _read_domains(given: object, robots: Sequence[str], file: str) -> Iterator[Domain]:
    for name, number in mapping(given or {}, (), file, DOMAINS).items():
        place = f"{file}: {DOMAINS}.{name}"
        if name not in (KEYS[1], *robots):
            raise InputError(f"{place}: {unknown('robot', str(name), robots)}")
        if type(number) is not int or not 0 <= number <= MAX_DOMAIN:
            raise InputError(f"{place}: write a ROS_DOMAIN_ID, 0 to {MAX_DOMAIN}")
        yield Domain("" if name == KEYS[1] else str(name), number)


_ENDS = [[PUBLISHES], [SUBSCRIBES], [PUBLISHES, SUBSCRIBES], [SERVES]]
_RIGHT: Mapping[str, Callable[[Any], bool]] = {
    "one_sender": lambda it: isinstance(it, bool),
    "qos": lambda it: isinstance(it, dict) and all(isinstance(word, str) for word in it.values()),
    "bridge": lambda it: it in _ENDS,
    "type": lambda it: isinstance(it, str),
}
_FORMS = {
    "one_sender": "true or false",
    "qos": "words, as {durability: transient_local}",
    "bridge": "[publishes], [subscribes], both, or [serves]",
    "type": "a type, as sensor_msgs/msg/LaserScan",
}


def _in_groups(given: object, file: str) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Each node of a group with its group."""
    if not isinstance(given, list):
        raise InputError(f"{file}: one_of is not a list; write [[NODE, NODE]]")
    seen: dict[str, int] = {}
    for at, group in enumerate(given):
        place = f"{file}: one_of[{at}]"
        names = tuple(full_name(node, place) for node in texts(group, place))
        for node in names:
            if seen.setdefault(node, at) != at:
                raise InputError(f"{place}: {node} is in one_of[{seen[node]}] too; join the two")
            yield node, names


def _by_node(value: object, file: str, key: str) -> Iterator[tuple[str, str]]:
    for node, place in mapping(value or {}, (), file, key).items():
        if not isinstance(place, str):
            raise InputError(f"{file}: {key}.{node}: write a text")
        if key == SENDS and not all(" -> " in it for it in place.split(", ")):
            raise InputError(f"{file}: {key}.{node}: write parent -> child, not {place!r}")
        yield str(node), place
