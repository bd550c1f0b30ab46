# SPDX-License-Identifier: Apache-2.0
"""What a fleet whose robots are in several ROS domains needs, and what does not cross them."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.fleet.file.domains import Apart
from multibot_rewrite.fleet.fleet import Fleet, planned
from multibot_rewrite.fleet.launch.starts import FleetStarts
from multibot_rewrite.planning.domain_bridge import crossings, services_apart
from multibot_rewrite.system.domains import domain_of
from multibot_rewrite.system.records import MAY, System

NOT_ACROSS = declare("MF849", "not-across-domains", ERROR, formats=("fleet",))


def not_across(fleet: Fleet) -> Iterator[Finding]:
    """Yield findings: calls, topics and nodes of a fleet that end at the border of a ROS domain."""
    apart = fleet.apart
    plan = planned(fleet) if apart.domains else System()
    yield from _of_simulator(apart, plan)
    called = lists_by_key(
        ((end.node, own, other), end.name) for end, own, other in services_apart(plan)
    )
    for (node, own, other), names in called.items():
        message = f"{node} of domain {own} calls {shorten(names)}, which domain {other} has"
        hint = "run both in one domain: services and actions do not cross"
        yield _finding(apart, message, hint, WARNING)
    # Topics without a known type that a node of one domain reads and another domain sends.
    crossing = crossings(plan, ()) if plan.domains else ()
    if untyped := sorted({it.name for it in crossing if not it.type}):
        message = f"domain_bridge cannot bring {shorten(untyped)}: the type is not known"
        yield _finding(
            apart, message, "give the type in the file of nodes (docs/node-sets.md)", WARNING
        )


def _of_simulator(apart: Apart, plan: System) -> Iterator[Finding]:
    """Yield nodes of simulator plugins whose robot is in another domain."""
    # rclcpp has one context in that process, so one domain (gazebo_ros_pkgs ros2
    # gazebo_ros/include/gazebo_ros/node.hpp, CreateWithArgs; no element of <ros> names another).
    # What gz sends has a bridge in the robot's domain. A domain_bridge brings no services and
    # actions, by which a manager is asked.
    numbers = domain_of(plan)
    own = [it for it in plan.nodes if it.plugin.file and numbers[it.robot] != numbers[""]]
    if own:
        where = f"runs in the process of the simulator, in domain {numbers['']}"
        level = WARNING if all(it.sure == MAY for it in own) else ERROR
        hint = (
            "give the robots one domain in the simulation, or write simulator: none for real robots"
        )
        robots = dict.fromkeys(it.robot for it in own)
        message = f"{own[0].name} {where}, and its robot is in {numbers[own[0].robot]}"
        yield _finding(apart, message, hint, level)._replace(robots=tuple(robots))


def one_launch_each(apart: Apart, starts: FleetStarts) -> Iterator[Finding]:
    """Report robots in several domains whose nodes one launch file would have to reach."""
    reached = [
        robot
        for robot in starts.robots
        if any(it.components or it.brought_up for it in robot.starts)
    ]
    several = {starts.domains.get(it.name, 0) for it in starts.robots}
    if reached and len(several) > 1:
        names = shorten(it.name for it in reached)
        message = f"the launch file loads or activates nodes of {names}, from one domain"
        first = f"ros2 launch fleet.launch.py robots:={reached[0].name}"
        yield _finding(apart, message, f"start each robot by itself: {first}", WARNING)


def _finding(apart: Apart, message: str, hint: str, level: str) -> Finding:
    """Return a finding at the domains in the fleet file."""
    file, line = apart.place
    return NOT_ACROSS.finding(message, hint, level=level, file=file, line=line)
