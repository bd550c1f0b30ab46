# SPDX-License-Identifier: Apache-2.0
"""Two robots of a built fleet in one MuJoCo scene: a command for the first moves the first alone.

Names come from the folder as the referee reads it; commands, odometry, tf and joint states go through
DDS. The scene is the judge of what each robot says of itself.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest
import rcl_names
from scenes import arm, base, built, played, sent

NEEDED = ("rclpy", "mujoco")
pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not all(map(importlib.util.find_spec, NEEDED)),
        reason=f"DDS and physics: pip install mujoco, {rcl_names.INSTALL}",
    ),
]


def moved(found: dict[str, Any], robot: str) -> list[float]:
    pairs = zip(found["began"][robot], found["ended"][robot], strict=True)
    return [after - before for before, after in pairs]


def drove(found: dict[str, Any], one: dict[str, Any], other: dict[str, Any]) -> None:
    """Assert that the first drove forward and left, the second stands, and both know it."""
    x, y, _ = moved(found, one["name"])
    assert x > 0.5
    assert y > 0.02
    assert moved(found, other["name"]) == pytest.approx([0, 0, 0], abs=0.02)
    for it, there in ((one, (x, y)), (other, (0, 0))):
        said = found["said"][it["name"]]
        for kind in ("odom", "tf"):
            assert said[kind][:2] == it["frames"]
            assert said[kind][2:] == pytest.approx(there, abs=0.05)


def test_a_base_with_a_lidar_drives_and_the_other_stands(tmp_path: Path) -> None:
    found = built("two_robots_nav2", tmp_path)
    one, other = (
        base(found, it, tmp_path / it / "hexbase.urdf", at)
        for it, at in (("robot1", 1), ("robot2", -1))
    )
    seen = {it: sent(found, it, "sensor_msgs/msg/LaserScan") for it in ("robot1", "robot2")}
    assert len(set(seen.values())) == 2
    drove(played(60, [one, other], (one["commands"], "Twist", [0.2, 0.1])), one, other)


@pytest.mark.deep
def test_a_base_with_an_arm_drives_and_the_arm_stands(tmp_path: Path) -> None:
    found = built("mixed_fleet", tmp_path)
    one, other = (
        base(found, it, tmp_path / it / "hexbase.urdf", at)
        for it, at in (("base1", 1), ("base2", -1))
    )
    third = arm(found, "arm", tmp_path / "arm" / "arm.urdf", 0)
    seen = played(80, [one, other, third], (one["commands"], "Twist", [0.2, 0.1]))
    drove(seen, one, other)
    assert moved(seen, "arm") == pytest.approx([0, 0], abs=0.02)
    goal = dict(zip(third["joints"], (0.4, -0.3), strict=True))
    seen = played(80, [one, other, third], (third["trajectory"], "JointTrajectory", goal))
    assert moved(seen, "arm") == pytest.approx([0.4, -0.3], abs=0.05)
    assert seen["said"]["arm"]["states"] == pytest.approx(goal, abs=0.05)
    for it in ("base1", "base2"):
        assert moved(seen, it) == pytest.approx([0, 0, 0], abs=0.02)


@pytest.mark.deep
def test_of_two_arms_one_moves(tmp_path: Path) -> None:
    found = built("two_arms_moveit", tmp_path)
    one, other = (
        arm(found, it, tmp_path / it / "arm.urdf", at) for it, at in (("left", 1), ("right", -1))
    )
    goal = dict(zip(one["joints"], (0.4, -0.3), strict=True))
    seen = played(100, [one, other], (one["trajectory"], "JointTrajectory", goal))
    assert moved(seen, "left") == pytest.approx([0.4, -0.3], abs=0.05)
    assert moved(seen, "right") == pytest.approx([0, 0], abs=0.05)
    assert seen["said"]["left"]["states"] == pytest.approx(goal, abs=0.05)
    assert set(seen["said"]["left"]["states"]).isdisjoint(seen["said"]["right"]["states"])
