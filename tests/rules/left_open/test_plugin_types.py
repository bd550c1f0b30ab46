# SPDX-License-Identifier: Apache-2.0
"""A plugin's topic of one type, and a node that reads it as another one: found before anything runs.

Sources: gazebo_ros_pkgs ros2 gazebo_ros_ray_sensor.cpp (PointCloud2 without <output_type>),
slam_toolbox slam_toolbox_common.cpp (subscribes to scan as LaserScan).
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from open_findings import found
from paths import fixture_text

FLEET = """\
description: scout.urdf
stack: slam_toolbox
robots:
  - {name: robot1}
  - {name: robot2, pose: {x: 3}}
"""
SCOUT = fixture_text("plugin_types_scout.urdf")


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["both", "postfix"])
@pytest.mark.parametrize(
    ("output", "codes"),
    [
        ("<output_type>sensor_msgs/LaserScan</output_type>", set()),
        ("<output_type>sensor_msgs/PointCloud2</output_type>", {"MG306"}),
        ("", {"MG306"}),
    ],
)
def test_a_lidar_of_another_type(tmp_path: Path, layout: str, output: str, codes: set[str]) -> None:
    robot = SCOUT.replace("<output_type>sensor_msgs/LaserScan</output_type>", output)
    built, planned = found(tmp_path, {"fleet.yaml": FLEET, "scout.urdf": robot}, layout)
    assert {it.code for it in built} == {it.code for it in planned} == codes
    for it in planned:
        assert re.search(
            r"but \S*/lidar_driver\S* has it as sensor_msgs/msg/PointCloud2", it.message
        )
        assert "scout.urdf:" in f"{it.file}:{it.line} {it.hint}"
