# SPDX-License-Identifier: Apache-2.0
"""A hint that is followed ends in "verified": each reason that a user can mend, with its hint.

Expected: the word, and that the hint names what was written here (never what the code thinks of it).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import pytest

from multibot_rewrite import rewrite

ROVER = '<robot name="rover"><link name="base"/>{}</robot>'
CONTROL = (
    '<gazebo><plugin name="c" filename="libgazebo_ros2_control.so">{}</plugin></gazebo>'
    '<ros2_control name="r" type="system"><hardware><plugin>gazebo_ros2_control/GazeboSystem'
    "</plugin></hardware></ros2_control>"
)
IMU = (
    '<gazebo reference="base"><sensor name="imu" type="imu"/></gazebo>'
    '<ros2_control name="r" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin>'
    '</hardware><sensor name="imu"/></ros2_control>'
)
HIT = (
    '<gazebo reference="base"><sensor name="s" type="contact"><contact><topic>{}</topic>'
    "</contact></sensor></gazebo>"
    '<gazebo><plugin name="gz::sim::systems::TriggeredPublisher" '
    'filename="gz-sim-triggered-publisher-system"><input type="gz.msgs.Contacts" topic="hit"/>'
    '<output type="gz.msgs.Empty" topic="stop"/></plugin></gazebo>'
)
SENSORS = (
    '<gazebo><plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/></gazebo>'
)
# A plugin of ROS 1 alone: no rule of its own moves its transforms.
DRIVE = (
    '<gazebo><plugin name="d" filename="libgazebo_ros_skid_steer_drive.so">'
    "<robotNamespace>/a</robotNamespace><broadcastTF>true</broadcastTF></plugin></gazebo>"
)
PARAM = (
    '<gazebo><plugin name="c" filename="libgazebo_ros_control.so"><robotParam>{}</robotParam>'
    "</plugin></gazebo>"
)
LIDAR = (
    '<joint name="uwl/uwl_base_swivel_joint" type="fixed"><parent link="base"/>'
    '<child link="eye"/></joint><link name="eye"/>'
    '<gazebo><plugin name="l" filename="libdave_pulse_lidar_plugin.so">'
    "<robot_namespace>uwl</robot_namespace></plugin></gazebo>"
)
ESTOP = (
    '<ros2_control name="s" type="system"><hardware><plugin>husarion_ugv_gazebo/EStopSystem</plugin>'
    "</hardware></ros2_control>"
)
ABB = (
    '<link name="hand"/><joint name="joint_1" type="revolute"><parent link="base"/>'
    '<child link="hand"/></joint><ros2_control name="s" type="system"><hardware>'
    "<plugin>abb_hardware_interface/ABBSystemHardware</plugin></hardware>"
    '<joint name="joint_1"><command_interface name="position"/></joint></ros2_control>'
)
# PX4-Autopilot src/modules/simulation/gz_bridge/GZBridge.cpp: .../link/base_link/sensor/imu_sensor/imu
PX4 = (
    "<link name='base_link'/><gazebo reference='base_link'>"
    "<sensor name='imu_sensor' type='imu'><gz_frame_id>base_link</gz_frame_id></sensor>"
    "<sensor name='air_pressure_sensor' type='air_pressure'/></gazebo>"
)
MOTOR = (
    '<link name="prop"/><joint name="rotor_0_joint" type="continuous"><parent link="base"/>'
    '<child link="prop"/></joint><gazebo><plugin name="custom::MotorFailureSystem" '
    'filename="MotorFailurePlugin"/></gazebo><gazebo reference="base">'
    '<sensor name="s" type="imu"><gz_frame_id>base</gz_frame_id></sensor></gazebo>'
)
WINCH = '<gazebo><plugin name="w" filename="libacme_winch.so"/></gazebo>'
ARM = (
    '<ros2_control name="s" type="system"><hardware><plugin>acme/Arm</plugin></hardware>'
    "</ros2_control>"
)
MARK = '<acme at="base"/>'
SAWYER = (
    '<gazebo><plugin name="c" filename="libsawyer_gazebo_ros_control.so">'
    "<robotNamespace>/a</robotNamespace></plugin></gazebo>"
)
KOBUKI = '<gazebo><plugin name="k" filename="libgazebo_ros_kobuki.so"/></gazebo>'


class Followed(NamedTuple):
    """A description with its options, the code and the words of the hint, and what the hint makes."""

    text: str
    layout: str
    distro: str
    code: str
    hint: str
    after: str
    options: dict[str, Any]


def followed(
    text: str,
    layout_and_distro: str,
    code: str,
    hint: str,
    after: str | None = None,
    **options: Any,
) -> Followed:
    layout, _, distro = layout_and_distro.partition(" ")
    return Followed(text, layout, distro, code, hint, text if after is None else after, options)


ROWS = (
    followed(LIDAR, "postfix humble", "MB422", "--affix prefix", affix="prefix"),
    followed(ESTOP, "postfix jazzy", "MG301", "--layout tf-per-robot or both", layout="both"),
    followed(ABB, "postfix humble", "MB428", "--layout tf-per-robot", layout="tf-per-robot"),
    *(
        followed(MOTOR, f"{it} jazzy", "MB428", "--layout", layout="frame-prefix")
        for it in ("postfix", "both")
    ),
    followed(PX4, "postfix jazzy", "MB428", "frame-prefix", layout="frame-prefix"),
    followed(
        WINCH,
        "postfix jazzy",
        "MB902",
        "opens: nothing",
        definitions="[plugin acme_winch]\nopens: nothing\n",
    ),
    followed(
        ARM,
        "postfix jazzy",
        "MB903",
        "opens: nothing",
        definitions="[hardware acme/Arm]\nopens: nothing\n",
    ),
    followed(
        MARK,
        "postfix jazzy",
        "MB901",
        "add a line to a file of plugin definitions: uses or declares",
        definitions="[element acme]\nat: robot\n@at uses link\n",
    ),
    followed(SAWYER, "postfix humble", "MG305", "load the plugin for one robot only", after=""),
    followed(
        KOBUKI, "both humble", "MG402", "allow it with --shared FRAME", shared_frames=["odom"]
    ),
    followed(SENSORS, "postfix jazzy", "MB416", "--world-systems leave", world_systems="leave"),
    followed(
        CONTROL.format(""), "postfix humble", "MB426", "--topics namespace", topics="namespace"
    ),
    followed(IMU, "tf-per-robot jazzy", "MB425", "--layout both", layout="both"),
    followed(
        HIT.format("~/hit"),
        "postfix jazzy",
        "MB438",
        "write both the same way",
        after=HIT.format("hit"),
    ),
    followed(
        DRIVE,
        "tf-per-robot",
        "MG320",
        "--layout frames-per-robot",
        layout="frames-per-robot",
    ),
    followed(
        PARAM.format("/robot_description"),
        "postfix humble",
        "MB410",
        "the part after the last slash",
        after=PARAM.format("robot_description"),
    ),
)


@pytest.mark.parametrize("row", ROWS, ids=[it.code for it in ROWS])
def test_what_the_hint_says_ends_in_proved(row: Followed, tmp_path: Path) -> None:
    before = rewrite(ROVER.format(row.text), "robot1", layout=row.layout, distro=row.distro)
    assert before.not_verified
    assert [it.hint for it in before.findings if it.code == row.code and row.hint in it.hint]
    options = {"layout": row.layout, "distro": row.distro, **row.options}
    if "definitions" in options:
        file = tmp_path / "acme.vocab"
        file.write_text(options["definitions"])
        options["definitions"] = [str(file)]
    assert rewrite(ROVER.format(row.after), "robot1", **options).not_verified == ()


def test_a_name_that_stays_and_is_looked_up_in_the_world_has_no_layout() -> None:
    """legubiao/quadruped_ros2_control gz_system.cpp fills foot_force from every force sensor there is:
    one layout hides the name, the others leave it to all robots."""
    class_ = "gz_quadruped_hardware/GazeboSimSystem"
    system = f"<hardware><plugin>{class_}</plugin></hardware><sensor name='foot_force'/>"
    control = f"<ros2_control name='c' type='system'>{system}</ros2_control>"
    text = f"<robot name='r'><link name='a'/>{control}</robot>"
    found = rewrite(text, "robot1", distro="jazzy").findings
    (hint,) = (it.hint for it in found if it.code == "MB428")
    assert "Gazebo of its own" in hint and "--layout" not in hint
