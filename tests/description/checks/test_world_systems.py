# SPDX-License-Identifier: Apache-2.0
"""What the lint says of all copies leaves a rewrite unverified: world systems, absolute names."""

from __future__ import annotations

import pytest

from multibot_rewrite.description.library import rewrite

ROBOT = '<robot name="rover"><link name="base_link"/><gazebo>{}</gazebo></robot>'
SENSORS = '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>'
# gazebo_ros2_control_plugin.cpp waits for the parameters of this node: an absolute name is the same in
# each namespace, and its own where nodes have the name of the robot.
CONTROL = (
    '<plugin name="control" filename="libgazebo_ros2_control.so">'
    "<robot_param_node>{}</robot_param_node></plugin>"
)


def codes(inside: str, layout: str) -> list[str]:
    made = rewrite(ROBOT.format(inside), "robot1", layout=layout, distro="humble")
    assert bool(made.not_verified) == bool(made.findings)
    return [it.code for it in made.findings]


def test_a_system_of_the_world_is_not_proved() -> None:
    """gz-sensors issue 497: each copy of the robot loads it again."""
    assert codes(SENSORS, "both") == ["MB416"]


def test_an_absolute_node_is_renamed_where_nodes_are() -> None:
    assert "MB410" not in codes(CONTROL.format("/robot_state_publisher"), "postfix")


@pytest.mark.parametrize(
    ("link", "sensor", "layout", "told"),
    [
        ("base_link", "air_pressure_sensor", "postfix", 2),
        ("base_link", "air_pressure_sensor", "frame-prefix", 0),
        ("base_link", "barometer", "postfix", 0),
        ("base", "air_pressure_sensor", "postfix", 0),
    ],
)
def test_px4_looks_for_the_sensors_of_its_airframes(
    link: str, sensor: str, layout: str, told: int
) -> None:
    """PX4-Autopilot GZBridge.cpp: .../link/base_link/sensor/air_pressure_sensor/air_pressure."""
    sensors = f'<sensor name="imu_sensor" type="imu"/><sensor name="{sensor}" type="air_pressure"/>'
    block = f'<gazebo reference="{link}">{sensors}</gazebo>'
    text = f'<robot name="drone"><link name="{link}"/>{block}</robot>'
    found = rewrite(text, "robot1", layout=layout, distro="jazzy").findings
    assert [it.code for it in found].count("MB428") == told


@pytest.mark.parametrize("tag", ["robot_param", "robotParam", "robot_param_node"])
def test_each_name_of_a_description_is_said_with_its_tag(tag: str) -> None:
    """gazebo_ros_control reads robotParam, gazebo_ros2_control the others."""
    text = ROBOT.format(CONTROL.replace("robot_param_node", tag).format("/x"))
    (found,) = (it for it in rewrite(text, "robot1", layout="both", distro="humble").findings
                if it.code == "MB410")  # fmt: skip
    assert found.message == f"<{tag}> '/x' is the same for all robots"
    assert found.hint == "use the part after the last slash"
