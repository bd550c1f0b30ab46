# SPDX-License-Identifier: Apache-2.0
"""What a topic is, by its type and its name: does it move a robot, does one device send it?"""

from __future__ import annotations

import pytest

from multibot_rewrite.system import words

TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
STEER = "ackermann_msgs/msg/AckermannDrive"
POSE = "geometry_msgs/msg/PoseStamped"
START = "geometry_msgs/msg/PoseWithCovarianceStamped"
GRID, ODOMETRY = "nav_msgs/msg/OccupancyGrid", "nav_msgs/msg/Odometry"
JOINTS, TEXT = "sensor_msgs/msg/JointState", "std_msgs/msg/String"
SCAN, IMU, IMAGE = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/Image"
PACKED, JOY = "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Joy"
FLOATS = "std_msgs/msg/Float64MultiArray"


@pytest.mark.parametrize(
    ("name", "type_", "moving"),
    [
        # Always, whatever they are called.
        ("/arm/out", "trajectory_msgs/msg/JointTrajectory", True),
        ("/arm/out", "control_msgs/msg/JointJog", True),
        ("/out", STEER, True),
        ("/out", "ackermann_msgs/msg/AckermannDriveStamped", True),
        # Where the last word says so.
        ("/robot1/cmd_vel", TWIST, True),
        ("/robot1/cmd_vel", STAMPED, True),
        ("/arm/commands", FLOATS, True),
        ("/arm/setpoint", "std_msgs/msg/Float64", True),
        ("/arm/speed", FLOATS, True),
        ("/arm/wind", TWIST, False),
        ("/cmd/state", FLOATS, False),
        ("/cmd_vel", TEXT, False),
    ],
)
def test_what_sets_a_robot_in_motion(name: str, type_: str, moving: bool) -> None:
    assert words.moves(name, type_) is moving
    assert words.is_order(name, type_) is moving


@pytest.mark.parametrize(
    ("plain", "type_", "order", "start"),
    [
        ("/goal_pose", POSE, True, False),
        ("goalpose", POSE, True, False),
        ("/goal", POSE, True, False),
        ("/move_base_simple/goal", POSE, True, False),
        ("/initialpose", START, True, True),
        ("/initial_pose/", START, True, True),
        ("/initialpose", TEXT, False, False),
        ("/pose", START, False, False),
        ("/left/goal", POSE, False, False),
    ],
)
def test_what_sends_a_robot_somewhere(plain: str, type_: str, order: bool, start: bool) -> None:
    assert words.is_pose_order(plain, type_) is order
    assert words.is_order(plain, type_) is order
    assert words.is_start_pose(plain, type_) is start


@pytest.mark.parametrize(
    ("name", "type_", "kind"),
    [
        ("/a/cmd_vel", TWIST, "velocity"),
        ("/a/cmd_vel", STAMPED, "velocity"),
        ("/a/out", STEER, "steering"),
        ("/a/out", "ackermann_msgs/msg/AckermannDriveStamped", "steering"),
        ("/arm/commands", FLOATS, ""),
        ("/wind", TWIST, ""),
        ("/map", GRID, GRID),
        ("/map/static", GRID, GRID),
        ("/map/old/static", GRID, ""),
        ("/costmap", GRID, ""),
        ("/a/robot_description", TEXT, "robot_description"),
        ("/a/my_urdf", TEXT, "robot_description"),
        ("/robot_description/says", TEXT, ""),
        ("/joint_states", JOINTS, JOINTS),
        *((f"/joint_{it}", JOINTS, "") for it in ("commands", "cmd", "goals", "targets")),
        *((f"/joint_{it}", JOINTS, "") for it in ("desired", "reference")),
        ("/desired/joint_states", JOINTS, JOINTS),
        ("/camera", IMAGE, "image"),
        ("/camera/compressed", PACKED, "image"),
        ("/scan", SCAN, SCAN),
        ("/scan_reference", SCAN, SCAN),
        ("/joy", JOY, ""),
        ("/time", "sensor_msgs/msg/TimeReference", ""),
        ("/odom", ODOMETRY, ODOMETRY),
        ("/path", "nav_msgs/msg/Path", ""),
    ],
)
def test_data_of_one_kind_may_stand_for_each_other(name: str, type_: str, kind: str) -> None:
    assert words.kind_of_data(name, type_) == kind


@pytest.mark.parametrize(
    ("type_", "body", "sensor"),
    [
        (ODOMETRY, True, True),
        (JOINTS, True, False),
        *((f"sensor_msgs/msg/{it}", False, True) for it in ("CameraInfo", "MagneticField", "Joy")),
        ("sensor_msgs/msg/BatteryState", False, True),
        (SCAN, True, True),
        (IMU, True, True),
        (IMAGE, False, True),
        (PACKED, False, True),
        ("sensor_msgs/msg/PointCloud2", False, True),
        ("sensor_msgs/msg/NavSatFix", False, True),
        (TWIST, False, False),
    ],
)
def test_what_one_body_and_what_one_device_measures(type_: str, body: bool, sensor: bool) -> None:
    assert words.is_of_a_body(type_) is body
    assert words.is_of_one_sensor(type_) is sensor


@pytest.mark.parametrize(
    ("plain", "type_", "mixed"),
    [
        ("/out", SCAN, True),
        ("/out", GRID, True),
        ("/out", "trajectory_msgs/msg/JointTrajectoryPoint", True),
        ("/out", "control_msgs/msg/JointControllerState", True),
        ("/out", "moveit_msgs/msg/PlanningScene", True),
        ("/out", "moveit_msgs/msg/RobotState", False),
        ("/out", "stereo_msgs/msg/DisparityImage", True),
        ("/out", "radar_msgs/msg/RadarScan", True),
        ("/out", "can_msgs/msg/Frame", True),
        ("/out", "velodyne_msgs/msg/VelodyneScan", True),
        ("/out", "ouster_sensor_msgs/msg/PacketMsg", True),
        ("/out", "livox_ros_driver2/msg/CustomMsg", True),
        ("/out", "mavros_msgs/msg/State", True),
        ("/cmd_vel", TWIST, True),
        ("/wind", TWIST, False),
        ("/robot_description", TEXT, True),
        ("/robot_description/old", TEXT, False),
        ("/chatter", TEXT, False),
    ],
)
def test_data_of_two_robots_on_one_topic_would_be_mixed(
    plain: str, type_: str, mixed: bool
) -> None:
    assert words.is_of_one_robot(plain, type_) is mixed


def test_a_player_and_a_joystick_have_the_names_of_their_packages() -> None:
    """rosbag2_transport player.cpp; sensor_msgs."""
    assert (words.PLAYER, words.JOYSTICK) == ("rosbag2_player", JOY)
    assert (words.MAP, words.JOINTS, words.ODOMETRY) == (GRID, JOINTS, ODOMETRY)


# Which nodes are none of a robot's, by name.
@pytest.mark.parametrize(
    ("node", "more", "tool"),
    [
        ("/a/rviz2", (), True),
        ("/a/driver", (), False),
        # Without a slash a pattern is of any namespace, with one of the full name.
        ("/a/driver", ("driver",), True),
        ("/a/driver", ("dri*",), True),
        ("/a/driver", ("/a/*",), True),
        ("/a/driver", ("/b/*", "/a/driver"), True),
        ("/a/driver", ("/driver",), False),
        ("/a/driver", ("a*",), False),
        ("/a/driver", ("other", "/b/*"), False),
    ],
)
def test_a_tool_is_known_by_its_word_or_by_a_pattern(
    node: str, more: tuple[str, ...], tool: bool
) -> None:
    assert words.is_tool(node, more) is tool


@pytest.mark.parametrize(
    ("node", "viewer", "hidden", "spawner"),
    [
        ("/a/rviz2", True, False, False),
        ("/_ros2cli_12", True, True, False),
        ("/a/_hidden", False, True, False),
        ("/_a/driver", False, False, False),
        ("/a/spawner_arm", True, False, True),
        ("/spawner_a/arm", False, False, False),
    ],
)
def test_what_the_last_word_says(node: str, viewer: bool, hidden: bool, spawner: bool) -> None:
    said = (words.is_viewer(node), words.is_hidden(node), words.is_spawner(node))
    assert said == (viewer, hidden, spawner)


@pytest.mark.parametrize(
    ("node", "name", "above"),
    [
        ("/a/b/driver", "/a/b/scan", ["/a/scan", "/scan"]),
        ("/a/driver", "/a/x/scan", ["/x/scan"]),
        ("/a/driver", "/b/scan", []),
        ("/driver", "/scan", []),
    ],
)
def test_a_name_moved_to_the_namespaces_above(node: str, name: str, above: list[str]) -> None:
    assert list(words.in_namespaces_above(node, name)) == above
