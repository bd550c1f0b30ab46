# SPDX-License-Identifier: Apache-2.0
"""The bridge of a fleet carries each robot's gz topics once, under the names ROS nodes use."""

from __future__ import annotations

import pytest
import yaml
from paths import FIXTURES

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import check_topic_name
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.rewriters.vocabulary import load_vocabulary
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.spelling.bridged_topics import (
    BridgedTopic,
    as_yaml,
    bridge_data,
    bridged_as,
    bridged_topics,
    is_for_classic,
    once,
)
from multibot_rewrite.system.records import PUBLISHES, SERVES, SUBSCRIBES, Topic

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


def test_a_topic_that_is_made_of_two_elements() -> None:
    plugin = (
        '<plugin filename="gz-sim-multicopter-control-system" '
        'name="gz::sim::systems::MulticopterVelocityControl"><robotNamespace>quad</robotNamespace>'
        "<commandSubTopic>twist</commandSubTopic></plugin>"
    )
    bridged, _ = fleet("L1", f'<robot name="q"><link name="b"/><gazebo>{plugin}</gazebo></robot>')
    found = {it.gz_type: it.gz for it in bridged if it.robot == "robot1"}
    assert found == {"gz.msgs.Twist": "quad_robot1/twist", "gz.msgs.Boolean": "quad_robot1/enable"}


def names(layout: str) -> dict[str, str]:
    """gz name -> ROS name of robot1's topics."""
    return {item.gz: item.ros for item in fleet(layout)[0] if item.robot == "robot1"}


def test_topics_of_the_default_layout() -> None:
    assert names("L4") == {
        "scan/robot1": "/scan/robot1",
        "scan/robot1/points": "/scan/robot1/points",
        "eye/image/robot1": "/eye/image/robot1",
        "eye/camera_info/robot1": "/eye/camera_info/robot1",
        "/model/robot1/cmd_vel": "/cmd_vel/robot1",
        "odom/robot1": "/odom/robot1",
        "/model/robot1/tf": "/tf/robot1",
    }


@pytest.mark.parametrize(
    ("layout", "tf"), [("L1", "/robot1/tf"), ("L2", "/tf"), ("L3", "/robot1/tf")]
)
def test_topics_below_a_namespace(layout: str, tf: str) -> None:
    found = names(layout)
    assert found["robot1/scan"] == "/robot1/scan"
    assert found["robot1/eye/camera_info"] == "/robot1/eye/camera_info"
    assert found["/model/robot1/cmd_vel"] == "/robot1/cmd_vel"
    assert found["/model/robot1/tf"] == tf


@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
def test_two_robots_share_the_clock_and_nothing_else(layout: str) -> None:
    carried, _ = fleet(layout)
    shared = [item for item in carried if not item.robot]
    assert shared == [
        BridgedTopic(
            "", "/clock", "/clock", "rosgraph_msgs/msg/Clock", "gz.msgs.Clock", "GZ_TO_ROS"
        )
    ]
    gz = {robot: {item.gz for item in carried if item.robot == robot} for robot in ROBOTS}
    assert gz["robot1"].isdisjoint(gz["robot2"])
    assert all(gz.values())


def test_one_tf_for_all_is_carried_once() -> None:
    source = ROBOT.replace("<odom_topic>", "<tf_topic>/tf</tf_topic><odom_topic>")
    carried = [item for item in fleet("L2", source)[0] if item.ros == "/tf"]
    assert [(item.robot, item.gz) for item in carried] == [("", "/tf")]
    apart = [item for item in fleet("L3", source)[0] if item.ros.endswith("/tf")]
    assert [(item.robot, item.gz) for item in apart] == [(it, f"/{it}/tf") for it in ROBOTS]


def test_the_info_of_an_rgbd_camera_is_below_its_topic() -> None:
    source = ROBOT.replace('type="camera"><topic>eye/image', 'type="rgbd_camera"><topic>eye')
    carried = [item.gz for item in fleet("L2", source)[0] if item.robot == "robot1"]
    assert "robot1/eye/camera_info" in carried
    assert "robot1/eye/depth_image" in carried


def test_what_hangs_on_the_world_is_said() -> None:
    _, left = fleet("L2")
    assert [(item.robot, item.line, item.what) for item in left if item.robot == "robot1"] == [
        ("robot1", 6, "sensor mute_robot1"),
        ("robot1", 16, "<topic> of gz-sim-joint-state-publisher-system"),
    ]


def test_the_file_is_what_the_bridge_reads() -> None:
    rows = yaml.safe_load(
        as_yaml(fleet("L4", (FIXTURES / "robots" / "rover_gz.urdf").read_bytes())[0])
    )
    keys = {"ros_topic_name", "gz_topic_name", "ros_type_name", "gz_type_name", "direction"}
    assert rows and all(row.keys() == keys for row in rows)
    assert {row["direction"] for row in rows} <= {"GZ_TO_ROS", "ROS_TO_GZ"}
    assert len({row["ros_topic_name"] for row in rows}) == len(rows)


def test_the_data_names_sections_and_elements_that_the_vocabulary_has() -> None:
    vocabulary = load_vocabulary((), NEWEST_LTS, packages=False)
    for section, topics in bridge_data()["plugins"].items():
        (rewriter,) = vocabulary.find("plugin", section)
        given = {topic[0] for topic in topics if topic[0]}
        assert given <= {site.path for site in rewriter.sites}, section


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
    ("type_", "carried"),
    [
        ("camera", False), ("imu", False), ("magnetometer", False), ("altimeter", False),
        ("force_torque", False), ("gpu_lidar", True), ("rgbd_camera", True),
    ],
)  # fmt: skip
def test_a_sensor_that_classic_has_too_is_not_carried_there(type_: str, carried: bool) -> None:
    """sdformat sensor types; Gazebo Classic has ray and gpu_ray where gz has gpu_lidar."""
    sensor = f'<sensor name="s" type="{type_}"><topic>t</topic></sensor>'
    naming = make_naming("L4")
    of_classic, _ = bridged_topics({"a": inventory(f"{OF_CLASSIC}{sensor}")}, naming)
    assert ([it for it in of_classic if it.robot] != []) is carried
    alone, _ = bridged_topics({"a": inventory(sensor)}, naming)
    assert {it.direction for it in alone if it.robot} == {"GZ_TO_ROS"}


@pytest.mark.parametrize(
    ("library", "carried"), [("libgazebo_ros_x.so", False), ("gz-sim-x", True), ("", True)]
)
def test_a_sensor_with_a_plugin_of_classic_is_that_plugins(library: str, carried: bool) -> None:
    plugin = f'<plugin name="p" filename="{library}"/>'
    sensor = f'<sensor name="s" type="gpu_lidar"><topic>t</topic>{plugin}</sensor>'
    found, _ = bridged_topics({"a": inventory(sensor)}, make_naming("L4"))
    assert ([it.gz for it in found if it.robot] == ["t", "t/points"]) is carried


def test_topics_of_a_bridge_are_once_with_all_that_it_does() -> None:
    """Nothing said is both ways; the order is that of a plan."""
    rows = (
        BridgedTopic("a", "/x", "x", "a/msg/B", "gz.msgs.B", "ROS_TO_GZ"),
        BridgedTopic("b", "/x", "y", "a/msg/B", "gz.msgs.B", "GZ_TO_ROS"),
        BridgedTopic("b", "/y", "y", "a/msg/C", "gz.msgs.C", "ROS_TO_GZ"),
        BridgedTopic("b", "/z", "z", "a/msg/C", "gz.msgs.C", "BIDIRECTIONAL"),
    )
    both = (PUBLISHES, SUBSCRIBES)
    assert bridged_as(rows) == (
        Topic("/x", bridge=both, type="a/msg/B"),
        Topic("/y", bridge=(SUBSCRIBES,), type="a/msg/C"),
        Topic("/z", bridge=both, type="a/msg/C"),
    )
    served = Topic("/s", bridge=(SERVES,), type="a/srv/D")
    assert once((served, served._replace(bridge=(PUBLISHES,)))) == (
        served._replace(bridge=(PUBLISHES, SERVES)),
    )
    assert as_yaml(rows[:1]) == (
        '- ros_topic_name: "/x"\n  gz_topic_name: "/x"\n  ros_type_name: "a/msg/B"\n'
        '  gz_type_name: "gz.msgs.B"\n  direction: ROS_TO_GZ\n'
    )


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
