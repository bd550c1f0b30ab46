# SPDX-License-Identifier: Apache-2.0
"""Nav2 for all robots of a fleet: what ``ros2 launch multibot_rewrite nav2.launch.py`` starts.

The fleet file decides what that is: the nodes of Nav2 and slam_toolbox that its node sets have,
composed or not, in any layout, with the names, rules and parameter files of each robot. Sources:
nav2_bringup launch/ of humble (1.1.20) to rolling (a3a97043e), slam_toolbox
launch/online_sync_launch.py; nav2_lifecycle_manager lifecycle_manager.cpp and nav2_util
lifecycle_node.cpp: a manager and its node find each other by the node's name without namespace
(bond); lifecycle_msgs msg/Transition.msg."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.fleet.outputs.relays import BRIDGE, not_bridged
from multibot_rewrite.fleet.outputs.rviz_outputs import robot_windows, window_start
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER as MANAGER, NAV2
from multibot_rewrite.launch.actions import each_robot, node_class, own_file, place
from multibot_rewrite.launch.context import (
    SIM_TIME,
    Action,
    Context,
    RobotRef,
    fleet_of,
    node_file_of,
    sim_time,
    written,
)
from multibot_rewrite.planning.start import File, Start, keywords
from multibot_rewrite.producers.launch.door import is_installed, of_launch, of_launch_ros
from multibot_rewrite.related_files.rviz.rewrite import RvizText

NONE, ONE, EACH = "none", "one", "each"
MAP_SERVER, STATE = "map_server", "robot_state_publisher"
TRANSITIONS: Mapping[str, int] = MappingProxyType({"configure": 1, "activate": 3})
_INFO = "costmap_filter_info_server"
# Nodes of node sets that are called otherwise than what they are.
_KINDS: Mapping[str, str] = MappingProxyType(
    {f"{it}_filter_mask_server": MAP_SERVER for it in ("keepout", "speed")}
    | {f"{it}_{_INFO}": _INFO for it in ("keepout", "speed")}
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
    ("use_respawn", "false", "whether nodes that end are started again, if not composed"),
    ("log_level", "info", "the log level of all nodes"),
)


def generate_launch_description() -> Any:
    """Return the launch description of ``nav2.launch.py``."""
    actions, opaque = of_launch("actions"), of_launch("actions").OpaqueFunction
    declared = [
        actions.DeclareLaunchArgument(name, default_value=default, description=about)
        for name, default, about in ARGUMENTS
    ]
    fleet, robots = _configuration("fleet"), _configuration("robots")
    each = each_robot(fleet, lambda it: [opaque(function=partial(_starts, it)), place()], robots)
    made = [opaque(function=_shared_actions), each, opaque(function=_rviz_windows)]
    return of_launch().LaunchDescription([*declared, *made])


def _configuration(argument: str) -> Any:
    return of_launch("substitutions").LaunchConfiguration(argument)


def _is_on(context: Context, argument: str) -> bool:
    return str(context.launch_configurations.get(argument, "")).strip().lower() in ("true", "1")


def _starts(robot: LoadedRobot, context: Context) -> list[Action]:
    """Return what a robot starts: its nodes of Nav2, their state publisher, bridges and relays."""
    names = robot.table
    # Other nodes that its files have sections for may run, too: the node sets say which do.
    known = nodes_of_nav2(it for it in robot.node_set if it in names.nodes)
    if not known:
        hint = "add nav2, nav2_composed, nav2_slam or nav2_slam_composed to node_sets:"
        raise UsageError(f"robot {robot.name!r} has no node of Nav2; {hint}")
    with_state = _is_on(context, "robot_state_publisher") and STATE in names.nodes
    processes = [names.container(it) or names.full_name(it) for it in known]
    processes += [names.full_name(STATE)] if with_state else []
    own = next(it for it in fleet_of(context).starts.robots if it.name == robot.name)
    starts = {it.full_name: it for it in own.starts}
    wanted = [starts[it] for it in dict.fromkeys(processes) if it in starts]
    is_bridged = BRIDGE not in robot.relays or is_installed(BRIDGE)
    wanted += [it.start for it in robot.relays.values() if is_bridged]
    made = [one for it in wanted for one in _process(context, robot, it)]
    if not is_bridged:
        made.append(of_launch("actions").LogInfo(msg=not_bridged(robot.name)))
    return made


def _process(context: Context, robot: LoadedRobot, it: Start) -> list[Action]:
    """Return a process with its components; slam_toolbox is activated as by its own launch file."""
    actions, words = (
        of_launch_ros("actions"),
        ["--ros-args", "--log-level", _configuration("log_level")],
    )
    given = {
        **_keywords(context, robot, it),
        "output": "screen",
        "arguments": [*it.arguments, *words],
    }
    if it.components:
        component = of_launch_ros("descriptions").ComposableNode
        inside = [component(**_keywords(context, robot, one)) for one in it.components]
        return [actions.ComposableNodeContainer(**given, composable_node_descriptions=inside)]
    make = actions.LifecycleNode if it.brought_up else node_class()
    made = make(**given, respawn=_configuration("use_respawn"), respawn_delay=2.0)
    return [made, *(_activated(made) if it.brought_up and _is_on(context, "autostart") else ())]


def _keywords(context: Context, robot: LoadedRobot, it: Start) -> dict[str, Any]:
    """Return the keywords of a process or component alone, with its parameter files of this launch.

    One of them has what no file of the fleet sets, such as the nodes that it manages, and its map."""
    of, shared = (
        RobotRef(robot.name, _configuration("fleet")),
        fleet_of(context, _configuration("fleet")).table,
    )
    files = [node_file_of(context, one.path, of) for one in it.parameters if isinstance(one, File)]
    rows = [one for one in it.parameters if not isinstance(one, File)]
    values = {key: value for row in rows for key, value in row.items()}
    if "robot_description" in values:
        values |= robot.description_parameters
    if "autostart" in values:
        values["autostart"] = _is_on(context, "autostart")
    maps = (one.nodes[MAP_SERVER] for one in (robot.table, shared) if MAP_SERVER in one.nodes)
    file = str(context.launch_configurations.get("map", ""))
    if file and it.full_name in [one.full_name for one in maps]:
        values["yaml_filename"] = file
    clock = sim_time(context, robot, None)
    name = it.full_name.strip("/").replace("/", ".")
    own = own_file(context, robot, name, {it.full_name: values}, clock)
    alone = it._replace(parameters=(), arguments=(), components=())
    return {**keywords(alone), "parameters": [*files, *own]}


def _activated(made: Action) -> Iterator[Action]:
    """Yield actions that configure a node, and activate it afterwards."""
    known, events = of_launch("actions"), of_launch_ros("events.lifecycle")
    ids = of_launch("events").matches_action(made)

    def change(transition: str) -> Action:
        """Return the action that asks the node for a transition."""
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


def _shared_actions(context: Context) -> list[Action]:
    """Return the nodes that all robots share; their sections are alike in every robot's files."""
    fleet = fleet_of(context, _configuration("fleet"))
    shared = (it for it in fleet.starts.shared if kind_of(it.name) in NAV2)
    return [one for it in shared for one in _process(context, fleet.robots[0], it)]


def _rviz_windows(context: Context) -> list[Action]:
    """Return the RViz windows that the launch argument asks for; raises UsageError without any."""
    word = str(context.launch_configurations.get("rviz", NONE)).strip().lower()
    if word not in (NONE, ONE, EACH):
        raise UsageError(f"rviz:={word}: {unknown('way', word, (NONE, ONE, EACH))}")
    if word == NONE:
        return []
    fleet = fleet_of(context, _configuration("fleet"))
    windows = robot_windows(fleet.plan, each=word == EACH)
    if not windows:
        raise UsageError(f"rviz:={word}: {fleet.file}: write rviz: under related_files")
    if word == ONE and len(windows) > 1:
        # What works for one robot alone has a window of its own besides.
        shared = [it for it in windows if not it[1].robot]
        if not shared:
            hint = "say relayed: true in the fleet file, or rviz:=each"
            raise UsageError(f"rviz:=one: these robots need {len(windows)} windows; {hint}")
        windows = shared
    return [_rviz_window(context, *it) for it in windows]


def _rviz_window(context: Context, file: str, window: RvizText) -> Action:
    path = written(context, None, f"{window.robot or 'all'}/{file}", window.text)
    given = keywords(window_start(window, path))
    clock = sim_time(context, fleet_of(context, _configuration("fleet")).robots[0], None)
    clocks = [] if clock is None else [{SIM_TIME: clock}]
    return node_class()(**given | {"arguments": ["-d", path], "parameters": clocks})


def kind_of(name: str) -> str:
    """Return the name in ``NAV2`` of a node of a node set; its own name if ``NAV2`` lacks it."""
    return MANAGER if name.startswith(MANAGER) else _KINDS.get(name, name)


def nodes_of_nav2(names: Iterable[str]) -> list[str]:
    """Return the nodes of Nav2 and slam_toolbox among these, managers last: after what they manage."""
    known = (it for it in names if kind_of(it) in NAV2)
    return sorted(known, key=lambda it: NAV2.index(kind_of(it)))
