# SPDX-License-Identifier: Apache-2.0
"""Keyboard teleoperation of each robot of a fleet.

Source: teleop_twist_keyboard jazzy (``stamped`` and ``frame_id``; it publishes ``cmd_vel``).
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.fitting.node_topics import CommandEnd, entry_of, relays_of
from multibot_rewrite.fleet.robots.fitting.sensors import bridged_commands
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.planning.start import Start
from multibot_rewrite.related_files.names.node_topics import robot_topic
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC
from multibot_rewrite.system.words import PLAIN, STAMPED

PROGRAM, COMMAND = "teleop_twist_keyboard", "cmd_vel"
# What drives call the commands that they read.
COMMANDS = (COMMAND, "cmd_vel_unstamped", "reference", "reference_unstamped")
TO_GZ = DIRECTIONS["out"]


class Teleop(NamedTuple):
    """The command topic of a robot and its type; ``frame`` counts only if commands are stamped."""

    robot: str
    topic: str
    stamped: bool
    frame: str

    @property
    def start(self) -> Start:
        """The process that drives the robot."""
        stamped = ({"stamped": "true", "frame_id": self.frame},) if self.stamped else ()
        rules = ((COMMAND, self.topic),)
        return Start(PROGRAM, PROGRAM, parameters=stamped, remappings=rules)


def teleops(plan: FleetPlan) -> tuple[Teleop, ...]:
    """Return how to drive each robot that reads velocities. Raises InputError for a bad bridge file."""
    found = []
    for robot in plan.robots:
        # Something reads velocity commands, or sends them to a base that is not in the plan.
        own, usual = _robot_ends(plan, robot), _usual_topic(robot)
        sends = any(end.role == PUBLISHES and name == usual for _, end, name in own)
        if sends or _obeyed_topics([*_command_ends(plan, robot)]):
            found.append(teleop(plan, robot))
    return tuple(found)


def _robot_ends(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[tuple[str, Endpoint, str]]:
    """Yield (node, end, name) for the ends of a robot's nodes."""
    runs = (it for it in plan.fleet.table.runs if it.robot == robot.spec.namespace)
    yield from ((run.full_name, end, name) for run in runs for end, name in run.names)


def _usual_topic(robot: RewrittenRobot) -> str:
    return robot_topic(robot.topics, f"/{COMMAND}")


def teleop(plan: FleetPlan, robot: RewrittenRobot) -> Teleop:
    """Return how to drive a robot: by a ``cmd_vel`` that is obeyed, another topic, or an input."""
    # A mux, a smoother or a monitor that sends there is driven by an input of it.
    ends = [*_command_ends(plan, robot)]
    usual, obeyed = _usual_topic(robot), _obeyed_topics(ends)
    topic = entry_of(usual if usual in obeyed or not obeyed else obeyed[0], ends)
    types = {it.type for it in ends if it.role == SUBSCRIBES and it.topic == topic}
    if STAMPED not in types or PLAIN in types:
        return Teleop(robot.spec.namespace, topic, False, "")
    children = {edge.child for edge in robot.tree}
    root = next((link for link in robot.links if link not in children), "")
    return Teleop(robot.spec.namespace, topic, True, root)


def _command_ends(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[CommandEnd]:
    """Yield a robot's ends with velocities: those of nodes, then of bridges, which have no name."""
    for node, end, name in _robot_ends(plan, robot):
        if end.kind == TOPIC and end.type in (PLAIN, STAMPED) and not end.when:
            yield CommandEnd(node, end.role, name, end.type, end.parameter, end.name)
    own = bridged_commands(robot.member, robot.spec).items()
    found = [(robot_topic(robot.topics, f"/{name}"), type_) for name, type_ in own]
    if not found:
        fleet, name = plan.fleet, robot.spec.namespace
        inventory = {name: fleet.inventories[name]}
        made, _ = bridged_topics(inventory, fleet.naming, fleet.models, fleet.table.runs)
        found = [(it.ros, it.ros_type) for it in made if it.direction == TO_GZ]
    for topic, type_ in found:
        if type_ in (PLAIN, STAMPED):
            yield CommandEnd("", SUBSCRIBES, topic, type_)


def _obeyed_topics(ends: Sequence[CommandEnd]) -> list[str]:
    """Return the topics of commands that a drive obeys; if none, inputs of what is before one."""
    relays = relays_of(ends)
    heard = [it for it in ends if it.role == SUBSCRIBES]
    usual = [it for it in heard if not it.node or it.name.rpartition("/")[2] in COMMANDS]
    sent = {it.topic for it in ends if it.role == PUBLISHES}
    drives = [it.topic for it in usual if it.node not in relays]
    return drives or [it.topic for it in usual if it.topic not in sent]
