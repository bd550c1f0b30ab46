# SPDX-License-Identifier: Apache-2.0
"""Frames of a node that a fleet leaves to others are not missed in what it writes."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import built_fleet, planned_fleet

from multibot_rewrite.checks.build import make_outputs

DOG = """\
<robot name="dog">
  <link name="base_link"/><link name="leg"/>
  <joint name="hip" type="fixed"><parent link="base_link"/><child link="leg"/></joint>
</robot>
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
related_files: {params: ekf.yaml}
"""


def test_a_plugin_that_says_where_the_robot_is_has_a_name(tmp_path: Path) -> None:
    """Odometry in the map: the pose of the fleet file would be a second parent."""
    (tmp_path / "sub.sdf").write_text(SUB)
    (tmp_path / "fleet.yaml").write_text(
        "layout: tf-per-robot\nrobots: [{name: robot1, description: sub.sdf, pose: {x: 1}}]\n"
    )
    found = built_fleet(tmp_path / "fleet.yaml", "jazzy").findings
    (said,) = [it.message for it in found if it.code == "MF701"]
    assert "because its description already says where it is" in said


COSTMAP = """\
amcl: {ros__parameters: {base_frame_id: base_link, odom_frame_id: odom}}
local_costmap: {local_costmap: {ros__parameters: {robot_base_frame: base_link}}}
"""


@pytest.mark.slow
def test_all_that_read_a_frame_that_nothing_sends_are_told(tmp_path: Path) -> None:
    """behavior_server has no parameters here: timed_behavior.hpp takes base_link."""
    (tmp_path / "dog.urdf").write_text(DOG.replace("base_link", "d0/base_link"))
    (tmp_path / "ekf.yaml").write_text(COSTMAP)
    text = FLEET.replace("LAYOUT", "tf-per-robot").replace(
        "related_files", "node_sets: nav2\nrelated_files"
    )
    (tmp_path / "fleet.yaml").write_text(text)
    found = built_fleet(tmp_path / "fleet.yaml").findings
    (said,) = [it for it in found if it.code == "MG413" and "frame base_link," in it.message]
    for node in ("/local_costmap/local_costmap", "/behavior_server"):
        assert node in said.message
    for simulator in ("none", "gazebo"):
        (tmp_path / "ekf.yaml").write_text(COSTMAP.partition("\n")[2])
        head = text.replace("node_sets: nav2", f"node_sets: navigation\nsimulator: {simulator}")
        (tmp_path / "fleet.yaml").write_text(head)
        plan = planned_fleet(tmp_path / "fleet.yaml")
        lines = [it for it in make_outputs(plan).findings if it.code == "MG413"]
        assert {it.level for it in lines if "frame odom," in it.message} == {"note"}
