# SPDX-License-Identifier: Apache-2.0
"""What rtabmap waits for, as setupCallbacks of rtabmap_sync's CommonDataSubscriber.cpp has it, and what
a robot does whose rtabmap waits in vain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fleet
import programs
import pytest
import rcl_names
import verdict
from node_set_cells import Cell

from multibot_rewrite.cli import multibot

COLOUR = {"rgb/image", "rgb/camera_info"}
DEPTH = {*COLOUR, "depth/image"}
OFF = {"subscribe_depth": False, "subscribe_rgb": False}


@pytest.mark.parametrize(
    ("given", "names"),
    [
        ({}, {*DEPTH, "odom"}),
        ({"subscribe_scan": True}, {*DEPTH, "odom", "scan"}),
        ({"odom_frame_id": "odom"}, DEPTH),
        ({"subscribe_depth": False}, {*COLOUR, "odom"}),
        ({**OFF, "subscribe_scan": True}, {"scan", "odom"}),
        ({**OFF, "subscribe_scan": True, "subscribe_scan_cloud": True}, {"scan", "odom"}),
        ({**OFF, "subscribe_odom": False}, set()),
        ({"subscribe_rgbd": True}, {"rgbd_image", "odom"}),
        ({"subscribe_rgbd": True, "rgbd_cameras": 0}, {"rgbd_images", "odom"}),
        ({"subscribe_rgbd": True, "subscribe_sensor_data": True}, {"sensor_data", "odom"}),
        ({"subscribe_sensor_data": True, "subscribe_scan": True}, {"sensor_data", "odom"}),
        ({"subscribe_odom_info": True}, {*DEPTH, "odom", "odom_info"}),
    ],
)
def test_what_it_waits_for(given: dict[str, Any], names: set[str]) -> None:
    assert programs.synchronised(given) == names


@pytest.mark.parametrize(
    ("given", "exact"),
    [
        ({}, False),
        ({"subscribe_stereo": True}, True),
        ({"subscribe_scan": True}, False),
        ({**OFF, "subscribe_scan": True}, True),
        ({**OFF, "subscribe_scan": True, "approx_sync": True}, False),
        ({"approx_sync": False}, True),
    ],
)
def test_when_stamps_have_to_be_equal(given: dict[str, Any], exact: bool) -> None:
    assert programs.is_exact(given) is exact


@pytest.mark.live
@rcl_names.needed()
@pytest.mark.parametrize(
    ("old", "new", "what", "why"),
    [
        ("'subscribe_depth': False", "'subscribe_depth': True", "sees", "waits for /robot1/depth"),
        ("'approx_sync': True", "'approx_sync': False", "sees", "of one stamp alone"),
        ("'subscribe_scan': True", "'subscribe_scan': True, 'odom_frame_id': 'other'", "plans",
         "looks for other on /robot1/tf"),
        ("    return [\n", "    return [\n        Node(package='tf2_ros',"
         " executable='static_transform_publisher', namespace=f'/{name}', name='again',"
         " arguments=['--frame-id', 'map', '--child-frame-id', 'odom'],"
         " remappings=[('/tf_static', 'tf_static')]),\n", "plans",
         "odom on /robot1/tf is placed by"),
    ],
)  # fmt: skip
def test_a_spoiled_one(old: str, new: str, what: str, why: str, tmp_path: Path) -> None:
    cell = Cell("gz", "rtabmap", "jazzy", "tf-per-robot", "gazebo")
    (tmp_path / "fleet.yaml").write_text(cell.fleet)
    out = tmp_path / "out"
    assert multibot.main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    launch = out / "fleet.launch.py"
    text = launch.read_text()
    assert old in text
    launch.write_text(text.replace(old, new, 1))
    found = verdict.judged(fleet.read(out, "jazzy"))
    assert any(it[:2] == ("robot1", what) and why in it.why for it in found), found
