# SPDX-License-Identifier: Apache-2.0
"""Do robots stand in each other? By their start poses and how far each reaches to the side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from math import ceil, dist

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.description.checks.shapes import filled_by
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.rules.launch.models import in_each_other

# Robots of which each pair is looked at; of more the nearest neighbours in a list are.
MOST = 400
# A robot, where it starts, and how far it reaches.
_Placed = tuple[RewrittenRobot, tuple[float, float, float], float]


def too_near(plan: FleetPlan) -> Iterator[Finding]:
    """The robots in a simulator that start in another one.

    A robot turns in its place, so half of what the larger one reaches is let pass: what is found
    overlaps however they are turned. A fleet that all stands at the origin is a warning: somebody else
    may place it, but the launch file of a build does not.
    """
    robots = [it for it in plan.robots if is_simulated(it)]
    if not any(any(_place(it.spec)) for it in robots):
        yield from _without_poses(robots)
        return
    sources = [it.spec.sources for it in robots]
    reach = {key: _within(it) for key, it in dict(zip(sources, robots, strict=True)).items()}
    placed = [(it, _place(it.spec), reach[key]) for key, it in zip(sources, robots, strict=True)]
    for (one, here, own), (other, there, more) in _pairs(placed):
        if (gap := dist(here, there)) < own + more:
            yield _finding(other, one.spec.name, gap, own + more)


def _without_poses(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    if len(robots) > 1:
        room = max(1, ceil(4 * max(map(_within, robots))))
        message = f"the {len(robots)} robots are spawned at the origin, in each other"
        hint = f"write pose: {{x: {room}}} for {robots[1].spec.name}, and so on"
        yield at_robot(in_each_other, robots[1], message, hint, level=WARNING)


def _within(it: RewrittenRobot) -> float:
    return filled_by(it.member.inventory.document.root)


def _pairs(robots: Sequence[_Placed]) -> Iterator[tuple[_Placed, _Placed]]:
    return combinations(robots, 2) if len(robots) <= MOST else pairwise(robots)


def _place(spec: RobotSpec) -> tuple[float, float, float]:
    pose = spec.pose or Pose()
    return pose.x, pose.y, pose.z


def _finding(robot: RewrittenRobot, other: str, gap: float, needed: float) -> Finding:
    message = (
        f"robot {robot.spec.name!r} starts {gap:.2f} m from robot {other!r}; their shapes need"
        f" {needed:.2f} m"
    )
    return at_robot(in_each_other, robot, message, "give them pose: further apart")
