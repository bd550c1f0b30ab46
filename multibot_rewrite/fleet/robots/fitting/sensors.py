# SPDX-License-Identifier: Apache-2.0
"""Topics of sensors: nodes hear those that the robot has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec
from multibot_rewrite.fleet.robots.fitting.node_topics import (
    controllers,
    plugins,
    topic_of,
    topics_of,
    usual_values,
)
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.conditions import holds, verdict
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.evidence.filling import lookup
from multibot_rewrite.spelling.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES
from multibot_rewrite.system.words import ODOMETRY

# What a robot has one of, mostly: a reader of it has no other one in mind.
SENSED = (
    *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/NavSatFix"),
    *("sensor_msgs/msg/PointCloud2", ODOMETRY),
)
# The layout in which a description keeps its topics.
_NAMING = make_naming("tf-per-robot")


def offered_topics(member: Member, spec: RobotSpec) -> Mapping[str, Sequence[str]]:
    """Return the topics of the sensors in the description, by their types, as the robot alone has
    them."""
    found: dict[str, list[str]] = {}
    if spec.simulator != REAL:
        topics, _ = bridged_topics({"": collect(member.source, member.tree)}, _NAMING)
        for it in topics:
            # One that the description does not name comes where it is read.
            if it.ros_type in SENSED and it.direction == DIRECTIONS["in"] and not it.is_free:
                found.setdefault(it.ros_type, []).append(it.ros.strip("/"))
        for node in plugins(member):
            for end in node.endpoints:
                if end.role == PUBLISHES and end.type in SENSED and not end.when:
                    found.setdefault(end.type, []).append(topic_of(node, end))
    return found


def by_sensor(node: NodeFacts, offered: Mapping[str, Sequence[str]]) -> NodeFacts:
    """Return the node with the parameters by which it uses a sensor that its robot has one of."""
    chosen = next((it for type_, it in node.by_sensor if len(offered.get(type_, ())) == 1), None)
    if chosen is None:
        return node
    changed = node._replace(usual=(*node.usual, *chosen))
    value_of = lookup(changed, usual_values(changed))
    ends = (
        it._replace(when="" if holds(it.when, value_of) else it.when)
        for it in node.endpoints
        if (not it.when or verdict(it.when, value_of) is not False)
        and holds(it.condition, value_of)
    )
    return changed._replace(endpoints=tuple(ends))


def hearing_sensors(
    node: NodeFacts, nodes: Iterable[NodeFacts], offered: Mapping[str, Sequence[str]]
) -> NodeFacts:
    """Return the node with the robot's only topic of a sensor where it would hear one that nobody
    sends."""
    sent = topics_of(nodes, PUBLISHES)
    ends = []
    for end in node.endpoints:
        topics = offered.get(end.type, ()) if end.role == SUBSCRIBES and not end.when else ()
        lost = (
            len(topics) == 1 and "<" not in end.name and topic_of(node, end) not in {*topics, *sent}
        )
        # No file says the name that its stack has.
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
