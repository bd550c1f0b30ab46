# SPDX-License-Identifier: Apache-2.0
"""The RViz configs of a fleet that has none: what a display names is in the plan, of its robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import ROBOTS

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.outputs import rviz_outputs
from multibot_rewrite.related_files.rviz.read_config import read_config, rviz_data
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import PUBLISHES

FLEET = """\
layout: {layout}
node_sets: nav2
description: {description}
robots: [{{name: robot1}}, {{name: robot2, pose: {{y: 2.0}}}}]
"""


def displays(config: Any) -> Iterator[dict[str, Any]]:
    for it in config["Displays"]:
        yield it
        yield from displays(it) if "Displays" in it else ()


def test_every_type_has_its_display() -> None:
    """rviz_default_plugins plugins_description.xml: what each subscribes to."""
    assert {
        **{f"sensor_msgs/msg/{it}": it for it in ("LaserScan", "PointCloud2", "Range")},
        "nav_msgs/msg/OccupancyGrid": "Map", "nav_msgs/msg/Path": "Path",
        "geometry_msgs/msg/PolygonStamped": "Polygon", "geometry_msgs/msg/PoseArray": "PoseArray",
        **{f"visualization_msgs/msg/{it}": it for it in ("Marker", "MarkerArray")},
    } == rviz_data()["shown"]  # fmt: skip
    assert {*rviz_outputs._COLOURED} == {
        "LaserScan", "PointCloud2", "Range", "Path", "Polygon", "PoseArray"
    }  # fmt: skip
    assert {*rviz_outputs._QOS} == {"LaserScan", "PointCloud2", "Map"}
    assert rviz_outputs._TOOLS == {"SetInitialPose": "initialpose", "SetGoal": "goal_pose"}


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "layout", ["frames-per-robot", "tf-per-robot", "both", "postfix", "frame-prefix"]
)
def test_what_a_build_shows_is_in_its_plan(layout: str, tmp_path: Path) -> None:
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(FLEET.format(layout=layout, description=ROBOTS / "rover.urdf"))
    assert main(["build", str(fleet), "-o", str(tmp_path / "out"), "-q"]) == 0
    plan = from_yaml((tmp_path / "out" / "plan.yaml").read_bytes(), "plan.yaml")
    windows = sorted((tmp_path / "out").rglob("*.rviz"))
    assert len(windows) == (1 if "tf" not in layout and layout not in ("both", "postfix") else 2)
    sent = {(it.name, it.type) for it in plan.ends if it.role == PUBLISHES}
    for path in windows:
        assert read_config(read_yaml(path.read_bytes(), str(path))).displays
        manager = yaml.safe_load(path.read_text())["Visualization Manager"]
        for it in displays(manager):
            assert it["Class"] in {*rviz_data()["displays"], "rviz_common/Group"}
            topic = it.get("Topic") or it.get("Description Topic") or {}
            kind = it["Class"].rpartition("/")[2].replace("RobotModel", "String")
            types = {type_ for name, type_ in sent if name == topic.get("Value")}
            assert not topic or any(kind in type_ or kind == "Map" for type_ in types), it
        frames = {*plan.shared_frames, *(it for robot in plan.robots for it in robot.frames)}
        assert manager["Global Options"]["Fixed Frame"] in frames
    lines = (tmp_path / "out" / "commands.md").read_text().splitlines()
    assert sum(it.startswith("rviz2 -d ") for it in lines) == len(windows)
