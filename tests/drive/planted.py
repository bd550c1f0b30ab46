# SPDX-License-Identifier: Apache-2.0
"""Built folders that were spoiled: what was changed, and what a robot does not do then."""

from __future__ import annotations

from typing import NamedTuple


class Spoiled(NamedTuple):
    """A text of a built file that was changed, and what a robot does not do then."""

    example: str
    file: str
    old: str
    new: str
    robot: str
    what: str
    why: str


LAUNCH, ROVER, BRIDGE = "fleet.launch.py", "robot1/rover.urdf", "robot1/bridge.yaml"
PARAMS = "base1/nav2_params.yaml"
WHEEL = (
    '<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry>'
    "</collision>"
)
SYSTEM = '<plugin filename="gz-sim-{}-system" name="gz::sim::systems::{}"'
SIMULATED = [
    Spoiled("launch_tutorial", "world.sdf", SYSTEM.format("sensors", "Sensors"),
            SYSTEM.format("label", "Label"), "robot1", "sees", "no system sensors"),
    Spoiled("launch_tutorial", "world.sdf", SYSTEM.format("user-commands", "UserCommands"),
            SYSTEM.format("label", "Label"), "robot2", "starts", "no system that spawns it"),
    Spoiled("launch_tutorial", "world.sdf", SYSTEM.format("physics", "Physics"),
            SYSTEM.format("label", "Label"), "robot1", "drives", "the world has no physics"),
    Spoiled("launch_tutorial", ROVER, '<mass value="0.5"/>', '<mass value="0"/>', "robot1",
            "drives", "diff-drive has no left_joint in Gazebo"),
    Spoiled("launch_tutorial", ROVER, WHEEL, "", "robot1", "drives", "has no collision to roll on"),
    Spoiled("launch_tutorial", ROVER, "<mass value=", "<mass kg=", "robot1", "starts",
            "Gazebo keeps no link"),
    Spoiled("launch_tutorial", ROVER, "<right_joint>robot1_right_wheel_joint",
            "<right_joint>robot2_right_wheel_joint", "robot1", "drives", "has no right_joint"),
    Spoiled("two_robots_nav2", "robot1/hexbase.urdf", "<gz_frame_id>lidar_link",
            "<gz_frame_id>laser", "robot1", "sees", "in the frame laser, which is not"),
    Spoiled("launch_tutorial", ROVER, "robot1/odom</frame_id>", "robot2/odom</frame_id>",
            "robot1", "plans", "robot2/odom on /tf is where robot2 begins, too"),
    Spoiled("launch_tutorial", ROVER, "robot1/base_link</child_frame_id>",
            "robot2/base_link</child_frame_id>", "robot2", "plans", "is sent by robot1, too"),
    Spoiled("launch_tutorial", BRIDGE, '"gz.msgs.Twist"', '"gz.msgs.Pose"', "robot1", "drives",
            "no topic of ROS reaches its drive"),
    Spoiled("launch_tutorial", BRIDGE, "ROS_TO_GZ", "GZ_TO_ROS", "robot1", "drives",
            "no topic of ROS reaches its drive"),
    Spoiled("launch_tutorial", BRIDGE, 'ros_topic_name: "/robot1/cmd_vel"',
            'ros_topic_name: "/cmd_vel"', "robot1", "drives", "that moves []"),
    Spoiled("launch_tutorial", "robot2/rover.urdf", "<topic>robot2/cmd_vel",
            "<topic>robot1/cmd_vel", "robot2", "drives", "robot1 hears /robot1/cmd_vel, too"),
    Spoiled("launch_tutorial", ROVER, "</robot>", f"<gazebo>{SYSTEM.format('sensors', 'Sensors')}/>"
            "</gazebo></robot>", "robot1", "starts", "the world has the system Sensors, too"),
    Spoiled("launch_tutorial", LAUNCH, "'-name', name", "'-name', 'robot1'",
            "robot2", "starts", "two models are called"),
]  # fmt: skip
NAVIGATED = [
    Spoiled("mixed_fleet", LAUNCH, "'autostart': True", "'autostart': False", "base1", "starts",
            "autostart is not true"),
    Spoiled("two_robots_nav2", LAUNCH, "  'route_server',", "", "robot1", "starts",
            "route_server waits for a lifecycle manager"),
    Spoiled("two_robots_nav2", LAUNCH, "('/map', 'map')", "('/map', 'map_of_mine')", "robot1",
            "plans", "waits for the map /robot1/map"),
    Spoiled("mixed_fleet", PARAMS, "cmd_vel_in_topic: cmd_vel_smoothed",
            "cmd_vel_in_topic: cmd_vel_smooth", "base1", "drives", "that moves nothing"),
    Spoiled("mixed_fleet", PARAMS, "cmd_vel_out_topic: cmd_vel",
            "cmd_vel_out_topic: /base2/cmd_vel", "base1", "drives", "moves ['base2']"),
    Spoiled("mixed_fleet", PARAMS, "odom_frame_id: base1/odom", "odom_frame_id: base2/odom",
            "base1", "plans", "base2/odom"),
    Spoiled("mixed_fleet", PARAMS, "enable_stamped_cmd_vel: false", "enable_stamped_cmd_vel: true",
            "base1", "drives", "that moves nothing"),
    Spoiled("two_robots_nav2", "robot1/hexbase.urdf", "<topic>robot1/scan", "<topic>robot2/scan",
            "robot2", "sees", "which robot1 sends"),
]  # fmt: skip
CONTROLLED = [
    Spoiled("two_arms_moveit", LAUNCH,
            "namespace=f'/{name}',\n            name='robot_state_publisher'",
            "namespace='/left',\n            name='description'", "right", "starts",
            "waits for /right/robot_description, which no node sends"),
    Spoiled("two_arms_moveit", "left/controllers.yaml",
            "{type: joint_trajectory_controller/JointTrajectoryController}", "{}", "left", "starts",
            "has no type for arm_controller"),
    Spoiled("two_arms_moveit", "left/controllers.yaml", "joints: [left_finger_joint]",
            "joints: [right_finger_joint]", "left", "starts", "claims right_finger_joint/position"),
]  # fmt: skip
MOVEIT = "right/moveit_parameters.yaml"
MOVED = [
    Spoiled("two_arms_moveit", MOVEIT, "action_ns: follow_joint_trajectory", "action_ns: follow",
            "right", "drives", "on /right/arm_controller/follow: that moves nothing"),
    Spoiled("two_arms_moveit", MOVEIT, "arm_controller", "/left/arm_controller",
            "right", "drives", "/left/arm_controller/follow_joint_trajectory: that moves ['left']"),
    Spoiled("two_arms_moveit", MOVEIT, "- right_shoulder_joint", "- left_shoulder_joint",
            "right", "drives", "moves left_shoulder_joint by /right/arm_controller/"),
    Spoiled("two_arms_moveit", MOVEIT, "/**:\n  ros__parameters:\n", "/**:\n  ros__parameters:\n"
            "    planning_scene_monitor_options: {joint_state_topic: /left/joint_states}\n",
            "right", "sees", "reads /left/joint_states, which left sends"),
    Spoiled("two_arms_moveit", "left/controllers.yaml", "frame_id: left_base_link",
            "use_local_topics: true", "left", "sees", "reads /left/joint_states, which no node sends"),
    Spoiled("two_arms_moveit", LAUNCH, "arguments=['joint_state_broadcaster'],",
            "arguments=['joint_state_broadcaster', '--controller-ros-args',"
            " '-r joint_states:=/joint_states'],", "right", "sees", "sends on /joint_states, as left"),
    Spoiled("two_arms_moveit", LAUNCH, "arguments=['arm_controller'],",
            "arguments=['arm_controller', '--controller-ros-args',"
            " '-r ~/joint_trajectory:=/joint_trajectory'],", "left", "drives",
            "/joint_trajectory moves right, too"),
]  # fmt: skip
NAMED = [
    Spoiled("two_robots_nav2", "robot1/bridge.yaml", 'ros_topic_name: "/robot1/cmd_vel"',
            'ros_topic_name: "/cmd_vel"', "robot1", "drives", "/robot1/cmd_vel: that moves nothing"),
    Spoiled("two_robots_nav2", "robot2/bridge.yaml", 'gz_topic_name: "/robot2/cmd_vel"',
            'gz_topic_name: "/robot1/cmd_vel"', "robot2", "drives", "no topic of ROS reaches"),
    Spoiled("two_robots_nav2", "robot2/hexbase.urdf", "<topic>robot2/cmd_vel", "<topic>robot1/cmd_vel",
            "robot1", "drives", "/robot1/cmd_vel moves robot2, too"),
    Spoiled("two_robots_nav2", "robot2/hexbase.urdf", "<topic>robot2/scan", "<topic>scan",
            "robot2", "sees", "/robot2/scan, which no node sends"),
    Spoiled("two_robots_nav2", "robot2/bridge.yaml", '"/robot2/scan"', '"/robot1/scan"',
            "robot2", "sees", "/robot2/scan, which no node sends"),
    Spoiled("two_robots_nav2", "robot1/nav2_params.yaml", "odom_topic: odom",
            "odom_topic: /robot2/odom", "robot1", "sees", "which robot2 sends"),
    Spoiled("two_robots_nav2", "robot1/nav2_params.yaml", "robot_base_frame: base_link",
            "robot_base_frame: robot1/base_link", "robot1", "plans", "robot1/base_link on /robot1/tf"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "('/tf', 'tf')", "('/tf_', 'tf')",
            "robot1", "plans", "on /tf, where it is not"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "namespace=f'/{name}'", "namespace='/robot1'",
            "robot2", "starts", "two nodes are called /robot1/"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "  'route_server',", "  'router',",
            "robot1", "starts", "waits for router"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "'-topic', f'/{name}/robot_description'",
            "'-topic', 'robot_description'", "robot1", "starts", "waits for /robot_description"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "file(f'{name}/nav2_params.yaml')",
            "file(f'{name}/params.yaml')", "robot1", "starts", "params.yaml, which is not there"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "text(f'{name}/hexbase.urdf')",
            "text(f'{name}/hexbase')", "", "starts", "the launch file raises"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "cmd_vel:=/robot1/cmd_vel",
            "cmd_vel:=/robot2/cmd_vel", "robot1", "drives",
            "to /robot2/cmd_vel_nav: that moves ['robot2']"),
    Spoiled("mixed_fleet", "base1/nav2_params.yaml", "scan_topic: scan", "scan_topic: laser",
            "base1", "sees", "/base1/laser, which no node sends"),
    Spoiled("two_arms_moveit", "left/controllers.yaml", "arm_controller:\n", "hand:\n",
            "left", "starts", "arm_controller has no joints"),
    Spoiled("two_arms_moveit", "left/arm.urdf", 'command_interface name="position"',
            'command_interface name="effort"', "left", "starts", "the description does not export"),
    Spoiled("two_arms_moveit", "fleet.launch.py",
            "namespace=f'/{name}',\n            name='controller_manager'",
            "namespace='/',\n            name='controller_manager'", "right", "starts",
            "a spawner waits for /right/controller_manager"),
    Spoiled("two_robots_postfix", "robot2/scout.urdf", "cmd_vel/robot2", "cmd_vel/robot1",
            "robot1", "drives", "/cmd_vel/robot1 moves robot2, too"),
]  # fmt: skip
FAULTS = [*NAMED, *SIMULATED, *NAVIGATED, *CONTROLLED, *MOVED]
