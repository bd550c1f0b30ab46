"""A robot that closes, and breaks of it: each is found by a build, with both lines where there are two.

What each break does at run time is said here, from the sources of the nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from multibot_rewrite.findings.finding import NOTE, Finding
from multibot_rewrite.fleets.build import make_outputs
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import plan_fleet

FILES = {
    "rover.urdf": """\
<robot name="rover">
  <link name="base_link"/>
  <link name="left_wheel_link"/>
  <link name="right_wheel_link"/>
  <link name="imu_link"/>
  <link name="lidar_link"/>
  <link name="finger_link"/>
  <joint name="left_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="left_wheel_link"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="right_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="right_wheel_link"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="imu_joint" type="fixed"><parent link="base_link"/><child link="imu_link"/></joint>
  <joint name="finger_joint" type="prismatic">
    <parent link="base_link"/><child link="finger_link"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
  <ros2_control name="rover_base" type="system">
    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="left_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <joint name="right_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <joint name="finger_joint">
      <command_interface name="effort"/>
      <state_interface name="effort"/>
    </joint>
  </ros2_control>
  <gazebo>
    <plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
      <parameters>controllers.yaml</parameters>
    </plugin>
  </gazebo>
  <gazebo reference="imu_link">
    <sensor name="imu" type="imu"><topic>imu/data</topic><gz_frame_id>imu_link</gz_frame_id></sensor>
  </gazebo>
  <gazebo reference="lidar_link">
    <sensor name="lidar" type="gpu_lidar">
      <topic>scan</topic><gz_frame_id>lidar_link</gz_frame_id>
    </sensor>
  </gazebo>
</robot>
""",
    "controllers.yaml": """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    base_controller: {type: diff_drive_controller/DiffDriveController}
    gripper_controller: {type: joint_trajectory_controller/JointTrajectoryController}
base_controller:
  ros__parameters:
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
    wheel_separation: 0.4
    wheel_radius: 0.1
    base_frame_id: base_link
    odom_frame_id: odom
    enable_odom_tf: false
joint_state_broadcaster:
  ros__parameters: {frame_id: base_link}
gripper_controller:
  ros__parameters:
    joints: [finger_joint]
    command_interfaces: [effort]
    state_interfaces: [effort]
""",
    "ekf.yaml": """\
ekf_filter_node:
  ros__parameters:
    odom0: base_controller/odom
    imu0: imu/data
    odom_frame: odom
    base_link_frame: base_link
    world_frame: odom
    publish_tf: true
""",
    "bridge.yaml": """\
- ros_topic_name: imu/data
  gz_topic_name: imu/data
  ros_type_name: sensor_msgs/msg/Imu
  gz_type_name: gz.msgs.IMU
  direction: GZ_TO_ROS
""",
    "moveit.yaml": """\
moveit_simple_controller_manager:
  controller_names: [gripper_controller]
  gripper_controller:
    type: FollowJointTrajectory
    action_ns: follow_joint_trajectory
    joints: [finger_joint]
""",
    "fleet.yaml": """\
distro: jazzy
description: rover.urdf
companions:
  params: [controllers.yaml, ekf.yaml]
  bridge: bridge.yaml
  moveit: moveit.yaml
robots: [{name: robot1, pose: {x: 0}}, {name: robot2, pose: {x: 2}}]
""",
}
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
# What a build tells of the odometry of this robot in some layouts, and is no gap.
BESIDE = ("MF7", "MB", "MR")


def found(folder: Path, files: dict[str, str], layout: str = "frames-per-robot") -> list[Finding]:
    for name, text in files.items():
        (folder / name).write_text(text)
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"layout: {layout}\n{files['fleet.yaml']}")
    plan = plan_fleet(read_fleet(str(fleet), "", {}))
    every = {*plan.fleet.table.problems, *make_outputs(plan).findings}
    return [it for it in every if it.level != NOTE and not it.code.startswith(BESIDE)]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_that_closes(layout: str, tmp_path: Path) -> None:
    assert found(tmp_path, FILES, layout) == []


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
    ("ekf.yaml", "publish_tf: true", "publish_tf: false", "MF813", 8, ""),
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
]


@pytest.mark.parametrize(("file", "old", "new", "code", "line", "other"), BREAKS)
def test_a_break_is_found_with_its_lines(
    file: str, old: str, new: str, code: str, line: int, other: str, tmp_path: Path
) -> None:
    assert old in FILES[file]
    broken: Sequence[Finding] = found(tmp_path, {**FILES, file: FILES[file].replace(old, new)})
    if not code:
        assert not broken
        return
    (first, *_) = sorted(
        (it for it in broken if it.code == code), key=lambda it: (it.line, it.message)
    ) or [None]
    assert first, broken
    assert first.line == line
    assert other in first.hint
