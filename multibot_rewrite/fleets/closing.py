"""Does each robot of a fleet close, before and after its rewrite? What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from multibot_rewrite.closure.bridges import bridge_gaps
from multibot_rewrite.closure.frames import frame_gaps
from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.closure.interfaces import interface_gaps
from multibot_rewrite.closure.moveit import moveit_gaps
from multibot_rewrite.closure.topics import closed, topic_gaps
from multibot_rewrite.companions.params.known_nodes import load_known_nodes
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.evidence.records import Place
from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import Rule, declare
from multibot_rewrite.fleets.bridge_merge import as_spawned
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.output_values import OutputText, line_in_source
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.robot_groups import group_robots
from multibot_rewrite.fleets.robot_nodes import robot_nodes
from multibot_rewrite.fleets.systems import BRIDGE_FILE, System, system_after, system_before
from multibot_rewrite.remap.bridged_topics import bridged_topics

# So many names in one line.
_LISTED = 8
_ARM = """\
<robot name="arm">
  <link name="base_link"/>
  <link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="base_link"/><child link="hand"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <ros2_control name="arm" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="elbow">
      <command_interface name="position"/>
      <state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
NO_INTERFACE = declare(
    "MF811",
    "interface-not-exported",
    WARNING,
    what="A controller claims an interface that the ros2_control systems of the description do not "
    "export. Where the files before the rewrite agreed, it is an error.",
    why="The controller manager does not activate a controller whose interfaces do not exist.",
    fix="Name an interface that the description has, or add it to the ros2_control system.",
    bad="""\
controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters:
    joints: [elbow]
    command_interfaces: [velocity]
    state_interfaces: [position]
""",
    good="""\
controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters:
    joints: [elbow]
    command_interfaces: [position]
    state_interfaces: [position]
""",
    line=6,
    formats=("params",),
    beside={"robot.urdf": _ARM},
)
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
NOBODY_SENDS = declare(
    "MF813",
    "odometry-not-sent",
    ERROR,
    what="Every node of a robot that could send the transform to its base is told not to.",
    why="The robot's frames are not connected to the odometry: navigation and RViz do not see it move.",
    fix="Let one of them send it: enable_odom_tf of the controller, or publish_tf of the filter.",
    bad="""\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    enable_odom_tf: false
""",
    good="""\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    enable_odom_tf: true
""",
    line=6,
    formats=("params",),
)


NOT_MOVED = declare(
    "MF815",
    "moveit-controller-not-there",
    WARNING,
    what="MoveIt sends trajectories to a controller that none of the robot's parameter files declares, "
    "or for a joint that the controller does not move. An error where the rewrite has made it so.",
    why="MoveIt plans, and execution fails: no controller takes the trajectory.",
    fix="Use the controller's name and its joints.",
    bad="""\
moveit_simple_controller_manager:
  controller_names: [arm_controler]
  arm_controler: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [elbow]}
""",
    good="""\
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [elbow]}
""",
    line=3,
    formats=("moveit",),
    beside={
        "robot.urdf": _ARM,
        "controllers.yaml": """\
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [elbow], command_interfaces: [position], state_interfaces: [position]}
""",
    },
    options={"companions": {"params": "controllers.yaml"}},
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


def closing(plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputText]) -> Iterator[Finding]:
    """What is open in the robots of a fleet; robots of the same sources are looked at once.

    ``fleet`` has all nodes that are started, ``texts`` are the files that were made.
    """
    known = load_known_nodes(plan.file.parameters, plan.file.distro)
    for group in group_robots(plan):
        robot = group.robots[0]
        evidence = robot_nodes(robot.spec, plan.file)
        before, library = system_before(robot, evidence), evidence.known
        after = system_after(robot, fleet, texts, known)
        made = [*interface_gaps(before.given, library, before.exports)]
        now = [*interface_gaps(after.given, library, after.exports)]
        yield from _interfaces(robot, made, now)
        yield from _frames(robot, frame_gaps(before.given, library, before.sent))
        yield from _topics(robot, before, after)
        old, new = (list(moveit_gaps(it.moveit, it.given)) for it in (before, after))
        yield from _moveit(robot, old, new)
        yield from _bridge(plan, robot, texts)


def _interfaces(
    robot: RewrittenRobot, before: Sequence[Gap], after: Sequence[Gap]
) -> Iterator[Finding]:
    known = {it.key for it in before}
    rest = [it for it in after if it.key not in known]
    for level, gaps in ((WARNING, before), (ERROR, rest)):
        for first, *more in _by_place(gaps):
            names = f"{first.name} and {len(more)} more" if more else first.name
            claims = f"{first.node} of {robot.spec.name} claims {names}"
            message = f"{claims}, which no ros2_control exports"
            yield _found(NO_INTERFACE, robot, first, message, _meant(first), level)


def _by_place(gaps: Iterable[Gap]) -> Iterable[list[Gap]]:
    """The gaps of each controller that are written at one place."""
    found: dict[object, list[Gap]] = {}
    for it in gaps:
        found.setdefault((it.node, it.place), []).append(it)
    return found.values()


def _frames(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        message = f"nothing sends frame {it.name} of {robot.spec.name}: {it.node} is told not to"
        hint = "let one node send it: the controller (enable_odom_tf) or the filter (publish_tf)"
        yield _found(NOBODY_SENDS, robot, it, message, hint)


def _topics(robot: RewrittenRobot, before: System, after: System) -> Iterator[Finding]:
    had = closed(before.ends, before.shared)
    now = {it.key: it for it in topic_gaps(after.ends, after.shared)}
    for it in (it for it in now.values() if it.key in had):
        message = f"{it.node} reads {it.name}, which nothing of {robot.spec.name} sends any more"
        yield _found(NOT_SENT, robot, it, message, _meant(it), ERROR)
    # What the build adds, such as rows of a bridge, may close a gap.
    gaps = [
        it if it.near else now[it.key]._replace(place=it.place)
        for it in topic_gaps(before.ends, before.shared)
        if it.key in now
    ]
    for it in (it for it in gaps if it.near):
        message = f"{it.node} of {robot.spec.name} reads {it.name}, which nothing sends"
        yield _found(NOT_SENT, robot, it, message, _meant(it), WARNING)
    rest = [it for it in gaps if not it.near]
    if rest:
        yield _all_open(robot, rest)


def _moveit(
    robot: RewrittenRobot, before: Sequence[Gap], after: Sequence[Gap]
) -> Iterator[Finding]:
    known = {it.key for it in before}
    for it in (*before, *(it for it in after if it.key not in known)):
        level = WARNING if it.key in known else ERROR
        message = f"MoveIt uses {it.name}, which no controller of {robot.spec.name} has"
        yield _found(NOT_MOVED, robot, it, message, _meant(it), level)


def _bridge(
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
            yield _found(NO_GZ_TOPIC, robot, at, message, _meant(it))


def _all_open(robot: RewrittenRobot, gaps: Sequence[Gap]) -> Finding:
    names = sorted({it.name for it in gaps})
    shown = ", ".join(names[:_LISTED])
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    message = f"no known node of {robot.spec.name} sends {shown}{more}"
    hint = "name a stack or nodes that do, if no driver of its own does"
    return _found(WITHOUT_SENDER, robot, gaps[0]._replace(place=None), message, hint)


def _meant(gap: Gap) -> str:
    if not gap.near:
        return f"see {gap.near_place}" if gap.near_place else "name one that is there"
    where = f" ({gap.near_place})" if gap.near_place else ""
    return f"did you mean {gap.near}{where}?"


def _found(
    rule: Rule, robot: RewrittenRobot, gap: Gap, message: str, hint: str, level: str = ""
) -> Finding:
    """The finding where the name is needed, else at the robot in the fleet file."""
    at = gap.place or Place(robot.spec.file, robot.spec.line)
    place: dict[str, Any] = {"file": at.file, "line": at.line, "column": 1}
    return rule.finding(message, hint, level=level or rule.level, **place)
