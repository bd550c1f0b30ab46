# SPDX-License-Identifier: Apache-2.0
"""nav2.launch.py as ``check-launch`` reads it, without the real launch: what is started, and how.

The names are those of the layout; programs and what a lifecycle manager is told are those of
nav2_bringup's launch files, the numbers those of lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml
from launched_here import read_here
from nav2_fleet import FILE, written

from multibot_rewrite.launch import nav2
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchOrder
from multibot_rewrite.related_files.rviz.rewrite import RvizText

BESIDE = ["map_server", "amcl"]
NAV2 = {
    "amcl": "nav2_amcl",
    "behavior_server": "nav2_behaviors",
    "bt_navigator": "nav2_bt_navigator",
    "collision_monitor": "nav2_collision_monitor",
    "controller_server": "nav2_controller",
    "docking_server": "opennav_docking",
    "map_server": "nav2_map_server",
    "planner_server": "nav2_planner",
    "smoother_server": "nav2_smoother",
    "velocity_smoother": "nav2_velocity_smoother",
    "waypoint_follower": "nav2_waypoint_follower",
}
MANAGERS = [f"lifecycle_manager_{it}" for it in ("localization", "navigation")]
SHARED = "shared_nodes: [map_server]\nshared_topics: [/map, /clock, /rosout, /parameter_events]"


def read(folder: Path, *words: tuple[str, str], **fleet: str) -> LaunchGraph:
    """Return what is started for a fleet, with these launch arguments."""
    file = written(folder, **fleet) / "fleet.yaml"
    with pytest.MonkeyPatch.context() as kept:
        read_here(kept, folder)
        return launch_graph(LaunchOrder(str(FILE), (("fleet", str(file)), *words), trusted=True))


def windows(graph: LaunchGraph) -> list[LaunchedNode]:
    return [it for it in graph.nodes if it.executable == "rviz2"]


def by_name(graph: LaunchGraph) -> dict[str, LaunchedNode]:
    """By full name; an RViz has none."""
    return {f"{it.namespace.rstrip('/')}/{it.name}": it for it in graph.nodes if it.name}


@pytest.fixture(scope="module")
def each(tmp_path_factory: pytest.TempPathFactory) -> LaunchGraph:
    """Postfix: all in processes of their own, and all that can be asked for."""
    more = {"rviz": " Each ", "robot_state_publisher": "true", "use_sim_time": "true"}
    words = {"map": "/depot.yaml", "autostart": "false", **more}
    return read(tmp_path_factory.mktemp("fleet"), *words.items())


@pytest.fixture(scope="module")
def nodes(each: LaunchGraph) -> dict[str, LaunchedNode]:
    return by_name(each)


@pytest.fixture(scope="module")
def composed(tmp_path_factory: pytest.TempPathFactory) -> LaunchGraph:
    """Namespaces: in a container of each robot, with a map server for all and tf on one topic."""
    fleet = {"layout": "both", "node_set": "nav2_composed", "more": f"relayed: true\n{SHARED}"}
    return read(tmp_path_factory.mktemp("fleet"), ("rviz", "one"), **fleet)


def own(node: LaunchedNode) -> dict[str, object]:
    """Return what the launch file itself sets, but the clock."""
    name = f"{node.namespace.rstrip('/')}/{node.name}"
    (*_, told) = ({}, *(yaml.safe_load(it.text) for it in node.parameters))
    if not {*told} <= {"/**", name}:
        return {}
    return dict(told.get(name, {"ros__parameters": {}})["ros__parameters"])


def clocks(node: LaunchedNode) -> set[object]:
    """Return the values of use_sim_time that a node is told."""
    found = re.findall(r"use_sim_time: (\S+)", "".join(it.text for it in node.parameters))
    return {yaml.safe_load(it) for it in found}


@pytest.mark.more
@pytest.mark.parametrize("robot", ["robot1", "robot2"])
def test_a_manager_has_the_nodes_that_it_manages_by_their_names(
    robot: str, nodes: dict[str, LaunchedNode]
) -> None:
    manager = nodes[f"/lifecycle_manager_localization_{robot}"]
    assert (manager.package, manager.executable) == ("nav2_lifecycle_manager", "lifecycle_manager")
    wanted = [f"{it}_{robot}" for it in BESIDE]
    assert own(manager) == {"autostart": False, "node_names": wanted}
    moving = own(nodes[f"/lifecycle_manager_navigation_{robot}"])["node_names"]
    assert {"controller_server", f"bt_navigator_{robot}"} <= {*moving}  # type: ignore[misc]


@pytest.mark.more
def test_a_map_server_gets_its_map_and_no_node_is_told_of_others(
    nodes: dict[str, LaunchedNode],
) -> None:
    assert own(nodes["/map_server_robot1"]) == {"yaml_filename": "/depot.yaml"}
    told = {
        name for name, it in nodes.items() if any("node_names" in one.text for one in it.parameters)
    }
    assert all(it.startswith("/lifecycle_manager_") for it in told) and len(told) == 4


@pytest.mark.more
def test_amcl_has_the_start_pose_of_its_robot(nodes: dict[str, LaunchedNode]) -> None:
    told = "".join(it.text for it in nodes["/amcl_robot1"].parameters)
    assert re.search(r"initial_pose:\n +x: 1\.0|initial_pose\.x: 1\.0", told), told


@pytest.mark.more
def test_programs_are_those_of_nav2(nodes: dict[str, LaunchedNode]) -> None:
    """route_server came with Nav2 1.3.9 of Jazzy: neither launch file starts it."""
    for name, package in NAV2.items():
        (it,) = (nodes[key] for key in (f"/{name}_robot2", f"/robot2/{name}") if key in nodes)
        program = "opennav_docking" if name == "docking_server" else name
        assert (it.package, it.executable, it.container) == (package, program, "")
    state = nodes["/robot_state_publisher_robot2"]
    assert (state.package, state.executable) == ("robot_state_publisher",) * 2
    texts = "".join(it.text for it in state.parameters)
    assert "robot_description" in texts and "</robot>" in texts
    assert len(nodes) == 2 * (len(NAV2) + len(MANAGERS) + 1)


@pytest.mark.more
def test_each_process_has_the_level_of_the_log_and_shows_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """rcl's --log-level; the words of output are those of launch/logging/__init__.py."""
    given: dict[str, dict[str, Any]] = {}

    def noted(make: Callable[..., Any]) -> Callable[..., Any]:
        def made(**options: Any) -> Any:
            given[options["name"]] = options
            return make(**options)

        return made

    plain, module = nav2.node_class, nav2.of_launch_ros
    classes = ("LifecycleNode", "ComposableNodeContainer")
    monkeypatch.setattr(nav2, "node_class", lambda: noted(plain()))
    monkeypatch.setattr(
        nav2,
        "of_launch_ros",
        lambda name: (
            SimpleNamespace(**{it: noted(getattr(module(name), it)) for it in classes})
            if name == "actions"
            else module(name)
        ),
    )
    read(tmp_path, ("robot_state_publisher", "true"))
    read(tmp_path, layout="both", node_set="nav2_composed", more="relayed: true")
    assert {"amcl_robot1", "nav2_container", "robot_state_publisher_robot2", "tf_relay"} <= {*given}
    assert {it["output"] for it in given.values()} == {"screen"}
    for it in given.values():
        *_, ros, option, level = it["arguments"]
        assert (ros, option, level.variable_name) == ("--ros-args", "--log-level", "log_level")


@pytest.mark.more
def test_every_node_has_the_clock_that_is_said(each: LaunchGraph, composed: LaunchGraph) -> None:
    assert [clocks(it) for it in each.nodes] == [{True}] * len(each.nodes)
    # Nodes that others make in their process have only what is for all of it.
    manager = by_name(each)["/lifecycle_manager_navigation_robot1"]
    told = yaml.safe_load(next(it.text for it in manager.parameters if "node_names" in it.text))
    assert told["/**"] == {"ros__parameters": {"use_sim_time": True}}
    # Nobody says it: neither the launch, nor the fleet file, nor a file of parameters.
    assert [clocks(it) - {False} for it in composed.nodes] == [set()] * len(composed.nodes)


@pytest.mark.more
def test_a_window_of_each_robot_and_one_of_all(each: LaunchGraph, composed: LaunchGraph) -> None:
    for at, window in enumerate(windows(each), 1):
        tf = [(f"/{it}", f"/{it}/robot{at}") for it in ("tf", "tf_static")]
        assert (window.package, [*window.remappings][:2]) == ("rviz2", tf)
        assert window.arguments[0] == "-d"
        assert window.arguments[1].endswith(f"/robot{at}/one.rviz")
    assert len(windows(each)) == 2
    (shared,) = windows(composed)
    assert (shared.package, shared.remappings, shared.namespace) == ("rviz2", (), "/")
    assert shared.arguments[1].endswith("/all/one.rviz")


@pytest.mark.more
def test_components_are_in_the_container_of_their_robot(composed: LaunchGraph) -> None:
    nodes = by_name(composed)
    box = nodes["/robot1/nav2_container"]
    assert (box.package, box.executable) == ("rclcpp_components", "component_container_isolated")
    hosted = {name: it for name, it in nodes.items() if it.container == "/robot1/nav2_container"}
    own_nodes = [it for it in NAV2 if it != "map_server"]
    assert {*hosted} == {f"/robot1/{it}" for it in (*own_nodes, *MANAGERS)}
    amcl = hosted["/robot1/amcl"]
    assert (amcl.package, amcl.executable) == ("nav2_amcl", "nav2_amcl::AmclNode")
    manager = own(hosted["/robot1/lifecycle_manager_localization"])
    assert manager == {"autostart": True, "node_names": ["amcl"]}


def test_what_all_share_has_a_manager_of_its_own(composed: LaunchGraph) -> None:
    nodes = by_name(composed)
    assert "/robot1/map_server" not in nodes and nodes["/map_server"].package == "nav2_map_server"
    manager = nodes["/lifecycle_manager_shared"]
    assert own(manager) == {"autostart": True, "node_names": ["map_server"]}
    assert (manager.package, manager.executable) == ("nav2_lifecycle_manager", "lifecycle_manager")
    # No map was given: what parameter files say is not replaced.
    assert own(nodes["/map_server"]) == {}


def test_tf_of_each_robot_is_relayed(composed: LaunchGraph, nodes: dict[str, Any]) -> None:
    for tf in ("tf", "tf_static"):
        relay = by_name(composed)[f"/robot2/{tf}_relay"]
        assert (relay.package, relay.executable) == ("topic_tools", "relay")
        told = [*relay.arguments, *own(relay).values()]
        assert [it for it in told if str(it).startswith("/")] == [f"/robot2/{tf}", f"/{tf}"]
    assert not [it for it in nodes if "relay" in it]


@pytest.mark.more
@pytest.mark.parametrize(
    ("words", "fleet", "said"),
    [
        ({"rviz": "one"}, {}, "these robots need 2 windows; say relayed: true"),
        ({"rviz": "all"}, {}, "rviz:=all: way 'all' is not known"),
        ({}, {"node_set": "robot_localization"}, "robot 'robot1' has no node of Nav2; add nav2, "),
    ],
)
def test_what_cannot_be_started_is_said(
    words: dict[str, str], fleet: dict[str, str], said: str, tmp_path: Path
) -> None:
    notes = read(tmp_path, *words.items(), **fleet).notes
    assert any(said in it.message for it in notes), notes


@pytest.mark.more
def test_a_window_needs_a_config(tmp_path: Path) -> None:
    file = written(tmp_path) / "fleet.yaml"
    file.write_text(file.read_text().replace(", rviz: one.rviz", ""))
    with pytest.MonkeyPatch.context() as kept:
        read_here(kept, tmp_path)
        words = (("fleet", str(file)), ("rviz", "each"))
        notes = launch_graph(LaunchOrder(str(FILE), words, trusted=True)).notes
    assert any(f"rviz:=each: {file}: write rviz: under related_files" in it.message for it in notes)


@pytest.mark.parametrize("clock", [True, False, None])
def test_what_windows_are_started_with(clock: bool | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """The options of launch_ros's Node, whole."""
    fleet = SimpleNamespace(robots=["first", "second"])
    monkeypatch.setattr(nav2, "_configuration", lambda word: word)
    monkeypatch.setattr(nav2, "fleet_of", lambda _, said: {"fleet": fleet}[said])
    monkeypatch.setattr(
        nav2, "sim_time", lambda _, robot, told: {("first", None): clock}[robot, told]
    )
    monkeypatch.setattr(nav2, "node_class", lambda: dict)
    monkeypatch.setattr(nav2, "written", lambda *it: it[1:])
    clocks = [] if clock is None else [{"use_sim_time": clock}]
    usual = {"package": "rviz2", "executable": "rviz2", "parameters": clocks}
    rules = (("/tf", "/robot1/tf"),)
    assert nav2._rviz_window(None, "a.rviz", RvizText("robot1", "t", "/robot1", rules)) == {
        **usual, "namespace": "/robot1", "remappings": [*rules],
        "arguments": ["-d", (None, "robot1/a.rviz", "t")],
    }  # fmt: skip
    assert nav2._rviz_window(None, "a.rviz", RvizText("", "t")) == {
        **usual, "arguments": ["-d", (None, "all/a.rviz", "t")],
    }  # fmt: skip


def test_a_node_that_nobody_manages_is_brought_up_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """launch_ros OnStateTransition: activate it once it is inactive, and configure it now."""
    handler, emit = (lambda it: ("handler", it)), (lambda event: ("emit", event))
    of_launch = {
        "actions": SimpleNamespace(RegisterEventHandler=handler, EmitEvent=emit),
        "events": SimpleNamespace(matches_action=lambda it: ("of", it)),
    }
    of_launch_ros = {
        "events.lifecycle": SimpleNamespace(ChangeState=lambda **it: it),
        "event_handlers": SimpleNamespace(OnStateTransition=lambda **it: it),
    }
    monkeypatch.setattr(nav2, "of_launch", of_launch.__getitem__)
    monkeypatch.setattr(nav2, "of_launch_ros", of_launch_ros.__getitem__)

    def change(number: int) -> tuple[str, object]:
        return "emit", {"lifecycle_node_matcher": ("of", "slam"), "transition_id": number}

    assert [*nav2._activated("slam")] == [
        (
            "handler",
            {
                "target_lifecycle_node": "slam",
                "start_state": "configuring",
                "goal_state": "inactive",
                "entities": [change(3)],
            },
        ),
        change(1),
    ]


@pytest.mark.parametrize(
    ("text", "on"), [("true", True), (" True ", True), ("1", True), ("false", False), ("", False)]
)
def test_a_launch_argument_is_on(text: str, on: bool) -> None:
    around = SimpleNamespace(launch_configurations={"autostart": text})
    assert nav2._is_on(around, "autostart") is on
    assert nav2._is_on(around, "other") is False
