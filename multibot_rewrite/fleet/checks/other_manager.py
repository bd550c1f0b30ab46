# SPDX-License-Identifier: Apache-2.0
"""Controller managers that a plugin makes under another name than that of the robot's stack."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.spelling.records import Table

OTHER_MANAGER = declare("MF850", "other-manager", ERROR, formats=("fleet",))


def other_manager(robots: Iterable[RewrittenRobot], table: Table) -> Iterator[Finding]:
    """The robots whose stack has a manager that no plugin makes, though one makes another."""
    robots = [*robots]
    tables = table.by_robot(it.member.robot for it in robots)
    first: dict[str, RewrittenRobot] = {}
    for robot in robots:
        own = tables[robot.member.robot].runs
        made = [it.manager for it in robot.member.reading.nodes if it.manager]
        asked = {it.full_name for it in own if it.node == MANAGER and not it.written}
        if made and asked and asked.isdisjoint(made):
            message = f"the plugin makes {made[0]}, but spawners ask {min(asked)}"
            hint = "remove <namespace> and <controller_manager_name> of the plugin"
            # What is the same for all robots of a description is said in one line.
            at = first.setdefault(robot.spec.description, robot)
            yield at_robot(OTHER_MANAGER, at, message, hint)
