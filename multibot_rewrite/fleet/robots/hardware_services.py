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
    for robot in plan.robots:
        runs = (it for it in tables[robot.spec.namespace].runs if it.fact.of_hardware)
        own = (it for run in runs for it in run.names)
        served = [it for it in own if it[0].role == SERVES and it[0].name[0] == "/"]
        moved = [(end.name, name) for end, name in served if name != end.name]
        if moved:
            rules = ", ".join(f"{old}:={new}" for old, new in moved)
            message = f"the controller manager of robot {robot.spec.name!r} has the rules {rules}"
            hint = f"call {moved[0][1]}: nothing serves {moved[0][0]} any more"
            yield at_robot(MOVED, robot, message, hint)
