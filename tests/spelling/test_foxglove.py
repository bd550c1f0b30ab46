# SPDX-License-Identifier: Apache-2.0
"""The layout for Foxglove: its keys are those of lichtblick's sources, its topics those of the plan."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from paths import ROBOTS

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.spelling.foxglove import to_layout
from multibot_rewrite.system.records import Robot, System

ROVERS = """\
layout: {layout}
affix: prefix
stack: nav2
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
    """The panels of a mosaic, as react-mosaic has it: a name, or two parts."""
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


def test_frames_of_one_name_give_no_layout() -> None:
    robots = tuple(Robot(it, ("odom", "base_link"), f"/{it}/tf") for it in ("robot1", "robot2"))
    assert not to_layout(System(layout="tf-per-robot", robots=robots))
    assert to_layout(System(layout="tf-per-robot", robots=robots[:1]))
