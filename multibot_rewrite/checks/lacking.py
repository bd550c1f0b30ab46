# SPDX-License-Identifier: Apache-2.0
"""Nodes of node sets that end or wait for ever without input, and robots that cannot drive.

Sources: moveit2 jazzy moveit_ros/planning/rdf_loader/src/rdf_loader.cpp (no
robot_description_semantic, no model), ros2_control jazzy
hardware_interface/src/component_parser.cpp ("no ros2_control tag")."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.readback.active import active_parts
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.fitting.node_topics import topic_of
from multibot_rewrite.fleet.robots.fitting.sensors import (
    OF_CAMERAS,
    offered_topics,
    sent_as,
    wanted,
)
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.knowledge.records import MANAGER, MOVE_GROUP, NodeFacts
from multibot_rewrite.rules.system.instead import is_needed
from multibot_rewrite.system.records import PUBLISHES, RUNS, SUBSCRIBES, End, System
from multibot_rewrite.system.words import moves

MAP_SERVER, MAP = "map_server", "yaml_filename"
_MAP = f"write its {MAP} into a parameter file (related_files: {{params: FILE}}), or use nav2_slam"
LACKING = declare("MF857", "node-without-its-file", ERROR, formats=("fleet",))
NO_CAMERA = declare("MF861", "node-without-its-camera", WARNING, formats=("fleet",))


class Need(NamedTuple):
    """What a node reads: whether a robot has it, what it is, and where to name it."""

    is_there: Callable[[RewrittenRobot], bool]
    what: str
    hint: str


def _has_hardware(robot: RewrittenRobot) -> bool:
    """Return whether something in the description makes or fills a controller manager."""
    made = any(it.manager for it in robot.member.reading.nodes)
    return made or next(robot.member.described.document.root.iter("ros2_control"), None) is not None


NEEDS: Mapping[str, Need] = {
    MOVE_GROUP: Need(lambda it: bool(it.spec.srdf), "no SRDF", "name it: `srdf: FILE`"),
    MANAGER: Need(
        _has_hardware, "a description without <ros2_control>", "take a description that has one"
    ),
}


def lacking(plan: FleetPlan) -> Iterator[Finding]:
    """Yield nodes of node sets that end at once."""
    # One that a file of the robot names may get its input elsewhere.
    for robot in (it for it in plan.robots if not it.spec.launch):
        evidence = plan.evidence_of(robot)
        maps = {it.node for it in evidence.given if MAP in it.values and it.values[MAP].value}
        for node in evidence.nodes:
            if node.kind == MAP_SERVER and node.name not in maps and not node.when:
                message = f"robot {robot.spec.name!r} runs {node.name} without a map"
                yield at_robot(LACKING, robot, message, _MAP, NOTE)
            need = NEEDS.get(node.kind)
            is_named = not node.origin.node_set
            if need is None or is_named or node.when or node.shared or need.is_there(robot):
                continue
            message = f"robot {robot.spec.name!r} runs {node.name} ({node.origin}) with {need.what}"
            yield at_robot(LACKING, robot, message, f"{need.hint}, or leave the node set out")


def without_camera(plan: FleetPlan) -> Iterator[Finding]:
    """Yield nodes of node sets that read a camera, if a simulated robot has none or several."""
    for robot in (it for it in plan.robots if it.spec.simulator != REAL and not it.spec.launch):
        nodes = plan.evidence_of(robot).nodes
        waiting = [it for it in nodes if it.origin.node_set and not (it.when or it.shared)]
        ends = ((it, end) for it in waiting for end in it.endpoints if "<" not in end.name)
        kinds_of = ((it, end, wanted(it, end)) for it, end in ends)
        hears = [row for row in kinds_of if row[2] in OF_CAMERAS]
        offered = offered_topics(robot.member, robot.spec) if hears else {}
        lost = [
            (it.name, topic_of(it, end), kind)
            for it, end, kind in hears
            if topic_of(it, end) not in {*offered.get(kind, ()), *sent_as(nodes, kind)}
        ]
        if lost:
            who, what, kinds = (dict.fromkeys(it) for it in zip(*lost, strict=True))
            images = [topic for kind in OF_CAMERAS[:2] for topic in offered.get(kind, ())]
            has = f"its cameras send {shorten(images)}" if images else _NONE
            hint = _HEAR if any(offered.get(it) for it in kinds) else _TAKE
            waits = f"nothing sends {', '.join(what)} to {', '.join(who)} of {robot.spec.name!r}"
            yield at_robot(NO_CAMERA, robot, f"{waits}: {has}", hint)


_NONE = "its description has no camera"
_TAKE = "take a description with a camera that does, or leave the node set out"
_HEAR = (
    "name one in `remaps` of a node set of your own (docs/node-sets.md), or leave the node set out"
)


NOTHING_MOVES = declare("MF865", "commands-without-reader", WARNING, formats=("fleet",))
_SENSED = ("sensor_msgs/msg/", "nav_msgs/msg/Odometry")
# A robot without moving joints has nobody who sends them.
_JOINTS = "sensor_msgs/msg/JointState"
_HINT = "start what does in its launch file, or write which name is meant as a remap rule there"


def unmoved(robot: RewrittenRobot, facts: Sequence[NodeFacts], system: System) -> Iterator[Finding]:
    """Yield what is open in a robot that is completely known, by its own ``system``."""
    # Another robot may have a driver that no file names.
    # Is all known that it runs, some of it by its source?
    known = all(it.is_known and not it.untold for it in facts)
    by_source = any(" " in it.kind for it in facts)
    parts = active_parts(robot.member.source.root, robot.member.definitions)
    if not (known and by_source and all(it.is_known for it in parts)):
        return
    read = {it.name for it in system.ends if it.role == SUBSCRIBES}
    sent = {it.name for it in system.ends if it.role == PUBLISHES}
    published = (it for it in system.ends if it.role == PUBLISHES and it.sure == RUNS)
    moving = (it for it in published if moves(it.code_name or it.name, it.type))
    orders = [it for it in moving if it.name not in read]
    needed = (it for it in system.ends if it.role == SUBSCRIBES and is_needed(it))
    sensed = (it for it in needed if it.type.startswith(_SENSED) and it.type != _JOINTS)
    asked = [it for it in sensed if it.name not in sent]
    said = [f"nothing reads {_names_with_nodes(orders)}"] if orders else []
    said += [f"nothing sends {_names_with_nodes(asked)}"] if asked else []
    if said:
        who = f"robot {robot.spec.name!r}: all that it runs is known, and"
        yield at_robot(NOTHING_MOVES, robot, f"{who} {' and '.join(said)}", _HINT)


def _names_with_nodes(ends: Iterable[End]) -> str:
    """Return the names in the code, each with its node, for a message."""
    each = (f"{it.code_name or it.name} of {it.node.rpartition('/')[2]}" for it in ends)
    return shorten(dict.fromkeys(each))
