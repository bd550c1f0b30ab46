# SPDX-License-Identifier: Apache-2.0
"""ros2_control as a whole: systems, what loads them, who drives their joints, what controllers need."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

RULES = ("MB201", "MB201", "MB224", "MB226", "MB227", "MB229", "MB23", "MB11", "MB160")
LINKS = '<link name="a"/><link name="b"/><link name="c"/>'
JOINTS = "".join(
    f'<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/></joint>'
    for name, parent, child in (("j", "a", "b"), ("k", "b", "c"))
)
POSITION, VELOCITY = '<{}_interface name="position"/>', '<{}_interface name="velocity"/>'
BOTH = VELOCITY.format("command") + POSITION.format("state")
GZ, MOCK = "gz_ros2_control/GazeboSimSystem", "mock_components/GenericSystem"
CLASSIC = "gazebo_ros2_control/GazeboSystem"
FILE = "<parameters>controllers.yaml</parameters>"
MANAGER = "controller_manager: {ros__parameters: {c: {type: %s}}}\n"


def joint(name: str, inside: str = BOTH) -> str:
    return f'<joint name="{name}">{inside}</joint>'


def system(class_: str, inside: str = "", name: str = "s") -> str:
    hardware = f"<hardware><plugin>{class_}</plugin></hardware>"
    return f'<ros2_control name="{name}" type="system">{hardware}{inside}</ros2_control>'


def plugin(library: str, class_: str, inside: str) -> str:
    tag = f'<plugin filename="{library}" name="{class_}">'
    return f"<gazebo>{tag}{inside}</plugin></gazebo>"


def gz(inside: str = FILE) -> str:
    name = "gz_ros2_control::GazeboSimROS2ControlPlugin"
    return plugin("gz_ros2_control-system", name, inside)


def drive(*joints: str, library: str = "diff-drive", name: str = "DiffDrive") -> str:
    inside = "".join(f"<left_joint>{it}</left_joint>" for it in joints)
    return plugin(f"gz-sim-{library}-system", f"gz::sim::systems::{name}", inside)


def classic(inside: str = FILE) -> str:
    return plugin("libgazebo_ros2_control.so", "gazebo_ros2_control", inside)


def controller(type_: str, parameters: str) -> str:
    return f"{MANAGER % type_}c: {{ros__parameters: {parameters}}}\n"


def codes(inside: str, tmp_path: Path, controllers: str = "") -> list[str]:
    (tmp_path / "controllers.yaml").write_text(controllers or "controller_manager: {}\n")
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{LINKS}{JOINTS}{inside}</robot>')
    settings = Settings(select=RULES, distro="jazzy")
    return [it.code for it in lint_file(str(path), settings)]


def linted(inside: str, folder: Path) -> set[str]:
    """Return what all rules find in it."""
    codes(inside, folder)
    return {it.code for it in lint_file(str(folder / "r.urdf"), Settings(distro="jazzy"))}


def defects() -> Iterator[tuple[str, str, str]]:
    """Each planted defect, a healthy system, and its code."""
    return ((text, system(MOCK, joint("j")), code) for text, code in PLANTED.values())


SENSOR = '<sensor name="i">%s</sensor>' % ('<state_interface name="x"/>' * 2)
TWO_STATES = joint("j", POSITION.format("state") * 2)
PLANTED = {
    "a command twice": (system(MOCK, joint("j", BOTH + VELOCITY.format("command"))), "MB231"),
    "a state twice": (system(MOCK, TWO_STATES), "MB231"),
    "a state of a sensor twice": (system(MOCK, SENSOR), "MB231"),
    "a joint in two systems": (system(MOCK, joint("j")) + system("q/Q", joint("j"), "t"), "MB232"),
    "a joint twice in a system": (system(MOCK, joint("j") + joint("j")), "MB201"),
    "a name of two systems": (system(MOCK, joint("j")) + system(MOCK, joint("k")), "MB201"),
    "simulated hardware without plugin": (system(GZ, joint("j")), "MB233"),
    "the same of Classic": (system(CLASSIC, joint("j")), "MB233"),
    "no file of controllers": (system(GZ, joint("j")) + gz(""), "MB234"),
    "an empty name of that file": (system(GZ, joint("j")) + gz("<parameters/>"), "MB234"),
    "hardware of Classic in gz": (system(CLASSIC, joint("j")) + gz(), "MB235"),
    "hardware of gz in Classic": (system(GZ, joint("j")) + classic(), "MB235"),
    "a drive beside a controller": (system(GZ, joint("j")) + gz() + drive("j"), "MB236"),
    "two drives of one joint": (
        drive("j") + drive("j", library="ackermann-steering", name="AckermannSteering"),
        "MB236",
    ),
    "velocty": (system(MOCK, joint("j", '<command_interface name="velocty"/>' + BOTH)), "MB110"),
    "Position": (system(MOCK, joint("j", '<state_interface name="Position"/>' + BOTH)), "MB110"),
    "torque in simulation": (
        system(GZ, joint("j", '<command_interface name="torque"/>' + BOTH)) + gz(),
        "MB238",
    ),
    "a command without state": (system(MOCK, joint("j", VELOCITY.format("command"))), "MB239"),
    "a parameter of the plugin": (
        system(GZ, joint("j")) + gz(FILE + "<hold_joint>false</hold_joint>"),
        "MB110",
    ),
}  # fmt: skip


@pytest.mark.parametrize("defect", PLANTED)
def test_a_planted_defect_is_found_by_its_rule_alone(defect: str, tmp_path: Path) -> None:
    text, code = PLANTED[defect]
    assert codes(text, tmp_path) == [code]


IMU = '<sensor name="i"><state_interface name="orientation.x"/></sensor>'
CLAIMED = {
    "a trajectory of a joint without state": (
        system(GZ, joint("j", VELOCITY.format("command") + VELOCITY.format("state"))),
        controller(
            "joint_trajectory_controller/JointTrajectoryController",
            "{joints: [j], command_interfaces: [velocity], state_interfaces: [position, velocity]}",
        ),
    ),
    "an IMU without all of its states": (
        system(GZ, joint("j") + IMU),
        controller("imu_sensor_broadcaster/IMUSensorBroadcaster", "{sensor_name: i}"),
    ),
    "a drive without positions": (
        system(GZ, joint("j", VELOCITY.format("command") + VELOCITY.format("state"))),
        controller(
            "diff_drive_controller/DiffDriveController",
            "{left_wheel_names: [j], right_wheel_names: [j]}",
        ),
    ),
}


@pytest.mark.parametrize("defect", CLAIMED)
def test_what_controllers_need_has_to_be_there(defect: str, tmp_path: Path) -> None:
    text, controllers = CLAIMED[defect]
    assert set(codes(text + gz(), tmp_path, controllers)) == {"MB229"}


HEALTHY = {
    "one interface as command and state": system(
        MOCK, joint("j", VELOCITY.format("command") + VELOCITY.format("state"))
    ),
    "two joints": system(MOCK, joint("j") + joint("k")),
    "an actuator and a sensor of one joint": system(MOCK, joint("j", VELOCITY.format("command")))
    + system("q/Q", joint("j", POSITION.format("state")), "t"),
    "a mock without plugin": system(MOCK, joint("j")),
    "hardware of a driver": system("ur_robot_driver/URPositionHardwareInterface", joint("j")),
    "a simulation": system(GZ, joint("j")) + gz(),
    "a simulation by the old name": system("ign_ros2_control/IgnitionSystem", joint("j")) + gz(),
    "a simulation of Classic without file": system(CLASSIC, joint("j")) + classic(""),
    "plugins of both simulators": system(GZ, joint("j")) + gz() + classic(),
    "a drive beside a controller of other joints": system(GZ, joint("k")) + gz() + drive("j"),
    "a drive that is seen": system(GZ, joint("j", POSITION.format("state"))) + gz() + drive("j"),
    "drives of both simulators": drive("j")
    + plugin("libgazebo_ros_diff_drive.so", "d", "<ros/><left_joint>j</left_joint>"),
    "an interface of a driver's own": system("p/P", joint("j", '<state_interface name="torque"/>')),
    "a passive joint": system(MOCK, joint("j") + joint("k", POSITION.format("state"))),
    "a part without links": "",
}


@pytest.mark.parametrize("oddity", HEALTHY)
def test_a_healthy_oddity_is_left_alone(oddity: str, tmp_path: Path) -> None:
    assert codes(HEALTHY[oddity], tmp_path) == []
