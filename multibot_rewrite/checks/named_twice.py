# SPDX-License-Identifier: Apache-2.0
"""Names that two robots declare, that have a robot's name twice, and unused controller managers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.readback.meeting import FRAMES
from multibot_rewrite.description.sources.own_names import name_robot
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot, at_robot
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.planning.records import Table
from multibot_rewrite.rules.description.multirobot.named_robots import robots_share_a_name
from multibot_rewrite.rules.system.transforms import robots_name_twice

# The kinds of declared names that differ from robot to robot.
_DECLARED = ("link", "joint", "frame", "sensor", "hardware")
_KINDS = ("topic", "service")


def declared_twice(
    robots: Iterable[RewrittenRobot], naming: Naming, told: Iterable[Finding]
) -> Iterator[Finding]:
    """Yield what two robots declare, but no shared name and no frame that ``told`` reports."""
    met = {name for it in told if it.code == FRAMES for name in it.names}
    first: dict[tuple[str, str], RewrittenRobot] = {}
    kinds = [it for it in _DECLARED if it in naming.separators]
    for robot in robots:
        declared = robot.member.inventory.declared
        named = ((kind, name) for kind in kinds for name in declared.get(kind, ()))
        for kind, name in named:
            other = first.setdefault((kind, name), robot)
            is_told = kind in ("link", "frame") and name in met
            if other is robot or is_told or name in naming.shared_frames:
                continue
            message = f"{other.spec.name} and {robot.spec.name} would both have the {kind} {name!r}"
            hint = "give one of them another name, prefix or postfix"
            hint = SET_PREFIX if kind == "sensor" and robot.needs_prefix else hint
            yield at_robot(robots_share_a_name, robot, message, hint)


def named_twice(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    """Report for each description the first name that has the robot's name twice."""
    told = set()
    for it in robots:
        spec = it.spec
        starts = tuple(f"/{spec.namespace}/{spec.name}{end}" for end in "/_")
        is_named = name_robot(spec.arguments, [spec.name])
        read = (one for one in it.member.reading.names if one.kind in _KINDS)
        twice = (one.name for one in read if one.name.startswith(starts))
        name = next(twice, "") if is_named else ""
        if name and spec.description not in told:
            told.add(spec.description)
            given = spec.arguments.items()
            which = [key for key, text in given if name_robot({key: text}, [spec.name])]
            message = f"{name} has the name of robot {spec.name!r} twice"
            hint = f"write {' or '.join(which)}: '' under arguments"
            yield at_robot(robots_name_twice, it, message, hint)


OTHER_MANAGER = declare("MF850", "other-manager", ERROR, formats=("fleet",))


def other_manager(robots: Iterable[RewrittenRobot], table: Table) -> Iterator[Finding]:
    """Yield the robots whose node set has a manager that no plugin makes, though one makes another."""
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
