# SPDX-License-Identifier: Apache-2.0
"""The remap rules and values that a hint names, applied to a system as rcl and the nodes would."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.findings.finding import Remap, Setting
from multibot_rewrite.system.records import (
    OFF,
    PUBLISHES,
    RUNS,
    SIM_TIME,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Heard,
    Parameter,
    Qos,
    System,
)
from multibot_rewrite.system.words import CHANGE_STATE, MAP, NODE_NAMES, is_viewer

CLOCK = "rosgraph_msgs/msg/Clock"
STAMPED, BARE = "geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist"
_ROLES = {"publisher": PUBLISHES, "subscription": SUBSCRIBES}


def patched(graph: System, remaps: Iterable[Remap], settings: Iterable[Setting]) -> System:
    """Return the system after its nodes got these rules and values."""
    return with_settings(remapped(graph, remaps), settings)


def remapped(graph: System, rules: Iterable[Remap]) -> System:
    """Return the system after its nodes got these rules, as rcl applies them, with their ends."""
    for rule in rules:
        if rule.old.startswith("__"):
            graph = _called(graph, rule)
            continue
        ends = tuple(
            it._replace(name=rule.new) if (it.node, it.name) == (rule.node, rule.old) else it
            for it in graph.ends
        )
        edges = (moved for it in graph.edges for moved in _moved(it, rule))
        graph = graph._replace(ends=ends, edges=tuple(_once(edges)))
    return graph


def _called(graph: System, rule: Remap) -> System:
    """Return a node of another name or namespace: what has its old one before it goes along."""
    space, _, last = rule.node.rpartition("/")
    new = f"{space}/{rule.new}" if rule.old == "__node" else f"{rule.new.rstrip('/')}/{last}"
    target = new.rpartition("/")[0]

    def renamed(it: End) -> End:
        if it.node != rule.node:
            return it
        name = it.name.replace(f"{rule.node}/", f"{new}/")
        # What stands beside it in its namespace is called so by a relative name.
        relative = it.name.rpartition("/")[0] == space and it.name not in EVERYBODYS
        name = f"{target}/{name.rpartition('/')[2]}" if relative else name
        return it._replace(node=new, name=name)

    nodes = tuple(it._replace(name=new) if it.name == rule.node else it for it in graph.nodes)
    edges = (
        it._replace(publishers=tuple(new if one == rule.node else one for one in it.publishers))
        for it in graph.edges
    )
    return graph._replace(nodes=nodes, ends=tuple(map(renamed, graph.ends)), edges=tuple(edges))


def _moved(edge: Edge, rule: Remap) -> Iterator[Edge]:
    if edge.topic != rule.old or rule.node not in edge.publishers:
        yield edge
        return
    # Several sent it to one topic, each its own.
    yield edge._replace(topic=rule.new, publishers=(rule.node,), several=False)
    others = tuple(it for it in edge.publishers if it != rule.node)
    if others:
        yield edge._replace(publishers=others)


def _once(edges: Iterable[Edge]) -> Iterator[Edge]:
    found: dict[tuple[str, str, str], Edge] = {}
    for it in edges:
        key = it.topic, it.parent, it.child
        senders = {*it.publishers, *(found[key].publishers if key in found else ())}
        found[key] = it._replace(publishers=tuple(sorted(senders)))
    return iter(found.values())


def with_settings(graph: System, settings: Iterable[Setting]) -> System:
    """Return the system whose nodes have these values: of parameters, or in what they send."""
    for it in settings:
        if it.topic:
            heard = (one._replace(**_field(one, it)) for one in graph.heard)
            graph = graph._replace(heard=tuple(heard))
            continue
        if not it.name.startswith("--"):
            others = (one for one in graph.parameters if one[:2] != (it.node, it.name))
            graph = graph._replace(parameters=(*others, Parameter(it.node, it.name, it.value)))
        graph = _effect(it.name)(graph, it)
    return graph


def _field(heard: Heard, it: Setting) -> dict[str, str]:
    field = "child" if it.name == "child_frame_id" else "frame"
    return {field: it.value} if heard.topic == it.topic else {}


def _effect(name: str) -> Callable[[System, Setting], System]:
    """Return what a parameter does; KeyError for an unknown one: a hint may not name it."""
    first = name.partition(".")[0]
    return _EFFECTS[first]


def _clock(graph: System, it: Setting) -> System:
    clock = End(TOPIC, SUBSCRIBES, "/clock", CLOCK, node=it.node)
    apart = (one for one in graph.ends if one[:3] != clock[:3] or one.node != it.node)
    ends = (*apart, *[clock] * (it.value == "true"))
    sent = {one.name for one in ends if one.node == it.node and one.role == PUBLISHES}
    # What it stamps has the time that it has: that of the others on simulated time.
    simulated = max((one.age for one in graph.heard if one.topic not in sent), default=0.0)
    age = simulated if it.value == "true" else 0.0
    heard = (one._replace(age=age) if one.topic in sent else one for one in graph.heard)
    edges = (one._replace(age=age) if it.node in one.publishers else one for one in graph.edges)
    return graph._replace(ends=ends, heard=tuple(heard), edges=tuple(edges))


def _tf(graph: System, it: Setting) -> System:
    edges = []
    for one in graph.edges:
        if it.node not in one.publishers or one.static:
            edges.append(one)
        elif it.value == "true":
            edges.append(one._replace(sure=RUNS) if one.sure == OFF else one)
        elif left := tuple(node for node in one.publishers if node != it.node):
            edges.append(one._replace(publishers=left, several=False))
    return graph._replace(edges=tuple(edges))


def _stamps(graph: System, it: Setting) -> System:
    """Tools read a topic with whatever type it has."""
    own = {one.name for one in graph.ends if one.node == it.node and one.type == BARE}
    ends = (
        one._replace(type=STAMPED)
        if one.name in own and (one.node == it.node or is_viewer(one.node))
        else one
        for one in graph.ends
    )
    return graph._replace(ends=tuple(ends))


def _qos(graph: System, it: Setting) -> System:
    _, _, rest = it.name.partition(".")
    name, side, policy = rest.rsplit(".", 2)
    return _ends(
        graph, it, lambda one: (one.name, one.role) == (name, _ROLES[side]),
        lambda one: one._replace(qos=_with(one.qos, policy, it.value)),
    )  # fmt: skip


def _latched(graph: System, it: Setting) -> System:
    return _ends(
        graph, it, lambda one: (one.type, one.role) == (MAP, SUBSCRIBES),
        lambda one: one._replace(qos=_with(one.qos, "durability", "transient_local")),
    )  # fmt: skip


def _with(qos: Qos | None, policy: str, word: str) -> Qos | None:
    return qos._replace(**{policy: word.upper()}) if qos else None


def _ends(
    graph: System, it: Setting, which: Callable[[End], bool], change: Callable[[End], End]
) -> System:
    ends = (change(one) if one.node == it.node and which(one) else one for one in graph.ends)
    return graph._replace(ends=tuple(ends))


def _prefix(graph: System, it: Setting) -> System:
    """Frames of its transforms have the robot's name once."""

    def bare(frame: str) -> str:
        first, _, rest = frame.partition("/")
        return rest if first in rest.split("/") else frame

    edges = (
        one._replace(parent=bare(one.parent), child=bare(one.child))
        if it.node in one.publishers or not one.publishers
        else one
        for one in graph.edges
    )
    return graph._replace(edges=tuple(edges))


def _managed(graph: System, it: Setting) -> System:
    space = it.node.rpartition("/")[0]
    kept = {one if one.startswith("/") else f"{space}/{one}" for one in json.loads(it.value)}

    def asks(one: End) -> bool:
        node, _, what = one.name.rpartition("/")
        managed = f"/{what}" in (CHANGE_STATE, "/get_state") and one.node == it.node
        return managed and one.role not in (PUBLISHES, SUBSCRIBES) and node not in kept

    served = {one for one in graph.ends if one.role == "serves"}
    asked = [one for one in graph.ends if one not in served and asks(one)]
    ends = dict.fromkeys(one for one in graph.ends if one not in asked)
    for node in kept:
        new = (one._replace(name=f"{node}/{one.name.rpartition('/')[2]}") for one in asked)
        ends.update(dict.fromkeys(new) if node in {it.name for it in graph.nodes} else {})
    return graph._replace(ends=tuple(ends))


def _odometry(graph: System, it: Setting) -> System:
    edges = (
        one._replace(child=it.value) if it.node in one.publishers and one.parent == "map" else one
        for one in graph.edges
    )
    return graph._replace(edges=tuple(edges))


def _nothing_seen(graph: System, _: Setting) -> System:
    return graph


def _enclave(graph: System, it: Setting) -> System:
    nodes = (one._replace(enclave=it.value) if one.name == it.node else one for one in graph.nodes)
    return graph._replace(nodes=tuple(nodes))


def _unplayed(graph: System, it: Setting) -> System:
    ends = (one for one in graph.ends if (one.node, one.name) != (it.node, "/clock"))
    return graph._replace(ends=tuple(ends))


def _inactive(graph: System, it: Setting) -> System:
    controllers = (
        one._replace(state="inactive", claims=())
        if (one.manager, one.name) == (it.node, it.value)
        else one
        for one in graph.controllers
    )
    return graph._replace(controllers=tuple(controllers))


_EFFECTS = {
    SIM_TIME: _clock,
    **dict.fromkeys(("publish_tf", "enable_odom_tf", "tf_broadcast"), _tf),
    "enable_stamped_cmd_vel": _stamps,
    "qos_overrides": _qos,
    "static_layer": _latched,
    **dict.fromkeys(("frame_prefix", "tf_frame_prefix_enable"), _prefix),
    NODE_NAMES: _managed,
    "odom_frame_id": _odometry,
    "enable_button": _nothing_seen,
    "--enclave": _enclave,
    "--inactive": _inactive,
    "--clock": _unplayed,
}
