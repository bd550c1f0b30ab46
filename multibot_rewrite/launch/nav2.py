# SPDX-License-Identifier: Apache-2.0
"""Nav2 for all robots of a fleet: what ``ros2 launch multibot_rewrite nav2.launch.py`` starts.

The fleet file decides what that is: the nodes of Nav2 and slam_toolbox that its stacks have, composed
or not, in any layout, with the names, rules and parameter files of each robot.
Sources: nav2_bringup launch/ of humble (1.1.20) to rolling (a3a97043e), slam_toolbox
launch/online_sync_launch.py; nav2_lifecycle_manager lifecycle_manager.cpp and nav2_util
lifecycle_node.cpp: a manager and its node meet by the node's name without namespace (bond).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.companions.rviz.rewrite import RvizText
from multibot_rewrite.fleet.outputs.relays import BRIDGE, Relay, not_bridged
from multibot_rewrite.fleet.outputs.rviz_outputs import robot_windows
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.fleet.robots.node_names import NodeNames
from multibot_rewrite.fleet.scripts import LoadedFleet
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.launch import nav2_programs as programs
from multibot_rewrite.launch.actions import (
    composable_node,
    container,
    each_robot,
    lifecycle_node,
    node,
    node_class,
    place,
)
from multibot_rewrite.launch.context import (
    SIM_TIME,
    Action,
    Context,
    fleet_of,
    sim_time,
    written,
)
from multibot_rewrite.producers.launch.door import is_installed, of_launch, of_launch_ros

NONE, ONE, EACH = "none", "one", "each"
# Launch arguments: name, default (None if it has to be given), what it is.
ARGUMENTS = (
    ("fleet", None, "the fleet file"),
    ("robots", "", "some robots of it by name, or robots with poses in place of its own"),
    ("map", "", "the map for map_server; empty: what parameter files say"),
    (SIM_TIME, "", "true, false, or empty for what the fleet file says"),
    ("rviz", NONE, "none, one (one RViz for all robots) or each (one for each robot)"),
    ("robot_state_publisher", "false", "whether to start that of each robot, too"),
    ("autostart", "true", "whether the lifecycle managers start their nodes"),
    (
        "use_respawn",
        "false",
        "whether nodes that end are started again, where they are not composed",
    ),
    ("log_level", "info", "the log level of all nodes"),
)


def generate_launch_description() -> Any:
    """The launch description of ``nav2.launch.py``."""
    actions, opaque = of_launch("actions"), of_launch("actions").OpaqueFunction
    declared = [
        actions.DeclareLaunchArgument(name, default_value=default, description=about)
        for name, default, about in ARGUMENTS
    ]
    fleet, robots = _said("fleet"), _said("robots")
    made = [opaque(function=_shared), each_robot(fleet, _of_robot, robots), opaque(function=_rviz)]
    return of_launch().LaunchDescription([*declared, *made])


def _said(argument: str) -> Any:
    return of_launch("substitutions").LaunchConfiguration(argument)


def _is_on(context: Context, argument: str) -> bool:
    return str(context.launch_configurations.get(argument, "")).strip().lower() in ("true", "1")


def _of_robot(robot: LoadedRobot) -> list[Action]:
    """All that one robot runs."""
    started = partial(_started, robot)
    return [of_launch("actions").OpaqueFunction(function=started), place()]


def _started(robot: LoadedRobot, context: Context) -> list[Action]:
    names = robot.table
    # Other nodes that its files have sections for may run, too: the stacks say which do.
    known = programs.with_program(it for it in robot.stack if it in names.nodes)
    if not known:
        hint = "add nav2, nav2_composed, nav2_slam or nav2_slam_composed to stack:"
        raise UsageError(f"robot {robot.name!r} has no node of Nav2; {hint}")
    hosted = [it for it in known if names.container(it)]
    alone = [it for it in known if it not in hosted]
    made = [it for name in alone for it in _alone(robot, name, context)]
    made += _relays(robot)
    if hosted:
        made.append(_container(robot, hosted, context))
    if _is_on(context, "robot_state_publisher") and programs.STATE in names.nodes:
        made.append(_state_publisher())
    return made


def _alone(robot: LoadedRobot, name: str, context: Context) -> list[Action]:
    """A node in a process of its own; slam_toolbox is brought up here, as by its own launch file."""
    program, alone = programs.program(name, robot.distro), programs.unmanaged(name, robot.distro)
    made = (lifecycle_node if alone else node)(
        name,
        files=robot.params_files,
        package=program.package,
        executable=program.executable,
        output="screen",
        respawn=_said("use_respawn"),
        respawn_delay=2.0,
        arguments=["--ros-args", "--log-level", _said("log_level")],
        parameters=_own(robot.table, name, context),
    )
    return [made, *(_activated(made) if alone and _is_on(context, "autostart") else ())]


def _activated(made: Action) -> Iterator[Action]:
    """Configure a node, and activate it when that is done."""
    known, events = of_launch("actions"), of_launch_ros("events.lifecycle")
    ids = of_launch("events").matches_action(made)

    def change(transition: str) -> Action:
        number = programs.TRANSITIONS[transition]
        changed = events.ChangeState(lifecycle_node_matcher=ids, transition_id=number)
        return known.EmitEvent(event=changed)

    arrived = of_launch_ros("event_handlers").OnStateTransition(
        target_lifecycle_node=made,
        start_state="configuring",
        goal_state="inactive",
        entities=[change("activate")],
    )
    yield known.RegisterEventHandler(arrived)
    yield change("configure")


def _container(robot: LoadedRobot, hosted: list[str], context: Context) -> Action:
    """The container with its components."""
    program = programs.container_of(robot.distro)
    return container(
        programs.CONTAINER,
        files=robot.params_files,
        package=program.package,
        executable=program.executable,
        output="screen",
        arguments=[*program.words, "--ros-args", "--log-level", _said("log_level")],
        composable_node_descriptions=[_component(robot, it, context) for it in hosted],
    )


def _component(robot: LoadedRobot, name: str, context: Context) -> Any:
    program = programs.program(name, robot.distro)
    return composable_node(
        name,
        files=robot.params_files,
        package=program.package,
        plugin=program.plugin,
        parameters=_own(robot.table, name, context),
    )


def _own(names: NodeNames, name: str, context: Context) -> list[dict[str, Any]]:
    """What no file says of a node: its map, the nodes that it manages, the topics that it relays."""
    if name == programs.MAP_SERVER:
        file = str(context.launch_configurations.get("map", ""))
        return [{"yaml_filename": file}] if file else []
    if programs.kind_of(name) == programs.MANAGER:
        managed = [names.name(it) for it in names.managed.get(name, ())]
        return [{"autostart": _is_on(context, "autostart"), "node_names": managed}]
    return []


def _relays(robot: LoadedRobot) -> list[Action]:
    """What brings the robot's tf to /tf; a line where its package is not installed."""
    if BRIDGE in robot.relays and not is_installed(BRIDGE):
        return [of_launch("actions").LogInfo(msg=not_bridged(robot.name))]
    return [_relay(name, it) for name, it in robot.relays.items()]


def _relay(name: str, it: Relay) -> Action:
    package, executable = it.program
    told = [it.parameters] if it.parameters else []
    words = list(it.arguments)
    known = {"package": package, "executable": executable, "output": "screen"}
    return node(name, **known, parameters=told, arguments=words)


def _state_publisher() -> Action:
    name = programs.STATE
    return node(name, describe=True, package=name, executable=name, output="screen")


def _shared(context: Context) -> list[Action]:
    """The nodes that all robots share, with a lifecycle manager of their own."""
    fleet = fleet_of(context, _said("fleet"))
    names = fleet.table
    found = programs.with_program(names.nodes)
    if not found:
        return []
    made = [_shared_node(fleet, it, context) for it in found]
    values = {"autostart": _is_on(context, "autostart"), "node_names": found}
    manager = programs.program(programs.MANAGER, fleet.plan.file.distro)
    return [*made, _plain(programs.SHARED_MANAGER, manager, context, [values])]


def _shared_node(fleet: LoadedFleet, name: str, context: Context) -> Action:
    """A shared node has its section in the files of every robot, and they are alike."""
    (robot, *_), names = fleet.robots, fleet.table
    files = [
        written(context, None, f"nodes/{it}", robot.node_text(it)) for it in robot.params_files
    ]
    program = programs.program(name, robot.distro)
    return _plain(name, program, context, [*files, *_own(names, name, context)])


def _plain(name: str, program: programs.Program, context: Context, parameters: list[Any]) -> Action:
    return node_class()(
        name=name,
        package=program.package,
        executable=program.executable,
        output="screen",
        parameters=[*parameters, *_clock(context)],
    )


def _clock(context: Context) -> list[dict[str, bool]]:
    """The parameter that says whose time counts, where somebody says it."""
    clock = sim_time(context, fleet_of(context, _said("fleet")).robots[0], None)
    return [] if clock is None else [{SIM_TIME: clock}]


def _rviz(context: Context) -> list[Action]:
    """The windows that are asked for."""
    word = str(context.launch_configurations.get("rviz", NONE)).strip().lower()
    if word not in (NONE, ONE, EACH):
        raise UsageError(f"rviz:={word}: {unknown('way', word, (NONE, ONE, EACH))}")
    if word == NONE:
        return []
    fleet = fleet_of(context, _said("fleet"))
    windows = robot_windows(fleet.plan, each=word == EACH)
    if not windows:
        raise UsageError(f"rviz:={word}: {fleet.file} has no rviz: under companions")
    if word == ONE and len(windows) > 1:
        # What works for one robot alone has a window of its own besides.
        shared = [it for it in windows if not it[1].robot]
        if not shared:
            hint = "say relayed: true in the fleet file, or rviz:=each"
            raise UsageError(f"rviz:=one: these robots need {len(windows)} windows; {hint}")
        windows = shared
    return [_window(context, *it) for it in windows]


def _window(context: Context, file: str, window: RvizText) -> Action:
    path = written(context, None, f"{window.robot or 'all'}/{file}", window.text)
    return node_class()(
        package="rviz2",
        executable="rviz2",
        namespace=window.namespace or None,
        remappings=list(window.remaps),
        arguments=["-d", path],
        parameters=_clock(context),
    )
