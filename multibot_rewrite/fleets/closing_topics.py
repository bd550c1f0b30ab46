"""Topics that no node of a robot sends, before and after its rewrite; rows of its bridge."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.closure.bridges import bridge_gaps
from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.closure.topics import closed, topic_gaps
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.records import Place
from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.bridge_merge import as_spawned
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.gap_findings import at_gap, meant
from multibot_rewrite.fleets.output_values import OutputText, line_in_source
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.systems import BRIDGE_FILE, System
from multibot_rewrite.remap.bridged_topics import bridged_topics

# So many names in one line.
_LISTED = 8
NOT_SENT = declare(
    "MF812",
    "topic-under-another-name",
    WARNING,
    what="A node of a robot reads a topic that nothing of the robot sends, while another topic of the "
    "type is sent and nobody reads it. An error where the rewrite has made it so.",
    why="The node waits for data that never comes.",
    fix="Give both the same name.",
    bad="""\
ekf_node:
  ros__parameters: {imu0: sensors/imu/data, world_frame: odom}
imu_filter_madgwick:
  ros__parameters: {use_mag: false}
""",
    good="""\
ekf_node:
  ros__parameters: {imu0: imu/data, world_frame: odom}
imu_filter_madgwick:
  ros__parameters: {use_mag: false}
""",
    line=2,
    formats=("params",),
)
WITHOUT_SENDER = declare(
    "MF814",
    "topics-without-sender",
    NOTE,
    what="Nodes of a robot read topics, or call services, that no known node of the robot sends.",
    why="If nothing else sends them, these nodes wait for data that never comes.",
    fix="Nothing, if a driver that the fleet does not name sends them; else name its node or stack.",
    bad="""\
stack: slam_toolbox
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    good="""\
stack: joint_state_publisher
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    line=3,
    formats=("fleet",),
)
NO_GZ_TOPIC = declare(
    "MF816",
    "bridge-row-without-gz-topic",
    WARNING,
    what="A row of a bridge reads a gz topic that nothing in the description sends, while a sensor or "
    "plugin sends another one of the type.",
    why="The bridge waits for data that never comes.",
    fix="Give the row the topic of the sensor.",
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


def topic_findings(robot: RewrittenRobot, before: System, after: System) -> Iterator[Finding]:
    """What the rewrite has opened, what is under another name, and what no known node sends."""
    had = closed(before.ends, before.shared)
    now = {it.key: it for it in topic_gaps(after.ends, after.shared)}
    for it in (it for it in now.values() if it.key in had):
        message = f"{it.node} reads {it.name}, which nothing of {robot.spec.name} sends any more"
        yield at_gap(NOT_SENT, robot, it, message, meant(it), ERROR)
    # What the build adds, such as rows of a bridge, may close a gap.
    gaps = [
        it if it.near_place else now[it.key]._replace(place=it.place)
        for it in topic_gaps(before.ends, before.shared)
        if it.key in now
    ]
    for alike in _by_place_and_name(it for it in gaps if it.near):
        it = alike[0]
        nodes = ", ".join(dict.fromkeys(it.node for it in alike))
        verb = "reads" if nodes == it.node else "read"
        message = f"{nodes} of {robot.spec.name} {verb} {it.name}, which nothing sends"
        yield at_gap(NOT_SENT, robot, it, message, meant(it), WARNING)
    rest = [it for it in gaps if not it.near]
    if rest:
        yield _all_open(robot, rest)


def _by_place_and_name(gaps: Iterable[Gap]) -> Iterable[list[Gap]]:
    """Nodes that read the same topic where no file says so make one finding."""
    found: dict[object, list[Gap]] = {}
    for it in gaps:
        found.setdefault((it.place, it.name), []).append(it)
    return found.values()


def bridge_findings(
    plan: FleetPlan, robot: RewrittenRobot, texts: Sequence[OutputText]
) -> Iterator[Finding]:
    """Rows of the robot's bridge against the gz topics of its written description."""
    own = {robot.spec.namespace: robot.member.inventory}
    topics, _ = bridged_topics(own, plan.fleet.naming)
    sent = {f"/{it.gz.lstrip('/')}": it.gz_type for it in as_spawned(topics, [robot])}
    for text in (
        it for it in texts if it.path == f"{robot.spec.name}/{BRIDGE_FILE}" and it.sources
    ):
        for it in bridge_gaps(read_yaml(text.text.encode(), text.path), sent):
            message = (
                f"the bridge of {robot.spec.name} reads gz topic {it.name}, which nothing sends"
            )
            source = line_in_source(text, it.place.line) if it.place else None
            at = it._replace(place=Place(*source)) if source else it
            yield at_gap(NO_GZ_TOPIC, robot, at, message, meant(it))


def _all_open(robot: RewrittenRobot, gaps: Sequence[Gap]) -> Finding:
    names = sorted({it.name for it in gaps})
    shown = ", ".join(names[:_LISTED])
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    message = f"no known node of {robot.spec.name} sends {shown}{more}"
    hint = "name a stack or nodes that do, if no driver of its own does"
    return at_gap(WITHOUT_SENDER, robot, gaps[0]._replace(place=None), message, hint)
