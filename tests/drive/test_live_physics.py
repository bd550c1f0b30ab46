"""Two robots of a built fleet in one MuJoCo scene: a command for the first moves the first alone.

Names come from the folder as the referee reads it; commands, odometry, tf and joint states go through
DDS. The scene is the judge of what each robot says of itself.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import fleet
import gazebo
import pytest
import rcl_names
import verdict
from lxml import etree
from paths import ROOT

CHILD = Path(__file__).parent / "physics_child.py"
NEEDED = ("rclpy", "mujoco")
pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not all(map(importlib.util.find_spec, NEEDED)),
        reason=f"DDS and physics: pip install mujoco, {rcl_names.INSTALL}",
    ),
]
JOINT_STATE, ODOMETRY = "sensor_msgs/msg/JointState", "nav_msgs/msg/Odometry"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"


def built(example: str, folder: Path) -> fleet.Fleet:
    file = ROOT / "examples" / example / "fleet.yaml"
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "build", str(file)]
    subprocess.run([*command, "-o", str(folder)], check=True, capture_output=True)
    return fleet.read(folder, "lyrical")


def sent(found: fleet.Fleet, robot: str, kind: str) -> str:
    """The topic on which a robot sends such messages, by its nodes or its bridge."""
    nodes = [
        it.name for it in found.ends if (it.robot, it.role, it.type) == (robot, "publishes", kind)
    ]
    own = {it.topic for it in found.gz if it.model == found.models.get(robot)}
    rows = [it.ros for it in found.bridges if it.type == kind and it.gz in own]
    return [*nodes, *rows][0]


def base(found: fleet.Fleet, robot: str, file: Path, at: float) -> dict[str, Any]:
    """A robot with a drive: its joints, sizes and frames are those of its description."""
    root = etree.parse(str(file)).getroot()
    drive = next(it for it in root.iter("plugin") if "diff-drive" in it.get("filename"))
    (commands,) = {topic for who, topic, _ in verdict.heard(found) if who == robot}
    frames = [gazebo.text(drive, it) for it in ("frame_id", "child_frame_id")]
    own = [it for it in found.edges if it.robot == found.models[robot]]
    (tf,) = {it.topic for it in own if [it.parent, it.child] == frames}
    return {
        "name": robot, "urdf": str(file), "at": [at, 0], "free": True, "frames": frames, "tf": tf,
        "commands": commands, "odom": sent(found, robot, ODOMETRY),
        "states": f"{commands.rpartition('/')[0]}/joint_states",
        "wheels": [gazebo.text(drive, f"{it}_joint") for it in ("left", "right")],
        "separation": float(gazebo.text(drive, "wheel_separation")),
        "radius": float(gazebo.text(drive, "wheel_radius")),
    }  # fmt: skip


def arm(found: fleet.Fleet, robot: str, file: Path, at: float) -> dict[str, Any]:
    """A robot with a trajectory controller: the joints are those that its parameters name."""
    own = [it for it in found.nodes if it.robot == robot and it.name == "arm_controller"]
    topics = [it.name for it in found.ends if it.node == own[0].fqn and it.type == TRAJECTORY]
    return {
        "name": robot, "urdf": str(file), "at": [at, 3], "free": False,
        "trajectory": topics[0], "joints": own[0].values["joints"],
        "states": sent(found, robot, JOINT_STATE),
    }  # fmt: skip


def played(domain: int, robots: list[dict[str, Any]], *send: Any, film: str = "") -> dict[str, Any]:
    env = {
        **os.environ,
        "ROS_DOMAIN_ID": str(domain + os.getpid() % 20),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
    }
    command = [
        sys.executable,
        str(CHILD),
        json.dumps({"robots": robots, "send": send, "film": film}),
    ]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=240, env=env, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def moved(found: dict[str, Any], robot: str) -> list[float]:
    pairs = zip(found["began"][robot], found["ended"][robot], strict=True)
    return [after - before for before, after in pairs]


def drove(found: dict[str, Any], one: dict[str, Any], other: dict[str, Any]) -> None:
    """The first drove forward and to the left, the second stands; both know it."""
    x, y, _ = moved(found, one["name"])
    assert x > 0.5
    assert y > 0.02
    assert moved(found, other["name"]) == pytest.approx([0, 0, 0], abs=0.02)
    for it, there in ((one, (x, y)), (other, (0, 0))):
        said = found["said"][it["name"]]
        for kind in ("odom", *(("tf",) if importlib.util.find_spec("tf2_msgs") else ())):
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
