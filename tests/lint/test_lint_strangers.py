# SPDX-License-Identifier: Apache-2.0
"""What was told of healthy files of public repositories, and of which level it is now."""

from __future__ import annotations

from pathlib import Path

import pytest
from no_workers import lint_in_this_process
from paths import write_files

from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import Settings

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARM = (
    '<link name="a"><collision><geometry name="a"><box size="1 1 1"/></geometry></collision></link>'
    '<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
)
CONTROL = (
    '<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::'
    'GazeboSimROS2ControlPlugin"><parameters>%s</parameters></plugin></gazebo>'
)
FIND = "$(find arm)/config/c.yaml"
ARGUMENT = '<xacro:arg name="file" default=""/>'
HARDWARE = (
    '<ros2_control name="s" type="system"><hardware><plugin>%s</plugin></hardware></ros2_control>'
)
IMU = '<gazebo><plugin name="gz::sim::systems::Imu" filename="%s"/></gazebo>'
OWN = "md80_hardware_interface/MD80HardwareInterface"
TRICYCLE = """
tricycle_controller:
  ros__parameters:
    traction_joint_name: traction_joint
    traction: {max_velocity: 1.0}
"""
SOURCES = """
collision_monitor:
  ros__parameters:
    observation_sources: frnt
    front: {type: scan, topic: scan}
"""
MANAGER = "controller_manager:\n  ros__parameters:\n    update_rate: 100\n    arm: {%s}\n"
ROS_1_DISPLAY = "Visualization Manager:\n  Displays: [{Class: rviz/Grid}]\n"
CATKIN = "<package><name>arm</name><buildtool_depend>catkin</buildtool_depend></package>"
AMENT = "<package><name>arm</name><buildtool_depend>ament_cmake</buildtool_depend></package>"


@pytest.fixture(autouse=True)
def without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    lint_in_this_process(monkeypatch)


def robot(body: str, space: str = SPACE) -> str:
    return f'<robot name="arm" {space}>{ARM}{body}</robot>'


# (file, its text, other files) -> the levels of the rule's findings.
CASES = {
    "a .xacro.urdf": ("MB234", "a.xacro.urdf", robot(CONTROL % FIND, ""), {}, ["note"]),
    "a space of xacro": ("MB234", "a.urdf", robot(CONTROL % FIND), {}, ["note"]),
    "no word of xacro": ("MB234", "a.urdf", robot(CONTROL % FIND, ""), {}, ["warning"]),
    "an argument": ("MB234", "a.xacro", robot(ARGUMENT + CONTROL % "$(arg file)"), {}, ["warning"]),
    "no argument": ("MB234", "a.xacro", robot(CONTROL % ""), {}, ["error"]),
    "hardware of a package that is there": (
        *("MB110", "urdf/a.urdf", robot(HARDWARE % OWN)),
        {"package.xml": AMENT, "../md80_hardware_interface/package.xml": "<package/>"},
        [],
    ),
    "hardware of a package elsewhere in the repository": (
        *("MB110", "urdf/a.urdf", robot(HARDWARE % OWN)),
        {
            **{"package.xml": AMENT, "../../.git/HEAD": ""},
            "../../hw/md80_hardware_interface/package.xml": "<package/>",
        },
        [],
    ),
    "hardware of no package": ("MB110", "a.urdf", robot(HARDWARE % OWN), {}, ["note"]),
    "hardware of a known package": (
        *("MB110", "a.urdf", robot(HARDWARE % "mock_components/GenericSystm"), {}, ["warning"]),
    ),
    "hardware of a package that is called as a known one": (
        *("MB110", "a.urdf", robot(HARDWARE % "mock_component/GenericSystem"), {}, ["note"]),
    ),
    "a library of Gazebo": (
        *("MB160", "a.urdf", robot(IMU % "gz-sim-imuu-system"), {}, ["error"]),
    ),
    "a library that is not Gazebo's": (
        *("MB160", "a.urdf", robot(IMU % "acme-sim-imuu-system"), {}, ["note"]),
    ),
    "a library of Classic": (
        *(
            "MB110",
            "a.urdf",
            robot(IMU.replace("gz::sim::systems::Imu", "p") % "libgazebo_ros_diff_drve.so"),
            {},
            ["warning"],
        ),
    ),
    "the name of a <geometry>": ("MB901", "a.urdf", robot(""), {}, []),
    "a joint of a controller": ("MB877", "c.yaml", TRICYCLE, {}, []),
    "a controller without type": ("MB115", "c.yaml", MANAGER % "joints: [a]", {}, ["warning"]),
    "hardware of no controller": ("MB115", "c.yaml", MANAGER % "plugin: own/Hardware", {}, []),
    "a list in a text": ("MB877", "c.yaml", SOURCES, {}, ["warning"]),
    "RViz of ROS 1 there": ("MB101", "a.rviz", ROS_1_DISPLAY, {"package.xml": CATKIN}, ["note"]),
    "RViz of ROS 1 in ROS 2": (
        "MB101",
        "a.rviz",
        ROS_1_DISPLAY,
        {"package.xml": AMENT},
        ["warning"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_strangers_file_is_told_at_the_level_of_its_harm(case: str, tmp_path: Path) -> None:
    code, name, text, others, expected = CASES[case]
    package = tmp_path / "src" / "arm"
    write_files(package, {name: text, **others})
    found = lint_files([str(package / name)], Settings(select=(code,)))
    assert [it.level for it in found if it.code == code] == expected
