# SPDX-License-Identifier: Apache-2.0
"""Ports of simulated robots, such as the one at which an autopilot is met: each further robot that has
the number of an earlier one gets the next that is free.

Sources of the steps (``address+STEP`` in the vocabulary): ArduPilot
libraries/AP_HAL_SITL/SITL_cmdline.cpp (10 for each instance, ``sim_vehicle.py -I``); PX4-Autopilot
launch/multi_uav_mavros_sitl.launch (1 for each instance).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.readback.parameters import holds
from multibot_rewrite.description.readback.xml import elements_at
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.vocabulary.grammar import split_opens, split_path
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import tag_end, text_slot
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.robots.member import with_text
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

# So many robots are named in the note.
_NAMED = 4
_FLEET = "layout: both\ndistro: jazzy\ndescription: drone.sdf\nrobots:\n  - {name: robot1}\n"
OWN_PORTS = declare(
    "MF845",
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


class _Port(NamedTuple):
    """A number of a robot, the parameter that holds it, the step to that of the next robot, and what
    is replaced to change it: ``text`` with the number in it."""

    name: str
    number: int
    step: int
    start: int
    end: int
    text: str


def with_own_ports(robots: Sequence[RewrittenRobot]) -> list[RewrittenRobot]:
    """The robots with the ports that no earlier one has; the first that has to change says it."""
    ports = [() if it.spec.simulator == REAL else tuple(_ports(it)) for it in robots]
    taken = {port.number for own in ports for port in own}
    held: set[int] = set()
    numbers: list[dict[int, int]] = []
    for own in ports:
        new: dict[int, int] = {}
        for it in own:
            new[it.number] = new.get(it.number) or _free(it, held, taken)
            taken.add(new[it.number])
        held |= {*new.values()}
        numbers.append(new)
    each = list(zip(robots, ports, numbers, strict=True))
    first = next((it for it, own, new in each if _edits(own, new)), None)
    said = tuple(_said(first, each)) if first else ()
    return [
        _numbered(it._replace(findings=(*it.findings, *said)) if it is first else it, own, new)
        for it, own, new in each
    ]


def _said(
    robot: RewrittenRobot,
    each: Sequence[tuple[RewrittenRobot, Sequence[_Port], Mapping[int, int]]],
) -> Iterator[Finding]:
    changed = {port.name for _, own, new in each for port in own if new[port.number] != port.number}
    for name in sorted(changed):
        given = (
            (it.spec.name, new[port.number])
            for it, own, new in each
            for port in own
            if port.name == name
        )
        yield at_robot(OWN_PORTS, robot, *said_of_numbers(name, given))


def said_of_numbers(name: str, given: Iterable[tuple[str, int]]) -> tuple[str, str]:
    """Which number each robot got for a port, and what to do; raises nothing."""
    words = [f"{robot} {number}" for robot, number in given]
    more = f" and {len(words) - _NAMED} more" if words[_NAMED:] else ""
    message = f"{name} is numbered: {', '.join(words[:_NAMED])}{more}"
    return message, "start what each robot talks to with its number"


def _free(port: _Port, held: set[int], taken: set[int]) -> int:
    number = port.number
    while number in held or (number in taken and number != port.number):
        number += port.step
    return number


def _ports(robot: RewrittenRobot) -> Iterator[_Port]:
    inventory = robot.member.inventory
    document = inventory.document
    starts = dict(zip(document.elements, document.starts, strict=True))
    for host, section in inventory.served:
        for word in section.opens:
            _, step, when, path, usual = split_opens(word)
            if step and (not when or holds(host, when)):
                there = list(elements_at(host, split_path(path)[0]))
                for it in there:
                    yield from _written(document.source, starts[it], it, path, int(step))
                if usual and not there and starts[host]:
                    yield from _default(document.source, starts[host], path, usual, int(step))


def _written(source: bytes, start: int, element: _Element, path: str, step: int) -> Iterator[_Port]:
    text = text_of(element)
    slot = text_slot(source, start, text) if text.isdecimal() and int(text) else None
    if slot:
        yield _Port(path, int(text), step, *slot, "{}")


def _default(source: bytes, start: int, path: str, usual: str, step: int) -> Iterator[_Port]:
    """One that is not written is put first into its plugin."""
    at = tag_end(source, start)
    if not source.endswith(b"/>", start, at):
        yield _Port(path, int(usual), step, at, at, f"<{path}>{{}}</{path}>")


def _edits(own: Sequence[_Port], new: Mapping[int, int]) -> list[Edit]:
    return [
        Edit(it.start, it.end, it.text.format(new[it.number]).encode(), None)
        for it in own
        if new[it.number] != it.number
    ]


def _numbered(
    robot: RewrittenRobot, own: Sequence[_Port], new: Mapping[int, int]
) -> RewrittenRobot:
    edits = _edits(own, new)
    if not edits:
        return robot
    data = b"".join(cut(robot.member.inventory.document.source, sorted(edits)))
    robot = robot._replace(member=with_text(robot.member, data))
    return robot._replace(simulated=data) if robot.simulated else robot._replace(description=data)
