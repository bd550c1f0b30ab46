# SPDX-License-Identifier: Apache-2.0
"""Values that a reader takes and nobody means, each beside the one that is meant.

Of gz-sim, gz-sensors and ros2_control 6: what their code does with them is in plugin definitions and in
``sdf.schema``, with file and line.
"""

from __future__ import annotations

import pytest

from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

ROBOT = (
    '<robot name="r"><link name="base"/><link name="w"/><joint name="j" type="continuous">'
    '<parent link="base"/><child link="w"/></joint>{}</robot>'
)
GZ = '<gazebo><plugin filename="gz-sim-{}-system" name="gz::sim::systems::{}">{}</plugin></gazebo>'
MOTOR = GZ.format(
    "multicopter-motor-model",
    "MulticopterMotorModel",
    "<jointName>j</jointName><linkName>w</linkName><{0}>{{}}</{0}>",
)
LIMITED = GZ.format(
    "joint-position-controller",
    "JointPositionController",
    "<joint_name>j</joint_name><cmd_min>{}</cmd_min><cmd_max>{}</cmd_max>",
)
MECANUM = GZ.format("mecanum-drive", "MecanumDrive", "<wheelbase>{}</wheelbase>")
DIFF = GZ.format(
    "diff-drive", "DiffDrive", "<min_velocity>{}</min_velocity><max_velocity>{}</max_velocity>"
)
VOLUME = GZ.format(
    "buoyancy-engine",
    "BuoyancyEngine",
    "<link_name>w</link_name><min_volume>{}</min_volume><max_volume>{}</max_volume>",
)
WING = GZ.format(
    "lift-drag",
    "LiftDrag",
    "<link_name>w</link_name><area>{}</area><forward>{}</forward>",
)
THRUSTER = GZ.format(
    "thruster",
    "Thruster",
    "<joint_name>j</joint_name><thrust_coefficient>{}</thrust_coefficient>",
)
ODOMETRY = GZ.format(
    "odometry-publisher",
    "OdometryPublisher",
    "<dimensions>{}</dimensions><gaussian_noise>{}</gaussian_noise>",
)
BATTERY = GZ.format(
    "linearbatteryplugin",
    "LinearBatteryPlugin",
    "<battery_name>b</battery_name><voltage>12</voltage><capacity>2</capacity>"
    "<initial_charge>{}</initial_charge>",
)
HULL = GZ.format(
    "hydrodynamics", "Hydrodynamics", "<link_name>w</link_name><xU>{}</xU><nRabsR>{}</nRabsR>"
)
SENSOR = '<gazebo reference="base"><sensor name="s" type="{}">{}</sensor></gazebo>'
CONTACT = SENSOR.format("contact", "{}<contact><collision>c</collision>{}</contact>")
IMU = SENSOR.format(
    "imu",
    "<imu><orientation_reference_frame><localization>{}</localization>"
    "</orientation_reference_frame></imu>",
)
FORCES = SENSOR.format(
    "force_torque",
    "<force_torque><frame>{}</frame><measure_direction>{}</measure_direction></force_torque>",
)
NOISE = SENSOR.format(
    "gpu_lidar", "<lidar><noise><type>gaussian</type><stddev>{}</stddev></noise></lidar>"
)
LOGICAL = SENSOR.format(
    "logical_camera", "<logical_camera><near>{}</near><far>{}</far></logical_camera>"
)
LIDAR = SENSOR.format("{}", "<lidar><range><min>{}</min><max>10</max></range></lidar>")
CONTROL = (
    '<ros2_control name="c" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>'
    '<param name="{}">{}</param></hardware><joint name="j"><command_interface name="position"/>'
    '<state_interface name="position"/></joint>{}</ros2_control>'
)
IN_SENSOR = '<sensor name="ft"><{}_interface name="force.x"/></sensor>'


@pytest.mark.parametrize(
    ("code", "form", "good", "bad"),
    [
        ("MB124", MOTOR.format("turningDirection"), ("ccw",), ("clockwise",)),
        ("MB124", MOTOR.format("motorType"), ("velocity",), ("speed",)),
        ("MB125", LIMITED, ("-5", "5"), ("10", "5")),
        # -1 is no limit in gz-math's PID.
        ("MB125", LIMITED, ("0", "-1"), ("0", "-2")),
        ("MB125", VOLUME, ("0", "1"), ("2", "1")),
        ("MB125", DIFF, ("-1", "-0.5"), ("1", "0.5")),
        ("MB125", MECANUM, ("0.4",), ("0",)),
        ("MB125", WING, ("0.2", "0 0 -1"), ("-0.2", "0 0 -1")),
        ("MB125", WING, ("0.2", "1 0 0"), ("0.2", "0 0.0 0")),
        # A propeller that is turned round has a coefficient below 0 (Thruster.cc:579).
        ("MB125", THRUSTER, ("-0.1",), ("0",)),
        ("MB125", ODOMETRY, ("3", "0"), ("4", "0")),
        ("MB125", ODOMETRY, ("2", "0.1"), ("2", "-0.1")),
        ("MB125", BATTERY, ("2",), ("2.5",)),
        ("MB120", HULL, ("-1", "0"), ("-1", "none")),
        ("MB124", FORCES, ("sensor", "child_to_parent"), ("world", "child_to_parent")),
        ("MB124", FORCES, ("child", "parent_to_child"), ("child", "parent_child")),
        ("MB125", NOISE, ("0",), ("-0.1",)),
        ("MB628", LOGICAL, ("0.1", "5"), ("5", "0.1")),
        ("MB124", IMU, ("ENU",), ("EUN",)),
        ("MB125", LIDAR, ("gpu_lidar", "0.1"), ("gpu_lidar", "0")),
        # The Contact system reads the topic in <contact> alone.
        ("MB402", CONTACT, ("<topic>t</topic>", ""), ("", "<topic>t</topic>")),
        # No camera draws a lidar that casts rays.
        ("MB125", LIDAR, ("lidar", "0"), ("gpu_ray", "0")),
        ("MB124", CONTROL, ("calculate_dynamics", "true", ""), ("calculate_dynamics", "yes", "")),
        (
            "MB120",
            CONTROL,
            ("position_state_following_offset", "0.1", ""),
            ("position_state_following_offset", "near", ""),
        ),
        (
            "MB112",
            CONTROL,
            ("calculate_dynamics", "true", IN_SENSOR.format("state")),
            ("calculate_dynamics", "true", IN_SENSOR.format("command")),
        ),
    ],
)
def test_what_nobody_means_is_told(
    code: str, form: str, good: tuple[str, ...], bad: tuple[str, ...]
) -> None:
    settings = Settings(select=(code,), distro="jazzy")
    for values, count in ((good, 0), (bad, 1)):
        text = ROBOT.format(form.format(*values))
        assert len(lint_data("r.urdf", text.encode(), settings)) == count, values


@pytest.mark.parametrize(("release", "count"), [("humble", 0), ("jazzy", 1), ("kilted", 0)])
def test_a_topic_that_a_release_does_not_read_is_not_shared(release: str, count: int) -> None:
    """PosePublisher has read it since gz-sim 8, and gz-sim 9 up to 9.5.0 does not."""
    text = ROBOT.format(GZ.format("pose-publisher", "PosePublisher", "<topic>pose</topic>"))
    settings = Settings(select=("MB402",), distro=release)
    assert len(lint_data("r.urdf", text.encode(), settings)) == count
