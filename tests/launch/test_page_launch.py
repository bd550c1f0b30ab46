# SPDX-License-Identifier: Apache-2.0
"""The first snippets of the page on launch files: by hand with nav2_common, and with a fleet file."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import yaml
from launched_programs import launched
from paths import FIXTURES, ROOT

from multibot_rewrite import launch

PAGE = (ROOT / "docs" / "launch.md").read_text()
BY_HAND, OURS = re.findall(r"```python\n(def bt_navigator.*?)```", PAGE, re.DOTALL)
FLEET = """\
distro: jazzy
layout: LAYOUT
node_sets: nav2
robots:
  - {name: robot1, description: rover.urdf}
  - {name: robot2, description: rover.urdf}
related_files: {params: params.yaml}
"""
PARAMS = "bt_navigator:\n  ros__parameters: {odom_topic: /odom, robot_base_frame: base_link}\n"
HEAD = """\
from launch import LaunchDescription
from launch.actions import GroupAction
from launch_ros.actions import Node, PushRosNamespace
MORE

"""
TAIL = "\n\ndef generate_launch_description():\n    return LaunchDescription(MADE)\n"
MISSING = launch.missing() or ("" if find_spec("nav2_common") else "nav2_common is not here")
OWN = "from multibot_rewrite.launch import each_robot, node"


def test_ours_is_shorter_than_by_hand() -> None:
    def lines(text: str) -> int:
        return sum(1 for it in text.splitlines() if it.strip())

    assert lines(OURS) < lines(BY_HAND)
    assert len(OURS) < len(BY_HAND) / 2


def started(folder: Path, head: str, code: str, made: str) -> dict[str, Any]:
    """Return the odometry topic and the base frame by namespace, of what really starts."""
    text = HEAD.replace("MORE", head) + code + TAIL.replace("MADE", made)
    (folder / "readme.launch.py").write_text(text)
    told, said = launched(
        folder / "readme.launch.py", folder, programs={"bt_navigator": "nav2_bt_navigator"}
    )
    assert "Caught exception" not in said, said
    return dict(pair for it in told for pair in _parameters(it["files"]))


def _parameters(files: dict[str, str]) -> list[tuple[str, Any]]:
    found = []
    for text in (it for it in files.values() if "odom_topic" in it):
        for section, data in yaml.safe_load(text).items():
            values = data.get("bt_navigator", data).get("ros__parameters", {})
            if "odom_topic" in values:
                found.append((section.strip("/").split("/")[0], values["odom_topic"]))
    return found


@pytest.mark.slow
@pytest.mark.skipif(bool(launch.missing()), reason=f"not tried in the real launch: {MISSING}")
@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot"])
def test_each_robot_reads_its_own_odometry(layout: str, here: Path) -> None:
    for name, text in {
        "params.yaml": PARAMS,
        "fleet.yaml": FLEET.replace("LAYOUT", layout),
    }.items():
        (here / name).write_text(text)
    (here / "rover.urdf").write_text((FIXTURES / "robots" / "rover.urdf").read_text())
    found = started(here, OWN, OURS, "[made]")
    assert found == {it: f"/{it}/odom" for it in ("robot1", "robot2")}


@pytest.mark.slow
@pytest.mark.skipif(bool(MISSING), reason=f"not tried in the real launch: {MISSING}")
def test_by_hand_both_read_one(here: Path) -> None:
    (here / "params.yaml").write_text(PARAMS)
    head = "from nav2_common.launch import RewrittenYaml"
    assert started(here, head, BY_HAND, "made") == {"robot1": "/odom", "robot2": "/odom"}
