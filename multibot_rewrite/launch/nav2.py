# SPDX-License-Identifier: Apache-2.0
"""Nav2 for all robots of a fleet: what ``ros2 launch multibot_rewrite nav2.launch.py`` starts.

The fleet file decides what that is: the nodes of Nav2 and slam_toolbox that its stacks have, composed
or not, in any layout, with the names, rules and parameter files of each robot.
Sources: nav2_bringup launch/ of humble (1.1.20) to rolling (a3a97043e), slam_toolbox
launch/online_sync_launch.py; nav2_lifecycle_manager lifecycle_manager.cpp and nav2_util
lifecycle_node.cpp: a manager and its node meet by the node's name without namespace (bond);
lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.companions.rviz.rewrite import RvizText
from multibot_rewrite.fleet.outputs.relays import BRIDGE, not_bridged
from multibot_rewrite.fleet.outputs.rviz_outputs import robot_windows, window_start
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.fleet.robots.node_names import NodeNames
from multibot_rewrite.fleet.scripts import LoadedFleet
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER as MANAGER
from multibot_rewrite.knowledge.programs import NAV2, is_unmanaged, known_program
from multibot_rewrite.knowledge.stacks import built_in
from multibot_rewrite.knowledge.yaml_with_lines import unknown
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
from multibot_rewrite.spelling.start import keywords

NONE, ONE, EACH = "none", "one", "each"
CONTAINER, MAP_SERVER, SHARED_MANAGER = "nav2_container", "map_server", "lifecycle_manager_shared"
STATE = "robot_state_publisher"
TRANSITIONS: Mapping[str, int] = MappingProxyType({"configure": 1, "activate": 3})
_INFO = "costmap_filter_info_server"
# Nodes of stacks that are called otherwise than what they are.
_KINDS: Mapping[str, str] = MappingProxyType(
    {
        "keepout_filter_mask_server": MAP_SERVER,
        "speed_filter_mask_server": MAP_SERVER,
        f"keepout_{_INFO}": _INFO,
        f"speed_{_INFO}": _INFO,
    }
)
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
    known = nodes_of_nav2(it for it in robot.stack if it in names.nodes)
    if not known:
        hint = "add nav2, nav2_composed, nav2_slam or nav2_slam_composed to stack:"
        raise UsageError(f"robot {robot.name!r} has no node of Nav2; {hint}")
    hosted = [it for it in known if names.container(it)]
    alone = [it for it in known if it not in hosted]
    made = [it for name in alone for it in _alone(robot, name, context)]
    made += _relays(robot)
    if hosted:
        made.append(_container(robot, hosted, context))
    if _is_on(context, "robot_state_publisher") and STATE in names.nodes:
        made.append(node(STATE, describe=True, output="screen"))
    return made


def _alone(robot: LoadedRobot, name: str, context: Context) -> list[Action]:
    """A node in a process of its own; slam_toolbox is brought up here, as by its own launch file."""
    alone = is_unmanaged(built_in(robot.distro).nodes[kind_of(name)], robot.distro)
    made = (lifecycle_node if alone else node)(
        name,
        files=robot.params_files,
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
        number = TRANSITIONS[transition]
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
    return container(
        CONTAINER,
        files=robot.params_files,
        output="screen",
        arguments=["--ros-args", "--log-level", _said("log_level")],
        composable_node_descriptions=[
            composable_node(it, files=robot.params_files, parameters=_own(robot.table, it, context))
            for it in hosted
        ],
    )


def _own(names: NodeNames, name: str, context: Context) -> list[dict[str, Any]]:
    """What no file says of a node: its map, the nodes that it manages, the topics that it relays."""
    if name == MAP_SERVER:
        file = str(context.launch_configurations.get("map", ""))
        return [{"yaml_filename": file}] if file else []
    if kind_of(name) == MANAGER:
        managed = [names.name(it) for it in names.managed.get(name, ())]
        return [{"autostart": _is_on(context, "autostart"), "node_names": managed}]
    return []


def _relays(robot: LoadedRobot) -> list[Action]:
    """What brings the robot's tf to /tf; a line where its package is not installed."""
    if BRIDGE in robot.relays and not is_installed(BRIDGE):
        return [of_launch("actions").LogInfo(msg=not_bridged(robot.name))]
    own = {name: it.start._replace(namespace="", name="") for name, it in robot.relays.items()}
    return [node(name, output="screen", **keywords(it)) for name, it in own.items()]


def _shared(context: Context) -> list[Action]:
    """The nodes that all robots share, with a lifecycle manager of their own."""
    fleet = fleet_of(context, _said("fleet"))
    names = fleet.table
    found = nodes_of_nav2(names.nodes)
    if not found:
        return []
    made = [_shared_node(fleet, it, context) for it in found]
    values = {"autostart": _is_on(context, "autostart"), "node_names": found}
    return [*made, _plain(SHARED_MANAGER, fleet.plan.file.distro, context, [values])]


def _shared_node(fleet: LoadedFleet, name: str, context: Context) -> Action:
    """A shared node has its section in the files of every robot, and they are alike."""
    (robot, *_), names = fleet.robots, fleet.table
    files = [
        written(context, None, f"nodes/{it}", robot.node_text(it)) for it in robot.params_files
    ]
    return _plain(name, robot.distro, context, [*files, *_own(names, name, context)])


def _plain(name: str, release: str, context: Context, parameters: list[Any]) -> Action:
    program = known_program(kind_of(name), release)
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
    given = keywords(window_start(window, path))
    return node_class()(**given | {"arguments": ["-d", path], "parameters": _clock(context)})


def kind_of(name: str) -> str:
    """Return the name in ``NAV2`` of a node of a stack; its own where that has it not."""
    return MANAGER if name.startswith(MANAGER) else _KINDS.get(name, name)


def nodes_of_nav2(names: Iterable[str]) -> list[str]:
    """Return those of the nodes that are Nav2's or slam_toolbox, managers last, so that what they
    manage is there."""
    known = (it for it in names if kind_of(it) in NAV2)
    return sorted(known, key=lambda it: NAV2.index(kind_of(it)))
