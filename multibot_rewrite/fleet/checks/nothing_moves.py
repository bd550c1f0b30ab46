# SPDX-License-Identifier: Apache-2.0
"""A robot of which every node is known, and whose commands nothing reads, or whose sensors nothing
sends: it starts, and does not drive."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.readback.active import active_parts
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.rules.system.instead import is_needed
from multibot_rewrite.system.records import PUBLISHES, RUNS, SUBSCRIBES, End, System
from multibot_rewrite.system.words import moves

NOTHING_MOVES = declare("MF865", "commands-without-reader", WARNING, formats=("fleet",))
_SENSED = ("sensor_msgs/msg/", "nav_msgs/msg/Odometry")
# A robot without moving joints has nobody who sends them.
_JOINTS = "sensor_msgs/msg/JointState"
_HINT = "start what does in its launch file, or write which name is meant as a remap rule there"


def unmoved(robot: RewrittenRobot, facts: Sequence[NodeFacts], system: System) -> Iterator[Finding]:
    """Yield what is open in a robot of which all is known, by its own ``system``. Of another robot a
    driver may be missing that nobody has named."""
    if not _is_told(robot, facts):
        return
    read = {it.name for it in system.ends if it.role == SUBSCRIBES}
    sent = {it.name for it in system.ends if it.role == PUBLISHES}
    orders = [it for it in system.ends if _is_order(it) and it.name not in read]
    asked = [it for it in system.ends if _is_asked(it) and it.name not in sent]
    said = [f"nothing reads {_words(orders)}"] if orders else []
    said += [f"nothing sends {_words(asked)}"] if asked else []
    if said:
        who = f"robot {robot.spec.name!r}: all that it runs is known, and"
        yield at_robot(NOTHING_MOVES, robot, f"{who} {' and '.join(said)}", _HINT)


def _is_told(robot: RewrittenRobot, facts: Sequence[NodeFacts]) -> bool:
    """Is all known that it runs, some of it by its source?"""
    known = all(it.is_known and not it.untold for it in facts)
    by_source = any(" " in it.kind for it in facts)
    parts = active_parts(robot.member.source.root, robot.member.vocabulary)
    return known and by_source and all(it.is_known for it in parts)


def _is_order(it: End) -> bool:
    return it.role == PUBLISHES and it.sure == RUNS and moves(it.code_name or it.name, it.type)


def _is_asked(it: End) -> bool:
    is_sensed = it.type.startswith(_SENSED) and it.type != _JOINTS
    return it.role == SUBSCRIBES and is_needed(it) and is_sensed


def _words(ends: Iterable[End]) -> str:
    """The names in the code, each with its node."""
    each = (f"{it.code_name or it.name} of {it.node.rpartition('/')[2]}" for it in ends)
    return shorten(dict.fromkeys(each))
