# SPDX-License-Identifier: Apache-2.0
"""Robots of a built fleet, as the scene of ``physics_child.py`` wants them, and the scene played.

Names come from the folder as the referee reads it; commands, odometry, tf and states go through DDS.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import fleet
import gazebo
import verdict
from lxml import etree
from paths import ROOT

CHILD = Path(__file__).parent / "physics_child.py"
JOINT_STATE, ODOMETRY = "sensor_msgs/msg/JointState", "nav_msgs/msg/Odometry"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"


def built(example: str, folder: Path) -> fleet.Fleet:
    file = ROOT / "examples" / example / "fleet.yaml"
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "build", str(file)]
    subprocess.run([*command, "-o", str(folder)], check=True, capture_output=True)
    return fleet.read(folder, "lyrical")


def sent(found: fleet.Fleet, robot: str, kind: str) -> str:
    """Return the topic on which a robot sends such messages, by its nodes or its bridge."""
    nodes = [
        it.name for it in found.ends if (it.robot, it.role, it.type) == (robot, "publishes", kind)
    ]
    own = {it.topic for it in found.gz if it.model == found.models.get(robot)}
    rows = [it.ros for it in found.bridges if it.type == kind and it.gz in own]
    return [*nodes, *rows][0]


def base(found: fleet.Fleet, robot: str, file: Path, at: float) -> dict[str, Any]:
    """Return a robot with a drive: its joints, sizes and frames are those of its description."""
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
    """Return a robot with a trajectory controller: the joints are those that its parameters name."""
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
