"""A fleet file -> everything that is decided about its robots; what is written follows from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from multibot_rewrite.fleets.describe import Described, describe
from multibot_rewrite.fleets.fleet import Fleet, assemble, facts_of, merge
from multibot_rewrite.fleets.fleet_file import FleetFile
from multibot_rewrite.gc_pause import gc_paused


class FleetPlan(NamedTuple):
    """A fleet file, its robots with their descriptions, their tables and what to expect of them."""

    file: FleetFile
    robots: tuple[Described, ...]
    fleet: Fleet


def plan_fleet(file: FleetFile, also: Sequence[str] = ()) -> FleetPlan:
    """Rewrite every robot's description and make the table of the whole fleet.

    ``also`` are nodes that every robot runs, too. Raises as ``rewrite_all``, and UsageError for an
    unknown stack.
    """
    with gc_paused():
        return _planned(file, also)


def _planned(file: FleetFile, also: Sequence[str]) -> FleetPlan:
    robots = describe(file.robots, file.policy, file.vocabulary)
    stacks: dict[tuple[str, ...], list[Described]] = {}
    for robot in robots:
        stacks.setdefault(robot.spec.stacks, []).append(robot)
    fleets = [
        assemble(
            [it.member for it in group], facts_of((*names, *also), file.nodes or None), file.policy
        )
        for names, group in stacks.items()
    ]
    return FleetPlan(file, tuple(robots), merge(fleets))
