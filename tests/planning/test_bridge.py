# SPDX-License-Identifier: Apache-2.0
"""The bridge of a fleet carries each robot's gz topics once, under the names ROS nodes use."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import check_topic_name
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.planning.bridged_topics import (
    as_yaml,
    bridged_topics,
    is_for_classic,
)

ROBOTS = ("robot1", "robot2")
ROBOT = """\
<robot name="rover">
  <link name="base"/>
  <gazebo reference="base">
    <sensor name="lidar" type="gpu_lidar"><topic>scan</topic></sensor>
    <sensor name="eye" type="camera"><topic>eye/image</topic></sensor>
    <sensor name="mute" type="imu"/>
    <sensor name="old" type="imu"><plugin name="old" filename="libgazebo_ros_imu_sensor.so"/></sensor>
  </gazebo>
  <gazebo>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <odom_topic>odom</odom_topic>
    </plugin>
    <plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointState"/>
  </gazebo>
</robot>
"""


def fleet(layout: str, source: str | bytes = ROBOT):
    rewrites = rewrite_all(source, ROBOTS, layout=layout)
    inventories = {
        one.robot: collect(read_document(one.data, "rover"), builtin_tree((), NEWEST_LTS))
        for one in rewrites
    }
    return bridged_topics(inventories, make_naming(layout))


CLASSIC = """<robot name="rover"><link name="base"/><gazebo reference="base">
<sensor name="imu" type="imu"/>{}</gazebo><gazebo>
<plugin name="drive" filename="libgazebo_ros_diff_drive.so"/>{}</gazebo></robot>"""


@pytest.mark.parametrize(
    ("sensor", "plugin", "left"),
    [
        # Gazebo Classic publishes it on a topic of its own, which no ros_gz_bridge can read.
        ("", "", []),
        ('<sensor name="eye" type="camera"><topic>eye</topic></sensor>', "", []),
        ('<sensor name="lidar" type="gpu_lidar"/>', "", ["sensor lidar_robot1"]),
        (
            "",
            '<plugin name="p" filename="gz-sim-pose-publisher-system"/>',
            ["sensor imu_robot1"],
        ),
    ],
)
def test_a_robot_of_gazebo_classic_has_no_gz_topics(
    sensor: str, plugin: str, left: list[str]
) -> None:
    bridged, unbridged = fleet("L4", CLASSIC.format(sensor, plugin))
    assert [it.what for it in unbridged if it.robot == "robot1"] == left
    assert {it.ros for it in bridged if it.robot == "robot1"} == (
        {"/pose/robot1"} if plugin else set()
    )


OWN_PLUGIN = """<robot name="r"><link name="base"/><gazebo reference="base"><sensor name="i" type="imu">
<topic>imu</topic><plugin filename="{}" name="p"/></sensor></gazebo></robot>"""


@pytest.mark.parametrize(
    ("library", "topics"),
    [
        ("gz-sim-imu-system", ["/robot1/imu"]),
        ("libignition-gazebo-imu-system.so", ["/robot1/imu"]),
        ("ignition-gazebo-imu-system", ["/robot1/imu"]),
        ("libgazebo_ros_imu_sensor.so", []),
    ],
)
def test_a_system_of_gz_in_its_sensor_is_no_node(library: str, topics: list[str]) -> None:
    bridged, _ = fleet("L1", OWN_PLUGIN.format(library))
    assert [it.ros for it in bridged if it.robot == "robot1"] == topics


NAMESPACED = """<sdf version="1.12"><model name="rover" namespace="{}"><link name="base"/>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<odom_topic>odom</odom_topic><tf_topic>/tf</tf_topic></plugin></model></sdf>"""


@pytest.mark.parametrize(
    ("release", "namespace", "cmd_vel", "odom"),
    [
        ("rolling", "fleet", "/robot1/fleet/cmd_vel", "/robot1/fleet/odom"),
        ("rolling", "{name}", "", ""),
        ("lyrical", "fleet", "/model/robot1/cmd_vel", "robot1/odom"),
    ],
)
def test_topics_below_the_namespace_of_a_model(
    release: str, namespace: str, cmd_vel: str, odom: str
) -> None:
    source = NAMESPACED.format(namespace)
    (made,) = rewrite_all(source, ["robot1"], layout="L1", distro=release)
    tree = builtin_tree((), release)
    inventories = {"robot1": collect(read_document(made.data, "rover"), tree)}
    bridged, left = bridged_topics(inventories, make_naming("L1"))
    found = {it.gz_type: it.gz for it in bridged if it.robot}
    assert (found.get("gz.msgs.Twist", ""), found.get("gz.msgs.Odometry", "")) == (cmd_vel, odom)
    assert found["gz.msgs.Pose_V"] == "/robot1/tf"
    assert len(left) == (0 if cmd_vel else 2)


def names(layout: str) -> dict[str, str]:
    """gz name -> ROS name of robot1's topics."""
    return {item.gz: item.ros for item in fleet(layout)[0] if item.robot == "robot1"}


OF_CLASSIC = '<plugin name="c" filename="libgazebo_ros_camera.so"/>'


def inventory(inside: str) -> Inventory:
    text = f'<robot name="r"><link name="b"/><gazebo reference="b">{inside}</gazebo></robot>'
    return collect(read_document(text.encode(), "r"), builtin_tree((), NEWEST_LTS))


@pytest.mark.parametrize(
    "library", ["gz-sim-x", "gz_x", "ign_x", "ignition-gazebo-x", "libgz_x.so"]
)
def test_a_description_for_both_is_not_for_classic_alone(library: str) -> None:
    assert is_for_classic(inventory(OF_CLASSIC))
    assert not is_for_classic(inventory(f'{OF_CLASSIC}<plugin name="g" filename="{library}"/>'))
    assert not is_for_classic(inventory('<plugin name="a" filename="libacme.so"/>'))


@pytest.mark.parametrize(
    ("library", "carried"), [("libgazebo_ros_x.so", False), ("gz-sim-x", True), ("", True)]
)
def test_a_sensor_with_a_plugin_of_classic_is_that_plugins(library: str, carried: bool) -> None:
    plugin = f'<plugin name="p" filename="{library}"/>'
    sensor = f'<sensor name="s" type="gpu_lidar"><topic>t</topic>{plugin}</sensor>'
    found, _ = bridged_topics({"a": inventory(sensor)}, make_naming("L4"))
    assert ([it.gz for it in found if it.robot] == ["t", "t/points"]) is carried


@pytest.mark.parametrize(
    ("inside", "carried"),
    [
        ("<contact><topic>bump</topic></contact>", ["bump"]),
        # Contact.cc:115 reads the one below <contact> alone, and knows this text.
        ("<topic>bump</topic>", []),
        ("<contact><topic>__default_topic__</topic></contact>", []),
    ],
)
def test_the_topic_of_a_contact_sensor(inside: str, carried: list[str]) -> None:
    sensor = f'<sensor name="s" type="contact">{inside}</sensor>'
    found, left = bridged_topics({"a": inventory(sensor)}, make_naming("L4"))
    assert [it.gz for it in found if it.robot] == carried
    assert len(left) == (0 if carried else 1)


@pytest.mark.parametrize("layout", ["L1", "L4"])
def test_a_name_of_gazebo_that_ros_refuses_is_bridged_under_one_that_it_takes(layout: str) -> None:
    """No part of a ROS name begins with a digit (rcl validate_topic_name.c); Gazebo keeps its own."""
    plugin = (
        '<plugin filename="gz-sim-detachable-joint-system" name="gz::sim::systems::DetachableJoint">'
        "<parent_link>b</parent_link><child_model>4bar-x</child_model><child_link>l</child_link>"
        "<output_topic>/model/4bar-x/state</output_topic></plugin>"
    )
    source = f'<robot name="q"><link name="b"/><gazebo>{plugin}</gazebo></robot>'
    bridged, _ = fleet(layout, source)
    (found,) = (it for it in bridged if it.robot == "robot1" and "state" in it.ros)
    assert "4bar-x" in found.gz and "_4bar_x" in found.ros
    assert not check_topic_name(found.ros)
    assert f'gz_topic_name: "/{found.gz.lstrip("/")}"' in as_yaml([found])
