"""Launch files with a fleet file: substitutions, and actions for each of its robots.

``load_fleet`` serves any launch script and needs no launch. What is here is for values that are known
only while a launch file runs, as those of LaunchConfiguration are; XML and YAML launch files get it
by ``launch.frontend``. The only module that imports launch and launch_ros, where they are needed.

A robot or a fleet that is not given is that of the group around it (``each_robot``). Files that nodes
read are in a folder that goes with the launch. Source: launch, launch_ros jazzy.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.fleets import spawn as spawning
from multibot_rewrite.fleets.fleet_file import Pose
from multibot_rewrite.fleets.scripts import LoadedFleet, LoadedRobot, load_fleet
from multibot_rewrite.model import Finding, UsageError
from multibot_rewrite.remap.yaml_with_lines import unknown

# What launch calls SomeSubstitutionsType: a string, a substitution, or several of both.
Text = Any
Action = Any
Context = Any
Substitution = Any
Make = Callable[[LoadedRobot], Iterable[Action]]
# The launch configurations that hold the fleet and the robot of a group.
FLEET, ROBOT = "multibot_fleet", "multibot_robot"
# What a launch keeps: its fleets by path, its folder, the warnings that it has given.
_FLEETS, _FOLDER, _TOLD = "multibot_fleets", "multibot_folder", "multibot_told"
FILE = "file"
SPAWNERS = MappingProxyType({"gz": spawning.GZ, "classic": spawning.CLASSIC})
PLACER = ("tf2_ros", "static_transform_publisher")
# Characters that JSON may hold as they are, and YAML may not.
_ESCAPED = {code: f"\\u{code:04x}" for code in (*range(0x7F, 0xA0), 0x2028, 0x2029, 0xFEFF)}
# Parameters that no file of the fleet holds.
_OWN = "multibot.yaml"


class RobotRef(NamedTuple):
    """Which robot of which fleet; None is that of the group around it."""

    robot: Text = None
    fleet: Text = None


HERE = RobotRef()


def missing() -> str:
    """Why launch cannot be imported, or an empty string."""
    try:
        from launch.frontend import expose_action  # noqa: F401
    except ImportError as error:
        return f"{type(error).__name__}: {error}"
    return ""


def fleet_of(context: Context, fleet: Text = None) -> LoadedFleet:
    """The fleet of a file, in a function of OpaqueFunction; a launch loads each file once.

    ``fleet`` may hold substitutions. Warnings go to launch's log. Raises as ``load_fleet``.
    """
    path = _scoped(context, FLEET, "fleet") if fleet is None else perform(context, fleet)
    known: dict[str, LoadedFleet] = _of_launch(context, _FLEETS, dict)
    if path not in known:
        known[path] = load_fleet(path)
        _warn(context, known[path].findings)
    return known[path]


def robot_of(context: Context, of: RobotRef = HERE) -> LoadedRobot:
    """A robot; raises as ``fleet_of``, and UsageError for one that is not there."""
    name = _scoped(context, ROBOT, "robot") if of.robot is None else perform(context, of.robot)
    return fleet_of(context, of.fleet).robot(name)


def file_of(context: Context, file: str, of: RobotRef = HERE) -> str:
    """Write a file of the fleet into the folder of this launch; returns its path.

    It is the robot's own, or the one for all robots where there is no robot.
    """
    fleet = fleet_of(context, of.fleet)
    robot = None if _nobody(context, of) else robot_of(context, of)
    text = robot.text(file) if robot else fleet.text(file)
    _warn(context, fleet.made.findings)
    return _written(context, robot, file, text)


def perform(context: Context, text: Text) -> str:
    """What a text with substitutions is in this context."""
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

    return str(perform_substitutions(context, normalize_to_list_of_substitutions(text)))


def description(robot: Text = None, fleet: Text = None) -> Substitution:
    """A robot's rewritten description."""
    return value("description", robot=robot, fleet=fleet)


def params_file(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """The path of a robot's parameter file, rewritten: an item of ``parameters=[...]``."""
    return value(FILE, file, robot, fleet)


def rviz_config(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """The path of a robot's RViz config, or of the one that shows all."""
    return value(FILE, file, robot, fleet)


def bridge_config(robot: Text = None, fleet: Text = None) -> Substitution:
    """The path of a robot's file for ros_gz_bridge, or of what one bridge carries for all."""
    return value(FILE, "bridge.yaml", robot, fleet)


def value(word: Text, name: Text = "", robot: Text = None, fleet: Text = None) -> Substitution:
    """What ``$(multibot WORD NAME)`` is: one of ``WORDS`` about a robot, or the path of a file."""
    return substitution()([word, name], RobotRef(robot, fleet))


def each_robot(fleet: Text, make: Make, robots: Text = "", **action: Any) -> Action:
    """An action that does what ``make`` returns for every robot, each robot in a group of its own.

    ``robots`` are names, with commas between, where only some are wanted; ``action`` is what any
    action takes, such as a condition.

        each_robot(LaunchConfiguration("fleet"), lambda robot: [Node(..., **robot.node("amcl"))])
    """

    def groups(context: Context) -> list[Action]:
        loaded = fleet_of(context, fleet)
        names = _listed(context, robots)
        chosen = [loaded.robot(name) for name in names] if names else loaded.robots
        return [_group(loaded, robot, make(robot)) for robot in chosen]

    return _later(groups, action)


def node(
    name: Text,
    *,
    files: Text = "",
    robot: Text = None,
    fleet: Text = None,
    describe: bool = False,
    condition: Any = None,
    **options: Any,
) -> Action:
    """A node of a robot's stacks: launch_ros's Node with its name, namespace, rules and parameters.

    ``name`` is the node's in the stack; ``files`` are parameter files of the fleet, a list or with
    commas between; ``describe`` gives it the description. ``options`` are Node's own: its
    remappings come first and its parameters last, where they win.
    """
    of = RobotRef(robot, fleet)

    def started(context: Context) -> list[Action]:
        its, called = robot_of(context, of), perform(context, name)
        paths = [file_of(context, it, of) for it in _listed(context, files)]
        own = _own_file(context, its, called, describe)
        return [_node(its, called, [*paths, *own], options)]

    return _later(started, {"condition": condition})


def spawn(simulator: Text, robot: Text = None, fleet: Text = None, **action: Any) -> Action:
    """A robot's spawner: ``gz`` for ros_gz_sim, ``classic`` for gazebo_ros."""

    def started(context: Context) -> list[Action]:
        called = perform(context, simulator)
        if called not in SPAWNERS:
            raise UsageError(unknown("simulator", called, SPAWNERS))
        its = robot_of(context, RobotRef(robot, fleet))
        arguments = its.spawn_arguments if called == "gz" else its.classic_arguments
        return [_program(SPAWNERS[called], arguments)]

    return _later(started, action)


def place(robot: Text = None, fleet: Text = None, **action: Any) -> Action:
    """The static transform of a robot's pose, where one is needed."""

    def started(context: Context) -> list[Action]:
        arguments = robot_of(context, RobotRef(robot, fleet)).transform_arguments
        return [_program(PLACER, arguments)] if arguments else []

    return _later(started, action)


@cache
def substitution() -> Any:
    """The class of the substitutions here."""
    from launch import Substitution as Base

    class Multibot(Base):  # type: ignore[misc]
        """Words about a robot, known when the launch file runs."""

        def __init__(self, words: Sequence[Text], of: RobotRef) -> None:
            super().__init__()
            self.words, self.of = words, of

        def perform(self, context: Context) -> str:
            return _said(context, [perform(context, it) for it in self.words], self.of)

    return Multibot


def node_class() -> Any:
    """launch_ros's Node."""
    from launch_ros.actions import Node

    return Node


def action_options(entity: Any, parser: Any) -> dict[str, Any]:
    """What every action takes from an XML or YAML launch file: its condition."""
    from launch import Action as Base

    options: dict[str, Any] = Base.parse(entity, parser)[1]
    return options


def expose(substitutions: Mapping[str, Any], actions: Mapping[str, Any]) -> None:
    """Make parsing functions known to the launch files of every frontend."""
    from launch.frontend import expose_action, expose_substitution

    for name, parse in substitutions.items():
        expose_substitution(name)(parse)
    for name, parse in actions.items():
        expose_action(name)(parse)


def _node(robot: LoadedRobot, name: str, files: list[str], options: Mapping[str, Any]) -> Action:
    """Node's own remappings and parameters are where they win: rcl takes the first rule that matches,
    and the last value."""
    given = {
        "name": robot.table.name(name),
        "namespace": robot.table.namespace(name),
        "remappings": [*(options.get("remappings") or ()), *robot.table.for_node(name)],
        "parameters": [*files, *(options.get("parameters") or ())],
    }
    return node_class()(**{**options, **given})


def _program(found: tuple[str, str], arguments: list[str]) -> Action:
    package, executable = found
    return node_class()(package=package, executable=executable, arguments=arguments)


def _own_file(context: Context, robot: LoadedRobot, node: str, describe: bool) -> list[str]:
    """The path of a file with the node's description and start, where it has one."""
    values = robot.start_parameters(node)
    if describe:
        values["robot_description"] = robot.description
    if not values:
        return []
    # JSON is YAML to rcl, and its strings are never taken for something else.
    data = {robot.table.full_name(node): {"ros__parameters": values}}
    text = json.dumps(data, ensure_ascii=False).translate(_ESCAPED)
    return [_written(context, robot, f"{node.replace('/', '_')}.{_OWN}", text)]


def _group(fleet: LoadedFleet, robot: LoadedRobot, actions: Iterable[Action]) -> Action:
    from launch.actions import GroupAction, SetLaunchConfiguration

    here = {FLEET: fleet.file, ROBOT: robot.name}
    sets = [SetLaunchConfiguration(key, text) for key, text in here.items()]
    return GroupAction([*sets, *actions])


def _later(function: Callable[[Context], list[Action]], action: Mapping[str, Any]) -> Action:
    from launch.actions import OpaqueFunction

    return OpaqueFunction(function=function, **action)


def _said(context: Context, words: Sequence[str], of: RobotRef) -> str:
    options = [it for it in words if it.partition(":=")[0] in RobotRef._fields and ":=" in it]
    of = of._replace(**dict(it.split(":=", 1) for it in options))
    word, name = (*(it for it in words if it not in options), "", "")[:2]
    if word == FILE:
        return file_of(context, name, of)
    if word not in WORDS:
        raise UsageError(f"$(multibot {word}): {unknown('word', word, (*WORDS, FILE))}")
    return WORDS[word](robot_of(context, of), name)


def _pose(robot: LoadedRobot, axis: str) -> str:
    values = (robot.pose or Pose())._asdict()
    if axis not in values:
        raise UsageError(f"$(multibot pose {axis}): {unknown('axis', axis, values)}")
    return str(values[axis])


WORDS: Mapping[str, Callable[[LoadedRobot, str], str]] = MappingProxyType(
    {
        "name": lambda robot, _: robot.name,
        "namespace": lambda robot, _: robot.namespace,
        "model": lambda robot, _: robot.model,
        "pose": _pose,
        "description": lambda robot, _: robot.description,
        "srdf": lambda robot, _: robot.srdf,
        "frame": LoadedRobot.frame,
        "joint": LoadedRobot.joint,
        "topic": LoadedRobot.topic,
        "node": lambda robot, name: robot.table.full_name(name),
    }
)


def _listed(context: Context, names: Text) -> list[str]:
    """Names with commas between, or a list of them; of a list with substitutions launch makes one
    text."""
    several = not isinstance(names, str) and isinstance(names, Sequence)
    if several and all(isinstance(it, str) for it in names):
        return list(names)
    return [it for it in map(str.strip, perform(context, names).split(",")) if it]


def _nobody(context: Context, of: RobotRef) -> bool:
    return of.robot is None and ROBOT not in context.launch_configurations


def _scoped(context: Context, key: str, what: str) -> str:
    if key not in context.launch_configurations:
        hint = f"give it {what}, or put it into multibot_robots or each_robot"
        raise UsageError(f"it is not said which {what} is meant; {hint}")
    return str(context.launch_configurations[key])


def _of_launch(context: Context, key: str, make: Callable[[], Any]) -> Any:
    """What a launch keeps under ``key`` as long as it runs."""
    known = context.get_locals_as_dict()
    if key not in known:
        context.extend_globals({key: make()})
    return context.get_locals_as_dict()[key]


def _written(context: Context, robot: LoadedRobot | None, file: str, text: str) -> str:
    folder = _of_launch(context, _FOLDER, lambda: _folder(context))
    path = os.path.join(folder.name, robot.name if robot else "all", os.path.basename(file))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as out:
        out.write(text.encode())
    return path


def _folder(context: Context) -> TemporaryDirectory[str]:
    """A folder that is removed at the shutdown of a launch, or with its context if that never comes."""
    from launch.event_handlers import OnShutdown

    folder = TemporaryDirectory(prefix="multibot_launch_")
    gone = OnShutdown(on_shutdown=lambda event, context: folder.cleanup())
    context.register_event_handler(gone)
    return folder


def _warn(context: Context, findings: Iterable[Finding]) -> None:
    from launch.logging import get_logger

    told: set[Finding] = _of_launch(context, _TOLD, set)
    for finding in findings:
        if finding not in told:
            told.add(finding)
            get_logger("multibot").warning(str(finding))
