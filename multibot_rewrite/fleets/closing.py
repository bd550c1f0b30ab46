"""Does each robot of a fleet close, before and after its rewrite? What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.closure.frames import frame_gaps, tree_gaps
from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.closure.interfaces import interface_gaps
from multibot_rewrite.closure.moveit import moveit_gaps
from multibot_rewrite.companions.params.known_nodes import load_known_nodes
from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.closing_topics import bridge_findings, topic_findings
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.gap_findings import at_gap, meant
from multibot_rewrite.fleets.output_values import OutputText
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.robot_groups import group_robots
from multibot_rewrite.fleets.robot_nodes import node_sources
from multibot_rewrite.fleets.systems import system_after, system_before
from multibot_rewrite.fleets.tf_conflicts import tf_conflicts
from multibot_rewrite.graph.transforms import edges_in

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
NOBODY_SENDS = declare(
    "MF813",
    "odometry-not-sent",
    WARNING,
    what="Every node of a robot that could send the transform to its base is told not to: an error if "
    "there are two, a warning if another node, which no file names, may send it.",
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


TWO_TREES = declare(
    "MF817",
    "two-tf-trees",
    WARNING,
    what="Nodes of a robot send transforms that make two trees of its frames.",
    why="tf finds no way from the one to the other: a map is not connected to the robot.",
    fix="Use the same odometry frame in both.",
    bad="""\
slam_toolbox:
  ros__parameters: {odom_frame: odom, map_frame: map}
ekf_filter_node:
  ros__parameters: {odom_frame: odom_filtered, world_frame: odom_filtered, base_link_frame: base_link}
""",
    good="""\
slam_toolbox:
  ros__parameters: {odom_frame: odom, map_frame: map}
ekf_filter_node:
  ros__parameters: {odom_frame: odom, world_frame: odom, base_link_frame: base_link}
""",
    line=3,
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


def closing(plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputText]) -> Iterator[Finding]:
    """What is open in the robots of a fleet; robots of the same sources are looked at once.

    ``fleet`` has all nodes that are started, ``texts`` are the files that were made.
    """
    yield from tf_conflicts(plan, fleet, texts)
    known = load_known_nodes(plan.file.parameters, plan.file.distro)
    for group in group_robots(plan):
        robot = group.robots[0]
        evidence = plan.evidence[node_sources(robot.spec)]
        before, library = system_before(robot, evidence), evidence.known
        after = system_after(robot, fleet, texts, known)
        made = [*interface_gaps(before.given, library, before.exports)]
        now = [*interface_gaps(after.given, library, after.exports)]
        yield from _interfaces(robot, made, now)
        yield from _frames(robot, frame_gaps(before.given, library, before.sent))
        yield from _trees(robot, tree_gaps(edges_in(robot.member.source.root), before.senders))
        yield from topic_findings(robot, before, after)
        old, new = (list(moveit_gaps(it.moveit, it.given)) for it in (before, after))
        yield from _moveit(robot, old, new)
        yield from bridge_findings(plan, robot, texts)


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
            yield at_gap(NO_INTERFACE, robot, first, message, meant(first), level)


def _by_place(gaps: Iterable[Gap]) -> Iterable[list[Gap]]:
    """The gaps of each controller that are written at one place."""
    found: dict[object, list[Gap]] = {}
    for it in gaps:
        found.setdefault((it.node, it.place), []).append(it)
    return found.values()


def _frames(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        both = f"{it.node} and {it.near} ({it.near_place}) are" if it.near else f"{it.node} is"
        message = f"nothing sends frame {it.name} of {robot.spec.name}: {both} told not to"
        hint = "let one node send it: the controller (enable_odom_tf) or the filter (publish_tf)"
        # Another node, which no file names, may send what one alone does not.
        yield at_gap(NOBODY_SENDS, robot, it, message, hint, ERROR if it.near else WARNING)


def _trees(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        message = f"{it.node} of {robot.spec.name} sends {it.name}, apart from {it.near}"
        where = f" ({it.near_place})" if it.near_place else ""
        hint = f"use the same odometry frame in both{where}, or add what joins them"
        yield at_gap(TWO_TREES, robot, it, message, hint)


def _moveit(
    robot: RewrittenRobot, before: Sequence[Gap], after: Sequence[Gap]
) -> Iterator[Finding]:
    known = {it.key for it in before}
    for it in (*before, *(it for it in after if it.key not in known)):
        level = WARNING if it.key in known else ERROR
        message = f"MoveIt uses {it.name}, which no controller of {robot.spec.name} has"
        yield at_gap(NOT_MOVED, robot, it, message, meant(it), level)
