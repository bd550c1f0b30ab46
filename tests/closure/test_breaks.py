"""A robot that closes, and breaks of it: a build and a plan find each, with both lines.

What each break does at run time is said here, from the sources of the nodes.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from closed_robot import FILES

from multibot_rewrite.findings.finding import NOTE, Finding
from multibot_rewrite.fleets.build import make_outputs
from multibot_rewrite.fleets.closed_plan import closed_plan
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import plan_fleet

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
# What a build tells of the odometry of this robot in some layouts, and is no gap.
BESIDE = ("MF125", "MF7", "MB", "MR")


def found(
    folder: Path, files: dict[str, str], layout: str = "frames-per-robot"
) -> tuple[list[Finding], list[Finding]]:
    """What a build says, and what a plan says."""
    for name, text in files.items():
        (folder / name).write_text(text)
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"layout: {layout}\n{files['fleet.yaml']}")
    plan = plan_fleet(read_fleet(str(fleet), "", {}))
    problems = plan.fleet.table.problems
    built = {*problems, *make_outputs(plan).findings}
    planned = {*problems, *closed_plan(plan).gaps}
    return _gaps(built), _gaps(planned)


def _gaps(every: Iterable[Finding]) -> list[Finding]:
    return [it for it in every if it.level != NOTE and not it.code.startswith(BESIDE)]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_that_closes(layout: str, tmp_path: Path) -> None:
    assert found(tmp_path, FILES, layout) == ([], [])


BREAKS = [
    # The controller's joints are not those of the hardware.
    ("controllers.yaml", "[left_wheel_joint]", "[left_whel_joint]", "MF811", 9, "rover.urdf:23"),
    ("controllers.yaml", "[right_wheel_joint]", "[wheel_joint]", "MF811", 10, "rover.urdf"),
    # The hardware lacks what the controller claims.
    ("rover.urdf", '      <command_interface name="velocity"/>\n', "", "MF811", 9, ""),
    ("rover.urdf", 'state_interface name="position"', 'state_interface name="pos"', "MF811", 9, ""),
    (
        "controllers.yaml",
        "enable_odom_tf: false",
        "position_feedback: false\n    enable_odom_tf: false",
        "",
        0,
        "",
    ),
    # The filter's odometry is not that of the controller's parameters: nothing joins the two.
    ("ekf.yaml", "base_link_frame: base_link", "base_link_frame: base_lnk", "MF813", 15, ""),
    # Nobody sends odom -> base_link.
    ("ekf.yaml", "publish_tf: true", "publish_tf: false", "MF813", 15, ""),
    # Both send it.
    ("controllers.yaml", "enable_odom_tf: false", "enable_odom_tf: true", "MF607", 1, ""),
    ("controllers.yaml", "    enable_odom_tf: false\n", "", "MF607", 1, ""),
    # The filter reads what is sent under another name.
    ("ekf.yaml", "imu0: imu/data", "imu0: imu_0/data", "MF812", 4, ""),
    ("ekf.yaml", "odom0: base_controller/odom", "odom0: diff_drive/odom", "MF812", 3, ""),
    ("controllers.yaml", "base_controller", "drive_controller", "MF812", 3, ""),
    (
        "bridge.yaml",
        "ros_topic_name: imu/data",
        "ros_topic_name: imu_0/data",
        "MF812",
        4,
        "bridge.yaml:1",
    ),
    # The bridge reads a topic of Gazebo that no sensor sends.
    ("bridge.yaml", "gz_topic_name: imu/data", "gz_topic_name: imu_0/data", "MF816", 2, ""),
    ("rover.urdf", "<topic>imu/data</topic>", "<topic>imu_0/data</topic>", "MF816", 2, ""),
    # MoveIt sends to a controller that is not there, or for another joint.
    ("moveit.yaml", "gripper_controller", "hand_controller", "MF815", 3, ""),
    ("moveit.yaml", "[finger_joint]", "[left_wheel_joint]", "MF815", 6, "controllers.yaml:20"),
    ("controllers.yaml", "gripper_controller", "gripper", "MF815", 3, "controllers.yaml"),
    # The hardware is commanded by effort.
    (
        "controllers.yaml",
        "command_interfaces: [effort]",
        "command_interfaces: [velocity]",
        "MF811",
        20,
        "rover.urdf",
    ),
    (
        "rover.urdf",
        'state_interface name="effort"',
        'state_interface name="force"',
        "MF811",
        20,
        "",
    ),
    # Nav2 reads what nobody sends.
    ("nav2.yaml", "scan_topic: scan", "scan_topic: scan_front", "MF812", 2, "/scan"),
    ("nav2.yaml", "topic: /scan", "topic: /front", "MF812", 12, "/scan"),
    ("nav2.yaml", "type: scan, topic: scan", "type: scan, topic: lidar", "MF812", 22, "/scan"),
    ("nav2.yaml", "topic: cmd_vel_smoothed", "topic: cmd_vel_smoth", "MF812", 25, ""),
    (
        "nav2.yaml",
        "base_link, odom_topic: odometry/filtered",
        "base_link, odom_topic: odom",
        "MF812",
        14,
        "",
    ),
    (
        "nav2.yaml",
        "{odom_topic: odometry/filtered, feedback",
        "{odom_topic: odom, feedback",
        "MF812",
        16,
        "",
    ),
    ("nav2.yaml", "{odom_topic: odometry/filtered}", "{odom_topic: odm}", "MF812", 27, ""),
    ("rover.urdf", "<topic>scan</topic>", "<topic>front/scan</topic>", "MF812", 2, "/front/scan"),
    # A source in the list without a topic of its own: it reads what it is called.
    (
        "nav2.yaml",
        "observation_sources: scan\n",
        "observation_sources: scan lidar\n",
        "MF127",
        11,
        "",
    ),
    # Two trees of frames, with both lines.
    ("nav2.yaml", "odom_frame: odom,", "odom_frame: odom_slam,", "MF817", 1, "nav2.yaml:1"),
    ("ekf.yaml", "frame: odom", "frame: odom_combined", "MF817", 1, "nav2.yaml:1"),
    # Frames that nothing sends.
    ("nav2.yaml", "base_frame: base_link,", "base_frame: base_lnk,", "MF112", 2, "base_link"),
    ("nav2.yaml", "global_frame: odom", "global_frame: odomm", "MF112", 6, ""),
    (
        "controllers.yaml",
        "base_frame_id: base_link",
        "base_frame_id: base_footprint",
        "MF112",
        13,
        "",
    ),
    # A controller of a type that does not exist, one without its section, one that nobody declares.
    (
        "controllers.yaml",
        "DiffDriveController",
        "DifDriveController",
        "MF802",
        5,
        "DiffDriveController",
    ),
    ("controllers.yaml", "base_controller:\n  ros", "base_controler:\n  ros", "MF607", 22, ""),
    # The joint of the hardware is called otherwise than the controller's.
    (
        "rover.urdf",
        'joint name="finger_joint">\n      <command',
        'joint name="finger">\n      <command',
        "MF811",
        20,
        "",
    ),
]


@pytest.mark.parametrize(("file", "old", "new", "code", "line", "other"), BREAKS)
def test_a_break_is_found_with_its_lines(
    file: str, old: str, new: str, code: str, line: int, other: str, tmp_path: Path
) -> None:
    assert old in FILES[file]
    both = found(tmp_path, {**FILES, file: FILES[file].replace(old, new)})
    if not code:
        assert both == ([], [])
        return
    for broken in both:
        alike = (it for it in broken if it.code == code)
        first = min(alike, key=lambda it: (it.line, it.message), default=None)
        assert first, broken
        assert first.line == line
        assert other in first.hint
