# SPDX-License-Identifier: Apache-2.0
"""Frames that two nodes of a fleet send, by its parameter files and descriptions."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import SMALL, fleet_folder, planned_fleet

from multibot_rewrite.fleet.build import make_outputs
from multibot_rewrite.fleet.fleet_plan import FleetPlan

PARENTS = """\
layout: L2
affix: prefix
description: rover.urdf
robots: [{name: r1}, {name: r2}]
"""


def planned(folder: Path, text: str = SMALL, **files: str) -> FleetPlan:
    return planned_fleet(fleet_folder(folder, text, **files))


@pytest.mark.more
def test_two_nodes_that_send_one_frame(tmp_path: Path) -> None:
    params = (
        "amcl: {ros__parameters: {odom_frame_id: odom}}\n"
        "slam_toolbox:\n  ros__parameters: {odom_frame: odom, map_frame: map}\n"
    )
    text = f"stack: [localization, nav2_slam]\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=params)
    found = [it for it in make_outputs(plan).findings if it.code == "MG408"]
    assert len(found) == 1
    assert found[0].message == "several nodes send map -> r1/odom on /tf"
    assert "/r1/amcl, /r1/slam_toolbox" in found[0].hint
    assert (Path(found[0].file).name, found[0].line) == ("params.yaml", 2)


FILTER = (
    "ekf_filter_node:\n  ros__parameters: {odom_frame: odom, base_link_frame: lidar_link, MORE}\n"
)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        pytest.param("world_frame: odom", ["r1/base_link and r1/odom"], id="two-parents"),
        pytest.param("world_frame: odom, publish_tf: false", [], id="switched-off"),
        pytest.param("world_frame: map, map_frame: map", [], id="filters-the-map"),
    ],
)
def test_what_a_parameter_file_says_is_sent(more: str, said: list[str], tmp_path: Path) -> None:
    text = f"stack: robot_localization\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=FILTER.replace("MORE", more))
    found = [it for it in make_outputs(plan).findings if it.code == "MG401"]
    assert [said[0] in it.message for it in found] == [True] * len(said)


GZ_DRIVE = """<robot name="rover"><link name="base_link"/><gazebo>
<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system"/></gazebo></robot>"""


@pytest.mark.parametrize(
    ("more", "is_bridged"),
    [("", False), (", publish_tf: false", True), (", base_link_frame: mast", True)],
)
def test_the_bridge_leaves_a_transform_to_the_filter_that_sends_it(
    more: str, is_bridged: bool, tmp_path: Path
) -> None:
    params = f"ekf_filter_node:\n  ros__parameters: {{odom_frame: odom, world_frame: odom{more}}}\n"
    text = f"stack: robot_localization\ncompanions: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=params, rover__urdf=GZ_DRIVE)
    made = make_outputs(plan)
    rows = "".join(it.text for it in made.files if it.path.endswith("bridge.yaml"))
    assert ("tf2_msgs/msg/TFMessage" in rows) == is_bridged
    assert "MG408" not in {it.code for it in made.findings}


@pytest.mark.more
def test_two_robots_that_send_a_shared_frame_on_one_topic(tmp_path: Path) -> None:
    text = f"stack: nav2\nshared_frames: [map, odom]\n{PARENTS}"
    (found,) = [it for it in make_outputs(planned(tmp_path, text)).findings if it.code == "MG408"]
    assert (found.message, found.level) == ("several nodes send map -> odom on /tf", "error")
    assert "/r1/amcl, /r2/amcl" in found.hint
    apart = text.replace("layout: L2", "layout: L3")
    assert not [it for it in make_outputs(planned(tmp_path, apart)).findings if it.code == "MG408"]
