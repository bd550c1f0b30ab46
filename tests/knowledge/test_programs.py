# SPDX-License-Identifier: Apache-2.0
"""What starts a node: the executables are those of each package's CMakeLists.txt or setup.py."""

from __future__ import annotations

import pytest

from multibot_rewrite.knowledge.programs import known_program, runs
from multibot_rewrite.knowledge.stacks import load_nodes


@pytest.mark.parametrize(
    ("node", "package", "executable"),
    [
        ("ukf_filter_node", "robot_localization", "ukf_node"),
        ("urg_node", "urg_node", "urg_node_driver"),
        ("joy_linux", "joy_linux", "joy_linux_node"),
        ("turtlebot3_node", "turtlebot3_node", "turtlebot3_ros"),
        ("docking_server", "opennav_docking", "opennav_docking"),
        ("robot_state_publisher", "robot_state_publisher", "robot_state_publisher"),
    ],
)
def test_a_node_is_started_by_the_executable_of_its_package(
    node: str, package: str, executable: str
) -> None:
    assert known_program(node, "jazzy")[:2] == (package, executable)


def test_a_program_of_another_package_may_run_a_node() -> None:
    manager = load_nodes("jazzy")["controller_manager"]
    assert runs(manager, "ur_robot_driver/ur_ros2_control_node")
    assert runs(manager, "controller_manager/ros2_control_node")
    assert not runs(manager, "controller_manager/spawner")


def test_a_class_runs_a_node() -> None:
    bridge = load_nodes("jazzy")["ros_gz_bridge"]
    assert runs(bridge, "ros_gz_bridge/ros_gz_bridge::RosGzBridge")
