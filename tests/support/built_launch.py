# SPDX-License-Identifier: Apache-2.0
"""Fleets of each kind, built: what the tests of ``fleet.launch.py`` share."""

from __future__ import annotations

import shutil
from pathlib import Path

from paths import ROBOTS

from multibot_rewrite.cli.multibot import main

TWO = "robots:\n  - {name: robot1, pose: {x: 1.0}}\n  - {name: robot2, pose: {x: 3.0}}\n"
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    wheels: {type: diff_drive_controller/DiffDriveController}
wheels:
  ros__parameters: {left_wheel_names: [left_wheel_joint], right_wheel_names: [right_wheel_joint]}
"""
FLEETS = {
    "classic": f"description: rover.urdf\n{TWO}",
    "gz": "description: rover_gz.urdf\nnode_sets: gz_ros2_control\nrelated_files: {params: c.yaml}\n"
    + TWO,
    "sdf": f"description: rover.sdf\n{TWO}",
    "real": f"description: two_finger_arm.urdf\nsimulator: none\nnode_sets: robot_state\n{TWO}",
    "kinds": (
        "robots:\n  - {name: robot1, description: rover.urdf, pose: {x: 1.0}}\n"
        "  - {name: arm, description: two_finger_arm.urdf, pose: {x: 3.0}}\n"
    ),
    "ten": "description: rover.urdf\nrobots:\n  - {name: robot, count: 10, step: {y: 2.0}}\n",
}


def built(folder: Path, kind: str, layout: str) -> Path:
    """Return the folder of a fleet that was built."""
    for name in ("rover.urdf", "rover_gz.urdf", "rover.sdf", "two_finger_arm.urdf"):
        shutil.copy(ROBOTS / name, folder)
    (folder / "c.yaml").write_text(CONTROLLERS)
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"layout: {layout}\n{FLEETS[kind]}")
    assert main(["build", str(fleet), "-o", str(folder / "out"), "-q"]) == 0
    return folder / "out"
