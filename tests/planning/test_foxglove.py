# SPDX-License-Identifier: Apache-2.0
"""The layout for Foxglove: its keys are those of lichtblick's sources, its topics those of the plan."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from paths import ROBOTS

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.shown import to_layout, world_of_plan
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    Robot,
    System,
    Topic,
    edge_of,
)

ROVERS = """\
layout: {layout}
affix: prefix
node_sets: nav2
description: {description}
robots: [{{name: robot1}}, {{name: robot2, pose: {{y: 2.0}}}}]
"""


def built(folder: Path, layout: str) -> dict[str, Any]:
    (folder / "fleet.yaml").write_text(
        ROVERS.format(layout=layout, description=ROBOTS / "rover.urdf")
    )
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out"), "-q"]) == 0
    made: dict[str, Any] = json.loads((folder / "out" / "foxglove.json").read_text())
    return made


def leaves(layout: Any) -> list[str]:
    """Return the panels of a mosaic, as react-mosaic has it: a name, or two parts."""
    if isinstance(layout, str):
        return [layout]
    assert layout["direction"] in ("row", "column")
    return [*leaves(layout["first"]), *leaves(layout["second"])]


@pytest.mark.more
def test_a_tab_for_all_robots_and_one_for_each(tmp_path: Path) -> None:
    made = built(tmp_path, "frames-per-robot")
    panels = made["configById"]
    assert made.keys() == {"configById", "globalVariables", "userNodes", "playbackConfig", "layout"}
    tabs = panels[made["layout"]]["tabs"]
    assert [it["title"] for it in tabs] == ["all robots", "robot1", "robot2"]
    shown = [name for it in tabs for name in leaves(it["layout"])]
    assert sorted([*shown, made["layout"]]) == sorted(panels)
    assert {it.partition("!")[0] for it in panels} <= {"3D", "Image", "Teleop", "Tab"}
    all_of_them, own = panels["3D!all"], panels["3D!robot2"]
    assert {"/robot1/scan", "/robot2/scan"} <= all_of_them["topics"].keys()
    assert all(it.startswith("/robot2/") for it in own["topics"])
    assert own["followTf"] == "robot2/base_footprint"
    assert own["publish"]["poseTopic"] == "/robot2/goal_pose"
    assert own["layers"]["robot2"]["topic"] == "/robot2/robot_description"
    assert own["layers"]["robot2"]["framePrefix"] == ""
    image = panels["Image!robot1_0"]["imageMode"]
    assert image["imageTopic"].rpartition("/")[0] == image["calibrationTopic"].rpartition("/")[0]


@pytest.mark.more
def test_links_without_a_prefix_get_that_of_the_robot(tmp_path: Path) -> None:
    """robot_state_publisher's frame_prefix: the links are bare, the frames are not."""
    layers = built(tmp_path, "frame-prefix")["configById"]["3D!all"]["layers"]
    assert [it["framePrefix"] for it in layers.values()] == ["robot1/", "robot2/"]


def sends(node: str, name: str, type_: str, role: str = PUBLISHES) -> End:
    return End(TOPIC, role, name, type_, "", node, None, "")


TWIST = "geometry_msgs/msg/Twist"
PLAN = System(
    nodes=(Node("/a/driver", robot="a"), Node("/maps")),
    ends=(
        sends("/a/driver", "/a/scan", "sensor_msgs/msg/LaserScan"),
        sends("/a/driver", "/a/odom", "nav_msgs/msg/Odometry"),
        sends("/a/driver", "/a/eye/image", "sensor_msgs/msg/Image"),
        sends("/a/driver", "/a/description", "std_msgs/msg/String"),
        sends("/a/driver", "/a/robot_description", "std_msgs/msg/String"),
        sends("/a/driver", "/a/front/cmd_vel", TWIST, SUBSCRIBES),
        sends("/a/driver", "/a/cmd_vel", TWIST, SUBSCRIBES),
        sends("/a/driver", "/a/go", TWIST, SUBSCRIBES),
        sends("/a/driver", "/a/goal_pose", "geometry_msgs/msg/PoseStamped", SUBSCRIBES),
        sends("/maps", "/map", "nav_msgs/msg/OccupancyGrid"),
        sends("/maps", "/a/go", TWIST),
        End(SERVICE, PUBLISHES, "/a/none", "sensor_msgs/msg/LaserScan", "", "/maps", None, ""),
    ),
    robots=(
        Robot("a", ("a/odom", "a/base_link"), "/tf"),
        Robot("b", ("x/odom",), "/tf", (), "x", "g/b"),
    ),
    topics=(
        Topic("/g/b/depth", bridge=(PUBLISHES,), type="sensor_msgs/msg/PointCloud2"),
        Topic("/g/b/cmd", bridge=(SUBSCRIBES,), type=TWIST),
        Topic("/all", bridge=(PUBLISHES,), type="sensor_msgs/msg/PointCloud2"),
    ),
    layout="frame-prefix",
    shared_frames=("map",),
)


def scene(frame: str, topics: list[str], layers: dict[str, object], goal: str) -> dict[str, object]:
    return {
        "followTf": frame,
        "followMode": "follow-pose",
        "topics": {it: {"visible": True} for it in topics},
        "layers": layers,
        "publish": {
            "type": "pose",
            "poseTopic": goal,
            "poseEstimateTopic": "/initialpose",
            "pointTopic": "/clicked_point",
        },
    }


def model(robot: str, prefix: str, space: str) -> dict[str, object]:
    return {
        "layerId": "foxglove.Urdf",
        "instanceId": robot,
        "label": robot,
        "visible": True,
        "sourceType": "topic",
        "topic": f"/{space}/robot_description",
        "framePrefix": prefix,
    }


def test_the_whole_layout_of_a_small_plan() -> None:
    a, b = model("a", "a/", "a"), model("b", "x/", "g/b")
    side = {"direction": "column", "first": "Image!a_0", "second": "Teleop!a"}
    own = {"direction": "row", "first": "3D!a", "second": side, "splitPercentage": 70}
    other = {"direction": "row", "first": "3D!b", "second": "Teleop!b", "splitPercentage": 70}
    assert json.loads(to_layout(PLAN)) == {
        "configById": {
            "3D!all": scene(
                "map", ["/a/scan", "/g/b/depth", "/map"], {"a": a, "b": b}, "/a/goal_pose"
            ),
            "3D!a": scene("a/base_link", ["/a/scan", "/map"], {"a": a}, "/a/goal_pose"),
            "Image!a_0": {
                "imageMode": {
                    "imageTopic": "/a/eye/image",
                    "calibrationTopic": "/a/eye/camera_info",
                }
            },
            "Teleop!a": {"topic": "/a/cmd_vel", "publishRate": 10},
            "3D!b": scene("x/odom", ["/g/b/depth", "/map"], {"b": b}, "/goal_pose"),
            "Teleop!b": {"topic": "/g/b/cmd", "publishRate": 10},
            "Tab!robots": {
                "activeTabIdx": 0,
                "tabs": [
                    {"title": "all robots", "layout": "3D!all"},
                    {"title": "a", "layout": own},
                    {"title": "b", "layout": other},
                ],
            },
        },
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": "Tab!robots",
    }


@pytest.mark.parametrize(
    ("edges", "shared", "frame"),
    [
        ((edge_of("map", "odom"), edge_of("site", "map")), ("map", "site"), "map"),
        ((edge_of("site", "map"),), ("map", "site"), "site"),
        ((edge_of("lab", "odom"),), ("world", "map"), "map"),
        ((), ("world",), "world"),
        ((), ("hall",), "a/odom"),
    ],
)
def test_robots_stand_in_what_they_share(
    edges: tuple[Edge, ...], shared: tuple[str, ...], frame: str
) -> None:
    assert world_of_plan(PLAN._replace(edges=edges, shared_frames=shared)) == frame
