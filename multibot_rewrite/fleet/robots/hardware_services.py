# SPDX-License-Identifier: Apache-2.0
"""Services that the hardware of a robot has under another name than its code says."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import at_robot
from multibot_rewrite.system.records import SERVES

MOVED = declare("MF851", "service-of-hardware-moved", NOTE, formats=("fleet",))


def moved_services(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the absolute services of hardware that have the robot's name now, one finding a robot."""
    tables = plan.fleet.table.by_robot(it.spec.namespace for it in plan.robots)
    hardware = {it.full_name for it in plan.fleet.table.nodes if it.home.of_hardware}
    for robot in plan.robots:
        own = [it for it in tables[robot.spec.namespace].names if it.node in hardware]
        served = [it for it in own if it.endpoint.role == SERVES and it.endpoint.name[0] == "/"]
        moved = [(it.endpoint.name, it.name) for it in served if it.name != it.endpoint.name]
        if moved:
            rules = ", ".join(f"{old}:={new}" for old, new in moved)
            message = f"the controller manager of robot {robot.spec.name!r} has the rules {rules}"
            hint = f"call {moved[0][1]}: nothing serves {moved[0][0]} any more"
            yield at_robot(MOVED, robot, message, hint)
