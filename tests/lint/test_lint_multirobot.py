# SPDX-License-Identifier: Apache-2.0
"""MB4: what is reported for a second robot, and what is not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lint_calls import Settings, lint_file

from multibot_rewrite.base.naming import make_naming

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
DRIVE = '<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so">{}</plugin></gazebo>'
CONTROL = '<gazebo><plugin name="c" filename="gz_ros2_control-system">{}</plugin></gazebo>'
SENSOR = '<link name="a"/><gazebo reference="a"><sensor name="s" type="imu">{}</sensor></gazebo>'
HARDWARE = """<ros2_control name="h" type="system"><hardware><plugin>x/Y</plugin>{}</hardware>
</ros2_control>"""
TWO = ("robot1", "robot2")
BOTH, BARE = make_naming("both"), make_naming("tf-per-robot")
ONE_TF = make_naming("frames-per-robot")


def codes(folder: Path, text: str, select: str = "MB4", **options: Any) -> list[str]:
    ending = "urdf.xacro" if "xmlns:xacro" in text else "urdf"
    file = folder / f"r.{ending}"
    file.write_text(text if text.startswith("<robot") else f'<robot name="r">{text}</robot>')
    found = lint_file(str(file), Settings(select=tuple(select.split()), **options))
    return sorted(it.code for it in found)


def remapped(rule: str) -> str:
    return f"<ros><namespace>n</namespace><remapping>{rule}</remapping></ros>"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (DRIVE.format(remapped("cmd_vel:=/cmd_vel")), ["MB401"]),
        (DRIVE.format(remapped("cmd_vel:=cmd")), []),
        (DRIVE.format(remapped("odom:=/tf")), []),
        (DRIVE.format(remapped("odom:=/clock")), []),
        (DRIVE.format(remapped("odom:=/")), []),
        (DRIVE.format(remapped("nonsense")), []),
        (DRIVE.format(remapped("")), []),
        (CONTROL.format(remapped("odom:=/odom")), ["MB401"]),
        (CONTROL.format(remapped("odom:=odom")), []),
        (SENSOR.format("<topic>/imu</topic>"), ["MB402"]),
    ],
)
def test_absolute_topics(text: str, expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, text, "MB401 MB402 MB426") == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (SENSOR.format("<topic>imu</topic>"), ["MB402"]),
        (SENSOR.format("<topic>__default_topic__</topic>"), []),
        (SENSOR.format("<topic/>"), []),
        (SENSOR.format("<topic>/clock</topic>"), []),
        # Gazebo Classic puts the model's name before it, or does not read it.
        (SENSOR.format('<topic>i</topic><plugin name="p" filename="libgazebo_ros_imu.so"/>'), []),
        (
            SENSOR.format('<topic>i</topic><plugin name="p" filename="gz-sim-imu-system"/>'),
            ["MB402"],
        ),
    ],
)
def test_gz_topics(text: str, expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, text, "MB402") == expected


@pytest.mark.parametrize(
    ("namespace", "expected"),
    [("/demo", ["MB403"]), ("demo/", ["MB403"]), ("/", []), ("", []), ("${ns}", [])],
)
def test_namespaces(namespace: str, expected: list[str], tmp_path: Path) -> None:
    text = DRIVE.format(f"<ros><namespace>{namespace}</namespace></ros>")
    assert codes(tmp_path, text, "MB403") == expected
    assert codes(tmp_path, text + text, "MB403") == expected  # a namespace is reported once


FRAME = '<link name="base"/><link name="x/laser"/><gazebo reference="base">{}</gazebo>'


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        ("robot1/base", ["MB404"]),
        ("/robot1/base", ["MB404"]),
        ("base", []),
        ("/base", []),
        ("x/laser", []),
        ("y/x/laser", ["MB404"]),
        ("robot1/elsewhere", []),
        ("", []),
        ("/", []),
    ],
)
def test_names_of_robots_in_frames(frame: str, expected: list[str], tmp_path: Path) -> None:
    sensor = f'<sensor name="s" type="gpu_lidar"><gz_frame_id>{frame}</gz_frame_id></sensor>'
    assert codes(tmp_path, FRAME.format(sensor), "MB404") == expected


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ("", ["MB406", "MB406"]),
        ("<odometry_frame>odom</odometry_frame>", ["MB406", "MB407"]),
        ("<odometry_frame>world</odometry_frame>", ["MB406"]),
        ("<odometry_frame>r/odom</odometry_frame>", ["MB406", "MB407"]),
        ("<odometry_frame/>", ["MB406"]),
    ],
)
def test_frames_of_odometry(inside: str, expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, DRIVE.format(inside), "MB406 MB407") == expected


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ("", []),
        ("<publish_odom_tf>true</publish_odom_tf>", ["MB408"]),
        ("<publish_odom_tf>1</publish_odom_tf>", ["MB408"]),
        ("<publish_odom_tf>false</publish_odom_tf>", []),
        ("<publish_wheel_tf> True </publish_wheel_tf>", ["MB408"]),
        ("<publish_odom_tf>true</publish_odom_tf>" + remapped("/tf:=tf"), []),
        ("<publish_odom_tf>true</publish_odom_tf>" + remapped("odom:=tf"), ["MB408"]),
    ],
)
def test_tf_of_plugins(inside: str, expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, DRIVE.format(inside), "MB408") == expected


def test_tf_that_is_on_unless_switched_off(tmp_path: Path) -> None:
    text = DRIVE.replace("diff_drive", "planar_move")
    assert codes(tmp_path, text.format(""), "MB408") == ["MB408"]
    assert codes(tmp_path, text.format("<publish_odom_tf>false</publish_odom_tf>"), "MB408") == []


def test_where_robots_share_tf_no_rule_is_missing(tmp_path: Path) -> None:
    text = DRIVE.format("<publish_odom_tf>true</publish_odom_tf>")
    assert codes(tmp_path, text, "MB408", robots=TWO, naming=ONE_TF) == []
    assert codes(tmp_path, text, "MB408", robots=TWO, naming=BOTH) == ["MB408"]
    assert codes(tmp_path, text, "MB408", robots=TWO) == ["MB408"]


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("/dev/ttyUSB0", 1),
        ("192.168.1.10", 1),
        (" 192.168.1.10:502 ", 1),
        ("can0", 1),
        ("COM3", 1),
        ("127.0.0.1", 0),
        ("0.0.0.0", 0),
        ("1.2.3", 0),
        ("can", 0),
        ("scan0", 0),
        ("", 0),
    ],
)
def test_devices(value: str, expected: int, tmp_path: Path) -> None:
    text = HARDWARE.format(f'<param name="port">{value}</param>')
    assert codes(tmp_path, text, "MB412") == ["MB412"] * expected


@pytest.mark.parametrize(
    ("library", "expected"),
    [
        ("gz-sim-imu-system", 1),
        ("libignition-gazebo6-sensors-system.so", 1),
        ("gz-sim-joint-state-publisher-system", 0),
        ("", 0),
    ],
)
def test_systems_of_the_world(library: str, expected: int, tmp_path: Path) -> None:
    text = f'<gazebo><plugin name="x" filename="{library}"/></gazebo>'
    assert codes(tmp_path, text, "MB416") == ["MB416"] * expected


# ---------------------------------------------------------------- xacro: what a caller can give

LIDAR = (
    f'<robot name="r" {XACRO}><xacro:arg name="ns" default=""/>'
    '<xacro:property name="base" value="$(arg ns)/scan"/>'
    '<xacro:macro name="lidar" params="topic frame:=a"><link name="a"/><gazebo reference="a">'
    '<sensor name="s" type="gpu_lidar"><topic>{}</topic></sensor></gazebo></xacro:macro>'
    '<xacro:lidar topic="{}"/></robot>'
)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("inside", "given", "expected"),
    [
        ("scan", "x", ["MB402"]),
        ("${topic}", "scan", ["MB402"]),
        ("${topic}", "$(arg ns)/scan", []),
        ("${topic}", "${base}", []),
        ("$(arg ns)/scan", "x", []),
        # A default may be another one in another call.
        ("${frame}/scan", "x", []),
        ("${'a' + topic}", "scan", ["MB402"]),
    ],
)
def test_values_that_a_caller_can_give(
    inside: str, given: str, expected: list[str], tmp_path: Path
) -> None:
    assert codes(tmp_path, LIDAR.format(inside, given), "MB402") == expected


MACRO = f'<robot name="r" {XACRO}><xacro:macro name="m" params="{{}}">{{}}</xacro:macro></robot>'
JOINT = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint>'
MIMIC = JOINT.format("${{prefix}}j", "${{prefix}}a", "${{prefix}}b").replace(
    "</joint>", '<mimic joint="{}"/></joint>'
)
LINKS = '<link name="${prefix}a"/><link name="${prefix}b"/>'


@pytest.mark.parametrize(
    ("params", "inside", "expected"),
    [
        ("prefix", LINKS + '<link name="c"/>', ["MB417"]),
        ("prefix:=''", LINKS + '<link name="c"/>', ["MB417"]),
        ("*origin prefix:=^|x_", LINKS + '<link name="c"/>', ["MB417"]),
        ("tf_prefix", LINKS.replace("prefix", "tf_prefix") + '<link name="c"/>', ["MB417"]),
        ("prefix", LINKS, []),
        ("prefix", LINKS + '<link name="world"/>', []),
        # A value in place of a name may hold the prefix: unknown.
        ("prefix name", LINKS + '<link name="${name}"/>', []),
        # Most are bare: it is meant so.
        ("prefix", '<link name="${prefix}a"/><link name="b"/><link name="c"/>', []),
        # Links have it, joints have not, as where a namespace parts them.
        ("prefix", LINKS + JOINT.format("j", "${prefix}a", "${prefix}b"), []),
        ("prefix", LINKS + JOINT.format("${prefix}j", "a", "${prefix}b"), ["MB417"]),
        ("prefix", LINKS + JOINT.format("${prefix}j", "tool0", "${prefix}b"), []),
        ("prefix", LINKS + '<gazebo reference="a"/>', ["MB417"]),
        ("prefix", LINKS + JOINT.format("${prefix}j", "${prefix}a", "b"), ["MB417"]),
        ("prefix", LINKS + MIMIC.format("j"), ["MB417"]),
        ("prefix", LINKS + MIMIC.format("${prefix}j"), []),
        ("prefix", LINKS + "<gazebo><plugin><link_name>a</link_name></plugin></gazebo>", ["MB417"]),
        ("prefix", LINKS + "<gazebo><plugin><topic>a</topic></plugin></gazebo>", []),
        # Carried on by a property.
        (
            "prefix",
            '<xacro:property name="p" value="${prefix}x_"/><link name="${p}a"/><link name="b"/>',
            ["MB417"],
        ),
        ("name", '<link name="${name}a"/><link name="c"/>', []),
        ("prefix", '<link name="a"/>', ["MB418"]),
        ("prefix", '<link name="a"/><xacro:other/>', []),
        ("prefix", '<link name="a"/><xacro:if value="${prefix == \'\'}"/>', []),
        ("prefix", "", []),
        ("", LINKS, []),
    ],
)
def test_prefixes_of_macros(params: str, inside: str, expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, MACRO.format(params, inside), "MB417 MB418") == expected


# Where plugins and transmissions name a link, joint or frame: gazebo_ros and gz-sim of any age.
NAMING = [
    "left_joint",
    "right_joint",
    "leftJoint",
    "rightJoint",
    "joint_name",
    "jointName",
    "link_name",
    "linkName",
    "frame_name",
    "frameName",
    "body_name",
    "bodyName",
    "robot_base_frame",
    "robotBaseFrame",
    "child_frame_id",
    "gz_frame_id",
    "ignition_frame_id",
]


@pytest.mark.parametrize("tag", NAMING)
def test_every_element_that_names_a_part_has_the_prefix(tag: str, tmp_path: Path) -> None:
    for name, expected in (("a", ["MB417"]), ("${prefix}a", [])):
        inside = f"{LINKS}<gazebo><plugin><{tag}> {name} </{tag}></plugin></gazebo>"
        assert codes(tmp_path, MACRO.format("prefix", inside), "MB417") == expected


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ('<xacro:arg name="prefix" default=""/><link name="a"/>', ["MB418"]),
        ('<xacro:arg name="prefix" default=""/><link name="$(arg prefix)a"/>', []),
        ('<xacro:arg name="side" default=""/><link name="a"/>', []),
        (
            '<xacro:arg name="prefix" default=""/><link name="$(arg prefix)a"/><link name="b"/>',
            ["MB417"],
        ),
    ],
)
def test_prefixes_of_files(inside: str, expected: list[str], tmp_path: Path) -> None:
    text = f'<robot name="r" {XACRO}>{inside}</robot>'
    assert codes(tmp_path, text, "MB417 MB418") == expected


# ---------------------------------------------------------------- robots with names

ARMS = '<link name="arm"/><link name="arm_left"/>'
JOINTS = '<link name="a"/><link name="b"/><link name="c"/>' + "".join(
    JOINT.format(name, "a", child) for name, child in (("j", "b"), ("j2", "c"))
)


@pytest.mark.parametrize(
    ("text", "options", "expected"),
    [
        ('<link name="a"/><gazebo reference="a/robot1"/>', {}, []),
        ('<link name="a"/><gazebo reference="a/robot1"/>', {"robots": TWO}, ["MB420"]),
        ('<link name="a"/><gazebo reference="b/robot1"/>', {"robots": TWO}, []),
        (ARMS, {"robots": ("left_b", "b"), "naming": BOTH}, []),
        (ARMS, {"robots": ("b",), "naming": BOTH}, []),
        (JOINTS, {}, []),
        (JOINTS, {"robots": TWO}, ["MB405"]),
        (JOINTS, {"robots": TWO, "naming": make_naming("both", "prefix")}, []),
        (JOINTS, {"robots": TWO, "naming": BARE}, []),
    ],
)
def test_names_of_robots_that_meet(
    text: str, options: dict[str, Any], expected: list[str], tmp_path: Path
) -> None:
    assert codes(tmp_path, text, "MB405 MB42", **options) == expected


IMU = SENSOR.format("") + (
    '<ros2_control name="h" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem'
    '</plugin></hardware><sensor name="s"/></ros2_control>'
)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({}, ["MB415"]),
        ({"robots": TWO}, []),
        ({"robots": TWO, "naming": BARE}, ["MB425"]),
        ({"robots": TWO, "naming": BOTH}, []),
    ],
)
def test_sensors_by_bare_name(options: dict[str, Any], expected: list[str], tmp_path: Path) -> None:
    assert codes(tmp_path, IMU, "MB415 MB425", **options) == expected


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "text",
    [
        "",
        "<gazebo/>",
        "<gazebo><plugin/></gazebo>",
        '<gazebo><plugin filename="" name=""><ros/></plugin></gazebo>',
        DRIVE.format("<ros><remapping/><namespace/></ros><odometry_frame> </odometry_frame>"),
        '<gazebo reference=""><sensor><topic/></sensor></gazebo>',
        "<ros2_control><hardware><param/></hardware></ros2_control>",
        '<joint><parent/><child/></joint><link/><link name=""/>',
    ],
)
def test_empty_things_are_no_crash(text: str, tmp_path: Path) -> None:
    for options in ({}, {"robots": TWO}, {"robots": TWO, "naming": make_naming("postfix")}):
        assert "MB001" not in codes(tmp_path, text, "MB", **options)  # type: ignore[arg-type]


NO_SENSOR = IMU.replace('<sensor name="s"/></ros2', "</ros2")


def test_hardware_without_sensors_looks_none_up(tmp_path: Path) -> None:
    """gz_system.cpp looks for the sensors of its component alone."""
    assert "<sensor" in NO_SENSOR
    assert codes(tmp_path, NO_SENSOR, "MB415 MB425", robots=TWO, naming=BARE) == []
    assert codes(tmp_path, NO_SENSOR, "MB415 MB425") == []
    # Others look nothing up.
    other = IMU.replace("gz_ros2_control/GazeboSimSystem", "mock_components/GenericSystem")
    for options in ({}, {"robots": TWO, "naming": BARE}):
        assert codes(tmp_path, other, "MB001 MB415 MB425", **options) == []  # type: ignore[arg-type]
