# SPDX-License-Identifier: Apache-2.0
"""Actions for robots of a fleet: subclasses of those of launch_ros, with all options of these."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.fleet.outputs import spawn as spawning
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.launch import later
from multibot_rewrite.launch.context import (
    ROBOTS,
    SIM_TIME,
    Action,
    Context,
    Here,
    RobotRef,
    Text,
    entered,
    fleet_of,
    here,
    listed,
    node_file_of,
    perform,
    robot_of,
    sim_time,
    written,
)
from multibot_rewrite.library.loaded_fleet import LoadedFleet
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.related_files.params.rcl_parameters import parameters_text

Make = Callable[[LoadedRobot], "Iterable[Action] | Action"]
SPAWNERS = MappingProxyType({"gz": spawning.GZ, "classic": spawning.CLASSIC})
PLACER = ("tf2_ros", "static_transform_publisher")
# The file of a node's description, start pose and clock.
_OWN = "multibot.yaml"
# The fleet decides these; a launch file that sets them would contradict it.
FROM_THE_FLEET = ("name", "namespace")


def each_robot(fleet: Text, make: Make, robots: Text = "", **action: Any) -> Action:
    """Return an action that runs the actions of ``make`` for every robot, each in its own group.

    ``robots`` are some robots' names, with commas, or robots in place of those of the file with their
    poses, as Nav2 writes them (``robot1={x: 1.0}; robot2={}``); ``action`` are options such as a
    condition.

        each_robot(LaunchConfiguration("fleet"), lambda robot: [Node(..., **robot.node("amcl"))])"""

    def groups(context: Context) -> list[Action]:
        """Return a group of actions for each chosen robot."""
        names = listed(context, robots)
        if "=" in (text := ",".join(names)):
            context.launch_configurations[ROBOTS], names = text, []
        loaded = fleet_of(context, fleet)
        chosen = [loaded.robot(name) for name in names] if names else loaded.robots
        return [_group(context, loaded, robot, make) for robot in chosen]

    return of_launch("actions").OpaqueFunction(function=groups, **action)


def node(name_in_set: Text = "", **options: Any) -> Action:
    """Return a node of a robot's node sets as launch_ros's Node, with all that the fleet says of it.

    For a controller it is that of its spawner, with its parameter files as ``-p``; a component is
    loaded into its container. ``name_in_set`` is its name in the node set; ``files`` are parameter
    files of the fleet, with commas or as a list; ``describe`` adds ``robot_description``; ``robot``
    and ``fleet`` say whose it is, ``use_sim_time`` which clock it has. All others are Node's own,
    and override. Raises UsageError for a name or a namespace, which the fleet has."""
    return _node("node", node_class(), name_in_set, options)


def lifecycle_node(name_in_set: Text = "", **options: Any) -> Action:
    """Return a node of a robot's node sets as a LifecycleNode, for events that change its state."""
    return _node("lifecycle_node", of_launch_ros("actions").LifecycleNode, name_in_set, options)


def container(name_in_set: Text = "", **options: Any) -> Action:
    """Return a container of a robot's node sets as launch_ros's ComposableNodeContainer.

    It takes the rules and parameter files of all nodes in its process, also of those that its
    components make, such as costmaps: give it the files of its components, too."""
    base = of_launch_ros("actions").ComposableNodeContainer
    return _node("container", base, name_in_set, options)


def composable_node(name_in_set: Text = "", **options: Any) -> Any:
    """Return a component: launch_ros's ComposableNode, for containers and LoadComposableNodes."""
    own, first = _split_options("composable_node", name_in_set, options)

    def made(context: Context) -> dict[str, Any]:
        """Return the keywords of the component in this launch."""
        name, its = perform(context, name_in_set), robot_of(context, own["of"])
        return _node_options(context, name, own, _with_program(its, name, first, component=True))

    placeholders = {"package": "later", "plugin": "later"}
    base = of_launch_ros("descriptions").ComposableNode
    return later.component(base, made, {**placeholders, **first})


def spawn(simulator: Text, robot: Text = None, fleet: Text = None, **options: Any) -> Action:
    """Return a robot's spawner: ``gz`` (ros_gz_sim), ``classic`` (gazebo_ros); ``options`` of Node."""
    of = RobotRef(robot, fleet)

    def program(context: Context) -> tuple[tuple[str, str], list[str]]:
        """Return package and executable of the spawner, and its arguments."""
        called = perform(context, simulator)
        if called not in SPAWNERS:
            raise UsageError(unknown("simulator", called, SPAWNERS))
        its = robot_of(context, of)
        return SPAWNERS[called], its.spawn_arguments if called == "gz" else its.classic_arguments

    return _run_program(program, of, options)


def place(robot: Text = None, fleet: Text = None, **options: Any) -> Action:
    """Return the static transform of a robot's start pose, if one is needed; ``options`` of Node."""
    _check_options("place", options)
    of = RobotRef(robot, fleet)

    def program(context: Context) -> tuple[tuple[str, str], list[str]]:
        """Return package and executable of the publisher of a transform, and its arguments."""
        return PLACER, robot_of(context, of).transform_arguments

    return _run_program(program, of, options)


def node_class() -> Any:
    """Return the class Node of launch_ros."""
    return of_launch_ros("actions").Node


def _node(word: str, base: Any, name_in_set: Text, options: Mapping[str, Any]) -> Action:
    """Return an action of the class ``base`` for a node of a node set."""
    own, first = _split_options(word, name_in_set, options)

    def made(context: Context) -> later.Made:
        """Return the node's keywords in this launch, or the actions that load it as a component."""
        called, its = perform(context, name_in_set), robot_of(context, own["of"])
        if its.table.is_controller(called):
            return _node_options(context, called, own, first)
        box = its.table.container(called)
        programmed = _with_program(its, called, first, component=bool(box))
        given = _node_options(context, called, own, programmed)
        return _load_component(box, given, programmed) if box else given

    known = {key: it for key, it in first.items() if key != "plugin"}
    named = {} if base is node_class() else {"name": "later", "namespace": "", "package": "later"}
    return later.action(base, made, {"executable": "later", **named, **known})


def _split_options(
    word: str, name_in_set: Text, options: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the options of this package, and those of launch_ros."""
    _check_options(word, options)
    if not name_in_set:
        raise UsageError(f'{word}: which node? Write its name in the node set: {word}("amcl")')
    rest = dict(options)
    own = {key: rest.pop(key, None) for key in ("files", "describe", SIM_TIME)}
    own["of"] = RobotRef(rest.pop("robot", None), rest.pop("fleet", None))
    return own, rest


def _check_options(word: str, options: Mapping[str, Any]) -> None:
    """Raise UsageError for options that the fleet decides."""
    for it in FROM_THE_FLEET:
        if it in options:
            first = (
                f'write {word}("amcl") with its name in the node set, and ' if it == "name" else ""
            )
            raise UsageError(f"{word}: {it} comes from the fleet file; {first}remove {it}=")


def _node_options(
    context: Context, name: str, own: Mapping[str, Any], options: Mapping[str, Any]
) -> dict[str, Any]:
    """Return a node's options in this launch, or those of a controller's spawner.

    Given remappings come first and given parameters last: rcl takes the first rule and the last
    value."""
    its = robot_of(context, own["of"])
    paths = [node_file_of(context, it, own["of"]) for it in listed(context, own["files"] or "")]
    clock = sim_time(context, its, own[SIM_TIME])
    if its.table.is_controller(name):
        spawner = its.spawner(name, *paths)
        words = [*spawner["arguments"], *_option_list(options, "arguments")]
        return {**options, **spawner, "arguments": words}
    values = its.start_parameters(name) | (its.description_parameters if own["describe"] else {})
    also = own_file(context, its, name, {its.table.full_name(name): values}, clock)
    return {
        **options,
        "name": its.table.name(name),
        "namespace": its.table.namespace(name),
        "remappings": [*_option_list(options, "remappings"), *its.table.for_node(name)],
        "parameters": [*paths, *also, *_option_list(options, "parameters")],
    }


def _with_program(
    robot: LoadedRobot, name: str, options: Mapping[str, Any], component: bool = False
) -> dict[str, Any]:
    """Return the options with the program or class of the node set; raises UsageError without any."""
    word = "plugin" if component else "executable"
    if word in options:
        return dict(options)
    program = robot.program(name)
    if program is None or not (runs := getattr(program, word)):
        raise UsageError(f"no node set says what runs {name}; write package= and {word}=")
    made = {"package": program.package, word: runs, **options}
    arguments = [] if component else [*program.words, *_option_list(options, "arguments")]
    return {**made, "arguments": arguments} if arguments else made


def _option_list(options: Mapping[str, Any], word: str) -> list[Any]:
    """Return an option that is a list; empty where it is not given."""
    return [*(options.get(word) or ())]


def _load_component(box: str, options: Mapping[str, Any], given: Mapping[str, Any]) -> list[Action]:
    """Return a component, loaded into the container that the robot runs; UsageError for a program."""
    if "executable" in given:
        name, stays = options["name"], "or take a node set in which it has a process of its own"
        raise UsageError(f"{name} is a component of {box}: write plugin= for executable=, {stays}")
    component = of_launch_ros("descriptions").ComposableNode(**{**options, "condition": None})
    loaded = {"composable_node_descriptions": [component]}
    return [of_launch_ros("actions").LoadComposableNodes(target_container=box, **loaded)]


def _run_program(
    find: Callable[[Context], tuple[tuple[str, str], list[str]]],
    of: RobotRef,
    options: Mapping[str, Any],
) -> Action:
    """Return a program with its arguments; without arguments nothing is started."""
    given = {key: it for key, it in options.items() if key != SIM_TIME}

    def made(context: Context) -> later.Made:
        """Return the keywords of the program's process; no action without arguments."""
        (package, executable), arguments = find(context)
        if not arguments:
            return []
        words = [*arguments, *_option_list(given, "arguments")]
        made = {**given, "package": package, "executable": executable, "arguments": words}
        clock = sim_time(context, robot_of(context, of), options.get(SIM_TIME))
        if clock is not None:
            made["parameters"] = [{SIM_TIME: clock}, *_option_list(given, "parameters")]
        return made

    return later.action(node_class(), made, {"executable": "later", **given})


def own_file(
    context: Context,
    robot: LoadedRobot,
    node: str,
    values: Mapping[str, Mapping[str, Any]],
    clock: bool | None,
) -> list[str]:
    """Return the path of a file with what no file of the fleet sets for a node, and its clock."""
    # Nodes that others make in their process have no values but those for all of it.
    clocks = {} if clock is None else {"/**": {SIM_TIME: clock}}
    sections = clocks | {name: dict(own) for name, own in values.items() if own}
    text = parameters_text(sections)
    return [written(context, robot, f"{node}.{_OWN}", text)] if sections else []


def _group(context: Context, fleet: LoadedFleet, robot: LoadedRobot, make: Make) -> Action:
    """Return what a robot runs; launch_ros gives the clock to nodes that are not ours."""
    actions, before = of_launch("actions"), here(context)

    def entering(group: Here) -> Action:
        """Return the action that sets fleet and robot from there on."""
        return actions.OpaqueFunction(function=lambda context: entered(context, group))

    clock = sim_time(context, robot, None)
    sets = [] if clock is None else [of_launch_ros("actions").SetParameter(SIM_TIME, clock)]
    made = make(robot)
    several = [it for it in (made if isinstance(made, Iterable) else [made]) if it is not None]
    first, last = entering((fleet, robot.name)), entering(before)
    return actions.GroupAction([first, *sets, *several, last])
