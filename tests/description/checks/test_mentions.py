# SPDX-License-Identifier: Apache-2.0
"""Names in values that no site claims: where they are seen, and what is no name."""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite
from multibot_rewrite.description.checks.mentions import mentioned

NAMES = frozenset(("wl", "wr", "arm.left", "a::b", "robot1/base", "x|y"))
PLAIN = frozenset(("wl", "wr", "arm"))


@pytest.mark.parametrize(
    ("value", "name"),
    [
        ("wl", "wl"),
        ('["wl","wr"]', "wl"),
        ("['wr']", "wr"),
        ("{left: wl}", "wl"),
        ("{left:wr, right:wl}", "wr"),
        ("left=wl|right=wr", "wl"),
        ("wr.position", "wr"),
        ("(wl)", "wl"),
        ("f(wr)", "wr"),
        ("joints: [a, wr]", "wr"),
        ("wl/position", "wl"),
        ("rover::wl", "wl"),
        ("a:=wl", "wl"),
        ("a;wl", "wl"),
        ("package://p/m.dae;wl", "wl"),
        ("arm.left, other", "arm.left"),
        ("[arm.left]", "arm.left"),
        ("(a::b)", "a::b"),
        ("{at: robot1/base}", "robot1/base"),
        ("x|y", "x|y"),
    ],
)
def test_a_name_is_seen_between_whatever_separates(value: str, name: str) -> None:
    assert mentioned(value, NAMES) == name


@pytest.mark.parametrize(
    "value",
    [
        "wl_joint",
        "wlx",
        "the-wl",
        "WL",
        "wl.dae",
        "meshes/wl/wl.STL",
        "arm.yaml",
        "package://arm/meshes/wl",
        "package://wl/meshes/arm.dae",
        "file:///home/arm/wl",
        "model://arm",
        '["meshes/wl.stl", "arm.png"]',
        "libarm.so",
        "arm/arm.so",
        "1.0 2.0 wl_",
        "",
    ],
)
def test_parts_of_words_files_and_addresses_are_no_names(value: str) -> None:
    assert mentioned(value, PLAIN) == ""


@pytest.mark.parametrize(
    ("element", "warned"),
    [
        ("<link name='wr'>wl</link>", False),
        ("<own><link name='wr'>wl</link></own>", True),
        ("<link name='wr' like='wl'/>", True),
        # A call that xacro left: no parser of a URDF reads a parent of a child of <robot>.
        ("<cam parent='wl'><origin/></cam>", False),
        ("<own><cam parent='wl'><origin/></cam></own>", True),
        ("<cam parent='wl'/>", True),
    ],
)
def test_text_of_a_link_is_read_by_nobody(element: str, warned: bool) -> None:
    found = rewrite(f"<robot name='r'><link name='wl'/>{element}</robot>", "robot1").findings
    assert ("MB901" in {it.code for it in found}) is warned


@pytest.mark.parametrize(
    ("library", "row", "warned"),
    [
        # gazebo_ros_joint_state_publisher.cpp reads update_rate and joint_name.
        ("gazebo_ros_joint_state_publisher", "<odometry_frame>odom</odometry_frame>", False),
        ("gazebo_ros_joint_state_publisher", "<extra>wl</extra>", False),
        ("gazebo_ros_joint_state_publisher", "<extra><more>wl</more></extra>", False),
        # gazebo_ros node.cpp reads namespace, remapping, argument, parameter and qos of a <ros>.
        ("gazebo_ros_imu_sensor", "<ros><frame_name>wl</frame_name></ros>", False),
        ("acme", "<ros><frame_name>wl</frame_name></ros>", True),
        # ROS 2's plugin reads <left_joint> (gazebo_ros_diff_drive.cpp), ROS 1's <leftJoint>.
        ("gazebo_ros_diff_drive", "<leftJoint>j</leftJoint>", False),
        # Of another library nobody knows what it reads.
        ("acme", "<odometry_frame>odom</odometry_frame>", True),
        ("acme", "<extra>wl</extra>", True),
    ],
)
def test_what_a_known_plugin_does_not_read_is_no_mention(
    library: str, row: str, warned: bool
) -> None:
    joint = '<joint name="j" type="fixed"><parent link="wl"/><child link="wr"/></joint>'
    plugin = f'<plugin name="p" filename="lib{library}.so"><joint_name>j</joint_name>{row}</plugin>'
    text = f'<robot name="r"><link name="wl"/><link name="wr"/>{joint}<gazebo>{plugin}</gazebo></robot>'
    found = {it.code for it in rewrite(text.encode(), "robot1", distro="humble").findings}
    assert ("MB901" in found) is warned
