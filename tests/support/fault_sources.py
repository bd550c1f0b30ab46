# SPDX-License-Identifier: Apache-2.0
"""One system as each source has it: what is read of a file, a router, a message, a bag, a launch.

Each function gives the package what the source would hold of the system, spelled here from the source's
own format, and returns the system that is read of it.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

from graph_cases import qos
from healthy_systems import MAP, ODOMETRY, POSE, SCAN, START
from zenoh_robots import mangled, tf_message

from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.records import (
    Endpoint,
    FrameParameter,
    NodeFacts,
    SentTransform,
)
from multibot_rewrite.producers.bags.read import RECORDER, RecordedTopic, Recording
from multibot_rewrite.producers.bags.recording import as_snapshot
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, ParameterText
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched as read_launch
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.rosgraph.reading import from_message
from multibot_rewrite.producers.rosgraph.writing import to_message
from multibot_rewrite.producers.zenoh import observe
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import (
    ACTION,
    PUBLISHES,
    SERVES,
    SIM_TIME,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Place,
    System,
    clocks,
)

CLOCK, LATCHED = "/clock", ("map", "tf_static", "robot_description")
HEADED = (MAP, ODOMETRY, POSE, SCAN, START)
TF = "tf2_msgs/msg/TFMessage"
# What a source does not have, and what a fault may rest on.
TRANSFORMS, SENDERS, READERS, HEADERS, STATES, PARAMETERS, QOS, HASHES, NODES, SERVICES = (
    *("transforms", "who sends", "readers", "headers", "states"),
    *("parameters", "quality of service", "versions of types", "nodes", "services"),
)
# What only the parameters and descriptions of nodes tell.
LOOKUPS, ADDRESSES = "look-ups of nodes", "addresses"
IN_FILES = (LOOKUPS, ADDRESSES)
# What only messages tell.
NUMBERS, AGES = "received transforms", "ages of messages"


class Source(NamedTuple):
    """``read`` is what is read of a system; ``lacks`` are words of what is not in the source."""

    read: Callable[[System], System]
    lacks: tuple[str, ...] = ()


def from_file(graph: System) -> System:
    return from_json(to_json(graph), "graph.json")


def from_rosgraph(graph: System) -> System:
    return from_message(to_message(graph), "graph.yaml")


# ---------------------------------------------------------------- Zenoh


AT = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)


class Router:
    """What a session asks of a router: its tokens, and the transforms that are sent meanwhile."""

    def __init__(self, graph: System) -> None:
        self._graph = graph

    def tokens(self, _: str) -> tuple[list[str], bool]:
        return [*tokens(self._graph)], True

    def subscribe(
        self, key: str, latched: bool, received: Callable[[bytes, bytes], None]
    ) -> Callable[[], None]:
        """Each transform twice, by one sender or two in turn; of what is latched once."""
        topic = "/" + key.partition("/")[2].partition("/tf2_msgs::")[0]
        for it in self._graph.edges:
            if it.topic == topic:
                voices = (b"a" * 16, b"b" * 16) if it.several else (b"a" * 16,)
                for voice in voices * (1 if latched else 2):
                    stamp = divmod(time.time_ns() - int(it.age * 10**9), 10**9)
                    edge, numbers = (it.parent, it.child), it.transform or AT
                    received(tf_message(edge, numbers=numbers, stamp=stamp), voice)
        return lambda: None

    def deliver(self) -> None:
        """All has arrived."""


def from_zenoh(graph: System) -> System:
    @contextmanager
    def opened(*_: object) -> Iterator[Router]:
        yield Router(graph)

    with patch.object(observe, "opened", opened):
        return observe.look(Request(0.0), observe.Router("tcp/localhost:7447", 0))


def tokens(graph: System) -> Iterator[str]:
    """Liveliness tokens as rmw_zenoh writes them (liveliness_utils.cpp), each node a session."""
    numbers: dict[str, int] = {}
    for number, it in enumerate(graph.nodes):
        numbers.setdefault(it.name, number)
        yield f"{_start(number, 0, 'NN')}/{_owner(it.name)}"
    for number, it in enumerate(_announced(graph)):
        kind = {"publishes": "MP", "subscribes": "MS", "serves": "SS", "calls": "SC"}[it.role]
        start = _start(numbers.get(it.node, 999), number + 1, kind)
        package, space, name = it.type.split("/") if it.type.count("/") == 2 else ("", "", it.type)
        typed = f"{package}::{space}::dds_::{name}_" if package else it.type
        hash_ = it.type_hash or f"RIHS01_{it.type}".replace("/", "_")
        yield f"{start}/{_owner(it.node)}/{mangled(it.name)}/{typed}/{hash_}/{_profile(it)}"


def _announced(graph: System) -> Iterator[End]:
    """Topics and services; an action is its parts (rcl_action names.c), of which one shows its type."""
    for it in graph.ends:
        if it.kind != ACTION:
            yield it
        elif not any(e.name == f"{it.name}/_action/feedback" for e in graph.ends):
            role = PUBLISHES if it.role == SERVES else SUBSCRIBES
            name, type_ = f"{it.name}/_action/feedback", f"{it.type}_FeedbackMessage"
            yield it._replace(kind=TOPIC, role=role, name=name, type=type_)


def _start(session: int, number: int, kind: str) -> str:
    return f"@ros2_lv/0/{session:032x}/0/{number}/{kind}/%"


def _owner(node: str) -> str:
    space, _, name = node.rpartition("/")
    return f"{mangled(space or '/')}/{name}"


def _profile(end: End) -> str:
    """rmw types.h: 1 is reliable and transient local, 2 is best effort and volatile."""
    qos = end.qos
    weak = "2" if qos and qos.reliability == "BEST_EFFORT" else "1"
    kept = "1" if (qos.durability == "TRANSIENT_LOCAL" if qos else is_latched(end)) else "2"
    return f"{weak}:{kept}:1,10:,:,:,,"


def is_latched(end: End) -> bool:
    return not {*LATCHED}.isdisjoint(end.name.split("/"))


# ---------------------------------------------------------------- a recording


def from_bag(graph: System) -> System:
    return as_snapshot(recording(graph))


def recording(graph: System) -> Recording:
    """Return what a bag holds in which every topic was recorded, for a minute."""
    sent: dict[str, list[End]] = defaultdict(list)
    for it in graph.ends:
        if (it.kind, it.role) == (TOPIC, PUBLISHES):
            sent[it.name].append(it)
    topics = (
        RecordedTopic(
            name,
            ends[0].type,
            60,
            tuple(
                it.qos or qos(durability="TRANSIENT_LOCAL" if is_latched(it) else "VOLATILE")
                for it in ends
            ),
            _headers(graph, name, ends[0].type),
        )
        for name, ends in sorted(sent.items())
    )
    edges = (it._replace(publishers=(RECORDER,), several=False) for it in graph.edges)
    return Recording(tuple(topics), tuple(edges), 60.0)


def written(path: Path, graph: System) -> Path:
    """Return the same as a bag of rosbag2; types of which its writer knows no text are left out."""
    from made_bags import STORE, Made, write

    found = recording(graph)
    edges: dict[str, list[tuple[str, str]]] = defaultdict(list)
    for it in found.transforms:
        edges[it.topic].append((it.parent, it.child))
    topics = (
        Made(
            it.name,
            it.type,
            2,
            "".join(it.frames),
            edges[it.name],
            [own.durability == "TRANSIENT_LOCAL" for own in it.qos],
        )
        for it in found.topics
        if it.type in STORE.types
    )
    return write(path, topics)


def _headers(graph: System, name: str, type_: str) -> tuple[str, ...]:
    """Return what was heard there, else a frame of the robot whose topic it is."""
    heard = tuple(it.frame for it in graph.heard if it.topic == name)
    return heard or ((_frame(graph, name, type_),) if type_ in HEADED else ())


def _frame(graph: System, name: str, type_: str) -> str:
    """Return a frame of the robot whose topic it is; a map is in the one above."""
    word = name.split("/")[1]
    own = (it for it in graph.edges if word in (*it.child.split("/"), *it.topic.split("/")))
    edge = next(own, next(iter(graph.edges), None))
    if edge is None:
        return ""
    return edge.parent if type_ == MAP else edge.child


# ---------------------------------------------------------------- a launch file


def from_launch(graph: System) -> System:
    nodes, facts = launched(graph)
    parameters = _parameters()
    return read_launch(LaunchGraph(nodes), Knowledge(facts, parameters, "jazzy")).system


@cache
def _parameters() -> object:
    return load_known_nodes("", "jazzy")


def launched(graph: System) -> tuple[tuple[LaunchedNode, ...], Mapping[str, NodeFacts]]:
    """Return the nodes of a launch file that starts the system, and what is known of their
    programs: names in the code are plain, rules lead them where they are."""
    ends: dict[str, list[End]] = defaultdict(list)
    for it in graph.ends:
        ends[it.node].append(it)
    edges, told = _edges_by_sender(graph), clocks(graph)
    made, facts = [], {}
    for number, name in enumerate(it.name for it in graph.nodes):
        mine, sent = ends.get(name, []), edges.get(name, [])
        simulated = told.get(name, any(it.name == CLOCK for it in mine))
        asked = {f"asked_{at}": it.frame for at, it in enumerate(graph.lookups) if it.node == name}
        held = {it.name: it.value for it in graph.addresses if it.node == name}
        one = _launched(name, mine, sent, number, simulated, asked, held)
        made.append(one)
        own = _facts(one, mine, sent)
        frames = tuple(FrameParameter(key, it, given=True) for key, it in asked.items())
        facts[one.executable] = own._replace(frames=(*own.frames, *frames))
    return tuple(made), facts


def _launched(
    name: str,
    ends: list[End],
    edges: list[Edge],
    number: int,
    simulated: bool,
    asked: Mapping[str, str],
    held: Mapping[str, str],
) -> LaunchedNode:
    """Return a node, with the frames that it is ``asked`` for, and what the hardware of its
    description ``held``."""
    space, _, last = name.rpartition("/")
    # No rule leads an action elsewhere (rcl_action action_client.c): its name is in the code.
    outside = [it for it in ends if it.kind != ACTION and _is_led(it, space)]
    rules = tuple((_code_name(it), it.name) for it in outside)
    values = {**({SIM_TIME: "true"} if simulated else {}), **asked}
    if _is_description(ends):
        values["robot_description"] = repr(_urdf(edges, held))
    package = "robot_state_publisher" if _is_description(ends) else f"package_{number}"
    own = "".join(f"    {key}: {value}\n" for key, value in values.items())
    text = f"/**:\n  ros__parameters:\n{own}" if values else ""
    texts = (ParameterText("", text),) if text else ()
    place = Place("/ws/fleet.launch.py", number + 1)
    words = (package, f"program_{number}", last, space or "/", rules, texts, "", (), "", place)
    return LaunchedNode(*words)


def _is_led(end: End, space: str) -> bool:
    """Is it a rule that leads the name out of the node's namespace, or to its robot at the end?"""
    return not end.name.startswith(f"{space}/") or _has_robot_last(end.name, end.node)


def _has_robot_last(name: str, node: str) -> bool:
    """``/goal_pose/robot1`` of ``/bt_navigator_robot1``, or of ``/robot1/costmap/costmap``, as
    the layout `postfix` has them."""
    last = name.rpartition("/")[2]
    return name.count("/") > 1 and (node.endswith(f"_{last}") or node.startswith(f"/{last}/"))


def _code_name(end: End) -> str:
    """tf2_ros has absolute names (transform_broadcaster.hpp)."""
    if end.type == TF:
        return "/tf_static" if "tf_static" in end.name else "/tf"
    if _has_robot_last(end.name, end.node):
        return end.name.strip("/").rpartition("/")[0]
    return end.name.strip("/").replace("/", "_")


def _is_description(ends: list[End]) -> bool:
    published = [it.name for it in ends if it.role == PUBLISHES]
    return any(it.endswith("tf_static") for it in published) and any(
        "robot_description" in it for it in published
    )


def _urdf(edges: list[Edge], held: Mapping[str, str]) -> str:
    params = "".join(f'<param name="{key}">{it}</param>' for key, it in held.items())
    driver = f"<hardware><plugin>acme/Arm</plugin>{params}</hardware>"
    control = f'<ros2_control name="arm" type="system">{driver}</ros2_control>' if held else ""
    joints = "".join(
        f'<joint name="j{at}" type="{"fixed" if it.static else "continuous"}">'
        f'<parent link="{it.parent}"/><child link="{it.child}"/></joint>'
        for at, it in enumerate(edges)
    )
    return f'<robot name="r">{joints}{control}</robot>'


def _facts(node: LaunchedNode, ends: list[End], edges: list[Edge]) -> NodeFacts:
    space = node.namespace.rstrip("/")
    ruled = {new: old for old, new in node.remappings}
    known = tuple(
        Endpoint(it.kind, it.role, ruled.get(it.name, it.name.removeprefix(f"{space}/")), it.type)
        for it in ends
        if it.name != CLOCK or it.role == PUBLISHES
    )
    names = {name: f"frame_{at}" for at, name in enumerate(sorted(_named(edges)))}
    frames = tuple(FrameParameter(own, name, given=True) for name, own in names.items())
    sends = tuple(SentTransform(names[it.parent], names[it.child]) for it in edges)
    sends = () if _is_description(ends) else sends
    return NodeFacts(node.executable, node.package, known, frames=frames, sends=sends)


def _named(edges: list[Edge]) -> set[str]:
    return {name for it in edges for name in (it.parent, it.child)}


def _edges_by_sender(graph: System) -> dict[str, list[Edge]]:
    """Whose transform each is, of those that publish its topic: AMCL's in the map, the description's if
    it is static, else another's."""
    found: dict[str, list[Edge]] = defaultdict(list)
    kinds = Counter((it.node, it.name) for it in graph.ends if it.role == PUBLISHES)
    described = {
        it.node for it in graph.ends if it.role == PUBLISHES and "robot_description" in it.name
    }
    for edge in graph.edges:
        able = [it for it in edge.publishers if kinds[it, edge.topic]]
        in_map = "map" in edge.parent.split("/")
        fixed = edge.static and not in_map
        first = sorted(able, key=lambda it: ((it in described) != fixed, ("amcl" in it) != in_map))
        for node in first[: 2 if edge.several else 1]:
            found[node].append(edge)
    return found


SOURCES: Mapping[str, Source] = {
    "file": Source(from_file),
    "Zenoh": Source(from_zenoh, (HEADERS, STATES, PARAMETERS, QOS, *IN_FILES)),
    "rosgraph": Source(from_rosgraph, (TRANSFORMS, HEADERS, STATES, PARAMETERS, *IN_FILES)),
    "recorded": Source(
        from_bag, (NODES, READERS, SERVICES, SENDERS, STATES, PARAMETERS, AGES, *IN_FILES)
    ),
    "check-launch": Source(from_launch, (HEADERS, STATES, QOS, HASHES, NUMBERS, AGES)),
}
