# SPDX-License-Identifier: Apache-2.0
"""Services that the hardware of a robot has under another name than its code says."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import at_robot
from multibot_rewrite.system.records import SERVES

_ROBOTS = "robots:\n  - {name: robot1, description: arm.urdf}\n"
_FLEET = "layout: both\nsimulator: none\nstack: "
MOVED = declare(
    "MF851",
    "service-of-hardware-moved",
    NOTE,
    what="The hardware of a robot serves an absolute name. A rule at its controller manager puts the "
    "robot's name before it.",
    why="Who calls the old name reaches no robot any more. It may be an emergency stop.",
    fix="Call the name of each robot.",
    bad=f"{_FLEET}ros2_control\n{_ROBOTS}",
    good=f"{_FLEET}robot_state\n{_ROBOTS}",
    line=5,
    formats=("fleet",),
    beside={
        "arm.urdf": """\
<robot name="arm">
  <link name="base_link"/>
  <ros2_control name="arm" type="system">
    <hardware><plugin>sts_hardware_interface/STSHardwareInterface</plugin></hardware>
  </ros2_control>
</robot>
""",
    },
)


def moved_services(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the absolute services of hardware that have the robot's name now, one finding a robot."""
    table = plan.fleet.table
    hardware = {it.full_name for it in table.nodes if it.home.of_hardware}
    for robot in plan.robots:
        own = [it for it in table.names if it.node in hardware and it.robot == robot.spec.namespace]
        served = [it for it in own if it.endpoint.role == SERVES and it.endpoint.name[0] == "/"]
        moved = [(it.endpoint.name, it.name) for it in served if it.name != it.endpoint.name]
        if moved:
            rules = ", ".join(f"{old}:={new}" for old, new in moved)
            message = f"the controller manager of robot {robot.spec.name!r} has the rules {rules}"
            hint = f"call {moved[0][1]}: nothing serves {moved[0][0]} any more"
            yield at_robot(MOVED, robot, message, hint)
