# SPDX-License-Identifier: Apache-2.0
"""What a description starts, by the names that its consumers' sources give it."""

from __future__ import annotations

import pytest
from description_calls import NEWEST_LTS, Reading, load_definitions, read, wheels_in
from lxml.etree import fromstring


def reading(inside: str, root: str = "robot", release: str = NEWEST_LTS) -> Reading:
    text = f"<{root} name='r'>{inside}</{root}>"
    return read(text.encode(), "r.urdf", load_definitions((), release))


def names(inside: str, *kinds: str, release: str = NEWEST_LTS) -> list[str]:
    found = reading(inside, release=release).names
    return [it.name for it in found if it.kind in (kinds or ("topic", "service"))]


def plugin(library: str, inside: str = "", name: str = "p") -> str:
    return f'<gazebo><plugin name="{name}" filename="{library}">{inside}</plugin></gazebo>'


# gazebo_ros node.cpp: ns = text of <namespace>, "/" without it; a <ros> hides what is beside it;
# rclcpp puts a missing slash in front.
@pytest.mark.parametrize(
    ("inside", "node", "topic"),
    [
        ("", "/p", "/cmd_vel"),
        ("<ros/>", "/p", "/cmd_vel"),
        ("<ros><namespace>/a</namespace></ros>", "/a/p", "/a/cmd_vel"),
        ("<ros><namespace>a</namespace></ros>", "/a/p", "/a/cmd_vel"),
        ("<ros><namespace>/</namespace></ros>", "/p", "/cmd_vel"),
        ("<ros><namespace></namespace></ros>", "/p", "/cmd_vel"),
        ("<ros><namespace/></ros>", "/p", "/cmd_vel"),
        ("<ros><namespace>  </namespace></ros>", "/p", "/cmd_vel"),
        ("<ros><namespace><!-- x -->/a</namespace></ros>", "/a/p", "/a/cmd_vel"),
        ("<namespace>/a</namespace>", "/a/p", "/a/cmd_vel"),
        ("<namespace>/a</namespace><ros/>", "/p", "/cmd_vel"),
        ("<ros><remapping>cmd_vel:=b</remapping></ros>", "/p", "/b"),
        ("<remapping>cmd_vel:=b</remapping>", "/p", "/b"),
        ("<remapping>cmd_vel:=b</remapping><ros/>", "/p", "/cmd_vel"),
        ("<ros><remapping><!-- x -->cmd_vel:=/b</remapping></ros>", "/p", "/b"),
        ("<ros><remapping>cmd_vel:=b</remapping><namespace>a</namespace></ros>", "/a/p", "/a/b"),
        ("<ros><remapping>cmd_vel := b</remapping></ros>", "/p", "/cmd_vel"),
    ],
)
def test_the_node_of_a_classic_plugin(inside: str, node: str, topic: str) -> None:
    text = plugin("libgazebo_ros_diff_drive.so", inside)
    assert names(text, "node") == [node]
    assert topic in names(text)


# gz-sim SystemLoader.cc: lib, .so, a version and the old family's name do not count.
@pytest.mark.parametrize(
    ("library", "name"),
    [
        ("gz-sim-diff-drive-system", "gz::sim::systems::DiffDrive"),
        ("libgz-sim-diff-drive-system.so", "any label"),
        ("gz-sim8-diff-drive-system", "x"),
        ("libignition-gazebo6-diff-drive-system.so", "x"),
        ("ignition-gazebo-diff-drive-system", "ignition::gazebo::systems::DiffDrive"),
        ("my-own-name", "gz::sim::systems::DiffDrive"),
        ("my-own-name", "ignition::gazebo::systems::DiffDrive"),
        ("/opt/lib/libgz-sim-diff-drive-system.so", "x"),
    ],
)
def test_names_of_a_system(library: str, name: str) -> None:
    text = plugin(library, "<topic>drive</topic><odom_topic>/o</odom_topic>", name)
    assert names(text) == ["/drive", "/o"]
    assert not reading(text).unknown


# gz-sensors CameraSensor.cc: camera_info is beside the image, unless it is given.
@pytest.mark.parametrize(
    ("kind", "inside", "found"),
    [
        ("imu", "<topic>scan</topic>", {"/scan"}),
        ("imu", "<topic><!-- c -->imu</topic>", {"/imu"}),
        ("camera", "<topic/>", set()),
        ("camera", "", set()),
        ("camera", "<topic>front/image</topic>", {"/front/image", "/front/camera_info"}),
        ("camera", "<topic>image</topic>", {"/image", "/camera_info"}),
        (
            "camera",
            "<topic>a/b</topic><camera><camera_info_topic>c</camera_info_topic></camera>",
            {"/a/b", "/c"},
        ),
    ],
)
def test_topics_of_a_sensor(kind: str, inside: str, found: set[str]) -> None:
    text = f'<gazebo reference="l"><sensor name="s" type="{kind}">{inside}</sensor></gazebo>'
    assert set(names(text)) == found


def test_a_control_plugin_reads_its_settings_in_ros_alone() -> None:
    """gz_ros2_control_plugin.cpp: <ros> is asked for, nothing beside it is a namespace."""
    inside = "<namespace>/a</namespace><remapping>/tf:=b</remapping>"
    text = plugin("gz_ros2_control-system", inside, "gz_ros2_control::GazeboSimROS2ControlPlugin")
    assert names(text, "node") == ["/controller_manager", "/gz_ros_control"]
    assert "/tf" in names(text)
    within = plugin("libgz_ros2_control-system.so", f"<ros>{inside}</ros>", "x")
    assert names(within, "node") == ["/a/controller_manager", "/a/gz_ros_control"]
    assert "/a/b" in names(within, release="jazzy")
    # determine_controller_node_options (ros2_control 6.5.0) gives no controller the manager's rules.
    assert "/tf" in names(within, release="lyrical")


def test_ros_1_topics_are_below_the_namespace() -> None:
    """gazebo_ros_p3d.cpp (noetic): node handle of robotNamespace; absent it is global."""
    given = "<robotNamespace>a</robotNamespace><topicName>t</topicName><bodyName>b</bodyName>"
    assert names(plugin("libgazebo_ros_p3d.so", given)) == ["/a/t"]
    assert names(plugin("libgazebo_ros_p3d.so", given.replace(">a<", "><"))) == ["/t"]
    absolute = given.replace(">t<", ">/t<")
    assert names(plugin("libgazebo_ros_p3d.so", absolute)) == ["/t"]


def test_names_that_are_looked_up_in_the_world() -> None:
    """gz_system.cpp: an IMU is found by its name alone, in every model."""
    system = (
        '<gazebo reference="l"><sensor name="imu" type="imu"/></gazebo><ros2_control name="h">'
        "<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>"
        '<sensor name="imu"/></ros2_control>'
    )
    assert names(system, "sensor") == ["imu"]
    assert names(system.replace("GazeboSimSystem", "Other"), "sensor") == []


def test_topics_are_below_the_word_that_a_plugin_makes_them_of() -> None:
    """gazebo_ros_camera.cpp: image_transport topics are <camera_name>/image_raw."""
    text = plugin("libgazebo_ros_camera.so", "<camera_name>front</camera_name>")
    assert "/front" in names(text, "topics below")
    within = text.replace("<camera_name>", "<ros><namespace>a</namespace></ros><camera_name>")
    assert "/a/front" in names(within, "topics below")


def test_a_particle_emitter_has_a_topic() -> None:
    emitter = "<particle_emitter name='e'><topic>/smoke</topic></particle_emitter>"
    assert names(f"<gazebo reference='base'>{emitter}</gazebo>") == ["/smoke"]
    assert names("<gazebo reference='base'/>") == []


# rcl arguments.c: rules follow -r or --remap between --ros-args and --, and are taken in their old form
# outside of these; node.cpp puts <argument> first.
@pytest.mark.parametrize(
    ("arguments", "topic"),
    [
        (("--ros-args", "-r", "cmd_vel:=b"), "/b"),
        (("--ros-args", "--remap", "cmd_vel:=b"), "/b"),
        (("--ros-args", "--", "--ros-args", "-r", "cmd_vel:=b"), "/b"),
        (("cmd_vel:=b",), "/b"),
        (("-r", "cmd_vel:=b"), "/b"),
        (("cmd_vel:=b", "--ros-args", "-r", "cmd_vel:=c"), "/b"),
        (("--ros-args", "cmd_vel:=b"), "/cmd_vel"),
        (("--ros-args", "--", "-r", "cmd_vel:=b"), "/b"),
    ],
)
def test_rules_in_arguments(arguments: tuple[str, ...], topic: str) -> None:
    inside = "".join(f"<argument>{it}</argument>" for it in arguments)
    assert topic in names(plugin("libgazebo_ros_diff_drive.so", f"<ros>{inside}</ros>"))


@pytest.mark.parametrize(
    ("joint", "wheels"),
    [
        ('type="continuous">', True),
        ('type="revolute"><limit lower="-1e16" upper="1e16"/>', True),
        ('type="revolute"><axis><limit><lower>-1</lower><upper>1</upper></limit></axis>', True),
        ('type="revolute"><limit lower="-6.3" upper="6.3"/>', False),
        ('type="revolute"><limit upper="2" effort="1"/>', False),
        ('type="revolute"><limit lower="?" upper="6.3"/>', True),
        ('type="prismatic"><limit lower="0" upper="99"/>', False),
        ('type="fixed">', False),
    ],
)
@pytest.mark.parametrize(("interface", "may_drive"), [("velocity", True), ("position", False)])
def test_a_controller_drives_wheels(
    joint: str, wheels: bool, interface: str, may_drive: bool
) -> None:
    """An arm may be commanded by velocities, too: its joints end after some turns."""
    root = fromstring(
        f'<robot name="r"><joint name="j" {joint}</joint><ros2_control name="s" type="system">'
        f'<joint name="j"><command_interface name="{interface}"/></joint></ros2_control></robot>'
    )
    assert wheels_in(root) == (wheels and may_drive)
