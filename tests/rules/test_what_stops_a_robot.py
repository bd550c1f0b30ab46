# SPDX-License-Identifier: Apache-2.0
"""What stops or endangers a robot is an error; silence of drivers, services and states is told."""

from __future__ import annotations

import pytest
from graph_examples import read_system

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.rules.check import judge
from multibot_rewrite.system.records import BUSY_MACHINE, Caveat

TWIST, SCAN, ODOM = (
    "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry",
)  # fmt: skip
JOY, CLEAR = "sensor_msgs/msg/Joy", "nav2_msgs/srv/ClearEntireCostmap"
FOLLOW = "control_msgs/action/FollowJointTrajectory"


def found(*lines: str) -> list[Finding]:
    return judge(read_system("\n".join(f"running: {it}" for it in lines)))


def codes(*lines: str) -> list[tuple[str, str, str]]:
    return [(it.code, it.level, it.node) for it in found(*lines)]


DRIVER = [
    f"/robot2/base subscribes /robot2/cmd_vel {TWIST}",
    f"/robot2/base publishes /robot2/odom {ODOM}",
    "/robot2/base publishes /robot2/imu sensor_msgs/msg/Imu",
]
USERS = [
    f"/robot{it}/{node} {does} /robot{it}/{name} {type_}"
    for it in (1, 2)
    for node, does, name, type_ in (
        ("pilot", "publishes", "cmd_vel", TWIST),
        ("pilot", "subscribes", "odom", ODOM),
        ("filter", "subscribes", "imu", "sensor_msgs/msg/Imu"),
    )
]


def test_all_that_one_driver_does_is_one_finding() -> None:
    (it,) = found(*DRIVER, *USERS)
    assert (it.code, it.level, it.robot) == ("MG322", "error", "robot1")
    assert {*it.names} == {"/robot1/cmd_vel", "/robot1/odom", "/robot1/imu"}
    assert "robot1 has no base, as robot2 has (/robot2/base)" in it.message


def test_a_driver_that_nobody_waits_for_may_be_left_out() -> None:
    assert codes(*DRIVER, *(it for it in USERS if it.startswith("/robot2"))) == []


def test_goals_for_a_robot_whose_server_is_gone() -> None:
    go = "nav2_msgs/action/NavigateToPose"
    calls = [f"/fleet_manager calls /robot{it}/go {go}" for it in "12"]
    here = ["/robot1/driver", "/robot2/driver"]
    (it,) = found(*calls, *here, f"/robot2/bt_navigator serves /robot2/go {go}")
    assert (it.code, it.level, it.robot, it.names) == ("MG322", "error", "robot1", ("/robot1/go",))
    assert "robot1 has no bt_navigator" in it.message and "/fleet_manager in vain" in it.message
    # An RViz panel has goals for nobody, and where no robot serves it none is odd.
    panel = [it.replace("fleet_manager", "rviz2") for it in calls]
    assert codes(*panel, *here, f"/robot2/bt_navigator serves /robot2/go {go}") == []
    assert codes(*calls, *here) == []


def test_a_driver_under_another_name_is_why_it_is_missed() -> None:
    moved = [it.replace("/robot2/", "/").replace("/base ", "/robot1/base ") for it in DRIVER[1:2]]
    told = codes(*DRIVER, *USERS, *moved)
    assert ("MG303", "error", "/robot1/pilot") in told
    assert "MG322" not in {code for code, *_ in told}


COMMANDS = [
    f"/robot{it}/{node} {does} /robot{it}/{name} {TWIST}"
    for it in (1, 2)
    for node, does, name in (
        ("base", "subscribes", "cmd_vel"),
        ("collision_monitor", "publishes", "cmd_vel"),
        ("collision_monitor", "subscribes", "cmd_vel_smoothed"),
        ("velocity_smoother", "publishes", "cmd_vel_smoothed"),
    )
]


def test_a_lost_link_between_commands_and_drive_is_not_bridged() -> None:
    assert codes(*COMMANDS) == []
    (it,) = found(*(it for it in COMMANDS if "/robot1/collision" not in it))
    assert (it.code, it.level, it.robot, it.remaps) == ("MG322", "error", "robot1", ())
    assert "robot1 has no collision_monitor, as robot2 has" in it.message
    # Of a robot that has no like the hint says where to look.
    (it,) = found(*(it for it in COMMANDS[:4] if "collision" not in it))
    assert (it.code, it.level, it.node, it.remaps) == ("MG303", "error", "/robot1/base", ())
    assert "start what passes /robot1/cmd_vel_smoothed on" in it.hint
    # Who only sends may be idle.
    idle = [it for it in COMMANDS if it.startswith(("/robot1/base", "/robot2/base"))]
    assert codes(*idle, f"/robot2/teleop publishes /robot2/cmd_vel {TWIST}") == []


@pytest.mark.parametrize("space", ["/robot1", ""])
def test_a_dead_lidar_of_a_single_robot(space: str) -> None:
    lines = [
        f"{space}/amcl subscribes {space}/scan {SCAN}",
        f"{space}/rviz2 subscribes {space}/back_scan {SCAN}",
        f"{space}/base publishes {space}/odom {ODOM}",
    ]
    robot, name = space.strip("/"), f"{space}/scan"
    (gone,) = found(*lines)
    assert (gone.code, gone.level, gone.robot, gone.names) == ("MG322", "error", robot, (name,))
    assert f"no node sends {name}, read by {space}/amcl" in gone.message
    lines += [f"{space}/lidar publishes {name} {SCAN}"]
    sent = [f"transform odom -> laser on {space}/tf", f"frame_id odom on {space}/odom at 10 Hz"]
    (silent,) = found(*lines, *sent)
    assert (silent.code, silent.level, silent.node) == ("MG326", "error", f"{space}/lidar")
    # A look that had no processor may not have received it; that nodes are missing is no reason.
    system = read_system("\n".join(f"running: {it}" for it in (*lines, *sent))).system
    for code, level in ((BUSY_MACHINE, "inconclusive"), ("programs-unannounced", "error")):
        around = system.environment._replace(caveats=(Caveat(code, True, ""),))
        told = diagnose(system._replace(environment=around)).findings
        assert [(it.code, it.level) for it in told] == [("MG326", level)]
    assert codes(*lines, *sent, f"frame_id laser on {name}") == []
    # No laser is so slow by itself.
    (slow,) = found(*lines, *sent, f"frame_id laser on {name} at 0.3 Hz")
    assert (slow.code, slow.level, slow.message) == (
        "MG326", "warning", f"publishes {name} at 0.3 Hz"
    )  # fmt: skip
    assert codes(*lines, *sent, f"frame_id laser on {name} at 5 Hz") == []
    # Where nothing comes again and again nobody listened for long.
    assert codes(*lines, sent[0], sent[1].removesuffix(" at 10 Hz")) == []


@pytest.mark.parametrize("space", ["/robot1", ""])
def test_what_filters_make_is_no_source(space: str) -> None:
    """An EKF and navsat_transform wait for the drive, each with the odometry of the other."""
    lines = [
        f"{space}/ekf subscribes {space}/wheel/odom {ODOM}",
        f"{space}/ekf subscribes {space}/odometry/gps {ODOM}",
        f"{space}/ekf publishes {space}/odometry/filtered {ODOM}",
        f"{space}/navsat subscribes {space}/odometry/filtered {ODOM}",
        f"{space}/navsat publishes {space}/odometry/gps {ODOM}",
    ]
    (gone,) = found(*lines)
    assert (gone.code, gone.level, gone.names) == ("MG322", "error", (f"{space}/wheel/odom",))
    assert codes(*lines, f"{space}/drive publishes {space}/wheel/odom {ODOM}") == []


@pytest.mark.parametrize("frame", ["/laser", "/robot1/laser"])
def test_tf2_refuses_to_look_up_a_frame_with_a_slash_in_front(frame: str) -> None:
    lines = [
        f"/robot1/lidar publishes /robot1/scan {SCAN}",
        f"transform base_link -> {frame[1:]} on /robot1/tf",
        f"frame_id {frame} on /robot1/scan",
    ]
    (unread,) = found(*lines)
    assert (unread.code, unread.level) == ("MG412", "warning") and "slash" in unread.message
    (read,) = found(*lines, f"/robot1/amcl subscribes /robot1/scan {SCAN}")
    assert (read.code, read.level) == ("MG412", "error")
    assert codes(*(it.replace("frame_id /", "frame_id ") for it in lines)) == []


def test_a_scan_in_a_frame_of_no_tf_stops_who_reads_it() -> None:
    lines = [
        f"/robot1/lidar publishes /robot1/scan {SCAN}",
        "transform base_link -> camera on /robot1/tf",
        "frame_id other on /robot1/scan",
    ]
    assert codes(*lines) == [("MG412", "warning", "/robot1/lidar")]
    assert codes(*lines, f"/robot1/amcl subscribes /robot1/scan {SCAN}") == [
        ("MG412", "error", "/robot1/lidar")
    ]
    # A battery has no place, and an image is of use without one.
    image = [it.replace("scan", "image").replace(SCAN, "sensor_msgs/msg/Image") for it in lines]
    assert codes(*image, "/robot1/view subscribes /robot1/image sensor_msgs/msg/Image") == [
        ("MG412", "warning", "/robot1/lidar")
    ]


def test_a_node_that_is_active_at_another_robot() -> None:
    lines = ["/robot1/slam is active", "/robot2/slam is unconfigured"]
    assert codes(*lines) == [("MG511", "error", "/robot2/slam")]
    assert codes("/robot1/slam is inactive", "/robot2/slam is inactive") == [
        ("MG511", "warning", "/robot1/slam"),
        ("MG511", "warning", "/robot2/slam"),
    ]


def test_a_reader_in_a_namespace_where_nothing_runs() -> None:
    """It is told where the robots send the same, and not where they only read it, too."""
    reads = [f"/robot{it}/amcl subscribes /robot{it}/scan {SCAN}" for it in (1, 2)]
    sends = [f"/robot{it}/lidar publishes /robot{it}/scan {SCAN}" for it in (1, 2)]
    reader = f"/merger subscribes /rover/scan {SCAN}"
    (it,) = found(*reads, *sends, reader)
    assert (it.code, it.level, it.node) == ("MG303", "warning", "/merger")
    assert "no node is in /rover, and robot2 has /robot2/scan" in it.message
    assert {one.code for one in found(*reads, reader)} == {"MG322"}


def test_the_first_of_two_managers_is_named() -> None:
    change = "lifecycle_msgs/srv/ChangeState"
    calls = [f"/robot1/m{it} calls /robot1/amcl/change_state {change}" for it in (1, 2)]
    told = codes(*calls, f"/robot1/amcl serves /robot1/amcl/change_state {change}")
    assert told == [("MG302", "error", "/robot1/m1")]


def test_one_joystick_for_two_robots() -> None:
    lines = [
        f"/robot1/joy_node publishes /robot1/joy {JOY}",
        *(f"/robot{it}/teleop_twist_joy_node subscribes /robot1/joy {JOY}" for it in "12"),
    ]
    (it,) = found(*lines)
    assert (it.code, it.level, it.names) == ("MG310", "error", ("/robot1/joy",))
    assert codes(*lines[:2]) == []


def test_goals_for_the_one_controller_under_another_name() -> None:
    lines = [
        f"/robot1/moveit calls /robot1/arm_controller/follow {FOLLOW}",
        f"/robot1/controller serves /robot1/controller/follow {FOLLOW}",
    ]
    assert codes(*lines) == [("MG304", "error", "/robot1/moveit")]


@pytest.mark.parametrize(
    ("guard", "hint"),
    [
        ("twist_mux", "send it to a topic that /robot1/twist_mux reads"),
        ("collision_monitor", "put twist_mux before /robot1/collision_monitor"),
    ],
)
@pytest.mark.parametrize("sender", ["/robot1/teleop_node", "/foxglove_bridge", "/_ros2cli_1"])
def test_a_sender_past_what_chooses_or_limits(guard: str, hint: str, sender: str) -> None:
    lines = [
        f"/robot1/base subscribes /robot1/cmd_vel {TWIST}",
        f"/robot1/{guard} publishes /robot1/cmd_vel {TWIST}",
        f"{sender} publishes /robot1/cmd_vel {TWIST}",
        f"/foxglove_bridge subscribes /robot1/cmd_vel {TWIST}",
    ]
    (it,) = found(*lines)
    assert (it.code, it.level, it.node) == ("MG312", "error", sender)
    assert it.hint.startswith(hint)
    assert codes(*lines[:2], lines[3]) == []
