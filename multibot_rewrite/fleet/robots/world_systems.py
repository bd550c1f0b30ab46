# SPDX-License-Identifier: Apache-2.0
"""Systems of gz-sim that act on the whole world, in the description of a robot: the world of the fleet
loads them, once, and no robot does.

Why: gz-sim makes one object for each <plugin> that it meets (src/SystemManager.cc), so a second robot
with the Sensors system crashes it (gz-sensors issue 497).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.hazards import LEFT, world_systems
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.spans import Spans
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.robots.member import with_text
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

# The rule about a description alone; a fleet takes its advice.
_IN_ROBOT = "MB416"
_GZ = "gz-sim-"
MOVED = declare(LEFT, "system-of-the-world", NOTE, formats=("fleet",))


def without_world_systems(robots: Sequence[RewrittenRobot]) -> list[RewrittenRobot]:
    """The robots without such systems, each with those that it had; the first that had one says it."""
    made = [it if it.spec.simulator == REAL else _without(it) for it in robots]
    first = next((it for it in made if it.world_systems), None)
    if first is None:
        return made
    said = tuple(_said(first, made))
    return [it._replace(findings=(*it.findings, *said)) if it is first else it for it in made]


def systems_of(robots: Sequence[RewrittenRobot]) -> dict[str, str]:
    """The plugins that these robots had, by library; of two of one library that of the first robot."""
    found: dict[str, str] = {}
    for it in robots:
        found = {**it.world_systems, **found}
    return found


def _without(robot: RewrittenRobot) -> RewrittenRobot:
    document = robot.member.inventory.document
    own = [it.element for it in world_systems(robot.member.inventory)]
    # A description for Gazebo Classic keeps them: its worlds are not made here.
    if not own or not all(_library(it).startswith(_GZ) for it in own):
        return robot
    spans = Spans(document)
    edits = [Edit(spans.start_of(it), spans.end_of(it), b"", None) for it in own]
    data = b"".join(cut(document.source, sorted(edits)))
    texts = {_library(it): spans.text_of(it).decode() for it in own}
    robot = robot._replace(
        member=with_text(robot.member, data),
        world_systems=texts,
        findings=tuple(it for it in robot.findings if it.code != _IN_ROBOT),
    )
    return robot._replace(simulated=data) if robot.simulated else robot._replace(description=data)


def _library(plugin: _Element) -> str:
    return library_key((plugin.get("filename") or "").rpartition("/")[2])


def _said(first: RewrittenRobot, robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    every = systems_of(robots)
    hint = "another world than the fleet's has to load them"
    yield at_robot(MOVED, first, f"the world loads {shorten(sorted(every))}, not each robot", hint)
    for it in robots:
        for library, text in it.world_systems.items():
            if text.split() != every[library].split():
                message = f"{it.spec.name} has other settings of {library}: they are not used"
                yield at_robot(MOVED, first, message, "write one text for all robots", WARNING)
