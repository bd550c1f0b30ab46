# SPDX-License-Identifier: Apache-2.0
"""Ports of the simulated robots of a fleet, each with a number of its own."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.findings.finding import NOTE, declare
from multibot_rewrite.description.own_ports import numbered, ports_of
from multibot_rewrite.description.readback.meeting import NUMBERED
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.robots.member import with_text
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

OWN_PORTS = declare(NUMBERED, "own-ports", NOTE, formats=("fleet",))


def with_own_ports(robots: Sequence[RewrittenRobot]) -> list[RewrittenRobot]:
    """The robots with the ports that no earlier one has; the first that has to change says it."""
    sources = [it.member.inventory.document.source for it in robots]
    made = numbered(
        {
            it.spec.name: (
                text,
                () if it.spec.simulator == REAL else [*ports_of(it.member.inventory)],
            )
            for it, text in zip(robots, sources, strict=True)
        }
    )
    every = [
        it if new == old else _with_text(it, new)
        for it, old, new in zip(robots, sources, made.texts, strict=True)
    ]
    first = next((n for n, old in enumerate(sources) if old != made.texts[n]), 0)
    if made.notes:
        said = (at_robot(OWN_PORTS, every[first], *it) for it in made.notes)
        every[first] = every[first]._replace(findings=(*every[first].findings, *said))
    return every


def _with_text(robot: RewrittenRobot, data: bytes) -> RewrittenRobot:
    robot = robot._replace(member=with_text(robot.member, data))
    return robot._replace(simulated=data) if robot.simulated else robot._replace(description=data)
