"""What an SRDF asks of a robot, before and after its rewrite: controllers of its groups' joints, tf."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.checks.gap_findings import at_gap, meant
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.systems import RobotSystem
from multibot_rewrite.producers.evidence.semantics import Semantics, semantics
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.rules.closure.moveit import moved_joints
from multibot_rewrite.rules.closure.semantics import group_gaps, virtual_gaps

_ARM = """\
<robot name="arm">
  <link name="base_link"/>
  <link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="base_link"/><child link="hand"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
_SRDF = """\
<robot name="arm">
  <virtual_joint name="v" type="{}" parent_frame="odom" child_link="base_link"/>
  <group name="arm"><joint name="elbow"/></group>
</robot>
"""
_FLEET = """\
srdf: arm.srdf
companions: {moveit: moveit_controllers.yaml}
robots: [{name: robot1, description: robot.urdf}]
"""
_CONTROLLERS = """\
moveit_simple_controller_manager:
  controller_names: [arm]
  arm: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [JOINT]}
"""
NOT_ACTUATED = declare(
    "MF826",
    "group-joint-without-controller",
    NOTE,
    what="A planning group of the SRDF has a joint that none of MoveIt's controllers moves. An error "
    "where the rewrite has made it so.",
    why="MoveIt plans for the group, and cannot execute: no set of controllers moves all its joints.",
    fix="Add the joint to a controller, or declare it passive in the SRDF if nothing moves it.",
    bad=_FLEET,
    good=_FLEET.replace("moveit_controllers", "controllers"),
    line=3,
    formats=("fleet",),
    beside={
        "robot.urdf": _ARM,
        "arm.srdf": _SRDF.format("fixed"),
        "moveit_controllers.yaml": _CONTROLLERS.replace("JOINT", "wrist"),
        "controllers.yaml": _CONTROLLERS.replace("JOINT", "elbow"),
    },
)
NOT_LOCATED = declare(
    "MF827",
    "virtual-joint-without-transform",
    NOTE,
    what="A virtual joint of the SRDF moves (planar, floating), and no known node of the robot sends "
    "the transform that is its state.",
    why="MoveIt waits for a complete state of the robot: it does not plan from where the robot is.",
    fix="Name the node that sends it, or make the joint fixed.",
    bad="srdf: moving.srdf\nrobots: [{name: robot1, description: robot.urdf}]\n",
    good="srdf: arm.srdf\nrobots: [{name: robot1, description: robot.urdf}]\n",
    line=2,
    formats=("fleet",),
    beside={
        "robot.urdf": _ARM,
        "arm.srdf": _SRDF.format("fixed"),
        "moving.srdf": _SRDF.format("planar"),
    },
)


def semantic_findings(
    plan: FleetPlan, robot: RewrittenRobot, before: RobotSystem, after: RobotSystem
) -> Iterator[Finding]:
    """What a robot's SRDF names and nothing else of the robot has."""
    job = plan.jobs[robot.spec.sources].srdf
    if job is None:
        return
    source = semantics(read_document(job.data, job.file).root, robot.member.source.root, job.file)
    old = list(group_gaps(source, moved_joints(before.moveit)))
    yield from _groups(robot, old, NOTE)
    known = {it.key for it in old}
    new = group_gaps(_written(robot, job.file), moved_joints(after.moveit))
    yield from _groups(robot, [it for it in new if it.key not in known], ERROR)
    for it in virtual_gaps(source, before.sent):
        message = f"{it.node} of {robot.spec.name} has the transform {it.name} as its state"
        hint = "no known node sends it: name the one that does, or make the joint fixed"
        yield at_gap(NOT_LOCATED, robot, it, message, hint)


def _written(robot: RewrittenRobot, file: str) -> Semantics:
    return semantics(
        read_document(robot.srdf, file).root,
        robot.member.inventory.document.root,
        f"{robot.spec.name}/{file.rpartition('/')[2]}",
    )


def _groups(robot: RewrittenRobot, gaps: Sequence[Gap], level: str) -> Iterator[Finding]:
    by_group: dict[str, list[Gap]] = {}
    for it in gaps:
        by_group.setdefault(it.node, []).append(it)
    for group, (first, *rest) in by_group.items():
        more = f" and {len(rest)} more" if rest else ""
        message = f"no controller of MoveIt moves {first.name}{more} of group {group}"
        yield at_gap(
            NOT_ACTUATED, robot, first, f"{message} of {robot.spec.name}", meant(first), level
        )
