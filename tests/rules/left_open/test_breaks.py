# SPDX-License-Identifier: Apache-2.0
"""A robot that closes, and breaks of it: a build and a plan find each, with both lines.

What each break does at run time is said here, from the sources of the nodes.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from closed_robot import ARM_FILES, FILES, MASS
from open_findings import found

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
# Findings about one line: a name that is in no file, a plugin of another name, joints of one file.
ONE_LINE = ("MB504", "MB80", "MB853", "MB854", "MB885", "MB874", "MF802")
PLACE = re.compile(r"\w+\.(urdf|yaml):\d+")


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("files", [FILES, ARM_FILES], ids=["rover", "arm"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_that_closes(layout: str, files: dict[str, str], tmp_path: Path) -> None:
    assert found(tmp_path, files, layout) == ([], [])


# File, its text, what is put in its place, the finding's code and line, and what its hint names.
BREAKS = [
    # The controller's joints are not those of the hardware.
    ("controllers.yaml", "[left_wheel_joint]", "[left_whel_joint]", "MB229:9 rover.urdf:23"),
    ("controllers.yaml", "[right_wheel_joint]", "[wheel_joint]", "MB229:10 rover.urdf"),
    # The hardware lacks what the controller claims.
    ("rover.urdf", '      <command_interface name="velocity"/>\n', "", "MB229:9"),
    ("rover.urdf", 'state_interface name="position"', 'state_interface name="pos"', "MB229:9"),
    # The filter's odometry is not that of the controller's parameters: nothing joins the two.
    ("ekf.yaml", "base_link_frame: base_link", "base_link_frame: base_lnk", "MG406:15"),
    # Nobody sends odom -> base_link.
    ("ekf.yaml", "publish_tf: true", "publish_tf: false", "MG406:15"),
    # Both send it.
    ("controllers.yaml", "enable_odom_tf: false", "enable_odom_tf: true", "MG408:1"),
    ("controllers.yaml", "    enable_odom_tf: false\n", "", "MG408:1"),
    # The filter reads what is sent under another name.
    ("ekf.yaml", "imu0: imu/data", "imu0: imu_0/data", "MG303:4"),
    ("ekf.yaml", "odom0: base_controller/odom", "odom0: diff_drive/odom", "MG303:3"),
    ("controllers.yaml", "base_controller", "drive_controller", "MG303:3"),
    (
        "bridge.yaml",
        "ros_topic_name: imu/data",
        "ros_topic_name: imu_0/data",
        "MG303:4 bridge.yaml:1",
    ),
    # The bridge reads a topic of Gazebo that no sensor sends.
    ("bridge.yaml", "gz_topic_name: imu/data", "gz_topic_name: imu_0/data", "MB879:2"),
    ("rover.urdf", "<topic>imu/data</topic>", "<topic>imu_0/data</topic>", "MB879:2"),
    # MoveIt sends to a controller that is not there, or for another joint.
    ("moveit.yaml", "gripper_controller", "hand_controller", "MB857:3"),
    ("moveit.yaml", "[finger_joint]", "[left_wheel_joint]", "MB857:6 controllers.yaml:20"),
    ("controllers.yaml", "gripper_controller", "gripper", "MB857:3 controllers.yaml"),
    # The hardware is commanded by effort.
    (
        "controllers.yaml",
        "command_interfaces: [effort]",
        "command_interfaces: [velocity]",
        "MB229:20 rover.urdf",
    ),
    (
        "rover.urdf",
        'name="effort"/>\n      <state_interface name="position"',
        'name="effort"/>\n      <state_interface name="force"',
        "MB229:20",
    ),
    # Nav2 reads a scan as points: the sender of the topic is the bridge of the lidar.
    ("nav2.yaml", "data_type: LaserScan", "data_type: PointCloud2", "MG306:12"),
    ("nav2.yaml", "type: scan, topic: scan", "type: pointcloud, topic: scan", "MG306:22"),
    # Nav2 reads what no node sends.
    ("nav2.yaml", "scan_topic: scan", "scan_topic: scan_front", "MG303:2 /scan"),
    ("nav2.yaml", "topic: /scan", "topic: /front", "MG303:12 /scan"),
    ("nav2.yaml", "type: scan, topic: scan", "type: scan, topic: lidar", "MG303:22 /scan"),
    ("nav2.yaml", "topic: cmd_vel_smoothed", "topic: cmd_vel_smoth", "MG303:26"),
    (
        "nav2.yaml",
        "base_link, odom_topic: odometry/filtered",
        "base_link, odom_topic: odom",
        "MG303:14",
    ),
    (
        "nav2.yaml",
        "{odom_topic: odometry/filtered, feedback",
        "{odom_topic: odom, feedback",
        "MG303:16",
    ),
    ("nav2.yaml", "{odom_topic: odometry/filtered}", "{odom_topic: odm}", "MG303:28"),
    ("rover.urdf", "<topic>scan</topic>", "<topic>front/scan</topic>", "MG303:2 /front/scan"),
    # A source in the list without a topic of its own: it reads what it is called.
    ("nav2.yaml", "observation_sources: scan\n", "observation_sources: scan lidar\n", "MB885:11"),
    # Two trees of frames, with both lines.
    ("nav2.yaml", "odom_frame: odom,", "odom_frame: odom_slam,", "MG406:1 nav2.yaml:1"),
    ("ekf.yaml", "frame: odom", "frame: odom_combined", "MG406:1 nav2.yaml:1"),
    # Frames that nothing sends.
    ("nav2.yaml", "base_frame: base_link,", "base_frame: base_lnk,", "MB853:2 base_link"),
    ("nav2.yaml", "global_frame: odom", "global_frame: odomm", "MB853:6"),
    ("controllers.yaml", "base_frame_id: base_link", "base_frame_id: base_footprint", "MB853:13"),
    # A controller of a type that does not exist, one without its section, one that nobody declares.
    (
        "controllers.yaml",
        "DiffDriveController",
        "DifDriveController",
        "MF802:5 DiffDriveController",
    ),
    ("controllers.yaml", "base_controller:\n  ros", "base_controler:\n  ros", "MG408:5"),
    # The joint of the hardware is called otherwise than the controller's.
    (
        "rover.urdf",
        'joint name="finger_joint">\n      <command',
        'joint name="finger">\n      <command',
        "MB229:20",
    ),
    # Both wheels are one joint.
    (
        "controllers.yaml",
        "[right_wheel_joint]",
        "[left_wheel_joint]",
        "MB240:10 controllers.yaml:9",
    ),
    # A link with two joints above it: one of them counts, and sends a transform.
    (
        "rover.urdf",
        f'<link name="finger_link">{MASS}</link>\n',
        f'<link name="finger_link">{MASS}</link>\n'
        '  <joint name="second" type="fixed"><parent link="lidar_link"/>'
        '<child link="imu_link"/></joint>\n',
        "MB504:15",
    ),
    # The filter sends the transform of a link that the description has.
    (
        "ekf.yaml",
        "base_link_frame: base_link",
        "base_link_frame: lidar_link",
        "MG401:1 rover.urdf:19",
    ),
    # The filter of the map sends map -> odom, and nothing odom -> base_link.
    ("ekf.yaml", "world_frame: odom\n", "world_frame: map\n", "MG406:15"),
    # The costmap's source and its plugin are called otherwise than their parameters.
    ("nav2.yaml", "sources: scan\n", "sources: scn\n", "MB877:11 nav2.yaml:12"),
    ("nav2.yaml", "plugins: [obstacle_layer]", "plugins: [obstacl_layer]", "MB877:8 nav2.yaml:10"),
    # The bridge of an IMU, reversed, or of another type.
    ("bridge.yaml", "GZ_TO_ROS", "ROS_TO_GZ", "MB879:2 rover.urdf:43"),
    ("bridge.yaml", "gz.msgs.IMU", "gz.msgs.Magnetometer", "MB879:2 rover.urdf:43"),
    ("bridge.yaml", "msg/Imu", "msg/MagneticField", "MG306:4 bridge.yaml:1"),
    ("moveit.yaml", "follow_joint_trajectory", "follow_trajectory", "MB857:5 controllers.yaml:6"),
]


# The same for an arm with sensors.
ARM_BREAKS = [
    # The SRDF names what the URDF has not.
    (
        "arm.srdf",
        '<joint name="finger_joint"/>',
        '<joint name="fingr_joint"/>',
        "MB804:3 finger_joint",
    ),
    ("arm.srdf", 'tip_link="tool_link"', 'tip_link="tol_link"', "MB803:2 tool_link"),
    ("arm.srdf", 'name="elbow_joint" value', 'name="elbo_joint" value', "MB804:6 elbow_joint"),
    # A broadcaster of a sensor that the hardware has not.
    ("controllers.yaml", "sensor_name: tool_imu", "sensor_name: imu", "MB229:20 arm.urdf:36"),
    ("controllers.yaml", "sensor_name: wrist_ft", "sensor_name: tcp_fts", "MB229:22 arm.urdf:48"),
    ("arm.urdf", '<sensor name="wrist_ft">', '<sensor name="tool_ft">', "MB229:22 arm.urdf:48"),
    ("arm.urdf", '<state_interface name="torque.z"/>', "", "MB229:22 arm.urdf:52"),
    ("controllers.yaml", "joint: finger_joint", "joint: grip_joint", "MB229:18 arm.urdf:31"),
    # The filter reads the topic of a broadcaster under its usual name.
    (
        "sensors.yaml",
        "imu_broadcaster/imu",
        "imu_sensor_broadcaster/imu",
        "MG303:3 controllers.yaml:7",
    ),
    ("controllers.yaml", "imu_broadcaster", "imu_sensor", "MG303:3 controllers.yaml:7"),
    # Sources that no node sends: behind a laser filter, of joint_state_publisher.
    ("sensors.yaml", "topic: scan_filtered", "topic: scan_filtred", "MG303:15 sensors.yaml:7"),
    ("sensors.yaml", "[joint_states]", "[arm_joint_states]", "MG303:17 controllers.yaml:4"),
    # The laser filter reads scan.
    ("bridge.yaml", "ros_topic_name: scan", "ros_topic_name: scan_raw", "MG303:7 bridge.yaml:1"),
    # A source in the list is called otherwise than its parameters.
    ("sensors.yaml", "sources: [front]", "sources: [frnt]", "MB877:14 sensors.yaml:15"),
    # The row of the bridge is for the other direction, for another type, or for another topic.
    ("bridge.yaml", "GZ_TO_ROS", "ROS_TO_GZ", "MB879:2 arm.urdf:57"),
    ("bridge.yaml", "gz.msgs.LaserScan", "gz.msgs.PointCloudPacked", "MB879:2 arm.urdf:57"),
    ("bridge.yaml", "msg/LaserScan", "msg/PointCloud2", "MB874:1 sensor_msgs/msg/LaserScan"),
    ("bridge.yaml", "msg/LaserScan", "msg/PointCloud2", "MG306:7 bridge.yaml:1"),
    ("arm.urdf", "<topic>scan</topic>", "<topic>lidar</topic>", "MB879:2 arm.urdf:57"),
    # MoveIt uses a joint of another controller, an action that is not served, or another type of it.
    (
        "moveit.yaml",
        "joints: [shoulder_joint, elbow_joint]",
        "joints: [shoulder_joint, finger_joint]",
        "MB857:6 controllers.yaml:13",
    ),
    (
        "moveit.yaml",
        "action_ns: gripper_cmd",
        "action_ns: follow_joint_trajectory",
        "MB857:9 controllers.yaml:6",
    ),
    ("moveit.yaml", "GripperCommand", "FollowJointTrajectory", "MB857:8 controllers.yaml:6"),
    ("moveit.yaml", "hand_controller]", "hand_controler]", "MB857:2 moveit.yaml:7"),
    (
        "controllers.yaml",
        "position_controllers/GripperActionController",
        "forward_command_controller/ForwardCommandController",
        "MB857:9 controllers.yaml:6",
    ),
    # A controller with parameters that no manager has.
    (
        "controllers.yaml",
        "    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}\n",
        "",
        "MB857:3 controllers.yaml:5",
    ),
    ("controllers.yaml", "arm_controller:\n  ros", "arm_controler:\n  ros", "MB878:11 yaml:5"),
    # A joint that is twice in the list of a controller, so another one has none.
    (
        "controllers.yaml",
        "joints: [shoulder_joint, elbow_joint]",
        "joints: [shoulder_joint, shoulder_joint]",
        "MB857:6 controllers.yaml:13",
    ),
    (
        "controllers.yaml",
        "frame_id: tool_link}\nft",
        "frame_id: tol_link}\nft",
        "MB853:20 tool_link",
    ),
]


EVERY = [*((FILES, *it) for it in BREAKS), *((ARM_FILES, *it) for it in ARM_BREAKS)]


@pytest.mark.more
@pytest.mark.sample(12)
@pytest.mark.parametrize(("files", "file", "old", "new", "expected"), EVERY)
def test_a_break_is_found_with_its_lines(
    files: dict[str, str],
    file: str,
    old: str,
    new: str,
    expected: str,
    tmp_path: Path,
) -> None:
    assert old in files[file]
    code, line, other = re.split("[: ]", f"{expected} ", maxsplit=2)
    both = found(tmp_path, {**files, file: files[file].replace(old, new)})
    for broken in both:
        alike = (it for it in broken if it.code == code)
        first = min(alike, key=lambda it: (it.line, it.message), default=None)
        assert first, broken
        assert first.line == int(line)
        assert other.strip() in first.hint
        # What only a node set has is in no file.
        one_line = code.startswith(ONE_LINE) or other.startswith("/")
        assert one_line or PLACE.search(f"{first.message} {first.hint}"), first
