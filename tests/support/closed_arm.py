# SPDX-License-Identifier: Apache-2.0
"""The files of a fleet of two robots that close: an arm on a base, with MoveIt, sensors and filters."""

from __future__ import annotations

from closed_robot import MASS

ARM_FILES = {
    "arm.urdf": """\
<robot name="arm">
  <link name="base_link">MASS</link>
  <link name="upper_link">MASS</link>
  <link name="tool_link">MASS</link>
  <link name="finger_link">MASS</link>
  <link name="lidar_link"/>
  <joint name="shoulder_joint" type="revolute">
    <parent link="base_link"/><child link="upper_link"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow_joint" type="revolute">
    <parent link="upper_link"/><child link="tool_link"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="finger_joint" type="prismatic">
    <parent link="tool_link"/><child link="finger_link"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
  <ros2_control name="arm_system" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="shoulder_joint">
      <command_interface name="position"/>
      <state_interface name="position"/>
    </joint>
    <joint name="elbow_joint">
      <command_interface name="position"/>
      <state_interface name="position"/>
    </joint>
    <joint name="finger_joint">
      <command_interface name="position"/>
      <state_interface name="position"/>
      <state_interface name="velocity"/>
    </joint>
    <sensor name="tool_imu">
      <state_interface name="orientation.x"/>
      <state_interface name="orientation.y"/>
      <state_interface name="orientation.z"/>
      <state_interface name="orientation.w"/>
      <state_interface name="angular_velocity.x"/>
      <state_interface name="angular_velocity.y"/>
      <state_interface name="angular_velocity.z"/>
      <state_interface name="linear_acceleration.x"/>
      <state_interface name="linear_acceleration.y"/>
      <state_interface name="linear_acceleration.z"/>
    </sensor>
    <sensor name="wrist_ft">
      <state_interface name="force.x"/>
      <state_interface name="force.y"/>
      <state_interface name="force.z"/>
      <state_interface name="torque.x"/>
      <state_interface name="torque.y"/>
      <state_interface name="torque.z"/>
    </sensor>
  </ros2_control>
  <gazebo reference="lidar_link">
    <sensor name="lidar" type="gpu_lidar">
      <topic>scan</topic><gz_frame_id>lidar_link</gz_frame_id>
    </sensor>
  </gazebo>
</robot>
""".replace("MASS", MASS),
    "arm.srdf": """\
<robot name="arm">
  <group name="arm"><chain base_link="base_link" tip_link="tool_link"/></group>
  <group name="hand"><joint name="finger_joint"/></group>
  <group_state name="home" group="arm">
    <joint name="shoulder_joint" value="0"/>
    <joint name="elbow_joint" value="0"/>
  </group_state>
  <end_effector name="hand" parent_link="tool_link" group="hand"/>
  <disable_collisions link1="base_link" link2="upper_link" reason="Adjacent"/>
</robot>
""",
    "controllers.yaml": """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    hand_controller: {type: position_controllers/GripperActionController}
    imu_broadcaster: {type: imu_sensor_broadcaster/IMUSensorBroadcaster}
    ft_broadcaster: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}
joint_state_broadcaster:
  ros__parameters: {use_local_topics: false}
arm_controller:
  ros__parameters:
    joints: [shoulder_joint, elbow_joint]
    command_interfaces: [position]
    state_interfaces: [position]
hand_controller:
  ros__parameters:
    joint: finger_joint
imu_broadcaster:
  ros__parameters: {sensor_name: tool_imu, frame_id: tool_link}
ft_broadcaster:
  ros__parameters: {sensor_name: wrist_ft, frame_id: tool_link}
""",
    "sensors.yaml": """\
ekf_filter_node:
  ros__parameters:
    imu0: imu_broadcaster/imu
    odom_frame: odom
    base_link_frame: base_link
    world_frame: odom
scan_to_scan_filter_chain:
  ros__parameters:
    filter1: {name: range, type: laser_filters/LaserScanRangeFilter, params: {lower_threshold: 0.1}}
collision_monitor:
  ros__parameters:
    base_frame_id: base_link
    odom_frame_id: odom
    observation_sources: [front]
    front: {type: scan, topic: scan_filtered}
joint_state_publisher:
  ros__parameters: {source_list: [joint_states]}
""",
    "bridge.yaml": """\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
""",
    "moveit.yaml": """\
moveit_simple_controller_manager:
  controller_names: [arm_controller, hand_controller]
  arm_controller:
    type: FollowJointTrajectory
    action_ns: follow_joint_trajectory
    joints: [shoulder_joint, elbow_joint]
  hand_controller:
    type: GripperCommand
    action_ns: gripper_cmd
    joints: [finger_joint]
""",
    "fleet.yaml": """\
distro: jazzy
node_sets: [ros2_control]
description: arm.urdf
srdf: arm.srdf
related_files:
  params: [controllers.yaml, sensors.yaml]
  bridge: bridge.yaml
  moveit: moveit.yaml
robots: [{name: robot1, pose: {x: 0}}, {name: robot2, pose: {x: 2}}]
""",
}
