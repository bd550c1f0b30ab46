"""What is open between a robot's controllers, its hardware and MoveIt; lists in parameter files."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.checks.gap_findings import at_gap, in_source, meant
from multibot_rewrite.fleet.checks.judged import controlled
from multibot_rewrite.fleet.outputs.output_values import OutputText
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.systems import RobotSystem
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.interfaces import control_system
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.rules.closure.lists import list_gaps
from multibot_rewrite.rules.closure.moveit import moveit_gaps
from multibot_rewrite.rules.closure.undeclared import undeclared_gaps

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
NOT_MOVED = declare(
    "MF815",
    "moveit-controller-not-there",
    WARNING,
    what="MoveIt sends trajectories to a controller that none of the robot's parameter files declares, "
    "for a joint that the controller does not move, or to an action that it does not serve. An error "
    "where the rewrite has made it so.",
    why="MoveIt plans, and execution fails: no controller takes the trajectory.",
    fix="Use the controller's name, its joints and its action.",
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
NOT_DECLARED = declare(
    "MF810",
    "section-of-no-controller",
    WARNING,
    what="A section has the parameters of a controller, and no controller manager declares it. A note "
    "unless it is called nearly as a declared controller that has no section.",
    why="Nothing reads the section: the controller that is meant runs with its defaults, or fails.",
    fix="Give the section the controller's name, or declare the controller below controller_manager.",
    bad="""\
controller_manager:
  ros__parameters:
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
joint_trajectory_controller:
  ros__parameters: {joints: [elbow], command_interfaces: [position], state_interfaces: [position]}
""",
    good="""\
controller_manager:
  ros__parameters:
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [elbow], command_interfaces: [position], state_interfaces: [position]}
""",
    line=5,
    formats=("params",),
    beside={"robot.urdf": _ARM},
)
NOT_LISTED = declare(
    "MF819",
    "listed-name-without-parameters",
    WARNING,
    what="A list of a node (sources, plugins, layers, filters) has a name without parameters, and "
    "parameters of nearly that name are in no list.",
    why="The node reads the parameters of the names in its list: it uses defaults, or does not start.",
    fix="Write the name alike in both places.",
    bad="""\
collision_monitor:
  ros__parameters:
    observation_sources: [frnt]
    front: {type: scan, topic: scan}
""",
    good="""\
collision_monitor:
  ros__parameters:
    observation_sources: [front]
    front: {type: scan, topic: scan}
""",
    line=3,
    formats=("params",),
)


def controller_findings(
    robot: RewrittenRobot,
    before: RobotSystem,
    after: RobotSystem,
    known: Mapping[str, NodeFacts],
    texts: Sequence[OutputText],
    active: Collection[str],
) -> Iterator[Finding]:
    """What is open in a robot's controllers and lists of parameters, before and after the rewrite;
    ``texts`` are the files that were made, ``active`` the controllers that launch files start so."""
    old, new = (control_system(it.given, known, it.exports, active) for it in (before, after))
    yield from controlled(robot, old, new, texts)
    open_, left = (list(moveit_gaps(it.moveit, it.given, known)) for it in (before, after))
    yield from _moveit(robot, open_, [in_source(it, texts) for it in left])
    for it in undeclared_gaps(before.given, known):
        message = (
            f"{it.name} has parameters of a controller that {robot.spec.name} does not declare"
        )
        hint = meant(it) if it.near else f"declare it as at {it.near_place}, or leave it out"
        yield at_gap(NOT_DECLARED, robot, it, message, hint, WARNING if it.near else NOTE)
    for it in list_gaps(before.given):
        message = f"{it.node} of {robot.spec.name} has {it.name}, without parameters"
        yield at_gap(NOT_LISTED, robot, it, message, meant(it))


def _moveit(
    robot: RewrittenRobot, before: Sequence[Gap], after: Sequence[Gap]
) -> Iterator[Finding]:
    known = {it.key for it in before}
    for it in (*before, *(it for it in after if it.key not in known)):
        level = WARNING if it.key in known else ERROR
        message = f"MoveIt uses {it.name}, which no controller of {robot.spec.name} has"
        yield at_gap(NOT_MOVED, robot, it, message, meant(it), level)
