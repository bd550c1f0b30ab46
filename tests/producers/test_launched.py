# SPDX-License-Identifier: Apache-2.0
"""What launch files start, and the nodes of a robot that follow from it."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from launched_nodes import AMCL, AT, launched, runs, started

from multibot_rewrite import InputError, UsageError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.fleet.fleet import facts_of
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.launched import world_files, worlds
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchInclude,
    LaunchNote,
    LaunchOrder,
    ParameterText,
    graph_of,
    launch_order,
    orders_in_words,
    orders_of,
)
from multibot_rewrite.producers.launch.running import full_name
from multibot_rewrite.system.records import Place

PUBLISHER = "robot_state_publisher"


def test_a_launched_node_runs_and_the_plan_says_its_line() -> None:
    found = runs(launched(AMCL))["amcl"]
    assert (str(found.origin), found.when, found.package) == (
        "bringup.launch.py:12",
        "",
        "nav2_amcl",
    )
    assert "scan" in {it.name for it in found.endpoints}


def test_the_worlds_in_the_words_of_a_simulator() -> None:
    words = ("-r '/a b.sdf' c.world", "-v 4 d.model.xml", "e.model", "x 'f.sdf", "g.urdf")
    gz = started("ros_gz_sim", "gzserver", arguments=words)
    assert world_files(gz) == ["/a b.sdf", "c.world", "e.model"]
    assert world_files(gz._replace(executable="create")) == []


def test_a_world_that_is_there_is_read_but_for_classic(tmp_path: Path) -> None:
    file = tmp_path / "a.world"
    file.write_text('<sdf version="1.9"><world name="w"/></sdf>')
    words = (str(file), str(tmp_path / "gone.sdf"))
    nodes = [
        started(package, "gzserver", arguments=words) for package in ("ros_gz_sim", "gazebo_ros")
    ]
    graph: Any = SimpleNamespace(graph=LaunchGraph(tuple(nodes)))
    assert [(it.file, it.root.tag, it.place) for it in worlds(graph)] == [(str(file), "sdf", AT)]


def test_what_a_stack_has_and_nothing_launches_is_left_out_with_a_note() -> None:
    found = launched(AMCL, stacks=("robot_localization",))
    assert [(it.code, it.line) for it in found.findings] == [("MF821", 1)]
    assert "ekf_filter_node" in found.findings[0].message
    # Every robot runs robot_state_publisher, though no stack is named for it.
    assert set(runs(found)) == {"amcl", PUBLISHER}
    other = started(PUBLISHER, PUBLISHER, "rsp")
    assert set(runs(launched(AMCL, other))) == {"amcl", "rsp"}


def test_stacks_keep_their_nodes_where_a_part_of_a_launch_is_not_known() -> None:
    note = LaunchNote(AT, "package 'acme' is not installed here")
    found = launched(AMCL, stacks=("robot_localization",), notes=(note,))
    assert [(it.code, it.file, it.line) for it in found.findings] == [("MF823", *AT[:2])]
    assert {"amcl", "ekf_filter_node"} <= set(runs(found))


@pytest.mark.parametrize(
    ("node", "name"),
    [
        (started("nav2_amcl", "amcl", "amcl", namespace="/robot1"), "amcl"),
        (started("nav2_amcl", "amcl", "amcl", namespace="/robot1/front"), "front/amcl"),
        (started("nav2_amcl", "amcl", "amcl", namespace="/front"), "front/amcl"),
        (started("nav2_amcl", "amcl", namespace="/r"), "amcl"),
        (started("robot_localization", "ekf_node", "ekf_odom"), "ekf_odom"),
        (started("robot_localization", "ekf_node"), "ekf_filter_node"),
        (started("slam_toolbox", "async_slam_toolbox_node"), "slam_toolbox"),
        (started("nav2_controller", "nav2_controller::ControllerServer"), "controller_server"),
        (started("rclcpp_components", "component_container_mt"), "component_container"),
    ],
)
def test_the_name_of_a_node_is_that_of_its_launch_file_or_its_own(
    node: LaunchedNode, name: str
) -> None:
    found = launched(node)
    assert name in runs(found)
    assert [it.code for it in found.findings] == []
    assert runs(found)[name].endpoints


def test_a_rule_of_a_process_is_for_the_nodes_in_it() -> None:
    """launch_ros gives it without a node: rcl applies it to every node of the process."""
    rules = (("/robot1/local_costmap/costmap", "/robot1/costmap"), ("footprint", "shape"))
    words = ("nav2_controller", "controller_server", "controller_server")
    server = started(*words, namespace="/robot1", remappings=rules)
    found = runs(launched(server))["local_costmap/local_costmap"]
    moved = {it.name: it.remapped for it in found.endpoints if it.remapped}
    assert moved == {"costmap": "/costmap", "footprint": "/local_costmap/shape"}


def test_a_node_inside_of_another_has_the_name_of_its_code() -> None:
    found = runs(launched(started("turtlebot3_node", "turtlebot3_ros", "turtlebot3_node")))
    assert set(found) == {PUBLISHER, "turtlebot3_node", "diff_drive_controller"}
    inner = found["diff_drive_controller"]
    assert (inner.host, inner.is_controller) == ("turtlebot3_node", False)
    assert {"odom", "reset_odometry"} <= {it.name for it in inner.endpoints}


@pytest.mark.parametrize(
    ("namespace", "target", "name"),
    [
        ("/robot1", "diagnostics", "diagnostics"),
        ("/robot1/sensors/lidar", "diagnostics", "/sensors/lidar/diagnostics"),
        ("/robot1/sensors/lidar", "/robot1/diagnostics", "/diagnostics"),
        ("/robot1/sensors/lidar", "/robot1/sensors/lidar/front", "/sensors/lidar/front"),
        ("/robot1/sensors/lidar", "/diagnostics_all", "/diagnostics_all"),
        ("/", "diagnostics", "diagnostics"),
    ],
)
def test_a_rule_leads_from_the_nodes_own_namespace(namespace: str, target: str, name: str) -> None:
    """A relative target is in the namespace of the node: rcl remap.c, rcl_expand_topic_name."""
    rules = (("/diagnostics", target),)
    node = started("urg_node", "urg_node_driver", "urg", namespace=namespace, remappings=rules)
    (found,) = (it for key, it in runs(launched(node)).items() if key.endswith("urg"))
    ends = {it.name: it.remapped for it in found.endpoints}
    # Nothing is to be done where the rule leads to the name that it had.
    assert (ends["/diagnostics"] or "/diagnostics") == name


def test_a_costmap_comes_with_the_server_that_has_it() -> None:
    found = runs(launched(started("nav2_controller", "controller_server", "controller_server")))
    assert set(found) == {PUBLISHER, "controller_server", "local_costmap/local_costmap"}
    assert found["local_costmap/local_costmap"].origin.place == Place("bringup.launch.py", 12)


def test_a_component_is_in_its_container() -> None:
    it = started("nav2_amcl", "nav2_amcl::AmclNode", "amcl", container="/robot1/nav2_container")
    assert runs(launched(it))["amcl"].container == "nav2_container"


def test_remap_rules_count_the_first_of_a_name_and_not_those_of_tf() -> None:
    rules = (("scan", "front/scan"), ("scan", "rear/scan"), ("/tf", "tf"))
    ends = runs(launched(AMCL._replace(remappings=rules)))["amcl"].endpoints
    moved = {it.name: it.remapped for it in ends if it.remapped}
    assert moved == {"scan": "front/scan"}


def test_the_usual_remap_rules_of_a_stack_do_not_count() -> None:
    plain = started("nav2_controller", "controller_server", "controller_server")
    usual = {it.remapped for it in facts_of(("nav2",), None, NEWEST_LTS) for it in it.endpoints}
    assert "cmd_vel_nav" in usual
    found = runs(launched(plain, stacks=("nav2",)))["controller_server"]
    assert {it.remapped for it in found.endpoints} == {""}


def test_parameters_of_a_launch_file_set_names_and_later_ones_win() -> None:
    files = (
        ParameterText(
            "/ws/a.yaml", "/**:\n  ros__parameters: {scan_topic: one, odom_frame_id: o}\n"
        ),
        ParameterText("", "robot1:\n  amcl:\n    ros__parameters: {scan_topic: two}\n"),
        ParameterText("/ws/b.yaml", "other:\n  ros__parameters: {scan_topic: three}\n"),
    )
    found = launched(AMCL._replace(namespace="/robot1", parameters=files))
    (given,) = found.given
    assert given.name == "amcl"
    assert given.values["scan_topic"] == ("two", AT)
    assert given.values["odom_frame_id"] == ("o", Place("/ws/a.yaml", 2))
    names = {it.name for it in runs(found)["amcl"].endpoints}
    assert "two" in names and not {"one", "three", "scan"} & names


@pytest.mark.parametrize(
    ("namespace", "told", "name"),
    [
        # Filled for the robot by the launch file: the plan puts the name in front once.
        ("/robot1", "/robot1/scan", "/scan"),
        ("/robot1/front", "/robot1/front/scan", "/front/scan"),
        ("/robot1", "/robot10/scan", "/robot10/scan"),
        ("/robot1", "/scan", "/scan"),
        ("/", "/robot1/scan", "/robot1/scan"),
        ("/front", "/front/scan", "/front/scan"),
    ],
)
def test_a_name_that_a_launch_file_filled_for_its_robot_is_that_of_any(
    namespace: str, told: str, name: str
) -> None:
    text = f"/**:\n  ros__parameters: {{scan_topic: {told}}}\n"
    node = AMCL._replace(namespace=namespace, parameters=(ParameterText("/ws/a.yaml", text),))
    (found,) = (it for it in runs(launched(node)).values() if it.package == "nav2_amcl")
    assert name in {it.name for it in found.endpoints}


def test_a_file_that_sets_no_parameters_of_nodes_is_passed_over() -> None:
    flat = AMCL._replace(parameters=(ParameterText("/ws/flat.yaml", "scan_topic: one\n"),))
    assert "amcl" in runs(launched(flat))


def test_a_node_that_nothing_is_known_of_has_its_name_alone() -> None:
    found = launched(started("acme", "driver", "d"))
    assert [(it.code, it.file, it.line) for it in found.findings] == [("MF822", *AT[:2])]
    assert set(runs(found)) == {"d", PUBLISHER}
    with_stack = launched(started("acme", "driver", "d"), AMCL, stacks=("localization",))
    assert set(runs(with_stack)) == {"d", "amcl", PUBLISHER}
    # It may ask for transforms; nothing says that it does.
    its = runs(found)["d"]
    assert [(it.name, it.role) for it in its.endpoints] == [("/tf", ""), ("/tf_static", "")]
    assert its.when == ""
    # Its code decides the name.
    assert runs(launched(started("acme", "driver")))["driver"].when


@pytest.mark.parametrize(
    ("name", "namespace", "said"),
    [
        ("a-b", "/", "name 'a-b', which ROS refuses: character 2, '-', is not"),
        ("été", "/", "name 'été', which ROS refuses: character 1, 'é', is not"),
        ("a", "/own/r-1/", "namespace '/own/r-1/', which ROS refuses: character 7, '-', is not"),
        ("", "a//b", "namespace 'a//b', which ROS refuses: "),
    ],
)
def test_names_that_ros_refuses_are_told_with_their_line(
    name: str, namespace: str, said: str
) -> None:
    with pytest.raises(InputError) as caught:
        launched(started("acme", "driver", name, namespace=namespace))
    assert str(caught.value).startswith(f"{AT}: a node has the {said}")


@pytest.mark.parametrize("program", ["v4l2-camera.py", "v4l2.camera", "own::v4l2-camera"])
def test_the_name_of_a_program_is_made_one_that_ros_takes(program: str) -> None:
    """It stands for a name that its code alone knows."""
    node = started("acme", program, container="/box" if "::" in program else "")
    assert "v4l2_camera" in runs(launched(node))
    assert full_name(node, None) == "/v4l2_camera"


def test_what_an_event_starts_is_optional_and_a_spawner_is_no_node() -> None:
    late = AMCL._replace(later="after a time")
    found = runs(launched(late, started("controller_manager", "spawner")))
    assert {name: it.when for name, it in found.items()} == {PUBLISHER: "", "amcl": "after a time"}


def test_the_records_pass_between_processes() -> None:
    node = AMCL._replace(remappings=(("a", "b"),), parameters=(ParameterText("f", "x: 1"),))
    include = LaunchInclude(AT, "nav2_bringup/launch/a.launch.py", (("map", "m.yaml"),))
    graph = LaunchGraph(
        (node._replace(arguments=("-d", "f")),), (LaunchNote(AT, "no"),), includes=(include,)
    )
    assert graph_of(json.loads(json.dumps(graph))) == graph
    order = LaunchOrder("f", (("a", "b"),), ("src",), True)
    assert orders_of(json.dumps([2.0, [order]])) == (2.0, [order])


def test_an_order_is_what_follows_ros2_launch() -> None:
    assert launch_order("my.launch.py a:=1 b:='x y' c:=", ["src"]) == LaunchOrder(
        "my.launch.py", (("a", "1"), ("b", "x y"), ("c", "")), ("src",)
    )
    for text in ("f a=1", "f :=1", "f 'open"):
        with pytest.raises(UsageError, match="NAME:=VALUE"):
            launch_order(text)


def test_a_launch_file_that_nobody_trusts_writes_nothing(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    ran = tmp_path_factory.mktemp("ran") / "ran"
    file = ran.with_name("a.launch.py")
    file.write_text(f"open({str(ran)!r}, 'w')\n")
    with pytest.raises(InputError, match="--trust"):
        launch_graph(LaunchOrder(str(file)))
    assert not ran.exists()


def test_a_node_in_the_namespace_of_a_robot_is_that_robots_alone() -> None:
    """Usually one RViz and one bridge serve all robots; a launch file may start one for each."""
    own = started("ros_gz_bridge", "parameter_bridge", "gz", namespace="/robot1")
    assert runs(launched(own))["gz"].shared is False
    outside = started("ros_gz_bridge", "parameter_bridge", "gz", namespace="/gazebo")
    assert runs(launched(outside))["gazebo/gz"].shared is True


def test_the_nodes_are_all_known_where_only_a_parameter_file_is_not() -> None:
    note = LaunchNote(AT, "the parameter file 'p.yaml' is not there", parameters=True)
    found = launched(AMCL, stacks=("robot_localization",), notes=(note,))
    assert set(runs(found)) == {"amcl", PUBLISHER}
    assert sorted(it.code for it in found.findings) == ["MF821", "MF823"]
    assert "without what the file sets" in " ".join(it.hint for it in found.findings)
    graph = LaunchGraph((AMCL,), (note,))
    assert graph_of(json.loads(json.dumps(graph))) == graph
    assert graph.whole


@pytest.mark.parametrize(
    ("package", "executable", "name"),
    [
        ("joy_linux", "joy_linux_node", "joy_node"),
        ("diagnostic_aggregator", "aggregator_node", "analyzers"),
        ("turtlebot3_node", "turtlebot3_ros", "turtlebot3_node"),
        ("turtlebot4_diagnostics", "diagnostics_updater", "turtlebot4_diagnostics"),
        ("clearpath_diagnostics", "diagnostics_updater", "clearpath_diagnostics_updater"),
        ("joy2twist", "joy2twist", "joy2twist_node"),
    ],
)
def test_a_node_without_a_name_has_that_of_its_code(
    package: str, executable: str, name: str
) -> None:
    """Names as the constructors of the nodes have them, read in the vendors' sources."""
    found = runs(launched(started(package, executable)))
    assert found[name].when == ""
    assert found[name].package == package
    assert runs(launched(started("acme", "driver")))["driver"].when


@pytest.mark.parametrize(
    ("release", "target"),
    [("humble", "platform/odom"), ("jazzy", "platform/odom"), ("lyrical", "")],
)
def test_rules_of_a_manager_reach_its_controllers_where_the_release_forwards_them(
    release: str, target: str
) -> None:
    text = """\
/**:
  controller_manager: {ros__parameters: {wheels: {type: diff_drive_controller/DiffDriveController}}}
  wheels: {ros__parameters: {left_wheel_names: [l], right_wheel_names: [r]}}
"""
    own = (ParameterText("control.yaml", text),)
    rules = (("wheels/odom", "platform/odom"),)
    manager = started(
        *("controller_manager", "ros2_control_node"),
        namespace="/robot1",
        parameters=own,
        remappings=rules,
    )
    spawner = started("controller_manager", "spawner", namespace="/robot1", arguments=("wheels",))
    ends = runs(launched(manager, spawner, release=release))["wheels"].endpoints
    assert next(it.remapped for it in ends if it.name == "~/odom") == target


def test_several_launch_files_get_the_same_arguments(tmp_path: Path) -> None:
    """Words that are no files are those of one: a package with its file."""
    first, second = (str(tmp_path / it) for it in ("a.launch.py", "b.launch.py"))
    for it in (first, second):
        Path(it).touch()
    for words in ((), ("sim:=true", "name:=a=b")):
        values = tuple(tuple(it.split(":=", 1)) for it in words)
        found = orders_in_words([first, second, *words], "text", ("root",))
        assert [(it.file, it.arguments, it.roots) for it in found] == [
            (it, values, ("root",)) for it in (first, second)
        ]
    (alone,) = orders_in_words([first, "x:="], "text")
    assert (alone.file, alone.arguments) == (first, (("x", ""),))
    for wrong in (["a:=b"], [first, ":=b"], [first, "a=b"]):
        with pytest.raises(UsageError, match=r"^launch "):
            orders_in_words(wrong, "text")
