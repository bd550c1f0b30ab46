# SPDX-License-Identifier: Apache-2.0
"""What starts a node: the executables are those of each package's CMakeLists.txt or setup.py."""

from __future__ import annotations

import pytest

from multibot_rewrite.knowledge.programs import known_program


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
