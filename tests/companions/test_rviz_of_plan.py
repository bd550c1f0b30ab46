# SPDX-License-Identifier: Apache-2.0
"""The RViz configs of a fleet that has none: what a display names is in the plan, of its robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import ROBOTS, fixture_text
from plans import planned_end

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.companions.rviz import of_plan
from multibot_rewrite.companions.rviz.of_plan import windows_of_plan
from multibot_rewrite.companions.rviz.read_config import read_config, rviz_data
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    Node,
    Robot,
    System,
    Topic,
)

SCAN, MAP, GOAL = (
    *("sensor_msgs/msg/LaserScan", "nav_msgs/msg/OccupancyGrid"),
    "geometry_msgs/msg/PoseStamped",
)
FLEET = """\
layout: {layout}
stack: nav2
description: {description}
robots: [{{name: robot1}}, {{name: robot2, pose: {{y: 2.0}}}}]
"""


def two(layout: str, *tf: str) -> System:
    """Two robots with a map, a bridged scan and a goal; each one's transforms on a topic of ``tf``."""
    robots = [Robot(f"robot{at}", (f"robot{at}/base",), topic) for at, topic in enumerate(tf, 1)]
    ends = [
        planned_end(f"/{it.name}/nav", TOPIC, role, f"/{it.name}/{name}", type_)
        for it in robots
        for name, role, type_ in (
            *(("map", PUBLISHES, MAP), ("local/costmap", PUBLISHES, MAP)),
            ("goal_pose", SUBSCRIBES, GOAL),
        )
    ]
    return System(
        layout=layout,
        robots=tuple(robots),
        nodes=tuple(Node(f"/{it.name}/nav", robot=it.name) for it in robots),
        ends=tuple(ends),
        topics=tuple(Topic(f"/{it.name}/scan", bridge=(PUBLISHES,), type=SCAN) for it in robots),
        edges=tuple(Edge(it.frames[0], "map", "", True, ()) for it in robots),
        shared_frames=("map",),
    )


def displays(config: Any) -> Iterator[dict[str, Any]]:
    for it in config["Displays"]:
        yield it
        yield from displays(it) if "Displays" in it else ()


def test_one_window_has_a_group_for_each_robot() -> None:
    (made,) = windows_of_plan(two("frames-per-robot", "/tf", "/tf"), relayed=False)
    manager = yaml.safe_load(made.text)["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == "map"
    *_, first, second = manager["Displays"]
    assert (first["Name"], second["Name"]) == ("robot1", "robot2")
    shown = {it["Topic"]["Value"]: it for it in displays(second) if "Topic" in it}
    assert shown.keys() == {"/robot2/map", "/robot2/local/costmap", "/robot2/scan"}
    # rviz_default_plugins: a map is latched, a scan best effort; a costmap would hide the map.
    assert shown["/robot2/map"]["Topic"]["Durability Policy"] == "Transient Local"
    assert shown["/robot2/scan"]["Topic"]["Reliability Policy"] == "Best Effort"
    assert [it["Enabled"] for it in shown.values()] == [False, True, True]
    scans = [it["Color"] for it in displays(manager) if it.get("Name", "").endswith("scan")]
    assert len({*scans}) == 2
    goals = [it["Topic"]["Value"] for it in manager["Tools"] if "Topic" in it]
    assert goals == ["/robot1/goal_pose", "/robot2/goal_pose"]


WHOLE = fixture_text("rviz_of_plan_whole.yaml")


def test_the_whole_config_of_a_robot() -> None:
    """What rviz2 saves for these displays, in the first colour of Okabe and Ito."""
    plan = two("frames-per-robot", "/tf")
    about = planned_end("/robot1/nav", TOPIC, PUBLISHES, "/robot1/plan", "nav_msgs/msg/Path")
    (made,) = windows_of_plan(plan._replace(ends=(*plan.ends[::2], about)), relayed=False)
    assert made.text == WHOLE


def test_every_type_has_its_display() -> None:
    """rviz_default_plugins plugins_description.xml: what each subscribes to."""
    assert {
        **{f"sensor_msgs/msg/{it}": it for it in ("LaserScan", "PointCloud2", "Range")},
        "nav_msgs/msg/OccupancyGrid": "Map", "nav_msgs/msg/Path": "Path",
        "geometry_msgs/msg/PolygonStamped": "Polygon", "geometry_msgs/msg/PoseArray": "PoseArray",
        **{f"visualization_msgs/msg/{it}": it for it in ("Marker", "MarkerArray")},
    } == rviz_data()["shown"]  # fmt: skip
    assert {*of_plan._COLOURED} == {
        "LaserScan", "PointCloud2", "Range", "Path", "Polygon", "PoseArray"
    }  # fmt: skip
    assert {*of_plan._QOS} == {"LaserScan", "PointCloud2", "Map"}
    assert of_plan._TOOLS == {"SetInitialPose": "initialpose", "SetGoal": "goal_pose"}


def test_a_tf_topic_for_each_robot_is_a_window_for_each() -> None:
    plan = two("both", "/robot1/tf", "/robot2/tf")
    first, second = windows_of_plan(plan, relayed=False)
    assert second.robot == "robot2"
    assert second.remaps == (("/tf", "/robot2/tf"), ("/tf_static", "/robot2/tf_static"))
    assert "robot2" not in first.text
    assert len(windows_of_plan(plan, relayed=True)) == 1


def test_what_is_of_no_robot_has_no_colour() -> None:
    plan = two("frames-per-robot", "/tf", "/tf")
    hall = planned_end("/lidar_of_the_hall", TOPIC, PUBLISHES, "/hall_scan", SCAN)
    (made,) = windows_of_plan(plan._replace(ends=(*plan.ends, hall)), relayed=False)
    shown = displays(yaml.safe_load(made.text)["Visualization Manager"])
    (scan,) = [it for it in shown if it.get("Topic", {}).get("Value") == "/hall_scan"]
    assert "Color" not in scan and "Color Transformer" not in scan


@pytest.mark.more
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
