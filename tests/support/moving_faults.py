# SPDX-License-Identifier: Apache-2.0
"""Seeded faults of tf and of commands."""

from __future__ import annotations

from fault_changes import (
    LEFT,
    RIGHT,
    TRAJECTORY,
    Fault,
    added,
    bare_odometry,
    both,
    frame,
    in_each,
    nav,
    other_parent,
    prefixed_twice,
    renamed,
    sent_twice,
    shared_tf,
    twice,
)
from graph_cases import global_tf
from healthy_systems import NAVIGATE, POSE, SCAN, TF, TRIGGER, TWIST, arms, single

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES


def tf_rows() -> tuple[Fault, ...]:
    tf1, tf2 = "/robot1/tf", "/robot2/tf"
    own_rule = "/tf:=tf"
    return (
        Fault(
            "nobody passed /tf:=tf: both trees on /tf", nav, lambda g: global_tf(g, "robot1", "robot2"),
            "MG402", ("robot1 and robot2", "base_link", own_rule),
        ),
        Fault(
            "one robot_state_publisher lacks /tf:=tf", nav,
            both(
                renamed(tf2, "/tf", "/robot2/robot_state_publisher"),
                renamed("/robot2/tf_static", "/tf_static", "/robot2/robot_state_publisher"),
            ),
            "MG405", ("/robot2/robot_state_publisher", "on /tf", own_rule),
        ),
        Fault(
            "bt_navigator listens to /tf", nav, renamed(tf1, "/tf", "/robot1/bt_navigator"),
            "MG405", ("/robot1/bt_navigator", "hears", own_rule),
        ),
        Fault(
            "robot2's amcl sends tf to robot1", nav, renamed(tf2, tf1, "/robot2/amcl"),
            "MG405", ("/robot2/amcl", "names robot1"),
        ),
        Fault(
            "controllers send bare odom on a shared /tf", shared_tf, bare_odometry,
            "MG402", ("robot1 and robot2", "base_footprint"), ERROR, ("MG406",),
        ),
        Fault(
            "both amcl send map -> odom of their defaults", shared_tf, frame("odom", "map", "/tf"),
            "MG402", ("odom", "robot1 and robot2"),
        ),
        Fault(
            "a static map -> odom beside amcl", nav,
            both(
                added("/robot1/static_transform_publisher_x", (PUBLISHES, "/robot1/tf_static", TF)),
                frame("odom", "map", "/robot1/tf_static", True),
            ),
            "MG404", ("static_transform_publisher_x", "map -> odom"),
        ),
        Fault(
            "a node sends base_link -> map", nav, frame("map", "base_link", tf1),
            "MG403", ("circle", "map -> odom -> base_footprint -> base_link"),
        ),
        Fault(
            "the EKF sends odom_combined beside the controller's odom", nav,
            both(
                added("/robot1/ekf_node", (PUBLISHES, tf1, TF)),
                frame("base_footprint", "odom_combined", tf1),
            ),
            "MG401", ("odom and odom_combined", "base_footprint"),
        ),
        Fault(
            "the EKF calls its frame odom_combined, amcl odom", nav,
            other_parent("base_footprint", "odom_combined", tf1),
            "MG406", ("2 roots", "odom_combined", "no node sends"),
        ),
        Fault(
            "robot2's controller sends below robot1's odom", shared_tf,
            other_parent("base_footprint/robot2", "odom/robot1", "/tf"),
            "MG414", ("odom/robot1", "of robot2 to its own"), ERROR, ("MG406",),
        ),
        Fault(
            "frame_prefix on top of a rewritten description", shared_tf, prefixed_twice,
            "MG407", ("robot1/robot1", "frame_prefix"), ERROR, ("MG406",),
        ),
        Fault(
            "robot2 sends a mount with robot1's name", shared_tf,
            frame("imu_link/robot1", "base_link/robot2", "/tf"),
            "MG401", ("imu_link/robot1", "base_link/robot2"),
        ),
        Fault(
            "the EKF sends the controller's odometry as well", nav,
            both(
                added("/robot1/ekf_node", (PUBLISHES, tf1, TF)),
                sent_twice("base_footprint", tf1),
            ),
            "MG408", ("odom -> base_footprint", "/robot1/ekf_node", "publish_tf"),
        ),
        Fault(
            "two robots without any namespace", single, twice,
            "MG301", ("more than once", "without a namespace"), ERROR, ("MG402", "MG502"),
        ),
    )  # fmt: skip


def command_rows() -> tuple[Fault, ...]:
    cmd1 = "/robot1/cmd_vel"
    send1 = (PUBLISHES, cmd1, TWIST)
    return (
        Fault(
            "robot2's teleop drives robot1", nav, added("/robot2/teleop_twist_joy_node", send1),
            "MG311", ("/robot2/teleop_twist_joy_node", "a name of robot1"),
        ),
        Fault(
            "a joystick called after robot2 drives robot1", nav, added("/teleop_robot2", send1),
            "MG311", ("/teleop_robot2", "a name of robot1"),
        ),
        Fault(
            "a joystick against Nav2", nav, added("/robot1/teleop_twist_joy_node", send1),
            "MG312", ("teleop_twist_joy_node", "collision_monitor", "twist_mux"), ERROR,
        ),
        Fault(
            "ros2 topic pub on cmd_vel", nav, added("/_ros2cli_4711", send1),
            "MG312", ("/_ros2cli_4711", cmd1), ERROR,
        ),
        Fault(
            "a fleet manager drives as well", nav, added("/fleet_manager", send1),
            "MG312", ("/fleet_manager", cmd1), ERROR,
        ),
        Fault(
            "a joystick in the root", nav, added("/teleop_node", (PUBLISHES, "/cmd_vel", TWIST)),
            "MG308", ("no node reads", "/cmd_vel", "put twist_mux before"),
        ),
        Fault(
            "a joystick in a namespace with a capital", nav,
            added("/teleop_node", (PUBLISHES, "/Robot2/cmd_vel", TWIST)),
            "MG308", ("/Robot2/cmd_vel", "/robot2/cmd_vel"),
        ),
        Fault(
            "RViz's goal in the root", nav, added("/rviz2", (PUBLISHES, "/goal_pose", POSE)),
            "MG308", ("/rviz2", "/robot1/goal_pose"), NOTE,
        ),
        Fault(
            "both drivers obey /cmd_vel", nav, in_each("cmd_vel", "/cmd_vel"),
            "MG310", ("robot1 and robot2", "/cmd_vel"), ERROR, ("MG320",),
        ),
        Fault(
            "both robots obey /goal_pose", nav, in_each("goal_pose", "/goal_pose"),
            "MG310", ("robot1 and robot2", "/goal_pose"),
        ),
        Fault(
            "both amcl take /initialpose", nav,
            both(
                renamed("/robot1/initialpose", "/initialpose", "/robot1/amcl"),
                renamed("/robot2/initialpose", "/initialpose", "/robot2/amcl"),
            ),
            "MG310", ("/initialpose", "amcl"), ERROR, ("MG303", "MG308"),
        ),
        Fault(
            "ros2 bag play into the running robot", nav,
            added("/rosbag2_player", (PUBLISHES, "/robot1/scan", SCAN), (PUBLISHES, "/robot1/tf", TF)),
            "MG313", ("/robot1/scan", "ROS_DOMAIN_ID"),
        ),
        Fault(
            "ros2 bag play with commands", nav, added("/rosbag2_player", send1),
            "MG313", (cmd1,),
        ),
        Fault(
            "two programs send one arm's trajectories", arms,
            both(
                added("/left_arm/arm_controller", (SUBSCRIBES, LEFT, TRAJECTORY)),
                added("/left_arm/demo", (PUBLISHES, LEFT, TRAJECTORY)),
                added("/left_arm/servo_node", (PUBLISHES, LEFT, TRAJECTORY)),
            ),
            "MG312", ("demo", "servo_node"), WARNING,
        ),
        Fault(
            "the left arm's program moves the right arm", arms,
            both(
                added("/right_arm/arm_controller", (SUBSCRIBES, RIGHT, TRAJECTORY)),
                added("/left_arm/demo", (PUBLISHES, RIGHT, TRAJECTORY)),
            ),
            "MG311", ("/left_arm/demo", "a name of right_arm"),
        ),
        Fault(
            "robot1's patrol sends goals to robot2", nav,
            added("/robot1/patrol", (CALLS, "/robot2/navigate_to_pose", NAVIGATE)),
            "MG311", ("/robot1/patrol", "sends goals", "robot2"),
        ),
        Fault(
            "robot2's watchdog resets robot1", nav,
            both(
                added("/robot1/driver", (SERVES, "/robot1/reset", TRIGGER)),
                added("/robot2/driver", (SERVES, "/robot2/reset", TRIGGER)),
                added("/robot2/watchdog", (CALLS, "/robot1/reset", TRIGGER)),
            ),
            "MG311", ("/robot2/watchdog", "calls /robot1/reset"),
        ),
    )  # fmt: skip
