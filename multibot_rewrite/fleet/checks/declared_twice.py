# SPDX-License-Identifier: Apache-2.0
"""Names that two robots of a fleet declare, each in its own description."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.readback.meeting import FRAMES
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot, at_robot
from multibot_rewrite.rules.description.multirobot.named_robots import robots_share_a_name
from multibot_rewrite.spelling.records import Table

# The kinds that differ from robot to robot.
_KINDS = ("link", "joint", "frame", "sensor", "hardware")


def declared_twice(
    robots: Iterable[RewrittenRobot], naming: Naming, table: Table
) -> Iterator[Finding]:
    """What two robots declare though it is not shared, each in its description; but for frames where
    they meet by the table."""
    met = {name for it in table.problems if it.code == FRAMES for name in it.names}
    first: dict[tuple[str, str], RewrittenRobot] = {}
    kinds = [it for it in _KINDS if it in naming.separators]
    for robot in robots:
        declared = robot.member.inventory.declared
        named = ((kind, name) for kind in kinds for name in declared.get(kind, ()))
        for kind, name in named:
            other = first.setdefault((kind, name), robot)
            told = kind in ("link", "frame") and name in met
            if other is robot or told or name in naming.shared_frames:
                continue
            both = f"{other.spec.name} and {robot.spec.name}"
            message = f"{both} would both have the {kind} {name!r}"
            hint = "give one of them another name, prefix or postfix"
            hint = SET_PREFIX if kind == "sensor" and robot.needs_prefix else hint
            yield at_robot(robots_share_a_name, robot, message, hint)
