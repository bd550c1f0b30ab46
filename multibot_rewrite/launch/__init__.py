"""Launch files with a fleet file: substitutions, and actions for each robot.

``load_fleet`` is enough for plain launch scripts and does not need launch. This room is for values that
are known only while a launch file runs, such as a LaunchConfiguration; ``launch.frontend`` offers it to
XML and YAML. launch and launch_ros come through ``launch.door``, when needed. A robot or fleet that is
not given is that of the enclosing group (``each_robot``). Files for nodes are in a folder that is
removed at the end of the launch. Source: launch, launch_ros jazzy.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.companions.params.rcl_parameters import parameters_text
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.fleets import spawn as spawning
from multibot_rewrite.fleets.scripts import LoadedFleet, LoadedRobot, load_fleet
from multibot_rewrite.launch.door import missing as missing
from multibot_rewrite.launch.door import of_launch, of_launch_ros
from multibot_rewrite.launch.node_options import node_options
from multibot_rewrite.launch.robot_words import WORDS
from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.yaml_with_lines import unknown

# launch's SomeSubstitutionsType: a string, a substitution, or several of both.
Text = Any
Action = Any
Context = Any
Substitution = Any
Make = Callable[[LoadedRobot], Iterable[Action]]
# Launch configurations: fleet and robot of a group; may xacro files do anything ("true")? the release.
FLEET, ROBOT, TRUST, DISTRO = (f"multibot_{it}" for it in ("fleet", "robot", "trust", "distro"))
# What a launch keeps: its fleets by path, its folder, the warnings that it has logged.
_FLEETS, _FOLDER, _LOGGED = "multibot_fleets", "multibot_folder", "multibot_logged"
FILE = "file"
SPAWNERS = MappingProxyType({"gz": spawning.GZ, "classic": spawning.CLASSIC})
PLACER = ("tf2_ros", "static_transform_publisher")
# The file of a node's description and start pose.
_OWN = "multibot.yaml"


class RobotRef(NamedTuple):
    """A robot of a fleet; None means that of the enclosing group."""

    robot: Text = None
    fleet: Text = None


HERE = RobotRef()


def fleet_of(context: Context, fleet: Text = None) -> LoadedFleet:
    """The fleet of a file, for a function of OpaqueFunction; a launch loads each file once.

    ``fleet`` may hold substitutions. The launch configurations ``multibot_trust:=true`` and
    ``multibot_distro`` are options of ``load_fleet``. Warnings go to launch's log. Raises as that.
    """
    path = _scoped(context, FLEET, "fleet") if fleet is None else perform(context, fleet)
    known: dict[str, LoadedFleet] = _of_launch(context, _FLEETS, dict)
    if path not in known:
        trust, distro = (str(context.launch_configurations.get(it, "")) for it in (TRUST, DISTRO))
        known[path] = load_fleet(path, trust=trust.lower() in ("true", "1"), distro=distro)
        _warn(context, known[path].findings)
    return known[path]


def robot_of(context: Context, of: RobotRef = HERE) -> LoadedRobot:
    """A robot; raises as ``fleet_of``, and UsageError for an unknown robot."""
    name = _scoped(context, ROBOT, "robot") if of.robot is None else perform(context, of.robot)
    return fleet_of(context, of.fleet).robot(name)


def file_of(context: Context, file: str, of: RobotRef = HERE) -> str:
    """Write a file of the fleet into the folder of this launch; returns its path.

    It is the robot's own file, or the one for all robots if no robot is given.
    """
    fleet = fleet_of(context, of.fleet)
    robot = None if _is_for_all(context, of) else robot_of(context, of)
    text = robot.text(file) if robot else fleet.text(file)
    _warn(context, fleet.made.findings)
    return _written(context, robot, file, text)


def perform(context: Context, text: Text) -> str:
    """The value of a text with substitutions in this context."""
    utilities = of_launch("utilities")
    parts = utilities.normalize_to_list_of_substitutions(text)
    return str(utilities.perform_substitutions(context, parts))


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
    """The path of a robot's ros_gz_bridge file, or of the one for all robots."""
    return value(FILE, "bridge.yaml", robot, fleet)


def value(word: Text, name: Text = "", robot: Text = None, fleet: Text = None) -> Substitution:
    """The substitution ``$(multibot WORD NAME)``: one of ``WORDS``, or the path of a file."""
    return substitution()([word, name], RobotRef(robot, fleet))


def each_robot(fleet: Text, make: Make, robots: Text = "", **action: Any) -> Action:
    """An action that runs what ``make`` returns for every robot, each robot in its own group.

    ``robots`` are some robots' names, with commas; ``action`` are options such as a condition.

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
    """A node of a robot's stacks: launch_ros's Node with its names, remappings and parameters.

    For a controller it is that of its spawner, with its parameter files as ``-p``.
    ``name`` is its name in the stack; ``files`` are parameter files of the fleet, with commas or as
    a list; ``describe`` adds ``robot_description``. ``options`` are Node's own, and override.
    """
    of = RobotRef(robot, fleet)

    def actions(context: Context) -> list[Action]:
        its, called = robot_of(context, of), perform(context, name)
        paths = [file_of(context, it, of) for it in _listed(context, files)]
        own = _own_file(context, its, called, describe)
        return [_node(its, called, [*paths, *own], options)]

    return _later(actions, {"condition": condition})


def spawn(simulator: Text, robot: Text = None, fleet: Text = None, **action: Any) -> Action:
    """A robot's spawner: ``gz`` for ros_gz_sim, ``classic`` for gazebo_ros."""

    def actions(context: Context) -> list[Action]:
        called = perform(context, simulator)
        if called not in SPAWNERS:
            raise UsageError(unknown("simulator", called, SPAWNERS))
        its = robot_of(context, RobotRef(robot, fleet))
        arguments = its.spawn_arguments if called == "gz" else its.classic_arguments
        return [_program(SPAWNERS[called], arguments)]

    return _later(actions, action)


def place(robot: Text = None, fleet: Text = None, **action: Any) -> Action:
    """The static transform of a robot's start pose, if one is needed."""

    def actions(context: Context) -> list[Action]:
        arguments = robot_of(context, RobotRef(robot, fleet)).transform_arguments
        return [_program(PLACER, arguments)] if arguments else []

    return _later(actions, action)


@cache
def substitution() -> Any:
    """The class of the substitutions of this room."""

    class Multibot(of_launch().Substitution):  # type: ignore[misc]
        """A value about a robot, known when the launch file runs."""

        def __init__(self, words: Sequence[Text], of: RobotRef) -> None:
            super().__init__()
            self.words, self.of = words, of

        def perform(self, context: Context) -> str:
            return _value_of(context, [perform(context, it) for it in self.words], self.of)

    return Multibot


def node_class() -> Any:
    """launch_ros's Node."""
    return of_launch_ros("actions").Node


def action_options(entity: Any, parser: Any) -> dict[str, Any]:
    """The options of every action in an XML or YAML launch file, such as its condition."""
    options: dict[str, Any] = of_launch().Action.parse(entity, parser)[1]
    return options


def expose(substitutions: Mapping[str, Any], actions: Mapping[str, Any]) -> None:
    """Register parsing functions for XML and YAML launch files."""
    frontend = of_launch("frontend")
    for name, parse in substitutions.items():
        frontend.expose_substitution(name)(parse)
    for name, parse in actions.items():
        frontend.expose_action(name)(parse)


def _node(robot: LoadedRobot, name: str, files: list[str], options: Mapping[str, Any]) -> Action:
    """The Node; a component is loaded into its container."""
    given, container = node_options(robot, name, files, options), robot.table.container(name)
    return _loaded(container, given) if container else node_class()(**given)


def _loaded(container: str, options: Mapping[str, Any]) -> Action:
    """A component, loaded into the container that the robot runs."""
    component = of_launch_ros("descriptions").ComposableNode(**options)
    loaded = {"composable_node_descriptions": [component]}
    return of_launch_ros("actions").LoadComposableNodes(target_container=container, **loaded)


def _program(found: tuple[str, str], arguments: list[str]) -> Action:
    return node_class()(package=found[0], executable=found[1], arguments=arguments)


def _own_file(context: Context, robot: LoadedRobot, node: str, describe: bool) -> list[str]:
    """The path of a file with the node's description and start pose, if it needs one."""
    values = robot.start_parameters(node)
    if describe:
        values["robot_description"] = robot.description
    if not values:
        return []
    name, text = node.replace("/", "_"), parameters_text(robot.table.full_name(node), values)
    return [_written(context, robot, f"{name}.{_OWN}", text)]


def _group(fleet: LoadedFleet, robot: LoadedRobot, actions: Iterable[Action]) -> Action:
    known, here = of_launch("actions"), {FLEET: fleet.file, ROBOT: robot.name}
    sets = [known.SetLaunchConfiguration(key, text) for key, text in here.items()]
    return known.GroupAction([*sets, *actions])


def _later(function: Callable[[Context], list[Action]], action: Mapping[str, Any]) -> Action:
    return of_launch("actions").OpaqueFunction(function=function, **action)


def _value_of(context: Context, words: Sequence[str], of: RobotRef) -> str:
    options = [it for it in words if it.partition(":=")[0] in RobotRef._fields and ":=" in it]
    of = of._replace(**dict(it.split(":=", 1) for it in options))
    word, name = (*(it for it in words if it not in options), "", "")[:2]
    if word == FILE:
        return file_of(context, name, of)
    if word not in WORDS:
        raise UsageError(f"$(multibot {word}): {unknown('word', word, (*WORDS, FILE))}")
    return WORDS[word](robot_of(context, of), name)


def _listed(context: Context, names: Text) -> list[str]:
    """Names separated by commas, or a list; launch joins a list with substitutions into one text."""
    several = not isinstance(names, str) and isinstance(names, Sequence)
    if several and all(isinstance(it, str) for it in names):
        return list(names)
    return [it for it in map(str.strip, perform(context, names).split(",")) if it]


def _is_for_all(context: Context, of: RobotRef) -> bool:
    return of.robot is None and ROBOT not in context.launch_configurations


def _scoped(context: Context, key: str, what: str) -> str:
    if key not in context.launch_configurations:
        hint = f"set {what}, or put it into multibot_robots or each_robot"
        raise UsageError(f"no {what} is given; {hint}")
    return str(context.launch_configurations[key])


def _of_launch(context: Context, key: str, make: Callable[[], Any]) -> Any:
    """The value that a launch keeps under ``key`` while it runs."""
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
    """A folder that is removed when the launch shuts down, or at the latest with its context."""
    folder = TemporaryDirectory(prefix="multibot_launch_")
    gone = of_launch("event_handlers").OnShutdown(
        on_shutdown=lambda event, context: folder.cleanup()
    )
    context.register_event_handler(gone)
    return folder


def _warn(context: Context, findings: Iterable[Finding]) -> None:
    logged: set[Finding] = _of_launch(context, _LOGGED, set)
    for finding in findings:
        if finding not in logged:
            logged.add(finding)
            of_launch("logging").get_logger("multibot").warning(str(finding))
