"""Keyboard teleoperation of each robot of a fleet.

Source: teleop_twist_keyboard jazzy (``stamped`` and ``frame_id``; it publishes ``cmd_vel``).
"""

from __future__ import annotations

import shlex
from collections.abc import Collection
from typing import NamedTuple

from multibot_rewrite.companions.names.robot_topics import robot_topic
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.graph.transforms import description_edges
from multibot_rewrite.remap.records import PUBLISHES, TOPIC

PLAIN, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
COMMAND = "cmd_vel"


class Teleop(NamedTuple):
    """The command topic of a robot and its type; ``frame`` counts only if commands are stamped."""

    robot: str
    topic: str
    stamped: bool
    frame: str


def teleops(plan: FleetPlan, stamped: Collection[str] = ()) -> tuple[Teleop, ...]:
    """How each robot is driven; ``stamped`` are topics that are bridged with a stamp."""
    return tuple(teleop(plan, robot, stamped) for robot in plan.robots)


def teleop(plan: FleetPlan, robot: RewrittenRobot, stamped: Collection[str] = ()) -> Teleop:
    """The robot's ``cmd_vel`` if a node subscribes to it, else the first one with a subscriber."""
    name, usual = robot.spec.namespace, robot_topic(robot.topics, f"/{COMMAND}")
    heard = _listeners(plan, name)
    fed = usual in heard or usual in stamped or not heard
    topic = usual if fed else next(iter(heard))
    types = heard.get(topic, set())
    with_stamp = topic in stamped or (STAMPED in types and PLAIN not in types)
    return Teleop(name, topic, with_stamp, _base(robot) if with_stamp else "")


def arguments(it: Teleop) -> list[str]:
    """What follows ``teleop_twist_keyboard``."""
    stamped = ["-p", "stamped:=true", "-p", f"frame_id:={it.frame}"] if it.stamped else []
    return ["--ros-args", "-r", f"{COMMAND}:={it.topic}", *stamped]


def command(it: Teleop) -> str:
    """The command that drives a robot."""
    run = ["ros2", "run", "teleop_twist_keyboard", "teleop_twist_keyboard"]
    return shlex.join([*run, *arguments(it)])


def _listeners(plan: FleetPlan, robot: str) -> dict[str, set[str]]:
    """Subscribed ``cmd_vel`` topics without a publisher in the plan, with their types."""
    own = [it for it in plan.fleet.table.names if it.robot == robot and it.endpoint.kind == TOPIC]
    sent = {it.name for it in own if it.endpoint.role == PUBLISHES}
    heard: dict[str, set[str]] = {}
    for name in own:
        asked = name.endpoint.name.rpartition("/")[2]
        if asked == COMMAND and name.endpoint.role != PUBLISHES and name.name not in sent:
            heard.setdefault(name.name, set()).add(name.endpoint.type)
    return heard


def _base(robot: RewrittenRobot) -> str:
    """The root link of the rewritten description."""
    inventory = robot.member.inventory
    children = {edge.child for edge in description_edges(inventory)}
    return next((link for link in inventory.declared["link"] if link not in children), "")
