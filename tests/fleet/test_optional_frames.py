# SPDX-License-Identifier: Apache-2.0
"""Frames of a node that a fleet leaves to others are not missed in what it writes."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import built_fleet, planned_fleet

from multibot_rewrite.fleet.build import make_outputs
from multibot_rewrite.fleet.checks.read_back import read_back

DOG = """\
<robot name="dog">
  <link name="base_link"/><link name="leg"/>
  <joint name="hip" type="fixed"><parent link="base_link"/><child link="leg"/></joint>
</robot>
"""
# CHAMP: nothing starts this filter by the name of a stack.
FILTER = """\
footprint_to_odom_ekf:
  ros__parameters:
    {odom_frame: odom, base_link_frame: base_footprint, world_frame: odom, odom0: odom/raw}
"""
SUB = """\
<sdf version="1.9"><model name="sub">
  <link name="base_link"/>
  <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
    <odom_frame>map</odom_frame><robot_base_frame>base_link</robot_base_frame>
    <odom_topic>odom</odom_topic><tf_topic>tf</tf_topic>
  </plugin>
</model></sdf>
"""
FLEET = """\
layout: LAYOUT
distro: humble
robots:
  - {name: robot1, description: dog.urdf}
  - {name: robot2, description: dog.urdf, pose: {y: 2}}
companions: {params: ekf.yaml}
"""


@pytest.mark.more
@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot"])
def test_frames_of_a_filter_that_is_started_elsewhere(layout: str, tmp_path: Path) -> None:
    (tmp_path / "dog.urdf").write_text(DOG)
    (tmp_path / "ekf.yaml").write_text(FILTER)
    (tmp_path / "fleet.yaml").write_text(FLEET.replace("LAYOUT", layout))
    plan = planned_fleet(tmp_path / "fleet.yaml")
    made = make_outputs(plan, str(tmp_path / "out"))
    (first, *_) = made.planned.robots
    assert any("base_footprint" in it for it in first.frames)
    assert read_back(plan, made, str(tmp_path / "out")) == []


def test_a_plugin_that_says_where_the_robot_is_has_a_name(tmp_path: Path) -> None:
    """Odometry in the map: the pose of the fleet file would be a second parent."""
    (tmp_path / "sub.sdf").write_text(SUB)
    (tmp_path / "fleet.yaml").write_text(
        "layout: tf-per-robot\nrobots: [{name: robot1, description: sub.sdf, pose: {x: 1}}]\n"
    )
    found = built_fleet(tmp_path / "fleet.yaml", "jazzy").findings
    (said,) = [it.message for it in found if it.code == "MF701"]
    assert "because its description already says where it is" in said


SEEN = """\
<robot name="dog"><link name="base_link"/><link name="head"/>
<joint name="neck" type="fixed"><parent link="base_link"/><child link="head"/></joint>
<gazebo reference="head"><sensor name="eye" type="gpu_lidar"><topic>scan</topic>{}</sensor></gazebo>
</robot>
"""


COSTMAP = """\
amcl: {ros__parameters: {base_frame_id: base_link, odom_frame_id: odom}}
local_costmap: {local_costmap: {ros__parameters: {robot_base_frame: base_link}}}
"""


@pytest.mark.slow
def test_all_that_read_a_frame_that_nothing_sends_are_told(tmp_path: Path) -> None:
    """behavior_server has no parameters here: timed_behavior.hpp takes base_link."""
    (tmp_path / "dog.urdf").write_text(DOG.replace("base_link", "d0/base_link"))
    (tmp_path / "ekf.yaml").write_text(COSTMAP)
    text = FLEET.replace("LAYOUT", "tf-per-robot").replace("companions", "stack: nav2\ncompanions")
    (tmp_path / "fleet.yaml").write_text(text)
    found = built_fleet(tmp_path / "fleet.yaml").findings
    (said,) = [it for it in found if it.code == "MG413" and "frame base_link," in it.message]
    for node in ("/local_costmap/local_costmap", "/behavior_server"):
        assert node in said.message
    for simulator, codes in (("none", set()), ("gazebo", {"note"})):
        (tmp_path / "ekf.yaml").write_text(COSTMAP.partition("\n")[2])
        head = text.replace("stack: nav2", f"stack: navigation\nsimulator: {simulator}")
        (tmp_path / "fleet.yaml").write_text(head)
        plan = planned_fleet(tmp_path / "fleet.yaml")
        lines = [it for it in make_outputs(plan).findings if it.code == "MG413"]
        assert {it.level for it in lines if "frame odom," in it.message} == codes


def test_a_frame_of_a_node_that_hears_no_transforms_is_not_missed(tmp_path: Path) -> None:
    """imu_filter_madgwick sends fixed_frame, or writes it into nothing: it has no buffer of tf2."""
    filter_ = "imu_filter_madgwick: {ros__parameters: {fixed_frame: odom, publish_tf: false}}\n"
    (tmp_path / "imu.yaml").write_text(filter_)
    (tmp_path / "dog.urdf").write_text(SEEN.format("<gz_frame_id>head</gz_frame_id>"))
    (tmp_path / "fleet.yaml").write_text(
        "layout: tf-per-robot\nsimulator: gazebo\ndescription: dog.urdf\n"
        "companions: {params: imu.yaml}\nrobots: [{name: r1}]\n"
    )
    plan = planned_fleet(tmp_path / "fleet.yaml", "jazzy")
    assert [it for it in make_outputs(plan).findings if it.code == "MG413"] == []
