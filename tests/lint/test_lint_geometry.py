# SPDX-License-Identifier: Apache-2.0
"""Defects of geometry planted in two healthy robots, and what is odd in them and healthy.

What a defect breaks was taken from its consumer: gz-sim's DiffDrive, REP 103, gz-rendering, sdformat.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import pytest
from lint_calls import RULES, Settings, lint_data
from paths import ROBOTS

ROVER = (ROBOTS / "rover_gz.urdf").read_text()
ARM = (ROBOTS / "two_finger_arm.urdf").read_text()
GEOMETRY = Settings(select=("MB62", "MB63", "MB536", "MB537"))
LEFT_AT, RIGHT_AT = '<origin xyz="0 0.17 0"/>', '<origin xyz="0 -0.17 0"/>'
AXIS = '<axis xyz="0 1 0"/>'
SEPARATION, RADIUS = "<wheel_separation>0.34", "<wheel_radius>0.07"
ROUND = '<geometry><cylinder radius="0.07" length="0.04"/></geometry>'
CHASSIS = '<collision>\n      <geometry><box size="0.4 0.3 0.12"/></geometry>'
BASE_MASS = '<mass value="4.2"/>'
LIDAR_AT, CAMERA_AT = 'xyz="0.1 0 0.12"', 'xyz="0.2 0 0.08"'
RANGE = "<min>0.1</min><max>12</max>"
OPTICAL = 'rpy="-1.5708 0 -1.5708"'
CAMERA = "<camera>\n"


class Change(NamedTuple):
    """A text of a robot, and what it becomes; ``times`` how often, 0 for everywhere."""

    old: str
    new: str
    times: int = 1


class Changed(NamedTuple):
    """A robot with its changes, and the same without."""

    robot: str
    before: str


def of_rover(*changes: Change, robot: str = ROVER) -> Changed:
    before = robot
    for old, new, times in changes:
        assert old in robot, old
        robot = robot.replace(old, new, times or -1)
    return Changed(robot, before)


of_arm = partial(of_rover, robot=ARM)


def swapped(one: str, other: str) -> list[Change]:
    return [Change(one, "@"), Change(other, one), Change("@", other)]


def scan(low: str, high: str) -> str:
    angles = f"<min_angle>{low}</min_angle><max_angle>{high}</max_angle>"
    return f"<lidar><scan><horizontal>{angles}</horizontal></scan>"


def clip(near: str, far: str) -> list[Change]:
    return [Change(CAMERA, f"<camera><clip><near>{near}</near><far>{far}</far></clip>")]


def starting(at: str) -> list[Change]:
    state = f'<state_interface name="position"><param name="initial_value">{at}</param>'
    joint = f'<joint name="shoulder">{state}</state_interface></joint>'
    system = f'<ros2_control name="s" type="system">{joint}</ros2_control>'
    return [Change("</robot>", f"{system}</robot>")]


def controlled(at: str) -> list[Change]:
    name = "gz::sim::systems::JointPositionController"
    inside = f"<joint_name>shoulder</joint_name><initial_position>{at}</initial_position>"
    file = 'filename="gz-sim-joint-position-controller-system"'
    plugin = f'<plugin {file} name="{name}">{inside}</plugin>'
    return [Change("</robot>", f"<gazebo>{plugin}</gazebo></robot>")]


def centre(xyz: str) -> list[Change]:
    return [Change(BASE_MASS, f'<origin xyz="{xyz}"/>{BASE_MASS}')]


def mimics(inside: str) -> list[Change]:
    return [
        Change('<mimic joint="left_finger_joint"/>', f'<mimic joint="left_finger_joint" {inside}/>')
    ]


def mast(joint: str) -> list[Change]:
    """Return a weight on a joint of the arm's wrist."""
    inertia = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    link = f'<link name="tool"><inertial><mass value="3"/>{inertia}</inertial></link>'
    return [Change("</robot>", f'{link}<joint name="t" {joint}</joint></robot>')]


def tool(type_: str, axis: str, limit: str, more: str = "", at: str = "0.5 0 0") -> list[Change]:
    ends = '<parent link="wrist"/><child link="tool"/>'
    mass = Change('<mass value="3"/>', f'<origin xyz="{at}"/><mass value="3"/>')
    return [*mast(f'type="{type_}">{ends}<axis xyz="{axis}"/>{limit}{more}'), mass]


WEAK = '<limit lower="-1" upper="1" effort="10" velocity="1"/>'
STRONG = '<limit lower="-1" upper="1" effort="30" velocity="1"/>'
CPU = Change('type="gpu_lidar"', 'type="ray"')
# A plugin of Gazebo Classic sends what it sees.
SENT = Change("<topic>scan", '<plugin filename="libgazebo_ros_ray_sensor.so" name="l"/><topic>scan')
HOUSED = [
    CPU,
    SENT,
    Change("<lidar><range>", "<ray><range>"),
    Change("</range></lidar>", "</range></ray>"),
    Change(
        '<link name="lidar_link"/>',
        f'<link name="lidar_link"><collision>{ROUND}</collision></link>',
    ),
]
# Changed robots by the code that has to be found.
PLANTED: dict[str, dict[str, Changed]] = {
    "MB620": {
        "separation is half": of_rover(Change(SEPARATION, "<wheel_separation>0.17")),
        "separation is double": of_rover(Change(SEPARATION, "<wheel_separation>0.68")),
        "separation in centimetres": of_rover(Change(SEPARATION, "<wheel_separation>34")),
        "separation from one wheel to the middle": of_rover(
            Change(LEFT_AT, '<origin xyz="0 0.25 0"/>'),
            Change(RIGHT_AT, '<origin xyz="0 -0.25 0"/>'),
        ),
        "separation is left to its default": of_rover(
            Change(f"{SEPARATION}</wheel_separation>", "")
        ),
        "radius is the diameter": of_rover(Change(RADIUS, "<wheel_radius>0.14")),
        "radius of another wheel": of_rover(Change('radius="0.07"', 'radius="0.1"', 0)),
        "radius in millimetres": of_rover(Change(RADIUS, "<wheel_radius>70")),
        "radius is left to its default": of_rover(Change(f"{RADIUS}</wheel_radius>", "")),
    },
    "MB622": {
        "joints are swapped": of_rover(
            Change("<left_joint>left_wheel_joint", "<left_joint>right_wheel_joint"),
            Change("<right_joint>right_wheel_joint", "<right_joint>left_wheel_joint"),
        ),
        "one wheel is both": of_rover(
            Change("<right_joint>right_wheel_joint", "<right_joint>left_wheel_joint")
        ),
        "origins are swapped": of_rover(*swapped(LEFT_AT, RIGHT_AT)),
        "axes point to the right": of_rover(Change(AXIS, '<axis xyz="0 -1 0"/>', 0)),
        "one axis points to the right": of_rover(Change(AXIS, '<axis xyz="0 -1 0"/>')),
        "one joint is turned around": of_rover(
            Change(LEFT_AT, '<origin xyz="0 0.17 0" rpy="0 0 3.14159"/>')
        ),
        "one wheel is mounted upside down": of_rover(
            Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="3.14159 0 0"/>')
        ),
    },
    "MB624": {
        "wheel is fixed": of_rover(
            Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="fixed')
        ),
        "wheel has limits": of_rover(
            Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="revolute'),
            Change(AXIS, f'{AXIS}<limit lower="-3.14" upper="3.14" effort="1" velocity="9"/>'),
        ),
        "wheel slides": of_rover(
            Change('right_wheel_joint" type="continuous', 'right_wheel_joint" type="prismatic'),
            Change(RIGHT_AT, f'{RIGHT_AT}<limit lower="0" upper="1" effort="1" velocity="9"/>'),
        ),
    },
    "MB625": {
        "optical frame is not turned": of_rover(Change(OPTICAL, 'rpy="0 0 0"')),
        "optical frame without an origin": of_rover(Change(f'<origin xyz="0 0 0" {OPTICAL}/>', "")),
    },
    "MB626": {
        "camera at its optical frame": of_rover(
            Change('reference="camera_link"', 'reference="camera_optical_frame"')
        ),
        "depth camera at its optical frame": of_rover(
            Change('reference="camera_link"', 'reference="camera_optical_frame"'),
            Change('type="camera"', 'type="rgbd_camera"'),
        ),
    },
    "MB627": {
        "lidar below the ground": of_rover(Change(LIDAR_AT, 'xyz="0.1 0 -0.12"')),
        "camera below the ground": of_rover(Change(CAMERA_AT, 'xyz="0.2 0 -0.08"')),
        "lidar whose pose is below the ground": of_rover(
            Change("<topic>scan", "<pose>0 0 -0.3 0 0 0</pose><topic>scan")
        ),
    },
    "MB628": {
        "angles of a lidar swapped": of_rover(Change("<lidar>", scan("3.1", "-3.1"))),
        "ranges of a lidar swapped": of_rover(Change(RANGE, "<min>12</min><max>0.1</max>")),
        "range of a lidar in millimetres and metres": of_rover(
            Change(RANGE, "<min>100</min><max>12</max>")
        ),
    },
    "MB629": {
        "clip planes swapped": of_rover(*clip("300", "0.02")),
        "clip planes alike": of_rover(*clip("0.1", "0.1")),
        "near plane at the lens": of_rover(*clip("0", "100")),
        "near plane behind the lens": of_rover(*clip("-0.1", "100")),
    },
    "MB630": {
        "lidar in its housing": of_rover(*HOUSED, Change("<min>0.1", "<min>0.02")),
        "lidar deep in a box": of_rover(
            *HOUSED,
            Change(f"<collision>{ROUND}", '<collision><geometry><box size="1 1 1"/></geometry>'),
        ),
    },
    "MB637": {
        "lidar of Gazebo Classic": of_rover(CPU),
    },
    "MB631": {
        "collision in centimetres away": of_rover(
            Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="0 0 5"/><geometry>'))
        ),
        "collision with a wrong sign": of_rover(
            Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="-0.3 0 0"/><geometry>')),
            Change("<visual>\n      <geometry>", '<visual><origin xyz="0.3 0 0"/><geometry>'),
        ),
        "one mesh at two places": of_arm(
            Change(
                '<link name="upper_arm">',
                '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
                '</visual><collision><origin xyz="0 0 0.3"/><geometry><mesh filename="package://p/a.stl"/>'
                "</geometry></collision>",
            )
        ),
    },
    "MB632": {
        "centre of mass in millimetres": of_rover(*centre("12 0 3")),
        "centre of mass in another frame": of_rover(*centre("0 0 0.9")),
        "centre of mass of a mesh in millimetres": of_arm(
            Change(
                '<link name="upper_arm">\n    <inertial>',
                '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
                '</visual><inertial><origin xyz="0 0 200"/>',
            )
        ),
    },
    "MB633": {
        "motor too weak for its tool": of_arm(*tool("revolute", "0 1 0", WEAK)),
        "motor too weak for a lift": of_arm(*tool("prismatic", "0 0 1", WEAK)),
        "motor too weak further up": of_arm(
            Change('effort="20"', 'effort="9"'), *tool("fixed", "0 0 1", "")
        ),
    },
    "MB634": {
        "too heavy in front": of_rover(*centre("0.26 0 0.05")),
        "too heavy on one side": of_rover(*centre("0 0.25 0")),
        "wheels far behind": of_rover(
            Change(LEFT_AT, '<origin xyz="-0.5 0.17 0"/>'),
            Change(RIGHT_AT, '<origin xyz="-0.5 -0.17 0"/>'),
            Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="0 0 0.05"/><geometry>')),
        ),
    },
    "MB536": {
        "finger follows too far": of_arm(*mimics('multiplier="3"')),
        "finger follows the wrong way": of_arm(*mimics('multiplier="-1"')),
        "finger follows with an offset": of_arm(*mimics('offset="0.1"')),
    },
    "MB537": {
        "shoulder starts in degrees": of_arm(*starting("45")),
        "shoulder starts beyond its limit": of_arm(*starting("-1.6")),
        "shoulder is sent beyond its limit": of_arm(*controlled("2")),
    },
}


def codes(robot: str) -> set[str]:
    return {it.code for it in lint_data("robot.urdf", robot.encode(), GEOMETRY)}


def linted(robot: str, _folder: Path) -> set[str]:
    """Return what all rules find in it."""
    return {it.code for it in lint_data("robot.urdf", robot.encode(), Settings())}


def defects() -> Iterator[tuple[str, str, str]]:
    """Each planted defect, the robot without it, and its code."""
    return ((*it, code) for code, changed in PLANTED.items() for it in changed.values())


@pytest.mark.parametrize(("code", "name"), [(it, name) for it in PLANTED for name in PLANTED[it]])
def test_a_planted_defect_is_found(code: str, name: str) -> None:
    assert code in codes(PLANTED[code][name].robot)


@pytest.mark.parametrize("robot", [ROVER, ARM], ids=["rover", "arm"])
def test_the_robots_are_healthy_before(robot: str) -> None:
    assert codes(robot) == set()


HEALTHY: dict[str, Changed] = {
    "robot that drives along -x": of_rover(
        *swapped(LEFT_AT, RIGHT_AT), Change(AXIS, '<axis xyz="0 -1 0"/>', 0)
    ),
    "wheels turned with their joints": of_rover(
        Change(LEFT_AT, '<origin xyz="0 0.17 0" rpy="-1.5708 0 0"/>'),
        Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="-1.5708 0 0"/>'),
        Change(AXIS, '<axis xyz="0 0 1"/>', 0),
        Change('<origin rpy="1.5708 0 0"/>', "", 0),
    ),
    "mirrored wheels whose axes agree": of_rover(
        Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="0 0 3.14159"/>'),
        Change(AXIS, "@"),
        Change(AXIS, '<axis xyz="0 -1 0"/>'),
        Change("@", AXIS),
    ),
    "separation to the outside of wide wheels": of_rover(
        Change(SEPARATION, "<wheel_separation>0.365")
    ),
    "wheel that is a sphere": of_rover(
        Change('<cylinder radius="0.07" length="0.04"/>', '<sphere radius="0.07"/>', 0)
    ),
    "wheels of meshes": of_rover(
        Change('<cylinder radius="0.07" length="0.04"/>', '<mesh filename="package://p/w.stl"/>', 0)
    ),
    "wheel with a hub": of_rover(
        Change(
            ROUND,
            f"{ROUND}</collision><collision><geometry>"
            '<cylinder radius="0.02" length="0.1"/></geometry>',
        )
    ),
    "separation that is no number": of_rover(Change(SEPARATION, "<wheel_separation>wide")),
    "wheel with limits of many turns": of_rover(
        Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="revolute'),
        Change(AXIS, f'{AXIS}<limit lower="-1e16" upper="1e16" effort="1" velocity="9"/>'),
    ),
    "wheels that steer themselves": of_rover(
        Change("<left_joint>left_wheel_joint", "<left_joint>other")
    ),
    "optical frame of an optical frame": of_rover(
        Change(
            "</robot>",
            '<link name="rgb_optical_frame"/><joint name="o" type="fixed"><parent '
            'link="camera_optical_frame"/><child link="rgb_optical_frame"/></joint></robot>',
        )
    ),
    "camera that looks up on purpose": of_rover(Change(OPTICAL, 'rpy="0 0 0.7854"')),
    "camera link turned as its optical frame": of_rover(
        Change(f'{CAMERA_AT} rpy="0 0 0"', f"{CAMERA_AT} {OPTICAL}"),
        Change(f'xyz="0 0 0" {OPTICAL}', 'xyz="0 0 0"'),
    ),
    "sensor of optical flow": of_rover(Change("camera_link", "optical_flow_link", 0)),
    "camera turned back at its optical frame": of_rover(
        Change('reference="camera_link"', 'reference="camera_optical_frame"'),
        Change("<topic>front", "<pose>0 0 0 1.5708 -1.5708 0</pose><topic>front"),
    ),
    "lidar just above the ground": of_rover(Change(LIDAR_AT, 'xyz="0.1 0 -0.065"')),
    "imu below the ground": of_rover(Change('xyz="0 0 0.02"', 'xyz="0 0 -0.2"')),
    "sensor in a frame of its own": of_rover(
        Change("<topic>scan", '<pose relative_to="imu_link">0 0 -9 0 0 0</pose><topic>scan')
    ),
    "classic lidar that scans backwards": of_rover(
        CPU,
        SENT,
        Change("<lidar>", scan("2.2", "-2.2").replace("<lidar>", "<ray>")),
        Change("</lidar>", "</ray>"),
    ),
    "lidar of one ray": of_rover(Change("<lidar>", scan("0", "0"))),
    "lidar of a whole turn": of_rover(Change("<lidar>", scan("0", "6.28319"))),
    "clip planes with one default": of_rover(Change(CAMERA, "<camera><clip><far>10</far></clip>")),
    "lidar on a graphics card in its housing": of_rover(HOUSED[-1]),
    "lidar that starts outside of its housing": of_rover(*HOUSED),
    "lidar above its housing": of_rover(
        *HOUSED,
        Change("<min>0.1", "<min>0.01"),
        Change("<topic>scan", "<pose>0 0 0.1 0 0 0</pose><topic>scan"),
    ),
    "collision smaller than its visual": of_rover(
        Change(CHASSIS, CHASSIS.replace("0.4 0.3 0.12", "0.1 0.1 0.1"))
    ),
    "marker that is no collision": of_rover(
        Change(
            '<link name="imu_link"/>',
            '<link name="imu_link"><visual><geometry><sphere radius="0.005"/></geometry></visual>'
            '<collision><origin xyz="0 0 0.07"/><geometry><sphere radius="0.001"/></geometry>'
            "</collision></link>",
        )
    ),
    "mesh that is turned and moved": of_arm(
        Change(
            '<link name="upper_arm">',
            '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
            '</visual><collision><origin xyz="0 0 0.3" rpy="0 1.57 0"/><geometry><mesh '
            'filename="package://p/a.stl"/></geometry></collision>',
        )
    ),
    "centre of mass of a link with a boom": of_rover(*centre("0 0 0.4")),
    "placeholder of a mass": of_rover(
        *centre("3 0 0"), Change(BASE_MASS, '<mass value="0.0001"/>')
    ),
    "motor that holds its tool": of_arm(*tool("revolute", "0 1 0", STRONG)),
    "weak motor with an upright axis": of_arm(*tool("revolute", "0 0 1", WEAK)),
    "weak motor that is balanced": of_arm(*tool("revolute", "0 1 0", WEAK, at="0 0 0.5")),
    "weak joint that follows another": of_arm(
        *tool("revolute", "0 1 0", WEAK, '<mimic joint="wrist" multiplier="0.3"/>')
    ),
    "weak motor without gravity": of_arm(
        *tool("revolute", "0 1 0", WEAK),
        Change("</robot>", '<gazebo reference="tool"><gravity>false</gravity></gazebo></robot>'),
    ),
    "passive joint beside driven ones": of_arm(*tool("revolute", "0 1 0", WEAK), *starting("0")),
    "finger that follows a little further": of_arm(*mimics('multiplier="1.02"')),
    "finger that follows the other way with other limits": of_arm(
        *mimics('multiplier="-1"'),
        Change(
            '<axis xyz="0 -1 0"/>\n    <limit lower="0" upper="0.04"',
            '<axis xyz="0 1 0"/><limit lower="-0.04" upper="0"',
        ),
    ),
    "shoulder that starts at its limit": of_arm(*starting("1.5")),
    "wrist of many turns": of_arm(Change('lower="-3" upper="3"', 'lower="-30" upper="30"')),
}


@pytest.mark.parametrize("name", HEALTHY)
def test_what_is_odd_and_healthy_is_left_alone(name: str) -> None:
    assert codes(HEALTHY[name].robot) == set()


SIDE = '<joint name="j" type="fixed"><parent link="hip"/><child link="thigh"/>%s</joint>'
HIP = """<robot name="r"><link name="hip">
<visual><geometry><sphere radius="0.05"/></geometry></visual>
<collision><origin xyz="0 0.2 0"/><geometry><sphere radius="0.05"/></geometry></collision>
</link><link name="thigh"><visual><geometry><box size="%s"/></geometry></visual></link>%s</robot>
"""


@pytest.mark.parametrize(
    ("size", "at", "found"),
    [
        ("0.1 0.1 0.1", '<origin xyz="0 0.2 0"/>', set()),
        ("0.1 0.5 0.1", "", set()),
        ("0.1 0.1 0.1", '<origin xyz="0 0.2 0.2"/>', {"MB631"}),
        ("0.1 0.1 0.1", "", {"MB631"}),
    ],
)
def test_a_collision_where_the_next_link_is_seen_is_meant(
    size: str, at: str, found: set[str]
) -> None:
    assert codes(HIP % (size, SIDE % at)) == found


def test_the_message_has_the_value_that_would_pass() -> None:
    """Mass 3 kg, 0.5 m from the axis: 14.7 Nm."""
    robot, _ = of_arm(*tool("revolute", "0 1 0", WEAK))
    (found,) = lint_data("robot.urdf", robot.encode(), GEOMETRY)
    assert "14.7 Nm" in found.hint
    strong = robot.replace('upper="1" effort="10"', 'upper="1" effort="14.72"')
    assert codes(strong) == set()


def test_every_rule_of_geometry_has_a_defect() -> None:
    assert PLANTED.keys() == {
        it for it in RULES if ("MB620" <= it < "MB7" and it != "MB636") or it in ("MB536", "MB537")
    }
