# SPDX-License-Identifier: Apache-2.0
"""Conditions that a launch decides: the command line, the files that parameters name, and who listens.

Expectations are read in the sources of the nodes, each at its test.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, ParameterText
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched
from multibot_rewrite.system.records import MAY, RUNS, End, Place

CLOUD = "depth_image_proc/point_cloud_xyz_node"


@pytest.fixture(scope="module")
def known() -> Knowledge:
    return Knowledge(built_in("jazzy").nodes, load_known_nodes("", "jazzy"), "jazzy")


def node(
    program: str, *words: str, rules: tuple[tuple[str, str], ...] = (), **values: object
) -> LaunchedNode:
    package, executable = program.split("/")
    texts = ParameterText("", yaml.safe_dump({"/**": {"ros__parameters": values}}))
    place = Place("a.launch.py", 1)
    parameters = (texts,) if values else ()
    return LaunchedNode(package, executable, "", "/r", rules, parameters, "", words, "", place)


def read(known: Knowledge, *nodes: LaunchedNode, role: str = "subscribes") -> set[str]:
    """Return what the first node surely reads, or has in another role."""
    return {it.name for it in _ends(known, *nodes) if it.role == role and it.sure == RUNS}


def _ends(known: Knowledge, *nodes: LaunchedNode) -> list[End]:
    """Return the ends of the first node."""
    made = launched(LaunchGraph(nodes), known).system
    return [it for it in made.ends if it.node == made.nodes[0].name]


def test_a_node_listens_where_somebody_listens_to_it(known: Knowledge) -> None:
    """depth_image_proc point_cloud_xyz.cpp connectCb: it subscribes while points has a subscriber."""
    cloud = node(CLOUD, rules=(("image_rect", "depth/image"),))
    assert "/r/depth/image" not in read(known, cloud)
    listener = node(
        "pointcloud_to_laserscan/pointcloud_to_laserscan_node", rules=(("cloud_in", "points"),)
    )
    # It is lazy, too: cloud_in while scan has a subscriber.
    assert "/r/depth/image" not in read(known, cloud, listener)
    slam = node("slam_toolbox/async_slam_toolbox_node", scan_topic="scan")
    found = read(known, cloud, listener, slam)
    # camera_common.cpp getCameraInfoTopic: beside the image, whatever the rules say.
    assert {"/r/depth/image", "/r/depth/camera_info"} <= found
    assert "/r/camera_info" not in found


def test_a_node_has_what_its_options_ask_for(known: Knowledge) -> None:
    """joint_state_publisher.py main: without the path of a description it subscribes to the topic."""
    program = "joint_state_publisher/joint_state_publisher"
    assert "/r/robot_description" in read(known, node(program))
    assert "/r/robot_description" not in read(known, node(program, "robot.urdf"))


@pytest.mark.parametrize(
    ("text", "there"),
    [
        ("options = {\n  use_odometry = true,\n}", True),
        ("options = { use_odometry=true }", True),
        ("options = {\n  use_odometry = false,\n}", False),
        ("options = {\n  -- use_odometry = true,\n}", False),
        ("options = { never_use_odometry = true }", False),
        ('options = { use_odometry = true, "', False),
    ],
)
def test_a_node_has_what_its_file_asks_for(
    text: str, there: bool, known: Knowledge, tmp_path: Path
) -> None:
    """cartographer_ros node.cpp ComputeDefaultSensorIds: odom with use_odometry."""
    (tmp_path / "robot.lua").write_text(text)
    words = ("-configuration_directory", str(tmp_path), "-configuration_basename", "robot.lua")
    found = read(known, node("cartographer_ros/cartographer_node", *words))
    assert ("/r/odom" in found) is there


def test_a_file_that_is_not_there_says_nothing(known: Knowledge, tmp_path: Path) -> None:
    words = ("-configuration_directory", str(tmp_path), "-configuration_basename", "robot.lua")
    cartographer = node("cartographer_ros/cartographer_node", *words)
    assert "/r/odom" not in read(known, cartographer)
    (odom,) = (it for it in _ends(known, cartographer) if it.name == "/r/odom")
    assert (odom.sure.word, bool(odom.sure.why)) == (MAY.word, True)


@pytest.mark.parametrize(
    ("text", "there"),
    [("<DriveOnHeading/>", True), ("<!-- <DriveOnHeading/> -->", False), ("<Drive/>", False)],
)
def test_a_client_is_there_with_its_node_of_the_tree(
    text: str, there: bool, known: Knowledge, tmp_path: Path
) -> None:
    """nav2_behavior_tree bt_action_node.hpp: the node of the tree makes the client of its action."""
    (tmp_path / "tree.xml").write_text(f"<root><BehaviorTree>{text}</BehaviorTree></root>")
    path = str(tmp_path / "tree.xml")
    navigator = node("nav2_bt_navigator/bt_navigator", default_nav_to_pose_bt_xml=path)
    assert ("/r/drive_on_heading" in read(known, navigator, role="calls")) is there
