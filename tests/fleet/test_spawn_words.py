# SPDX-License-Identifier: Apache-2.0
"""Words for programs that put robots into a simulator and into the world."""

from __future__ import annotations

import pytest

from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.outputs import spawn
from multibot_rewrite.fleet.outputs.spawn import Spawn
from multibot_rewrite.fleet.robots import start_poses

POSE = Pose(1.0, -2.0, 0.5, 0.1, 0.2, 1.5)
FLAGS = ["-x", "1.0", "-y", "-2.0", "-z", "0.5", "-R", "0.1", "-P", "0.2", "-Y", "1.5"]
ROVER = Spawn("r1", "rover1", "/r1/robot_description", POSE, "r1")


@pytest.mark.parametrize(
    ("it", "source"),
    [
        (ROVER, ["-topic", "/r1/robot_description"]),
        (ROVER._replace(file="r.sdf"), ["-file", "r.sdf"]),
        (ROVER._replace(file="r.sdf", text="<sdf/>"), ["-string", "<sdf/>"]),
    ],
)
def test_what_follows_a_spawner(it: Spawn, source: list[str]) -> None:
    """ros_gz_sim create.cpp (gflags), gazebo_ros spawn_entity.py."""
    gz = ["-name", "rover1", *source, *FLAGS, "-allow_renaming=false"]
    classic = ["-entity", "rover1", *source, *FLAGS, "-robot_namespace", "/r1"]
    made = {name: spawn.spawner(it, name == "classic") for name in ("gz", "classic")}
    assert made["gz"].words == gz and made["classic"].words == classic
    assert spawn.spawner(it._replace(namespace=""), True).words == classic[:-2]
    assert made["gz"][:2] == ("ros_gz_sim", "create")
    assert made["classic"][:2] == ("gazebo_ros", "spawn_entity.py")


def test_a_pose_as_parameters_of_amcl() -> None:
    """nav2_amcl: they count with set_initial_pose alone."""
    assert start_poses.initial_pose(POSE) == {
        "set_initial_pose": True, "initial_pose.x": 1.0, "initial_pose.y": -2.0, "initial_pose.z": 0.5,
        "initial_pose.yaw": 1.5,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("name", "it_is"),
    [("odom_frame", True), ("odom_frame_id", True), ("odometry_frame_name", True),
     ("base.odom_frame", True),
     ("my_odom_frame", True), ("myodom_frame", False), ("odom_frames", False), ("odom", False)],
)  # fmt: skip
def test_what_drivers_call_their_odometry_frame(name: str, it_is: bool) -> None:
    assert bool(start_poses.ODOMETRY_FRAME.search(name)) is it_is
