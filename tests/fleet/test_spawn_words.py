# SPDX-License-Identifier: Apache-2.0
"""Words for programs that put robots into a simulator and into the world."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.launch.starts import Start
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
    assert spawn.gz_arguments(it) == gz and spawn.classic_arguments(it) == classic
    assert spawn.classic_arguments(it._replace(namespace="")) == classic[:-2]
    assert spawn.spawner(it, False) == Start("ros_gz_sim", "create", arguments=tuple(gz))
    assert spawn.spawner(it, True) == Start(
        "gazebo_ros", "spawn_entity.py", arguments=tuple(classic)
    )


@pytest.mark.parametrize(
    ("layout", "namespace", "node", "remaps"),
    [
        ("L1", "/r1", "start_pose", (("/tf_static", "tf_static"),)),
        ("L2", "/r1", "start_pose", ()),
        ("L4", "/", "start_pose_r1", (("/tf_static", "/tf_static/r1"),)),
    ],
)
def test_a_static_transform_is_a_process(
    layout: str, namespace: str, node: str, remaps: tuple[tuple[str, str], ...]
) -> None:
    made = start_poses.static_transform("r1", "map", "odom", POSE, make_naming(layout))
    words = [
        "--x", "1.0", "--y", "-2.0", "--z", "0.5", "--roll", "0.1", "--pitch", "0.2", "--yaw", "1.5",
        "--frame-id", "map", "--child-frame-id", "odom",
    ]  # fmt: skip
    assert made == start_poses.StaticTransform("r1", "map", "odom", POSE, namespace, node, remaps)
    program = ("tf2_ros", "static_transform_publisher", namespace, node)
    assert made.start == Start(*program, (), remaps, tuple(words))
    assert made.words[: len(words)] == words and made.words[len(words)] == "--ros-args"


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
