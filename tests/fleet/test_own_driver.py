# SPDX-License-Identifier: Apache-2.0
"""A driver of one's own that sends odometry: the start pose never is a second parent of the base."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.robots.start_poses import OWN_ODOMETRY

ROBOT = """\
<robot name="bare">
  <link name="base_link"/><link name="lidar_link"/>
  <joint name="l" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
</robot>
"""
FLEET = """\
layout: frames-per-robot
affix: prefix
{more}
robots:
  - {{name: robot1, description: bare.urdf, pose: {{x: 1.0}}}}
  - {{name: robot2, description: bare.urdf, pose: {{x: 3.0}}}}
related_files: {{params: params.yaml}}
"""
NODES = """\
nodes:
  my_driver:
    package: my_driver
    with: [tf_broadcaster]
    frames: {odom_frame: odom, base_frame: base_link}
    SENDS
node_sets:
  mine: {about: my robot, nodes: [my_driver]}
"""
DESCRIBED = "nodes: nodes.yaml\nnode_sets: mine"


def children(folder: Path, parameters: str, more: str = "", sends: str = "") -> list[str]:
    """Return the frame that the start pose of robot1 places; empty if it is not published."""
    (folder / "bare.urdf").write_text(ROBOT)
    (folder / "nodes.yaml").write_text(NODES.replace("SENDS", sends))
    (folder / "params.yaml").write_text(f"my_driver:\n  ros__parameters: {parameters}\n")
    (folder / "fleet.yaml").write_text(FLEET.format(more=more))
    fleet = load_fleet(folder / "fleet.yaml")
    words = fleet.robot("robot1").transform_arguments
    refused = [it.code for it in fleet.placed.findings]
    assert bool(words) == (OWN_ODOMETRY.code not in refused)
    return [words[words.index("--child-frame-id") + 1]] if words else []


@pytest.mark.more
def test_the_pose_is_that_of_the_odometry_frame_that_it_sends(tmp_path: Path) -> None:
    sends = "sends: {odom_frame: base_frame}"
    assert children(tmp_path, "{odom_frame: odom}", DESCRIBED, sends) == ["robot1/odom"]
    # By its parameters, not by their defaults.
    assert children(tmp_path, "{odom_frame: wheel}", DESCRIBED, sends) == ["robot1/wheel"]


@pytest.mark.more
def test_a_driver_that_is_described_and_sends_nothing(tmp_path: Path) -> None:
    assert children(tmp_path, "{odom_frame: odom}", DESCRIBED) == ["robot1/base_link"]


def test_the_commands_that_plan_say_it_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A rehearsal has the transform of no driver that nobody describes: it cannot see two parents."""
    assert children(tmp_path, "{odom_frame: odom}") == []
    assert main(["plan", str(tmp_path / "fleet.yaml")]) == 0
    (line,) = (it for it in capsys.readouterr().err.splitlines() if "MF710" in it)
    assert "fleet.yaml:5" in line and "the same for robot2" in line and "params.yaml:2" in line
