# SPDX-License-Identifier: Apache-2.0
"""What launch files start, and the nodes of a robot that follow from it."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_nodes import AMCL, AT, launched, runs, started

from multibot_rewrite import InputError, UsageError
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchOrder,
    ParameterText,
    launch_order,
    orders_in_words,
)
from multibot_rewrite.system.records import Place

PUBLISHER = "robot_state_publisher"


def test_what_a_node_set_has_and_nothing_launches_is_left_out_with_a_note() -> None:
    found = launched(AMCL, node_sets=("robot_localization",))
    assert [(it.code, it.line) for it in found.findings] == [("MF821", 1)]
    assert "ekf_filter_node" in found.findings[0].message
    # Every robot runs robot_state_publisher, though no node set is named for it.
    assert set(runs(found)) == {"amcl", PUBLISHER}
    other = started(PUBLISHER, PUBLISHER, "rsp")
    assert set(runs(launched(AMCL, other))) == {"amcl", "rsp"}


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
