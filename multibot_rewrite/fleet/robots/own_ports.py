# SPDX-License-Identifier: Apache-2.0
"""Ports of the simulated robots of a fleet, each with a number of its own."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.description.own_ports import numbered, ports_of
from multibot_rewrite.description.readback.meeting import NUMBERED
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.robots.member import with_text
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

_FLEET = "layout: both\ndistro: jazzy\ndescription: drone.sdf\nrobots:\n  - {name: robot1}\n"
OWN_PORTS = declare(
    NUMBERED,
    "own-ports",
    NOTE,
    what="A description or a parameter file names a port that only one robot can have, and each "
    "further robot got a number of its own.",
    why="Two plugins or nodes of one computer cannot open one port: the second robot would have "
    "no autopilot, or that of the first one.",
    fix="Start the program at the other end with the same number: of ArduPilot sim_vehicle.py -I 1 for "
    "the second robot, of PX4 px4 -i 1. A robot whose description has another number keeps it.",
    bad=f"{_FLEET}  - {{name: robot2}}\n",
    good=_FLEET,
    line=6,
    formats=("fleet",),
    beside={
        "drone.sdf": """\
<sdf version="1.9">
  <model name="drone">
    <link name="base_link"/>
    <plugin name="ArduPilotPlugin" filename="ArduPilotPlugin">
      <fdm_port_in>9002</fdm_port_in>
    </plugin>
  </model>
</sdf>
""",
    },
)


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
