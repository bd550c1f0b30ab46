# SPDX-License-Identifier: Apache-2.0
"""Defects of geometry planted in two healthy robots, and what is odd in them and healthy.

What a defect breaks was taken from its consumer: gz-sim's DiffDrive, REP 103, gz-rendering, sdformat.
"""

from __future__ import annotations

from collections.abc import Iterator
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
    """A weight on a joint of the arm's wrist."""
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
# Robot, changes, the code that has to be found.
PLANTED: dict[str, tuple[str, list[Change], str]] = {
    "separation is half": (ROVER, [Change(SEPARATION, "<wheel_separation>0.17")], "MB620"),
    "separation is double": (ROVER, [Change(SEPARATION, "<wheel_separation>0.68")], "MB620"),
    "separation in centimetres": (ROVER, [Change(SEPARATION, "<wheel_separation>34")], "MB620"),
    "separation from one wheel to the middle": (
        ROVER,
        [
            Change(LEFT_AT, '<origin xyz="0 0.25 0"/>'),
            Change(RIGHT_AT, '<origin xyz="0 -0.25 0"/>'),
        ],
        "MB620",
    ),
    "separation is left to its default": (
        ROVER,
        [Change(f"{SEPARATION}</wheel_separation>", "")],
        "MB620",
    ),
    "radius is the diameter": (ROVER, [Change(RADIUS, "<wheel_radius>0.14")], "MB620"),
    "radius of another wheel": (ROVER, [Change('radius="0.07"', 'radius="0.1"', 0)], "MB620"),
    "radius in millimetres": (ROVER, [Change(RADIUS, "<wheel_radius>70")], "MB620"),
    "radius is left to its default": (ROVER, [Change(f"{RADIUS}</wheel_radius>", "")], "MB620"),
    "joints are swapped": (
        ROVER,
        [
            Change("<left_joint>left_wheel_joint", "<left_joint>right_wheel_joint"),
            Change("<right_joint>right_wheel_joint", "<right_joint>left_wheel_joint"),
        ],
        "MB622",
    ),
    "one wheel is both": (
        ROVER,
        [Change("<right_joint>right_wheel_joint", "<right_joint>left_wheel_joint")],
        "MB622",
    ),
    "origins are swapped": (ROVER, swapped(LEFT_AT, RIGHT_AT), "MB622"),
    "axes point to the right": (ROVER, [Change(AXIS, '<axis xyz="0 -1 0"/>', 0)], "MB622"),
    "one axis points to the right": (ROVER, [Change(AXIS, '<axis xyz="0 -1 0"/>')], "MB622"),
    "one joint is turned around": (
        ROVER,
        [Change(LEFT_AT, '<origin xyz="0 0.17 0" rpy="0 0 3.14159"/>')],
        "MB622",
    ),
    "one wheel is mounted upside down": (
        ROVER,
        [Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="3.14159 0 0"/>')],
        "MB622",
    ),
    "wheel is fixed": (
        ROVER,
        [Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="fixed')],
        "MB624",
    ),
    "wheel has limits": (
        ROVER,
        [
            Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="revolute'),
            Change(AXIS, f'{AXIS}<limit lower="-3.14" upper="3.14" effort="1" velocity="9"/>'),
        ],
        "MB624",
    ),
    "wheel slides": (
        ROVER,
        [
            Change('right_wheel_joint" type="continuous', 'right_wheel_joint" type="prismatic'),
            Change(RIGHT_AT, f'{RIGHT_AT}<limit lower="0" upper="1" effort="1" velocity="9"/>'),
        ],
        "MB624",
    ),
    "optical frame is not turned": (ROVER, [Change(OPTICAL, 'rpy="0 0 0"')], "MB625"),
    "optical frame without an origin": (
        ROVER,
        [Change(f'<origin xyz="0 0 0" {OPTICAL}/>', "")],
        "MB625",
    ),
    "camera at its optical frame": (
        ROVER,
        [Change('reference="camera_link"', 'reference="camera_optical_frame"')],
        "MB626",
    ),
    "depth camera at its optical frame": (
        ROVER,
        [
            Change('reference="camera_link"', 'reference="camera_optical_frame"'),
            Change('type="camera"', 'type="rgbd_camera"'),
        ],
        "MB626",
    ),
    "lidar below the ground": (ROVER, [Change(LIDAR_AT, 'xyz="0.1 0 -0.12"')], "MB627"),
    "camera below the ground": (ROVER, [Change(CAMERA_AT, 'xyz="0.2 0 -0.08"')], "MB627"),
    "lidar whose pose is below the ground": (
        ROVER,
        [Change("<topic>scan", "<pose>0 0 -0.3 0 0 0</pose><topic>scan")],
        "MB627",
    ),
    "angles of a lidar swapped": (ROVER, [Change("<lidar>", scan("3.1", "-3.1"))], "MB628"),
    "ranges of a lidar swapped": (ROVER, [Change(RANGE, "<min>12</min><max>0.1</max>")], "MB628"),
    "range of a lidar in millimetres and metres": (
        ROVER,
        [Change(RANGE, "<min>100</min><max>12</max>")],
        "MB628",
    ),
    "clip planes swapped": (ROVER, clip("300", "0.02"), "MB629"),
    "clip planes alike": (ROVER, clip("0.1", "0.1"), "MB629"),
    "near plane at the lens": (ROVER, clip("0", "100"), "MB629"),
    "near plane behind the lens": (ROVER, clip("-0.1", "100"), "MB629"),
    "lidar in its housing": (ROVER, [*HOUSED, Change("<min>0.1", "<min>0.02")], "MB630"),
    "lidar of Gazebo Classic": (ROVER, [CPU], "MB637"),
    "lidar deep in a box": (
        ROVER,
        [
            *HOUSED,
            Change(f"<collision>{ROUND}", '<collision><geometry><box size="1 1 1"/></geometry>'),
        ],
        "MB630",
    ),
    "collision in centimetres away": (
        ROVER,
        [Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="0 0 5"/><geometry>'))],
        "MB631",
    ),
    "collision with a wrong sign": (
        ROVER,
        [
            Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="-0.3 0 0"/><geometry>')),
            Change("<visual>\n      <geometry>", '<visual><origin xyz="0.3 0 0"/><geometry>'),
        ],
        "MB631",
    ),
    "one mesh at two places": (
        ARM,
        [
            Change(
                '<link name="upper_arm">',
                '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
                '</visual><collision><origin xyz="0 0 0.3"/><geometry><mesh filename="package://p/a.stl"/>'
                "</geometry></collision>",
            )
        ],
        "MB631",
    ),
    "centre of mass in millimetres": (ROVER, centre("12 0 3"), "MB632"),
    "centre of mass in another frame": (ROVER, centre("0 0 0.9"), "MB632"),
    "centre of mass of a mesh in millimetres": (
        ARM,
        [
            Change(
                '<link name="upper_arm">\n    <inertial>',
                '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
                '</visual><inertial><origin xyz="0 0 200"/>',
            )
        ],
        "MB632",
    ),
    "motor too weak for its tool": (ARM, tool("revolute", "0 1 0", WEAK), "MB633"),
    "motor too weak for a lift": (ARM, tool("prismatic", "0 0 1", WEAK), "MB633"),
    "motor too weak further up": (
        ARM,
        [Change('effort="20"', 'effort="9"'), *tool("fixed", "0 0 1", "")],
        "MB633",
    ),
    "too heavy in front": (ROVER, centre("0.26 0 0.05"), "MB634"),
    "too heavy on one side": (ROVER, centre("0 0.25 0"), "MB634"),
    "wheels far behind": (
        ROVER,
        [
            Change(LEFT_AT, '<origin xyz="-0.5 0.17 0"/>'),
            Change(RIGHT_AT, '<origin xyz="-0.5 -0.17 0"/>'),
            Change(CHASSIS, CHASSIS.replace("<geometry>", '<origin xyz="0 0 0.05"/><geometry>')),
        ],
        "MB634",
    ),
    "finger follows too far": (ARM, mimics('multiplier="3"'), "MB536"),
    "finger follows the wrong way": (ARM, mimics('multiplier="-1"'), "MB536"),
    "finger follows with an offset": (ARM, mimics('offset="0.1"'), "MB536"),
    "shoulder starts in degrees": (ARM, starting("45"), "MB537"),
    "shoulder starts beyond its limit": (ARM, starting("-1.6"), "MB537"),
    "shoulder is sent beyond its limit": (ARM, controlled("2"), "MB537"),
}


def planted(robot: str, changes: list[Change]) -> str:
    for old, new, times in changes:
        assert old in robot, old
        robot = robot.replace(old, new, times or -1)
    return robot


def codes(robot: str) -> set[str]:
    return {it.code for it in lint_data("robot.urdf", robot.encode(), GEOMETRY)}


def linted(robot: str, _folder: Path) -> set[str]:
    """What all rules find in it."""
    return {it.code for it in lint_data("robot.urdf", robot.encode(), Settings())}


def defects() -> Iterator[tuple[str, str, str]]:
    """Each planted defect, the robot without it, and its code."""
    for robot, changes, code in PLANTED.values():
        yield planted(robot, changes), robot, code


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_defect_is_found(name: str) -> None:
    robot, changes, code = PLANTED[name]
    assert code in codes(planted(robot, changes))


@pytest.mark.parametrize("robot", [ROVER, ARM], ids=["rover", "arm"])
def test_the_robots_are_healthy_before(robot: str) -> None:
    assert codes(robot) == set()


HEALTHY: dict[str, tuple[str, list[Change]]] = {
    "robot that drives along -x": (
        ROVER,
        [*swapped(LEFT_AT, RIGHT_AT), Change(AXIS, '<axis xyz="0 -1 0"/>', 0)],
    ),
    "wheels turned with their joints": (
        ROVER,
        [
            Change(LEFT_AT, '<origin xyz="0 0.17 0" rpy="-1.5708 0 0"/>'),
            Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="-1.5708 0 0"/>'),
            Change(AXIS, '<axis xyz="0 0 1"/>', 0),
            Change('<origin rpy="1.5708 0 0"/>', "", 0),
        ],
    ),
    "mirrored wheels whose axes agree": (
        ROVER,
        [
            Change(RIGHT_AT, '<origin xyz="0 -0.17 0" rpy="0 0 3.14159"/>'),
            Change(AXIS, "@"),
            Change(AXIS, '<axis xyz="0 -1 0"/>'),
            Change("@", AXIS),
        ],
    ),
    "separation to the outside of wide wheels": (
        ROVER,
        [Change(SEPARATION, "<wheel_separation>0.365")],
    ),
    "wheel that is a sphere": (
        ROVER,
        [Change('<cylinder radius="0.07" length="0.04"/>', '<sphere radius="0.07"/>', 0)],
    ),
    "wheels of meshes": (
        ROVER,
        [
            Change(
                '<cylinder radius="0.07" length="0.04"/>', '<mesh filename="package://p/w.stl"/>', 0
            )
        ],
    ),
    "wheel with a hub": (
        ROVER,
        [
            Change(
                ROUND,
                f"{ROUND}</collision><collision><geometry>"
                '<cylinder radius="0.02" length="0.1"/></geometry>',
            )
        ],
    ),
    "separation that is no number": (ROVER, [Change(SEPARATION, "<wheel_separation>wide")]),
    "wheel with limits of many turns": (
        ROVER,
        [
            Change('left_wheel_joint" type="continuous', 'left_wheel_joint" type="revolute'),
            Change(AXIS, f'{AXIS}<limit lower="-1e16" upper="1e16" effort="1" velocity="9"/>'),
        ],
    ),
    "wheels that steer themselves": (
        ROVER,
        [Change("<left_joint>left_wheel_joint", "<left_joint>other")],
    ),
    "optical frame of an optical frame": (
        ROVER,
        [
            Change(
                "</robot>",
                '<link name="rgb_optical_frame"/><joint name="o" type="fixed"><parent '
                'link="camera_optical_frame"/><child link="rgb_optical_frame"/></joint></robot>',
            )
        ],
    ),
    "camera that looks up on purpose": (
        ROVER,
        [Change(OPTICAL, 'rpy="0 0 0.7854"')],
    ),
    "camera link turned as its optical frame": (
        ROVER,
        [
            Change(f'{CAMERA_AT} rpy="0 0 0"', f"{CAMERA_AT} {OPTICAL}"),
            Change(f'xyz="0 0 0" {OPTICAL}', 'xyz="0 0 0"'),
        ],
    ),
    "sensor of optical flow": (
        ROVER,
        [Change("camera_link", "optical_flow_link", 0)],
    ),
    "camera turned back at its optical frame": (
        ROVER,
        [
            Change('reference="camera_link"', 'reference="camera_optical_frame"'),
            Change("<topic>front", "<pose>0 0 0 1.5708 -1.5708 0</pose><topic>front"),
        ],
    ),
    "lidar just above the ground": (ROVER, [Change(LIDAR_AT, 'xyz="0.1 0 -0.065"')]),
    "imu below the ground": (ROVER, [Change('xyz="0 0 0.02"', 'xyz="0 0 -0.2"')]),
    "sensor in a frame of its own": (
        ROVER,
        [Change("<topic>scan", '<pose relative_to="imu_link">0 0 -9 0 0 0</pose><topic>scan')],
    ),
    "classic lidar that scans backwards": (
        ROVER,
        [
            CPU,
            SENT,
            Change("<lidar>", scan("2.2", "-2.2").replace("<lidar>", "<ray>")),
            Change("</lidar>", "</ray>"),
        ],
    ),
    "lidar of one ray": (ROVER, [Change("<lidar>", scan("0", "0"))]),
    "lidar of a whole turn": (ROVER, [Change("<lidar>", scan("0", "6.28319"))]),
    "clip planes with one default": (ROVER, [Change(CAMERA, "<camera><clip><far>10</far></clip>")]),
    "lidar on a graphics card in its housing": (ROVER, [HOUSED[-1]]),
    "lidar that starts outside of its housing": (ROVER, HOUSED),
    "lidar above its housing": (
        ROVER,
        [
            *HOUSED,
            Change("<min>0.1", "<min>0.01"),
            Change("<topic>scan", "<pose>0 0 0.1 0 0 0</pose><topic>scan"),
        ],
    ),
    "collision smaller than its visual": (
        ROVER,
        [Change(CHASSIS, CHASSIS.replace("0.4 0.3 0.12", "0.1 0.1 0.1"))],
    ),
    "marker that is no collision": (
        ROVER,
        [
            Change(
                '<link name="imu_link"/>',
                '<link name="imu_link"><visual><geometry><sphere radius="0.005"/></geometry></visual>'
                '<collision><origin xyz="0 0 0.07"/><geometry><sphere radius="0.001"/></geometry>'
                "</collision></link>",
            )
        ],
    ),
    "mesh that is turned and moved": (
        ARM,
        [
            Change(
                '<link name="upper_arm">',
                '<link name="upper_arm"><visual><geometry><mesh filename="package://p/a.stl"/></geometry>'
                '</visual><collision><origin xyz="0 0 0.3" rpy="0 1.57 0"/><geometry><mesh '
                'filename="package://p/a.stl"/></geometry></collision>',
            )
        ],
    ),
    "centre of mass of a link with a boom": (ROVER, centre("0 0 0.4")),
    "placeholder of a mass": (
        ROVER,
        [*centre("3 0 0"), Change(BASE_MASS, '<mass value="0.0001"/>')],
    ),
    "motor that holds its tool": (ARM, tool("revolute", "0 1 0", STRONG)),
    "weak motor with an upright axis": (ARM, tool("revolute", "0 0 1", WEAK)),
    "weak motor that is balanced": (ARM, tool("revolute", "0 1 0", WEAK, at="0 0 0.5")),
    "weak joint that follows another": (
        ARM,
        tool("revolute", "0 1 0", WEAK, '<mimic joint="wrist" multiplier="0.3"/>'),
    ),
    "weak motor without gravity": (
        ARM,
        [
            *tool("revolute", "0 1 0", WEAK),
            Change(
                "</robot>", '<gazebo reference="tool"><gravity>false</gravity></gazebo></robot>'
            ),
        ],
    ),
    "passive joint beside driven ones": (ARM, [*tool("revolute", "0 1 0", WEAK), *starting("0")]),
    "finger that follows a little further": (ARM, mimics('multiplier="1.02"')),
    "finger that follows the other way with other limits": (
        ARM,
        [
            *mimics('multiplier="-1"'),
            Change(
                '<axis xyz="0 -1 0"/>\n    <limit lower="0" upper="0.04"',
                '<axis xyz="0 1 0"/><limit lower="-0.04" upper="0"',
            ),
        ],
    ),
    "shoulder that starts at its limit": (ARM, starting("1.5")),
    "wrist of many turns": (ARM, [Change('lower="-3" upper="3"', 'lower="-30" upper="30"')]),
}


@pytest.mark.parametrize("name", HEALTHY)
def test_what_is_odd_and_healthy_is_left_alone(name: str) -> None:
    assert codes(planted(*HEALTHY[name])) == set()


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
    robot = planted(ARM, tool("revolute", "0 1 0", WEAK))
    (found,) = lint_data("robot.urdf", robot.encode(), GEOMETRY)
    assert "14.7 Nm" in found.hint
    strong = robot.replace('upper="1" effort="10"', 'upper="1" effort="14.72"')
    assert codes(strong) == set()


def test_every_rule_of_geometry_has_a_defect() -> None:
    assert {code for *_, code in PLANTED.values()} == {
        it for it in RULES if ("MB620" <= it < "MB7" and it != "MB636") or it in ("MB536", "MB537")
    }
