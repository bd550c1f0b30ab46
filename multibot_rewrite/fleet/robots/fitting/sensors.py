# SPDX-License-Identifier: Apache-2.0
"""Topics of sensors: nodes hear those that the robot has. Topics of commands to a simulator."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec
from multibot_rewrite.fleet.outputs.output_file import own_yaml
from multibot_rewrite.fleet.robots.fitting.node_topics import (
    COMMANDS,
    controllers,
    plugins,
    topic_of,
    topics_of,
    usual_values,
)
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.conditions import HEARD, holds, parse_condition, verdict
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.producers.ends import BridgeRow, bridge_rows
from multibot_rewrite.producers.evidence.filling import lookup
from multibot_rewrite.related_files.bridge import GZ_MODEL
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES
from multibot_rewrite.system.words import ODOMETRY

IMAGE, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
CLOUD = "sensor_msgs/msg/PointCloud2"
# What a robot has one of, mostly: a reader of it has no other one in mind.
SENSED = (
    *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/NavSatFix"),
    *(IMAGE, INFO, CLOUD, ODOMETRY),
)
# Who reads colours can do nothing with depths, which have the same type.
DEPTHS = f"{IMAGE} of depths"
OF_CAMERAS = (IMAGE, DEPTHS, INFO)
_DEPTH, _OF_COLOURS = "depth", ("rgb", "intensity")
# The layout in which a description keeps its topics.
_NAMING = make_naming("tf-per-robot")


def offered_topics(member: Member, spec: RobotSpec) -> Mapping[str, Sequence[str]]:
    """Return the topics of a description's sensors by what they are, as for a single robot."""
    sent: list[tuple[str, str]] = []
    if spec.simulator != REAL:
        topics, _ = bridged_topics({"": collect(member.source, member.tree)}, _NAMING)
        for it in topics:
            # One that the description does not name comes where it is read.
            if it.direction == DIRECTIONS["in"] and not it.is_free:
                sent.append((it.ros_type, it.ros.strip("/")))
        for node in plugins(member):
            ends = (it for it in node.endpoints if it.role == PUBLISHES and not it.when)
            sent += ((it.type, topic_of(node, it)) for it in ends)
    found = lists_by_key(it for it in sent if it[0] in SENSED)
    # Beside images of depths is a cloud of points in Gazebo.
    images, clouds = found.get(IMAGE, ()), found.get(CLOUD, ())
    depths = [it for it in images if _DEPTH in it or f"{it}/points" in clouds]
    return {**found, IMAGE: [it for it in images if it not in depths], DEPTHS: depths}


def bridge_rows_of(spec: RobotSpec) -> Iterator[BridgeRow]:
    """Yield the rows of the robot's own bridge files."""
    for path in spec.related_files.get("bridge", ()):
        yield from bridge_rows(own_yaml(spec, path), spec.bridge_namespace_of(path))


def bridged_commands(member: Member, spec: RobotSpec) -> dict[str, str]:
    """Return the types of commands that go to the simulator, by topic.

    Those of the robot's own bridge files come first, then those that the description names, for
    which the build has rows. Beside a drive, other rows with velocities are for something else."""
    rows = command_rows(spec)
    if spec.simulator == REAL or not rows:
        return {}
    own = {alone(it.inside): (it.end.name, it.end.type) for it in rows}
    made, _ = bridged_topics({"": collect(member.source, member.tree)}, _NAMING, {"": "robot"})
    led = [it for it in made if it.direction == DIRECTIONS["out"] and it.ros_type in COMMANDS]
    named = {alone(it.gz): (it.ros, it.ros_type) for it in led if not it.is_free}
    drives = {alone(it.gz) for it in led} or own.keys()
    every = [it for inside, it in (own | named | own).items() if inside in drives]
    return {alone(name): type_ for name, type_ in every if type_ in COMMANDS}


def command_rows(spec: RobotSpec) -> list[BridgeRow]:
    """Return the rows of the robot's own bridge files that bring something to its model."""
    rows = [it for it in bridge_rows_of(spec) if it.end.role in ("", SUBSCRIBES)]
    models = [found["model"] for it in rows if (found := GZ_MODEL.fullmatch(it.inside))]
    others = {it for it in models if it != models[0] and not PLACEHOLDER.search(it)}
    return [it for it in rows if others.isdisjoint(it.inside.split("/"))]


def alone(name: str) -> str:
    """Return a gz topic without the robot's or model's placeholder: ``model/cmd_vel``."""
    found = GZ_MODEL.fullmatch(name)
    return f"model{found['rest']}" if found else name.rpartition("<namespace>/")[2].strip("/")


def wanted(node: NodeFacts, end: Endpoint) -> str:
    """Return the kind of sensor data that an end reads; empty for one that no sensor has to send."""
    terms = (it for all_ in parse_condition(end.when) for it in all_)
    is_asked = end.role == SUBSCRIBES and all(it.parameter == HEARD for it in terms)
    return _image_kind(node, end) if is_asked else ""


def _image_kind(node: NodeFacts, end: Endpoint) -> str:
    """Return the type of an end, or ``DEPTHS`` for one of depth images."""
    deep = _DEPTH in f"{node.package}/{end.name}"
    of_depths = end.type == IMAGE and deep and end.name.partition("/")[0] not in _OF_COLOURS
    return DEPTHS if of_depths else end.type


def sent_as(nodes: Iterable[NodeFacts], kind: str) -> Collection[str]:
    """Return the topics that nodes surely send, without images of another kind."""
    every = ((node, it) for node in nodes for it in node.endpoints if it.role == PUBLISHES)
    given = (it for it in every if not it[1].when and {kind, _image_kind(*it)} != {IMAGE, DEPTHS})
    return {topic_of(*it) for it in given}


def by_sensor(node: NodeFacts, offered: Mapping[str, Sequence[str]]) -> NodeFacts:
    """Return the node with the parameters for the sensors that its robot has one of."""
    # The first in its entry count.
    chosen = [it for type_, it in node.by_sensor if len(offered.get(type_, ())) == 1]
    usual = dict((*node.usual, *(one for it in reversed(chosen) for one in it)))
    if not (node.by_sensor and usual):
        return node
    changed = node._replace(usual=(*usual.items(),))
    value_of = lookup(changed, usual_values(changed))
    ends = (
        it._replace(when="" if holds(it.when, value_of) else it.when)
        for it in node.endpoints
        if (not it.when or verdict(it.when, value_of) is not False)
        and holds(it.condition, value_of)
    )
    return changed._replace(endpoints=tuple(ends))


def hearing_sensors(
    node: NodeFacts, nodes: Sequence[NodeFacts], offered: Mapping[str, Sequence[str]]
) -> NodeFacts:
    """Return the node with the robot's only topic of a sensor in place of one that nobody sends."""
    kinds = [wanted(node, it) for it in node.endpoints]
    ends = []
    for end, kind in zip(node.endpoints, kinds, strict=True):
        topics = offered.get(kind, ())
        # Of two cameras that it reads one alone is there.
        one = len(topics) == 1 and (kind not in OF_CAMERAS or kinds.count(kind) == 1)
        there = {*topics, *sent_as(nodes, kind)} if one else ()
        lost = one and "<" not in end.name and topic_of(node, end) not in there
        # No file says the name that its node set has.
        named = end.named_from or end.name
        ends.append(end._replace(name=named, remapped=topics[0]) if lost else end)
    return node._replace(endpoints=tuple(ends)) if offered else node


def with_odometry(
    offered: Mapping[str, Sequence[str]], nodes: Iterable[NodeFacts]
) -> Mapping[str, Sequence[str]]:
    """Return what a robot offers, with the odometry of its controllers."""
    ends = topics_of(controllers(nodes), PUBLISHES, (ODOMETRY,))
    found = [*offered.get(ODOMETRY, ()), *ends]
    return {**offered, ODOMETRY: found} if ends else offered
