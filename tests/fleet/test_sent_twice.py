# SPDX-License-Identifier: Apache-2.0
"""Frames that two nodes of a fleet send, by its parameter files and descriptions."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import SMALL, fleet_folder, planned_fleet

from multibot_rewrite.checks.build import make_outputs
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
    sets = "node_sets: [localization, nav2_slam]\n"
    text = f"{sets}related_files: {{params: params.yaml}}\n{PARENTS}"
    plan = planned(tmp_path, text, params__yaml=params)
    found = [it for it in make_outputs(plan).findings if it.code == "MG408"]
    assert len(found) == 1
    assert found[0].message == "several nodes send map -> r1/odom on /tf"
    assert "/r1/amcl, /r1/slam_toolbox" in found[0].hint
    assert (Path(found[0].file).name, found[0].line) == ("params.yaml", 2)


@pytest.mark.more
def test_two_robots_that_send_a_shared_frame_on_one_topic(tmp_path: Path) -> None:
    text = f"node_sets: nav2\nshared_frames: [map, odom]\n{PARENTS}"
    (found,) = [it for it in make_outputs(planned(tmp_path, text)).findings if it.code == "MG408"]
    assert (found.message, found.level) == ("several nodes send map -> odom on /tf", "error")
    assert "/r1/amcl, /r2/amcl" in found.hint
    apart = text.replace("layout: L2", "layout: L3")
    assert not [it for it in make_outputs(planned(tmp_path, apart)).findings if it.code == "MG408"]
