"""A fleet file -> its rewritten robots and their remap table; all output follows from these."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from multibot_rewrite.bulk import uncollected
from multibot_rewrite.fleets.fleet import Fleet, assemble, facts_of, merge
from multibot_rewrite.fleets.fleet_file import FleetFile
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot, rewrite_robots


class FleetPlan(NamedTuple):
    """A fleet file, its rewritten robots, and the fleet of all of them."""

    file: FleetFile
    robots: tuple[RewrittenRobot, ...]
    fleet: Fleet


def plan_fleet(file: FleetFile, also: Sequence[str] = ()) -> FleetPlan:
    """Rewrite every robot's description and make the table of the whole fleet.

    ``also`` are more nodes that every robot runs. Raises as ``rewrite_all``, and UsageError for an
    unknown stack.
    """
    with uncollected():
        return _planned(file, also)


def _planned(file: FleetFile, also: Sequence[str]) -> FleetPlan:
    robots = rewrite_robots(file.robots, file.policy, file.vocabulary)
    stacks: dict[tuple[str, ...], list[RewrittenRobot]] = {}
    for robot in robots:
        stacks.setdefault(robot.spec.stacks, []).append(robot)
    fleets = [
        assemble(
            [it.member for it in group], facts_of((*names, *also), file.nodes or None), file.policy
        )
        for names, group in stacks.items()
    ]
    return FleetPlan(file, tuple(robots), merge(fleets))
