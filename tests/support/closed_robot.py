# SPDX-License-Identifier: Apache-2.0
"""The files of a fleet of two robots that close: controllers, a filter, a bridge, MoveIt, Nav2."""

from __future__ import annotations

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
FILES = {
    "rover.urdf": """\
<robot name="rover">
  <link name="base_link">MASS</link>
  <link name="left_wheel_link">MASS</link>
  <link name="right_wheel_link">MASS</link>
  <link name="imu_link"/>
  <link name="lidar_link"/>
  <link name="finger_link">MASS</link>
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
      <state_interface name="position"/>
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
""".replace("MASS", MASS),
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
    state_interfaces: [position]
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
    "nav2.yaml": """\
slam_toolbox:
  ros__parameters: {scan_topic: scan, odom_frame: odom, base_frame: base_link, map_frame: map}
local_costmap:
  local_costmap:
    ros__parameters:
      global_frame: odom
      robot_base_frame: base_link
      plugins: [obstacle_layer]
      obstacle_layer:
        plugin: nav2_costmap_2d::ObstacleLayer
        observation_sources: scan
        scan: {topic: /scan, data_type: LaserScan}
bt_navigator:
  ros__parameters: {global_frame: map, robot_base_frame: base_link, odom_topic: odometry/filtered}
velocity_smoother:
  ros__parameters: {odom_topic: odometry/filtered, feedback: CLOSED_LOOP}
collision_monitor:
  ros__parameters:
    base_frame_id: base_link
    odom_frame_id: odom
    observation_sources: [scan]
    scan: {type: scan, topic: scan}
twist_mux:
  ros__parameters:
    use_stamped: false
    topics: {nav: {topic: cmd_vel_smoothed, timeout: 0.5, priority: 10}}
controller_server:
  ros__parameters: {odom_topic: odometry/filtered}
""",
    "fleet.yaml": """\
distro: jazzy
node_sets: [nav2_slam, twist_mux, stamper]
description: rover.urdf
related_files:
  params: [controllers.yaml, ekf.yaml, nav2.yaml]
  bridge: bridge.yaml
  moveit: moveit.yaml
robots: [{name: robot1, pose: {x: 0}}, {name: robot2, pose: {x: 2}}]
nodes: nodes.yaml
""",
    "nodes.yaml": """nodes:
  stamper:
    package: own
    subscribes: {cmd_vel_out: {type: geometry_msgs/msg/Twist}}
    publishes: {base_controller/cmd_vel: {type: geometry_msgs/msg/TwistStamped}}
node_sets:
  stamper: {nodes: [stamper]}
""",
}
