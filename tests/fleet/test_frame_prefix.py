# SPDX-License-Identifier: Apache-2.0
"""Layout frame-prefix: a description keeps its links, and nodes put the robot's name before frames.

Expected from the sources: robot_state_publisher.cpp (frame_prefix is put before each frame as it is),
robot_localization ros_filter.cpp (tf_prefix and a slash before its five frames), rviz
tf_link_updater.cpp (TF Prefix and a slash before each link), sdformat (gz_frame_id is the frame of the
message as it is).
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet
from plans import robot_named

from multibot_rewrite import load_fleet
from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system.records import Parameter

ROVER = """\
<robot name="rover">
  <link name="base_link">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="lidar_link"/>
  <joint name="mast" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
  <gazebo reference="lidar_link">
    <sensor name="lidar" type="gpu_lidar">
      <topic>scan</topic>
      <gz_frame_id>lidar_link</gz_frame_id>
    </sensor>
  </gazebo>
</robot>
"""
PARAMS = """\
amcl: {ros__parameters: {base_frame_id: base_link, odom_frame_id: odom}}
robot_state_publisher: {ros__parameters: {frame_prefix: ""}}
ekf_filter_node:
  ros__parameters: {odom_frame: odom, base_link_frame: base_link, world_frame: odom, tf_prefix: PREFIX}
"""
FLEET = """\
layout: frame-prefix
node_sets: [localization, robot_localization]
description: rover.urdf
robots: [{name: robot1}, {name: robot2, namespace: graph2, prefix: frames2}]
related_files: {params: params.yaml, rviz: one.rviz}
"""
RVIZ = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Name: robot
      TF Prefix: ""
      Links:
        lidar_link: {Value: true}
    - Class: rviz_default_plugins/Axes
      Name: axes
      Reference Frame: lidar_link
  Global Options:
    Fixed Frame: map
"""


def made(folder: Path, prefix: str = "rover", fleet: str = FLEET) -> Outputs:
    (folder / "rover.urdf").write_text(ROVER)
    (folder / "params.yaml").write_text(PARAMS.replace("PREFIX", prefix))
    (folder / "one.rviz").write_text(RVIZ)
    (folder / "fleet.yaml").write_text(fleet)
    return built_fleet(folder / "fleet.yaml")


def text(outputs: Outputs, path: str) -> str:
    return next(it.data.decode() for it in outputs.files if it.path == path)


@pytest.mark.more
def test_nodes_with_a_prefix_of_their_own_keep_their_frames(tmp_path: Path) -> None:
    outputs = made(tmp_path)
    found = yaml.safe_load(text(outputs, "robot2/params.yaml"))
    nodes = {name: it["ros__parameters"] for name, it in found.items()}
    assert nodes["/graph2/amcl"]["base_frame_id"] == "frames2/base_link"
    assert nodes["/graph2/robot_state_publisher"]["frame_prefix"] == "frames2/"
    ekf = nodes["/graph2/ekf_filter_node"]
    assert ekf["tf_prefix"] == "frames2"
    assert {ekf[it] for it in ("odom_frame", "world_frame")} == {"odom"}
    assert ekf["base_link_frame"] == "base_link"
    # No line of what is missing either: the default of map_frame is that of all robots.
    assert "map_frame" not in ekf
    assert [it for it in outputs.findings if it.level == "error"] == []
    assert [it for it in outputs.findings if it.code in ("MB882", "MB863")] == []


@pytest.mark.more
@pytest.mark.parametrize("prefix", ["", '""'])
def test_without_a_prefix_of_its_own_frames_are_written_out(prefix: str, tmp_path: Path) -> None:
    found = yaml.safe_load(text(made(tmp_path, prefix), "robot1/params.yaml"))
    ekf = found["/robot1/ekf_filter_node"]["ros__parameters"]
    assert (ekf["odom_frame"], ekf["base_link_frame"]) == ("robot1/odom", "robot1/base_link")
    assert not ekf["tf_prefix"]


def test_rviz_puts_the_name_before_links_itself(tmp_path: Path) -> None:
    shown = text(made(tmp_path), "one.rviz")
    groups = yaml.safe_load(shown)["Visualization Manager"]["Displays"]
    models = [it for group in groups for it in group["Displays"] if "TF Prefix" in it]
    assert [it["TF Prefix"] for it in models] == ["robot1", "frames2"]
    assert [list(it["Links"]) for it in models] == [["lidar_link"]] * 2
    axes = [it for group in groups for it in group["Displays"] if "Reference Frame" in it]
    assert [it["Reference Frame"] for it in axes] == ["robot1/lidar_link", "frames2/lidar_link"]


@pytest.mark.more
def test_the_plan_has_the_frames_as_they_are_sent(tmp_path: Path) -> None:
    plan = read_plan(text(made(tmp_path), "plan.yaml").encode(), "plan.yaml")
    own = robot_named(plan, "robot2")
    assert {"frames2/base_link", "frames2/lidar_link", "frames2/odom"} <= {*own.frames}
    assert not {"base_link", "lidar_link"} & {*own.frames, *own.other_frames}
    publisher = "/graph2/robot_state_publisher"
    prefixes = [it for it in plan.parameters if it.node == publisher]
    assert prefixes == [Parameter(publisher, "frame_prefix", '"frames2/"')]
    # What the filter sends has its prefix.
    assert ("frames2/odom", "frames2/base_link") in {(it.parent, it.child) for it in plan.edges}


@pytest.mark.more
def test_a_script_gets_the_prefix_with_the_description(tmp_path: Path) -> None:
    made(tmp_path)
    robot = load_fleet(str(tmp_path / "fleet.yaml")).robot("robot2")
    assert robot.description_parameters == {
        "robot_description": robot.description,
        "frame_prefix": "frames2/",
    }
    (tmp_path / "fleet.yaml").write_text(FLEET.replace("frame-prefix", "L2\naffix: prefix"))
    other = load_fleet(str(tmp_path / "fleet.yaml")).robot("robot2")
    assert "frame_prefix" not in other.description_parameters


@pytest.mark.parametrize("wrong", ["affix: postfix", "separators: {link: _}"])
def test_another_way_to_write_frames_is_refused(wrong: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nodes put robot1/ before frames"):
        made(tmp_path, fleet=f"{wrong}\n{FLEET}")
