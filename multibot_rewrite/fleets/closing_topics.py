"""Topics that no node of a robot sends, before and after its rewrite."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.closure.topics import closed, topic_gaps, type_gaps
from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.gap_findings import at_gap, meant
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.systems import System

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

OTHER_TYPE = declare(
    "MF818",
    "topic-of-another-type",
    WARNING,
    what="A node of a robot reads a topic as one type, and all that send it send another type.",
    why="ROS does not connect them: the node waits for data that never comes.",
    fix="Make both of one type: by the parameter that chooses it, or in the row of the bridge.",
    bad="""\
- ros_topic_name: scan
  gz_topic_name: front/points
  ros_type_name: sensor_msgs/msg/PointCloud2
  gz_type_name: gz.msgs.PointCloudPacked
  direction: GZ_TO_ROS
""",
    good="""\
- ros_topic_name: scan
  gz_topic_name: front
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
""",
    formats=("bridge",),
    options={"stack": "slam_toolbox"},
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
    yield from _types(robot, _of_types(before, after))
    rest = [it for it in gaps if not it.near]
    if rest:
        yield _all_open(robot, rest)


def _of_types(before: System, after: System) -> Iterator[Gap]:
    """Ends that never meet, by the sources, or with what the build adds, such as rows of a bridge."""
    old = {it.key: it for it in type_gaps(before.ends, before.shared)}
    own = {it.key: it for it in before.ends}
    yield from old.values()
    for it in type_gaps(after.ends, after.shared):
        if it.key not in old and it.key in own:
            end = own[it.key]
            what = f"{end.name} as {end.type}"
            yield it._replace(name=what, node=end.node, place=end.place, at=end.at)


def _types(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        message = f"{it.node} of {robot.spec.name} reads {it.name}, but {it.near}"
        where = f", see {it.near_place}" if it.near_place else ""
        at = it._replace(at=it.at or it.near_place)
        yield at_gap(OTHER_TYPE, robot, at, message, f"make both of one type{where}")


def _by_place_and_name(gaps: Iterable[Gap]) -> Iterable[list[Gap]]:
    """Nodes that read the same topic where no file says so make one finding."""
    found: dict[object, list[Gap]] = {}
    for it in gaps:
        found.setdefault((it.place, it.name), []).append(it)
    return found.values()


def _all_open(robot: RewrittenRobot, gaps: Sequence[Gap]) -> Finding:
    names = sorted({it.name for it in gaps})
    shown = ", ".join(names[:_LISTED])
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    message = f"no known node of {robot.spec.name} sends {shown}{more}"
    hint = "name a stack or nodes that do, if no driver of its own does"
    return at_gap(WITHOUT_SENDER, robot, gaps[0]._replace(place=None), message, hint)
