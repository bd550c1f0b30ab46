# SPDX-License-Identifier: Apache-2.0
"""The ends that a robot's sources name, and the frames of what sensors of gz-sim send.

Source: gz-sim8 src/systems/sensors/Sensors.cc and Imu.cc (a sensor is called as its scoped name),
gz-sensors src/Sensor.cc (ign-sensors6, gz-sensors8, gz-sensors9: what names the frame, else its own
name), ros_gz_bridge convert/utils.hpp (frame_id_gz_to_ros makes / of each ::)."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import NamedTuple, cast

from lxml.etree import _Element

from multibot_rewrite.base.releases import OF_OLD, has_release
from multibot_rewrite.description.checks.links_and_joints import read_robot
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.knowledge.conditions import AND, holds, parse_condition
from multibot_rewrite.knowledge.records import MOVE_GROUP, Endpoint, NodeFacts
from multibot_rewrite.planning.of_runs import asked_alone, expanded, with_names
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.filling import filled, lookup
from multibot_rewrite.producers.evidence.semantics import FIXED, Semantics
from multibot_rewrite.related_files.bridge import (
    BOTH,
    FRAME,
    GZ,
    ROS,
    SERVICE as SERVICE_ROW,
    as_loaded,
    below,
)
from multibot_rewrite.related_files.yaml_text import YamlText, items, line_of, pairs
from multibot_rewrite.system.records import (
    CALLS,
    MAY,
    NOWHERE,
    OFF,
    PUBLISHES,
    RUNS,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Lookup,
    Place,
    Sure,
    edge_of,
)

NEEDS, TF = (SUBSCRIBES, CALLS), "/tf"
BRIDGE_FILE, BRIDGE_NODE = "bridge.yaml", "ros_gz_bridge"
_ROLES = {"GZ_TO_ROS": PUBLISHES, "ROS_TO_GZ": SUBSCRIBES}


def either_way(end: End) -> Iterator[End]:
    """Yield an end; one of an unknown role twice, as publisher and as subscriber."""
    if end.role:
        yield end
        return
    yield from (end._replace(role=it, sure=MAY) for it in (PUBLISHES, SUBSCRIBES))


def run_alone(node: NodeFacts, section: Run | None) -> Run:
    """Return a node of a robot without a name, by usual launch files and its ``section``."""
    above, _, name = f"/{node.name}".rpartition("/")
    rules = tuple(it for end in node.endpoints if end.remapped for it in _usual_rules(node, end))
    run = Run("", node.name, above or "/", name, rules, node)
    run = run._replace(values=section.values, place=section.place) if section else run
    return with_names(run)


def _usual_rules(node: NodeFacts, end: Endpoint) -> Iterator[tuple[str, str]]:
    """Yield the rules by which usual launch files rename an end."""
    asked, meant = (end._replace(name=it) for it in (asked_alone(node, end), end.remapped))
    for (_, source), (_, target) in zip(expanded(asked), expanded(meant), strict=True):
        yield source, target


class BridgeRow(NamedTuple):
    """A row of a ros_gz_bridge file: its end in ROS, its name in the simulator, its frame if set."""

    end: End
    inside: str
    frame: str


def bridge_rows(document: YamlText, above: str = "") -> Iterator[BridgeRow]:
    """Yield the rows of a ros_gz_bridge file in a namespace; one of both directions has no role."""
    for row in items(as_loaded(document, OF_OLD).root):
        values = {key.value: value for key, value in pairs(row)}
        # A row with one name has it on both sides (ros_gz_bridge bridge_config.cpp).
        service = values.get(SERVICE_ROW)
        name = service or values.get(BOTH) or values.get(ROS) or values.get(GZ)
        if name is None:
            continue
        words = {key: str(value.value) for key, value in values.items()}
        full = f"/{below(str(name.value), above).lstrip('/')}"
        role = SERVES if service else _ROLES.get(words.get("direction", ""), "")
        own = (role, full, words.get("ros_type_name", ""), "", f"/{BRIDGE_NODE}", None, "")
        kind, place = SERVICE if service else TOPIC, Place(document.file, line_of(name))
        inside = words.get(GZ) or words.get(BOTH) or str(name.value)
        yield BridgeRow(End(kind, *own, full, place=place), inside, words.get(FRAME, ""))


def edge(pair: Edge, node: str, place: Place = NOWHERE, topic: str = TF, sure: Sure = RUNS) -> Edge:
    """Return a transform on the tf topic of its robot, or on the static one next to it."""
    on = "/".join("tf_static" if it == "tf" and pair.static else it for it in topic.split("/"))
    return pair._replace(topic=on, publishers=(node,), sure=sure, place=place)


def virtual_lookups(semantics: Semantics) -> Iterator[Lookup]:
    """Yield the transforms of virtual joints' states: current_state_monitor.cpp of moveit2."""
    for it in semantics.virtual:
        if it.type != FIXED:
            yield Lookup(f"/{MOVE_GROUP}", it.child, it.parent, it.place)


def edges_off(given: Iterable[Run], known: Mapping[str, NodeFacts]) -> Iterator[Edge]:
    """Yield the transforms that one parameter switches off, with the place of that parameter."""
    for it in given:
        node = known.get(it.fact.known)
        runs = filled(node, it) if node and node.sends else None
        if node is None or runs is None or runs.sends:
            continue
        frames = {frame.parameter: frame.default for frame in runs.frames}
        for send in node.sends:
            place = _place_of_switch(send.condition, runs, it)
            if place:
                pair = edge_of(frames[send.parent], frames[send.child])
                yield edge(pair, f"/{it.node}", place, sure=OFF)


def _place_of_switch(condition: str, runs: NodeFacts, given: Run) -> Place | None:
    """Return the place of the parameter that alone switches an endpoint off."""
    value_of = lookup(runs, given.values)
    off = [it for it in condition.split(AND) if not holds(it, value_of)]
    parts = chain(*parse_condition(off[0])) if len(off) == 1 else ()
    found = (given.values[it.parameter] for it in parts if it.parameter in given.values)
    return next((it.place for it in found), None)


# The first of them that is there counts in these releases.
_NAMED = (
    ("camera/optical_frame_id", ""),
    *(("ignition_frame_id", "humble"), ("frame_id", "kilted+"), ("gz_frame_id", "")),
)
_MODEL, _LINK = "model", "link"


class SensorFrame(NamedTuple):
    """The gz topic of a sensor, or that above its topics, and the frame of what it sends.

    Its description names the frame, or its place in the model makes it. ``link`` is where it is
    written."""

    topic: str
    frame: str
    link: str
    is_named: bool
    line: int


def sensor_frames(root: _Element, model: str, release: str) -> Iterator[SensorFrame]:
    """Yield the sensors' frames in file order; in a URDF the links at fixed joints are merged."""
    bodies = read_robot(root).body
    names = [path for path, words in _NAMED if has_release(words, release)]
    for sensor in root.iter("sensor"):
        link, above = _link_and_models(sensor)
        line = cast("int", sensor.sourceline)
        named = next(filter(None, (text_at(sensor, it) for it in names)), "")
        made = "/".join((model, *above, bodies.get(link, link), sensor.get("name", "")))
        yield SensorFrame(_full(text_at(sensor, "topic")), named or made, link, bool(named), line)


def sensor_on(topic: str, sensors: Iterable[SensorFrame]) -> SensorFrame | None:
    """Return the sensor that sends on a gz topic; None without."""
    name = _full(topic)
    found = [it for it in sensors if it.link and it.topic != "/" and _is_at(name, it.topic)]
    return max(found, key=lambda it: len(it.topic), default=None)


def _is_at(name: str, above: str) -> bool:
    """Return whether a name is this one or below it."""
    return name == above or name.startswith(f"{above}/")


def _full(topic: str) -> str:
    """Return a topic with a slash in front."""
    return f"/{topic.lstrip('/')}"


def _link_and_models(sensor: _Element) -> tuple[str, list[str]]:
    """Return a sensor's link, empty for a sensor of a joint, and the models around it."""
    host = sensor.getparent()
    if host is None or host.tag not in (_LINK, "gazebo"):
        return "", []
    models = [it.get("name", "") for it in host.iterancestors(_MODEL)]
    return host.get("name" if host.tag == _LINK else "reference", ""), models[-2::-1]
