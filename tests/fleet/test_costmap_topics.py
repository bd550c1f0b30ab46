# SPDX-License-Identifier: Apache-2.0
"""The plan has the topics of costmaps as the built parameter files have them.

Source: navigation2 jazzy, nav2_costmap_2d/plugins/obstacle_layer.cpp (a relative topic is below the
costmap); kilted joins it with the namespace above, but for the BinaryFilter.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from paths import ROOT

from multibot_rewrite.fleet.build import make_outputs
from multibot_rewrite.fleet.checks.read_back import read_back

pytestmark = pytest.mark.slow

OUT = "/anywhere/out"
EXAMPLE = ROOT / "examples" / "namespace_and_prefix"
FLEET = f"""\
layout: LAYOUT
distro: DISTRO
description: {EXAMPLE}/hexbase.urdf.xacro
stack: [robot_state_publisher, navigation]
simulator: none
robots: [{{name: robot1}}, {{name: robot2}}]
companions: {{params: params.yaml}}
"""
PARAMS = """\
local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [obstacles]
      filters: [zones]
      obstacles:
        plugin: nav2_costmap_2d::ObstacleLayer
        observation_sources: front
        front: {topic: TOPIC, data_type: LaserScan}
      zones: {plugin: "nav2_costmap_2d::BinaryFilter", filter_info_topic: info}
"""


def built(folder: Path, layout: str, distro: str, topic: str) -> list[str]:
    """The topics of robot1's local costmap in the plan of a build, which is as planned."""
    (folder / "params.yaml").write_text(PARAMS.replace("TOPIC", topic))
    fleet = folder / "fleet.yaml"
    fleet.write_text(FLEET.replace("LAYOUT", layout).replace("DISTRO", distro))
    plan = planned_fleet(fleet, around=os.environ)
    made = make_outputs(plan, OUT)
    assert [str(it) for it in read_back(plan, made, OUT)] == []
    name = next(
        it.name
        for it in made.planned.nodes
        if it.robot == "robot1" and it.name.endswith("local_costmap/local_costmap")
    )
    ends = (it for it in made.planned.ends if it.node == name)
    return [it.name for it in ends if it.role == "subscribes"]


@pytest.mark.sample(12)
@pytest.mark.parametrize("topic", ["scan", "/scan"])
@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted"])
@pytest.mark.parametrize(
    ("layout", "scan"), [("tf-per-robot", "/robot1/scan"), ("postfix", "/scan/robot1")]
)
def test_a_source_is_the_robots_scan_in_every_release(
    tmp_path: Path, layout: str, scan: str, distro: str, topic: str
) -> None:
    assert scan in built(tmp_path, layout, distro, topic)


@pytest.mark.sample(1)
@pytest.mark.parametrize("distro", ["jazzy", "kilted"])
def test_the_info_of_a_binary_filter_too(tmp_path: Path, distro: str) -> None:
    assert "/robot1/info" in built(tmp_path, "tf-per-robot", distro, "scan")
