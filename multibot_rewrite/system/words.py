# SPDX-License-Identifier: Apache-2.0
"""Which topics move a robot, which say where it is or what it sees: by type and name."""

from __future__ import annotations

# They set a robot in motion: of these types always, of the second ones where the name says so.
_ALWAYS = (
    "ackermann_msgs/msg/AckermannDrive", "ackermann_msgs/msg/AckermannDriveStamped",
    "trajectory_msgs/msg/JointTrajectory", "control_msgs/msg/JointJog",
)  # fmt: skip
PLAIN, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
_BY_NAME = (PLAIN, STAMPED, "std_msgs/msg/Float64MultiArray", "std_msgs/msg/Float64")
_NAMED = ("cmd", "vel", "command", "setpoint", "speed")
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
    "livox_ros_driver2/", "mavros_msgs/",
)  # fmt: skip
MAP = "nav_msgs/msg/OccupancyGrid"
ODOMETRY, JOINTS = "nav_msgs/msg/Odometry", "sensor_msgs/msg/JointState"
# Data of one kind: a reader of the first may have meant the other.
_KINDS = {
    PLAIN: "velocity", STAMPED: "velocity",
    **dict.fromkeys(_ALWAYS[:2], "steering"),
    "sensor_msgs/msg/Image": "image", "sensor_msgs/msg/CompressedImage": "image",
}  # fmt: skip
# One device sends it; joints and ranges of one robot come from several.
_OF_ONE_SENSOR = (
    ODOMETRY, "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/NavSatFix",
    "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/MagneticField", "sensor_msgs/msg/BatteryState",
    "sensor_msgs/msg/Joy",
)  # fmt: skip
# Services of every node.
OF_EVERY_NODE = ("rcl_interfaces/", "type_description_interfaces/")
# No sensor's: a person's hand, a clock.
_NO_SENSOR = ("sensor_msgs/msg/Joy", "sensor_msgs/msg/TimeReference")
# What is sent to joints, as Isaac Sim and topic_based_ros2_control have it, is no state of them.
_TO_JOINTS = ("cmd", "command", "goal", "target", "desired", "reference")
JOYSTICK = "sensor_msgs/msg/Joy"
DESCRIPTION, _TEXT = "robot_description", "std_msgs/msg/String"
# The node of `ros2 bag play`.
PLAYER = "rosbag2_player"


def moves(name: str, type_: str) -> bool:
    """Does the topic set a robot in motion?"""
    last = name.rpartition("/")[2]
    return type_ in _ALWAYS or (type_ in _BY_NAME and any(it in last for it in _NAMED))


def is_pose_order(plain: str, type_: str) -> bool:
    """Does the topic (without its robot's name) send a robot somewhere, or say where it is?"""
    if type_ not in _POSES:
        return False
    bare = plain.strip("/").replace("_", "")
    return bare in _POSE_NAMES or bare.startswith("goalpos")


def is_start_pose(plain: str, type_: str) -> bool:
    """Does the topic (without its robot's name) tell a node where the robot starts?"""
    return type_ == _POSES[1] and is_pose_order(plain, type_)


def is_order(plain: str, type_: str) -> bool:
    """Does the topic (without its robot's name) move a robot or send it somewhere?"""
    return moves(plain, type_) or is_pose_order(plain, type_)


def kind_of_data(name: str, type_: str) -> str:
    """The kind of what a robot's driver, sensor, map server or description sends, or obeys; else ""."""
    last = name.rpartition("/")[2]
    if moves(name, type_):
        # A robot has one drive, and arms with as many controllers as its makers thought of.
        return _KINDS.get(type_, "")
    if type_ == MAP:
        return MAP if "map" in name.split("/")[-2:] else ""
    if type_ == _TEXT:
        return DESCRIPTION if is_description(name, type_) else ""
    if type_ == JOINTS and any(it in last for it in _TO_JOINTS):
        return ""
    sensor = type_.startswith("sensor_msgs/") and not type_.startswith(_NO_SENSOR)
    return _KINDS.get(type_, type_) if sensor or type_ == ODOMETRY else ""


def is_description(name: str, type_: str) -> bool:
    """Is it the topic of a robot's description?"""
    return type_ == _TEXT and name.endswith(("description", "urdf"))


def is_of_a_body(type_: str) -> bool:
    """Is it what the body of a single robot measures: its joints, its way, its scan?"""
    return type_ in _BODY


def is_of_one_sensor(type_: str) -> bool:
    """Does one device, or one filter, send it?"""
    return type_ in _OF_ONE_SENSOR


def is_of_one_robot(plain: str, type_: str) -> bool:
    """Would data of two robots be mixed on the topic: sensors, odometry, maps, commands, a
    description?"""
    sensors = type_.startswith(_SENSOR_PACKAGES)
    return sensors or moves(plain, type_) or plain.endswith(DESCRIPTION)
