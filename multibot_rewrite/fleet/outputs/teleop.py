# SPDX-License-Identifier: Apache-2.0
"""Keyboard teleoperation of each robot of a fleet.

Source: teleop_twist_keyboard jazzy (``stamped`` and ``frame_id``; it publishes ``cmd_vel``).
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.robot_topics import robot_topic
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import yaml_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.producers.ends import bridge_ends
from multibot_rewrite.spelling.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.spelling.records import Names
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC
from multibot_rewrite.system.words import PLAIN, STAMPED

COMMAND = "cmd_vel"
# What drives call the commands that they read.
COMMANDS = (COMMAND, "cmd_vel_unstamped", "reference", "reference_unstamped")
TO_GZ = DIRECTIONS["out"]


class Teleop(NamedTuple):
    """The command topic of a robot and its type; ``frame`` counts only if commands are stamped."""

    robot: str
    topic: str
    stamped: bool
    frame: str


def teleops(plan: FleetPlan) -> tuple[Teleop, ...]:
    """How each robot is driven that reads velocity commands. Raises InputError for a bridge file that
    cannot be read."""
    return tuple(teleop(plan, robot) for robot in plan.robots if _is_driven(plan, robot))


def _is_driven(plan: FleetPlan, robot: RewrittenRobot) -> bool:
    """Does something read velocity commands, or send them to a base that is not in the plan?"""
    own = _ends(plan, robot)
    sends = any(end.role == PUBLISHES and name == _usual(robot) for end, name in own)
    return sends or bool(_listeners(plan, robot))


def _ends(plan: FleetPlan, robot: RewrittenRobot) -> Names:
    runs = (it for it in plan.fleet.table.runs if it.robot == robot.spec.namespace)
    return tuple(it for run in runs for it in run.names)


def _usual(robot: RewrittenRobot) -> str:
    return robot_topic(robot.topics, f"/{COMMAND}")


def teleop(plan: FleetPlan, robot: RewrittenRobot) -> Teleop:
    """The robot's ``cmd_vel`` if a node subscribes to it, else the first one with a subscriber."""
    name, usual = robot.spec.namespace, _usual(robot)
    heard = _listeners(plan, robot)
    topic = usual if usual in heard or not heard else next(iter(heard))
    types = heard.get(topic) or {type_ for name, type_ in _bridged(plan, robot) if name == topic}
    with_stamp = STAMPED in types and PLAIN not in types
    return Teleop(name, topic, with_stamp, _base(robot) if with_stamp else "")


def arguments(it: Teleop) -> list[str]:
    """What follows ``teleop_twist_keyboard``."""
    stamped = ["-p", "stamped:=true", "-p", f"frame_id:={it.frame}"] if it.stamped else []
    return ["--ros-args", "-r", f"{COMMAND}:={it.topic}", *stamped]


def command(it: Teleop) -> str:
    """The command that drives a robot."""
    run = ["ros2", "run", "teleop_twist_keyboard", "teleop_twist_keyboard"]
    return shlex.join([*run, *arguments(it)])


def _listeners(plan: FleetPlan, robot: RewrittenRobot) -> dict[str, set[str]]:
    """Subscribed topics of commands without a publisher in the plan, with their types, then those of
    any name that bridges bring to the simulator."""
    own = [it for it in _ends(plan, robot) if it[0].kind == TOPIC]
    sent = {name for end, name in own if end.role == PUBLISHES}
    heard: dict[str, set[str]] = {}
    for end, name in own:
        asked = end.name.rpartition("/")[2] in COMMANDS and end.type in (PLAIN, STAMPED)
        if asked and end.role != PUBLISHES and name not in sent:
            heard.setdefault(name, set()).add(end.type)
    for topic, type_ in _bridged(plan, robot):
        if type_ in (PLAIN, STAMPED) and topic not in sent:
            heard.setdefault(topic, set()).add(type_)
    return heard


def _bridged(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[tuple[str, str]]:
    """The topics that go to the simulator, with their types: those of the robot's bridge files, then
    those of the bridge that is made."""
    for path in robot.spec.companions.get("bridge", ()):
        for end in bridge_ends(yaml_of(path), robot.spec.bridge_namespace_of(path)):
            if end.role == SUBSCRIBES:
                yield robot_topic(robot.topics, end.name), end.type
    fleet = plan.fleet
    own = {robot.spec.namespace: fleet.inventories[robot.spec.namespace]}
    made, _ = bridged_topics(own, fleet.naming, fleet.models, fleet.table.runs)
    yield from ((it.ros, it.ros_type) for it in made if it.direction == TO_GZ)


def _base(robot: RewrittenRobot) -> str:
    """The root link of the rewritten description."""
    children = {edge.child for edge in robot.tree}
    return next((link for link in robot.links if link not in children), "")
