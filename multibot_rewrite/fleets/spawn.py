"""How the robots of a fleet come into Gazebo: arguments of the two spawners.

Sources: ros_gz jazzy ``ros_gz_sim/src/create.cpp``; gazebo_ros_pkgs ros2 ``spawn_entity.py`` and
``gazebo_ros_factory.cpp``.
"""

from __future__ import annotations

import shlex
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.companions.names.robot_topics import NOTHING, fleet_topics, robot_topic
from multibot_rewrite.fleets.fleet_file import Pose
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.model import WARNING, Finding
from multibot_rewrite.naming import NAMESPACE

GZ, CLASSIC = ("ros_gz_sim", "create"), ("gazebo_ros", "spawn_entity.py")
FLAGS = {"x": "-x", "y": "-y", "z": "-z", "roll": "-R", "pitch": "-P", "yaw": "-Y"}
DESCRIPTION = "/robot_description"
# What a plugin of Gazebo Classic that is a ROS node is called.
CLASSIC_PLUGIN = "libgazebo_ros"


class Spawn(NamedTuple):
    """A robot to be spawned. ``namespace`` is what Gazebo Classic has to put it in, empty where its
    description says so itself: the spawner would overwrite what stands in each plugin."""

    robot: str
    model: str
    topic: str
    pose: Pose
    namespace: str


def spawns(plan: FleetPlan) -> tuple[tuple[Spawn, ...], tuple[Finding, ...]]:
    """How each robot is spawned, and what stands in the way of a namespace from the spawner."""
    made, findings = [], []
    for robot in plan.robots:
        known = fleet_topics(plan.fleet.table, plan.fleet.facts, robot.spec.namespace)
        made.append(spawn(robot, known.get(DESCRIPTION, "")))
        told, untold = _namespaces(robot)
        if told and untold:
            findings.append(_half(robot, untold))
    return tuple(made), tuple(findings)


def spawn(robot: RewrittenRobot, topic: str = "") -> Spawn:
    """How one robot is spawned; ``topic`` is where its description is, if another than usual."""
    spec = robot.spec
    told, untold = _namespaces(robot)
    needed = robot.topics.naming.topics == NAMESPACE and untold and not told
    return Spawn(
        spec.namespace,
        spec.model,
        topic or robot_topic(robot.topics, DESCRIPTION, NOTHING),
        spec.pose or Pose(),
        spec.namespace if needed else "",
    )


def gz_arguments(it: Spawn) -> list[str]:
    """What follows ``ros_gz_sim create``.

    Its flags are those of gflags, where ``-allow_renaming false`` would be true: a word of its own
    is no value of a flag that is on or off.
    """
    return ["-name", it.model, "-topic", it.topic, *_pose(it.pose), "-allow_renaming=false"]


def classic_arguments(it: Spawn) -> list[str]:
    """What follows ``gazebo_ros spawn_entity.py``."""
    namespace = ["-robot_namespace", f"/{it.namespace}"] if it.namespace else []
    return ["-entity", it.model, "-topic", it.topic, *_pose(it.pose), *namespace]


def gz_command(it: Spawn) -> str:
    """The line that spawns a robot in gz-sim."""
    return shlex.join(["ros2", "run", *GZ, *gz_arguments(it)])


def classic_command(it: Spawn) -> str:
    """The line that spawns a robot in Gazebo Classic."""
    return shlex.join(["ros2", "run", *CLASSIC, *classic_arguments(it)])


def either(it: Spawn, robot: RewrittenRobot) -> str:
    """The line for the simulator that the description is written for, the other one as a comment."""
    gz, classic = gz_command(it), classic_command(it)
    if CLASSIC_PLUGIN.encode() in robot.description:
        return f"{classic}\n# gz-sim: {gz}\n"
    return f"{gz}\n# Gazebo Classic: {classic}\n"


def _pose(pose: Pose) -> list[str]:
    values = pose._asdict()
    return [word for key, flag in FLAGS.items() for word in (flag, str(values[key]))]


def _namespaces(robot: RewrittenRobot) -> tuple[list[str], list[str]]:
    """The Gazebo Classic plugins of a description: those with a namespace, those without."""
    told: list[str] = []
    untold: list[str] = []
    for plugin in robot.member.inventory.document.root.iter("plugin"):
        if CLASSIC_PLUGIN in (plugin.get("filename") or ""):
            (told if _namespace(plugin) else untold).append(plugin.get("name") or "")
    return told, untold


def _namespace(plugin: etree._Element) -> str:
    # Without a <ros> the plugin itself is read (gazebo_ros node.cpp).
    return (plugin.findtext("ros/namespace") or plugin.findtext("namespace") or "").strip()


def _half(robot: RewrittenRobot, untold: list[str]) -> Finding:
    spec = robot.spec
    message = f"robot {spec.name!r}: plugins without a namespace beside others: {', '.join(untold)}"
    hint = "-robot_namespace would overwrite the others' too; write <ros><namespace> in each"
    return Finding("MF706", WARNING, message, hint, spec.file, spec.line, 1)
