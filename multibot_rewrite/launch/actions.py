# SPDX-License-Identifier: Apache-2.0
"""Actions for robots of a fleet: subclasses of those of launch_ros, with all options of these."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.companions.params.rcl_parameters import parameters_text
from multibot_rewrite.fleet.outputs import spawn as spawning
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.fleet.scripts import LoadedFleet
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.launch import later
from multibot_rewrite.launch.context import (
    FLEET,
    ROBOT,
    ROBOTS,
    SIM_TIME,
    Action,
    Context,
    RobotRef,
    Text,
    fleet_of,
    listed,
    made_for,
    node_file_of,
    perform,
    reference,
    robot_of,
    sim_time,
    written,
)
from multibot_rewrite.launch.node_options import check_options, node_options
from multibot_rewrite.launch.node_options import listed as option_list
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros

Make = Callable[[LoadedRobot], Iterable[Action]]
SPAWNERS = MappingProxyType({"gz": spawning.GZ, "classic": spawning.CLASSIC})
PLACER = ("tf2_ros", "static_transform_publisher")
# The file of a node's description, start pose and clock.
_OWN = "multibot.yaml"


def each_robot(fleet: Text, make: Make, robots: Text = "", **action: Any) -> Action:
    """An action that runs what ``make`` returns for every robot, each robot in its own group.

    ``robots`` are some robots' names, with commas, or robots in place of those of the file with their
    poses, as Nav2 writes them (``robot1={x: 1.0}; robot2={}``); ``action`` are options such as a
    condition.

        each_robot(LaunchConfiguration("fleet"), lambda robot: [Node(..., **robot.node("amcl"))])
    """

    def groups(context: Context) -> list[Action]:
        names = listed(context, robots)
        if "=" in (text := ",".join(names)):
            context.launch_configurations[ROBOTS], names = text, []
        loaded = fleet_of(context, fleet)
        chosen = [loaded.robot(name) for name in names] if names else loaded.robots
        return [_group(context, loaded, robot, make) for robot in chosen]

    return of_launch("actions").OpaqueFunction(function=groups, **action)


def node(name: Text, **options: Any) -> Action:
    """A node of a robot's stacks: launch_ros's Node with its names, remappings and parameters.

    For a controller it is that of its spawner, with its parameter files as ``-p``; a component is
    loaded into its container.
    ``name`` is its name in the stack; ``files`` are parameter files of the fleet, with commas or as
    a list; ``describe`` adds ``robot_description``; ``robot`` and ``fleet`` say whose it is,
    ``use_sim_time`` which clock it has. All others are Node's own, and override. Raises
    UsageError for a name or a namespace, which the fleet has.
    """
    return _node(node_class(), name, options)


def lifecycle_node(name: Text, **options: Any) -> Action:
    """The same as launch_ros's LifecycleNode, for events that change its state."""
    return _node(of_launch_ros("actions").LifecycleNode, name, options)


def container(name: Text, **options: Any) -> Action:
    """The same as launch_ros's ComposableNodeContainer.

    It takes the rules and parameter files of all nodes in its process, also of those that its
    components make, such as costmaps: give it the files of its components, too.
    """
    return _node(of_launch_ros("actions").ComposableNodeContainer, name, options)


def composable_node(name: Text, **options: Any) -> Any:
    """A component: launch_ros's ComposableNode, for containers and LoadComposableNodes."""
    own, first = _taken("composable_node", options)

    def made(context: Context) -> dict[str, Any]:
        return _made(context, perform(context, name), own, first)

    return later.component(of_launch_ros("descriptions").ComposableNode, made, first)


def spawn(simulator: Text, robot: Text = None, fleet: Text = None, **options: Any) -> Action:
    """A robot's spawner: ``gz`` for ros_gz_sim, ``classic`` for gazebo_ros; ``options`` of Node."""

    of = reference(robot, fleet)

    def program(context: Context) -> tuple[tuple[str, str], list[str]]:
        called = perform(context, simulator)
        if called not in SPAWNERS:
            raise UsageError(unknown("simulator", called, SPAWNERS))
        its = robot_of(context, of)
        return SPAWNERS[called], its.spawn_arguments if called == "gz" else its.classic_arguments

    return _program(program, of, options)


def place(robot: Text = None, fleet: Text = None, **options: Any) -> Action:
    """The static transform of a robot's start pose, if one is needed; ``options`` of Node."""
    check_options("place", options)
    of = reference(robot, fleet)

    def program(context: Context) -> tuple[tuple[str, str], list[str]]:
        return PLACER, robot_of(context, of).transform_arguments

    return _program(program, of, options)


def node_class() -> Any:
    """launch_ros's Node."""
    return of_launch_ros("actions").Node


def _node(base: Any, name: Text, options: Mapping[str, Any]) -> Action:
    """An action of the class ``base`` for a node of a stack."""
    own, first = _taken("node", options)

    def made(context: Context) -> later.Made:
        called = perform(context, name)
        given = _made(context, called, own, first)
        box = robot_of(context, own["of"]).table.container(called)
        return _loaded(box, given, first) if box else given

    known = {key: it for key, it in first.items() if key != "plugin"}
    placeholders = {} if base is node_class() else {"name": "later", "namespace": ""}
    return later.action(base, made, {"executable": "later", **placeholders, **known})


def _taken(word: str, options: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The options that are ours, and launch_ros's."""
    check_options(word, options)
    rest = dict(options)
    own = {key: rest.pop(key, None) for key in ("files", "describe", SIM_TIME)}
    own["of"] = reference(rest.pop("robot", None), rest.pop("fleet", None))
    return own, rest


def _made(
    context: Context, name: str, own: Mapping[str, Any], options: Mapping[str, Any]
) -> dict[str, Any]:
    """The options with those of the node in this launch."""
    its = robot_of(context, own["of"])
    paths = [node_file_of(context, it, own["of"]) for it in listed(context, own["files"] or "")]
    clock = sim_time(context, its, own[SIM_TIME])
    if its.table.is_controller(name):
        return node_options(its, name, paths, options)
    also = _own_file(context, its, name, bool(own["describe"]), clock)
    return node_options(its, name, [*paths, *also], options)


def _loaded(box: str, options: Mapping[str, Any], given: Mapping[str, Any]) -> list[Action]:
    """A component, loaded into the container that the robot runs; raises UsageError for a program."""
    if "executable" in given:
        name, stays = options["name"], "or take a stack in which it has a process of its own"
        raise UsageError(f"{name} is a component of {box}: write plugin= for executable=, {stays}")
    component = of_launch_ros("descriptions").ComposableNode(**{**options, "condition": None})
    loaded = {"composable_node_descriptions": [component]}
    return [of_launch_ros("actions").LoadComposableNodes(target_container=box, **loaded)]


def _program(
    find: Callable[[Context], tuple[tuple[str, str], list[str]]],
    of: RobotRef,
    options: Mapping[str, Any],
) -> Action:
    """A program with its arguments; without arguments nothing is started."""
    given = {key: it for key, it in options.items() if key != SIM_TIME}

    def made(context: Context) -> later.Made:
        (package, executable), arguments = find(context)
        if not arguments:
            return []
        words = [*arguments, *option_list(given, "arguments")]
        made = {**given, "package": package, "executable": executable, "arguments": words}
        clock = sim_time(context, robot_of(context, of), options.get(SIM_TIME))
        if clock is not None:
            made["parameters"] = [{SIM_TIME: clock}, *option_list(given, "parameters")]
        return made

    return later.action(node_class(), made, {"executable": "later", **given})


def _own_file(
    context: Context, robot: LoadedRobot, node: str, describe: bool, clock: bool | None
) -> list[str]:
    """The path of a file with the node's description, start pose and clock, if it needs one."""
    values = robot.start_parameters(node)
    if describe:
        values |= robot.description_parameters
    # Nodes that others make in their process have no values but those for all of it.
    clocks = {} if clock is None else {"/**": {SIM_TIME: clock}}
    sections = {**clocks, **({robot.table.full_name(node): values} if values else {})}
    name, text = node.replace("/", "_"), parameters_text(sections)
    return [written(context, robot, f"{name}.{_OWN}", text)] if sections else []


def _group(context: Context, fleet: LoadedFleet, robot: LoadedRobot, make: Make) -> Action:
    """What a robot runs; launch_ros gives the clock to nodes that are not ours."""
    known, here = of_launch("actions"), {FLEET: fleet.file, ROBOT: robot.name}
    sets = [known.SetLaunchConfiguration(key, text) for key, text in here.items()]
    clock = sim_time(context, robot, None)
    if clock is not None:
        sets.append(of_launch_ros("actions").SetParameter(SIM_TIME, clock))
    with made_for(RobotRef(robot.name, fleet.file)):
        return known.GroupAction([*sets, *make(robot)])
