"""MoveIt in a layout in which tf has other names of links than the URDF.

Source: moveit2 2.12.4 planning_scene_monitor.cpp (``getUpdatedFrameTransforms``: every frame of tf is
looked up from the root link or the virtual joint's parent, by its name in the URDF and SRDF),
current_state_monitor.cpp (a moving virtual joint: the same of its child), planning_scene_display.cpp
(``calculateOffsetPosition``). No parameter puts a prefix before them.
"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import at_robot

_PACKAGES = ("moveit_ros_move_group", "moveit_servo", "moveit_ros_planning")
_FLEET = """\
layout: LAYOUT
affix: prefix
description: arm.urdf
stack: moveit
robots:
  - {name: left}
"""
PREFIXED_LATER = declare(
    "MF837",
    "moveit-with-frame-prefix",
    ERROR,
    what="A robot runs MoveIt in layout frame-prefix: links have a prefix in tf, and none in the URDF.",
    why="MoveIt looks up in tf what the URDF calls its root link, which no robot has there: it cannot "
    "place goals in other frames, sensors or objects, its displays in RViz stand at the origin, two "
    "arms cannot be told from each other. No parameter of MoveIt puts a prefix before links.",
    fix="Take layout frames-per-robot with affix prefix: links have the same names in URDF, SRDF "
    "and tf. Leave frame_prefix of robot_state_publisher empty then.",
    bad=_FLEET.replace("LAYOUT", "frame-prefix"),
    good=_FLEET.replace("LAYOUT", "frames-per-robot"),
    line=6,
    formats=("fleet",),
    beside={
        "arm.urdf": """\
<robot name="arm">
  <link name="base"/><link name="hand"/>
  <joint name="elbow" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>
"""
    },
)


def moveit_frames(plan: FleetPlan) -> Iterator[Finding]:
    """The robots whose MoveIt would look for frames that tf does not have."""
    if not plan.fleet.naming.layout.at_run_time:
        return
    those = {it.name for it in plan.fleet.facts if it.package in _PACKAGES}
    running = {it.robot: it.node for it in reversed(plan.fleet.table.nodes) if it.node in those}
    for robot in plan.robots:
        if node := running.get(robot.spec.namespace):
            root = next(iter(robot.links), "")
            what = "looks for the links of the URDF in tf, which has"
            message = f"{node} of {robot.spec.name!r} {what} {root!r}"
            hint = "take layout frames-per-robot with affix: prefix"
            yield at_robot(PREFIXED_LATER, robot, message, hint)
