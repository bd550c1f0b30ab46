"""Which topics move a robot, which say where it is or what it sees: by type and name."""

from __future__ import annotations

import re

# They set a robot in motion: of these types always, of the second ones where the name says so.
_ALWAYS = (
    "ackermann_msgs/msg/AckermannDrive", "ackermann_msgs/msg/AckermannDriveStamped",
    "trajectory_msgs/msg/JointTrajectory", "control_msgs/msg/JointJog",
)  # fmt: skip
_BY_NAME = (
    "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped", "std_msgs/msg/Float64MultiArray",
    "std_msgs/msg/Float64",
)  # fmt: skip
_NAMED = re.compile(r"cmd|vel|command|setpoint|speed")
# Where to go, and where a robot is: a person or program sends it to one robot.
_POSES = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped")
# Without underscores.
_POSE_NAMES = ("goalpose", "initialpose", "goal", "movebasesimple/goal")
# What one robot's own body measures: never that of two robots.
_BODY = (
    "nav_msgs/msg/Odometry", "sensor_msgs/msg/JointState", "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/Imu",
)  # fmt: skip
_SENSOR_PACKAGES = (
    "sensor_msgs/", "nav_msgs/", "trajectory_msgs/", "control_msgs/", "moveit_msgs/msg/PlanningScene",
    "stereo_msgs/", "radar_msgs/", "can_msgs/", "velodyne_msgs/", "ouster_sensor_msgs/",
    "livox_ros_driver2/",
)  # fmt: skip
MAP = "nav_msgs/msg/OccupancyGrid"
JOYSTICK = "sensor_msgs/msg/Joy"
ODOMETRY, JOINTS = "nav_msgs/msg/Odometry", "sensor_msgs/msg/JointState"
DESCRIPTION = "robot_description"
# The node of `ros2 bag play`.
PLAYER = "rosbag2_player"


def moves(name: str, type_: str) -> bool:
    """Does the topic set a robot in motion?"""
    return type_ in _ALWAYS or (type_ in _BY_NAME and bool(_NAMED.search(name.rpartition("/")[2])))


def is_pose_order(plain: str, type_: str) -> bool:
    """Does the topic (without its robot's name) send a robot somewhere, or say where it is?"""
    return type_ in _POSES and plain.strip("/").replace("_", "") in _POSE_NAMES


def is_order(plain: str, type_: str) -> bool:
    """Does the topic (without its robot's name) move a robot or send it somewhere?"""
    return moves(plain, type_) or is_pose_order(plain, type_)


def is_of_a_body(type_: str) -> bool:
    """Is it what the body of a single robot measures: its joints, its way, its scan?"""
    return type_ in _BODY


def is_of_one_robot(plain: str, type_: str) -> bool:
    """Would data of two robots be mixed on the topic: sensors, odometry, maps, commands, a
    description?"""
    sensors = type_.startswith(_SENSOR_PACKAGES)
    return sensors or moves(plain, type_) or plain.endswith(DESCRIPTION)
