# SPDX-License-Identifier: Apache-2.0
"""Spawning the robots of a fleet in Gazebo: arguments of the two spawners.

Sources: ros_gz jazzy ``ros_gz_sim/src/create.cpp``; gazebo_ros_pkgs ros2 ``spawn_entity.py`` and
``gazebo_ros_factory.cpp``.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import expanded_name, path_for
from multibot_rewrite.fleet.robots.rewritten_robots import CLASSIC_PLUGIN, RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.simulators import (
    is_simulated,
    lookups_of_model,
    without_mass,
)
from multibot_rewrite.planning.start import File, Start, shell_line
from multibot_rewrite.producers.launch.programs import program_of, programs
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.related_files.names.node_topics import NOTHING, fleet_topics, robot_topic
from multibot_rewrite.system.records import PUBLISHES

GZ, CLASSIC = ("ros_gz_sim", "create"), ("gazebo_ros", "spawn_entity.py")
FLAGS = {"x": "-x", "y": "-y", "z": "-z", "roll": "-R", "pitch": "-P", "yaw": "-Y"}
# Options that a launch file may have besides.
_FURTHER = ("-timeout", "-spawn_service_timeout", "-package_to_model", "-world")
DESCRIPTION = "/robot_description"


class Spawn(NamedTuple):
    """A robot to be spawned from a topic, a file or its text.

    ``namespace`` is for the spawner of Gazebo Classic; it is empty if the
    plugins of the description have one, which the spawner would overwrite. ``further`` are options of
    its launch file."""

    robot: str
    model: str
    topic: str
    pose: Pose
    namespace: str
    file: str = ""
    text: str = ""
    further: tuple[str, ...] = ()

    @property
    def source(self) -> tuple[str, str | File]:
        """The option that says what is spawned; only that of gz-sim takes a text."""
        if self.text:
            return "-string", self.text
        return ("-file", File(self.file)) if self.file else ("-topic", self.topic)


def spawns(plan: FleetPlan) -> tuple[tuple[Spawn, ...], tuple[Finding, ...]]:
    """Return how each robot is spawned, and findings on its plugins and mass."""
    made: list[Spawn] = []
    findings: list[Finding] = []
    for robot in plan.robots:
        known = fleet_topics(plan.fleet.table, plan.fleet.facts, robot.spec.namespace)
        own = plan.evidence_of(robot).placing
        pairs = pairwise(own.arguments if own else ())
        further = tuple(word for it in pairs if it[0] in _FURTHER for word in it)
        made.append(spawn(robot, known.get(DESCRIPTION, ""))._replace(further=further))
        named, bare = _namespaces(robot)
        # Where names have a postfix, a plugin needs no namespace.
        if named and bare and robot.topics.naming.topics == NAMESPACE:
            some = f"robot {robot.spec.name!r}: some plugins have a namespace"
            hint = "add <ros><namespace> to these; -robot_namespace would overwrite the others"
            message = f"{some}, but not {', '.join(bare)}"
            findings.append(at_robot(PARTLY_NAMESPACED, robot, message, hint))
        findings += _other_models(robot)
        findings += _ros_1_plugins(robot)
        findings += without_mass(robot)
    return tuple(made), tuple(findings)


def in_folder(plan: FleetPlan) -> tuple[Spawn, ...]:
    """Return how robots are spawned from a built folder: by file if no node publishes it."""
    sent = {name for _, end, name in plan.fleet.table.ends if end.role == PUBLISHES}
    made, _ = spawns(plan)
    found = []
    for it, robot in zip(made, plan.robots, strict=True):
        is_sdf = robot.member.inventory.document.root.tag == "sdf"
        has_source = it.file or (it.topic in sent and not is_sdf)
        path = path_for(robot, expanded_name(robot.spec.description))
        found.append(it if has_source else it._replace(file=path))
    return tuple(found)


def simulators(plan: FleetPlan) -> list[str]:
    """Return the simulators of the robots: ``classic``, ``gz``, none."""
    return sorted({"classic" if it.is_classic else "gz" for it in plan.robots if is_simulated(it)})


def spawn(robot: RewrittenRobot, topic: str = "") -> Spawn:
    """Return how one robot is spawned; ``topic`` is that of its description if not the usual one."""
    spec = robot.spec
    named, bare = _namespaces(robot)
    needed = robot.topics.naming.topics == NAMESPACE and bare and not named
    return Spawn(
        spec.namespace,
        spec.model,
        topic or robot_topic(robot.topics, DESCRIPTION, NOTHING),
        spec.pose or Pose(),
        spec.namespace if needed else "",
        path_for(robot, expanded_name(spec.simulated)) if spec.simulated else "",
    )


def spawner(it: Spawn, classic: bool) -> Start:
    """Return the process that spawns a robot in Gazebo Classic or gz-sim."""
    # gflags reads ``-allow_renaming false`` as true: a flag takes its value after an equals sign.
    program, named = (CLASSIC, "-entity") if classic else (GZ, "-name")
    last = ["-robot_namespace", f"/{it.namespace}"] if it.namespace else []
    more = last if classic else ["-allow_renaming=false"]
    values = it.pose._asdict()
    pose = (word for key, flag in FLAGS.items() for word in (flag, str(values[key])))
    return Start(*program, arguments=(named, it.model, *it.source, *pose, *more, *it.further))


def command_of(it: Spawn, robot: RewrittenRobot) -> str:
    """Return the command for the description's simulator, with the other simulator's as a comment."""
    gz, classic = (shell_line(spawner(it, classic)) for classic in (False, True))
    if robot.is_classic:
        return f"{classic}\n# gz-sim: {gz}\n"
    return f"{gz}\n# Gazebo Classic: {classic}\n"


def is_of_vendor(own: LaunchedNode | None) -> bool:
    """Return whether an unknown program puts the robot into its simulator."""
    return own is not None and program_of(own) not in programs().spawners


def placed_at(words: Sequence[str | File], spec: RobotSpec) -> Iterator[str | File]:
    """Yield the arguments of a spawner with a robot's pose and model name, where they have them."""
    values = spec.pose._asdict() if spec.pose else {}
    own = {flag.lstrip("-"): str(values[key]) for key, flag in FLAGS.items() if values}
    own |= {key: str(it) for key, it in values.items()}
    own |= dict.fromkeys(("entity", "name", "model_name", "robot_name"), spec.model)
    before = ""
    for word in words:
        yield own.get(before.lstrip("-").replace("-", "_"), word) if before[:1] == "-" else word
        before = word if isinstance(word, str) else ""


def _namespaces(robot: RewrittenRobot) -> tuple[list[str], list[str]]:
    """Return the Gazebo Classic plugins of a description: those with a namespace, those without."""
    named: list[str] = []
    bare: list[str] = []
    for plugin in robot.member.inventory.document.root.iter("plugin"):
        if CLASSIC_PLUGIN.decode() in (plugin.get("filename") or ""):
            # Without <ros> gazebo_ros reads the plugin element itself (node.cpp).
            ros = plugin.find("ros")
            space = text_at(plugin if ros is None else ros, "namespace")
            (named if space else bare).append(plugin.get("name") or "")
    return named, bare


PARTLY_NAMESPACED = declare("MF706", "plugins-partly-namespaced", WARNING, formats=("fleet",))


MODEL_OF_OTHER_NAME = declare("MF707", "model-of-other-name", WARNING, formats=("fleet",))


PLUGIN_OF_ROS_1 = declare("MF713", "plugin-of-ros-1", WARNING, formats=("fleet",))


def _ros_1_plugins(robot: RewrittenRobot) -> Iterator[Finding]:
    """Yield a finding for each plugin without a definition for ROS 2."""
    of_ros_1 = (it for it in robot.member.inventory.served if it[1].type == "plugin")
    names = (host.get("filename") or it.names[0] for host, it in of_ros_1 if it.ros == "1")
    for name in dict.fromkeys(names):
        message = f"robot {robot.spec.name!r}: plugin {name} is of ROS 1: it is not loaded"
        hint = "put the plugin of ROS 2 in its place, or delete it"
        yield at_robot(PLUGIN_OF_ROS_1, robot, message, hint)


def _other_models(robot: RewrittenRobot) -> Iterator[Finding]:
    """Yield the first plugin that names the robot's model otherwise than it is spawned."""
    own = robot.member.inventory.model
    for claim in lookups_of_model(robot) if own != robot.spec.model else ():
        who = f"robot {robot.spec.name!r} is spawned as {robot.spec.model!r}"
        message = f"{who}, <{claim.element.tag}> looks for the model {own!r}"
        hint = f"write model: {own} for it, or leave model: out"
        yield at_robot(MODEL_OF_OTHER_NAME, robot, message, hint)
        return
