"""Rows of a robot's bridge against the gz topics of its description."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.fleet.checks.gap_findings import at_gap, in_source, meant
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.bridge_merge import as_spawned
from multibot_rewrite.fleet.outputs.output_values import OutputText
from multibot_rewrite.fleet.robots.member import line_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.rules.closure.bridges import GZ_TYPE, GZ_WAY, GzTopic, bridge_gaps
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.spelling.bridged_topics import bridged_topics
from multibot_rewrite.system.records import Place

NO_GZ_TOPIC = declare(
    "MF816",
    "bridge-row-without-gz-topic",
    WARNING,
    what="A row of a bridge reads a gz topic that nothing in the description sends, while a sensor or "
    "plugin sends another one of the type; or the description has the topic, of another type or in the "
    "other direction.",
    why="The bridge waits for data that never comes.",
    fix="Give the row the topic, the type and the direction of the sensor.",
    bad="""\
- ros_topic_name: scan
  gz_topic_name: lidar/scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
""",
    good="""\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
""",
    line=2,
    formats=("bridge",),
    beside={
        "robot.urdf": """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>scan</topic></sensor>
  </gazebo>
</robot>
""",
    },
)


def bridge_findings(
    plan: FleetPlan, robot: RewrittenRobot, texts: Sequence[OutputText]
) -> Iterator[Finding]:
    """Rows of the robot's bridge against the gz topics of its written description."""
    topics = _gz_topics(plan, robot)
    for text in texts:
        if text.path != f"{robot.spec.name}/{BRIDGE_FILE}" or not text.sources:
            continue
        for it in bridge_gaps(read_yaml(text.text.encode(), text.path), topics):
            at = in_source(it, [text])
            yield at_gap(NO_GZ_TOPIC, robot, at, _message(robot, it), _hint(it), WARNING)


def _gz_topics(plan: FleetPlan, robot: RewrittenRobot) -> dict[str, GzTopic]:
    own = {robot.spec.namespace: robot.member.inventory}
    topics, _ = bridged_topics(own, plan.fleet.naming)
    lines = _sensor_lines(robot)
    return {
        (name := f"/{it.gz.lstrip('/')}"): GzTopic(it.gz_type, it.direction, _place(name, lines))
        for it in as_spawned(topics, [robot])
    }


def _sensor_lines(robot: RewrittenRobot) -> dict[str, Place]:
    """The topic of each sensor -> its line in the source: inserted text moves those of the result."""
    sensors = robot.member.inventory.document.root.iter("sensor")
    source = robot.member.source
    return {
        f"/{topic.lstrip('/')}": Place(source.file, line_of(source, "sensor", number))
        for number, it in enumerate(sensors)
        if (topic := text_at(it, "topic"))
    }


def _place(topic: str, lines: Mapping[str, Place]) -> Place | None:
    bases = [it for it in lines if topic == it or topic.startswith(f"{it}/")]
    return lines[max(bases, key=len)] if bases else None


def _message(robot: RewrittenRobot, gap: Gap) -> str:
    row = f"the bridge of {robot.spec.name}"
    if gap.kind == GZ_WAY:
        return f"{row} has gz topic {gap.name} in the other direction than the description"
    if gap.kind == GZ_TYPE:
        return f"{row} has gz topic {gap.name} with another type than the description"
    return f"{row} reads gz topic {gap.name}, which nothing sends"


def _hint(gap: Gap) -> str:
    if gap.kind in (GZ_WAY, GZ_TYPE):
        return f"write {gap.near}" + (f", see {gap.near_place}" if gap.near_place else "")
    return meant(gap)
