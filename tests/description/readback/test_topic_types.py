# SPDX-License-Identifier: Apache-2.0
"""Role and type of every topic of a plugin, as ``create_publisher`` and the like have them.

Sources: ros-simulation/gazebo_ros_pkgs ros2 gazebo_plugins/src, unless a line says another one.
"""

from __future__ import annotations

import pytest
from description_calls import NEWEST_LTS, TYPES, RuntimeName, load_definitions, read

ODOM, TWIST, TF = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist", "tf2_msgs/msg/TFMessage"
IMAGE, INFO, CLOUD = (f"sensor_msgs/msg/{it}" for it in ("Image", "CameraInfo", "PointCloud2"))
JOINTS, SCAN = "sensor_msgs/msg/JointState", "sensor_msgs/msg/LaserScan"
VECTOR = "geometry_msgs/msg/Vector3Stamped"
HAZARD = "irobot_create_msgs/msg/HazardDetection"
PUB, SUB, SRV = "publishes", "subscribes", "serves"
SET_INFO = (SRV, "/set_camera_info", "sensor_msgs/srv/SetCameraInfo")
Ends = set[tuple[str, str, str]]


def endpoints(
    library: str, inside: str = "", sensor: str = "", more: str = ""
) -> list[RuntimeName]:
    plugin = f'<plugin name="p" filename="lib{library}.so">{inside}</plugin>'
    if sensor:
        plugin = f'<sensor name="s" type="{sensor}">{more}{plugin}</sensor>'
    text = f"<robot name='r'><gazebo>{plugin}</gazebo></robot>"
    (node,) = read(text.encode(), "r.urdf", load_definitions((), NEWEST_LTS)).nodes
    return [it for it in node.endpoints if not it.off]


def ends(library: str, inside: str = "", sensor: str = "", more: str = "") -> Ends:
    return {(it.role, it.name, it.type) for it in endpoints(library, inside, sensor, more)}


@pytest.mark.parametrize(
    ("library", "inside", "found"),
    [
        (
            "gazebo_ros_diff_drive",
            "<publish_odom>1</publish_odom><publish_odom_tf>true</publish_odom_tf>",
            {(SUB, "/cmd_vel", TWIST), (PUB, "/odom", ODOM), (PUB, "/tf", TF)},
        ),
        (
            "gazebo_ros_ackermann_drive",
            "<publish_distance>true</publish_distance><publish_steerangle>true</publish_steerangle>",
            {
                (SUB, "/cmd_vel", TWIST),
                (PUB, "/distance", "std_msgs/msg/Float32"),
                (PUB, "/steerangle", "std_msgs/msg/Float32"),
            },
        ),
        (
            "gazebo_ros_tricycle_drive",
            "<publish_wheel_joint_state>true</publish_wheel_joint_state>",
            {(SUB, "/cmd_vel", TWIST), (PUB, "/joint_states", JOINTS)},
        ),
        (
            "gazebo_ros_planar_move",
            "",
            {(SUB, "/cmd_vel", TWIST), (PUB, "/odom", ODOM), (PUB, "/tf", TF)},
        ),
        ("gazebo_ros_p3d", "", {(PUB, "/odom", ODOM)}),
        ("gazebo_ros_joint_state_publisher", "", {(PUB, "/joint_states", JOINTS)}),
        (
            "gazebo_ros_joint_pose_trajectory",
            "",
            {(SUB, "/set_joint_trajectory", "trajectory_msgs/msg/JointTrajectory")},
        ),
        ("gazebo_ros_force", "", {(SUB, "/gazebo_ros_force", "geometry_msgs/msg/Wrench")}),
        ("gazebo_ros_ft_sensor", "", {(PUB, "/wrench", "geometry_msgs/msg/WrenchStamped")}),
        ("gazebo_ros_bumper", "", {(PUB, "/bumper_states", "gazebo_msgs/msg/ContactsState")}),
        (
            "gazebo_ros_vacuum_gripper",
            "",
            {(PUB, "/grasping", "std_msgs/msg/Bool"), (SRV, "/switch", "std_srvs/srv/SetBool")},
        ),
        (
            "gazebo_ros_gps_sensor",
            "",
            {
                (PUB, "/p/out", "sensor_msgs/msg/NavSatFix"),
                (PUB, "/p/vel", "geometry_msgs/msg/Vector3Stamped"),
            },
        ),
        ("gazebo_ros_imu_sensor", "", {(PUB, "/p/out", "sensor_msgs/msg/Imu")}),
        ("gazebo_ros_video", "", {(SUB, "/p/image_raw", IMAGE)}),
        # iRobotEducation/create3_sim humble gazebo_ros_wheel_drop.cpp.
        ("gazebo_ros_create_wheel_drop", "", {(PUB, "/p/out", HAZARD)}),
        # tu-darmstadt-ros-pkg/hector_gazebo humble-devel gazebo_ros_magnetic.cpp, gazebo_ros_gps.cpp.
        ("hector_gazebo_ros_magnetic", "<ros/>", {(PUB, "/magnetic", VECTOR)}),
        (
            "hector_gazebo_ros_magnetic",
            "<ros/><topicName>mag</topicName><useMagneticFieldMsgs>true</useMagneticFieldMsgs>",
            {(PUB, "/mag", "sensor_msgs/msg/MagneticField")},
        ),
        (
            "hector_gazebo_ros_gps",
            "<ros/>",
            {(PUB, "/fix", "sensor_msgs/msg/NavSatFix"), (PUB, "/fix_velocity", VECTOR)},
        ),
        ("gazebo_ros_velodyne_laser", "", {(PUB, "/p/out", CLOUD)}),
        # Liquid-ai/Plankton master DVLROSPlugin.cpp: sensorOutputTopic and "_twist" behind it.
        (
            "uuv_gazebo_ros_dvl_plugin",
            "<ros/><sensor_topic>dvl</sensor_topic>",
            {
                (PUB, "/dvl", "uuv_sensor_ros_plugins_msgs/msg/DVL"),
                (PUB, "/dvl_twist", "geometry_msgs/msg/TwistWithCovarianceStamped"),
            },
        ),
    ],
)
def test_topics_of_a_plugin(library: str, inside: str, found: Ends) -> None:
    assert ends(library, inside) == found


# gazebo_ros_ray_sensor.cpp: PointCloud2 without the element; of any other text an error, no publisher.
@pytest.mark.parametrize(
    ("inside", "type_"),
    [
        ("", CLOUD),
        ("<output_type>sensor_msgs/LaserScan</output_type>", SCAN),
        ("<output_type> sensor_msgs/PointCloud2 </output_type>", CLOUD),
        ("<output_type>sensor_msgs/PointCloud</output_type>", "sensor_msgs/msg/PointCloud"),
        ("<output_type>sensor_msgs/Range</output_type>", "sensor_msgs/msg/Range"),
        ("<output_type>scan</output_type>", ""),
    ],
)
def test_a_type_that_an_element_chooses(inside: str, type_: str) -> None:
    assert ends("gazebo_ros_ray_sensor", inside) == {(PUB, "/p/out", type_)}


def test_a_remapped_topic_keeps_its_type() -> None:
    inside = "<ros><namespace>a</namespace><remapping>~/out:=scan</remapping></ros>"
    found = endpoints("gazebo_ros_imu_sensor", inside)
    assert [(it.role, it.name, it.type) for it in found] == [
        (PUB, "/a/scan", "sensor_msgs/msg/Imu")
    ]


# gazebo_ros_camera.cpp: below camera_name, or the sensor's name; what it has depends on the sensor.
@pytest.mark.parametrize(
    ("inside", "sensor", "more", "found"),
    [
        (
            "",
            "camera",
            "",
            {SET_INFO, (PUB, "/s/image_raw", IMAGE), (PUB, "/s/camera_info", INFO)},
        ),
        (
            "<camera_name>front</camera_name><triggered>true</triggered>",
            "camera",
            "",
            {
                SET_INFO,
                (PUB, "/front/image_raw", IMAGE),
                (PUB, "/front/camera_info", INFO),
                (SUB, "/front/image_trigger", "std_msgs/msg/Empty"),
            },
        ),
        (
            "<camera_name>front</camera_name><ros><namespace>a</namespace>"
            "<remapping>front/points:=cloud</remapping></ros>",
            "depth",
            "",
            {
                (SRV, "/a/set_camera_info", SET_INFO[2]),
                (PUB, "/a/front/image_raw", IMAGE),
                (PUB, "/a/front/camera_info", INFO),
                (PUB, "/a/front/depth/image_raw", IMAGE),
                (PUB, "/a/front/depth/camera_info", INFO),
                (PUB, "/a/cloud", CLOUD),
            },
        ),
        (
            "",
            "multicamera",
            "<camera name='left'/><camera name='right'/>",
            {
                SET_INFO,
                (PUB, "/s/left/image_raw", IMAGE),
                (PUB, "/s/left/camera_info", INFO),
                (PUB, "/s/right/image_raw", IMAGE),
                (PUB, "/s/right/camera_info", INFO),
            },
        ),
    ],
)
def test_topics_of_a_camera(inside: str, sensor: str, more: str, found: Ends) -> None:
    assert ends("gazebo_ros_camera", inside, sensor, more) == found


# Sources that could not be read: these topics have no type yet.
PID = {f"pid/{a}_{b}_motor" for a in ("front", "rear") for b in ("left", "right")}
UNTYPED = {*PID, "pid/articulation_joint", "collisions", "cmd_drive"}


@pytest.mark.slow
def test_every_topic_of_a_plugin_that_is_a_node_has_a_type() -> None:
    sections = load_definitions((), NEWEST_LTS, packages=False).sections(*TYPES)
    nodes = [it for it in sections if any(site.path == "ros/namespace" for site in it.sites)]
    missing = {it.name for section in nodes for it in section.wired if not it.type}
    assert missing == UNTYPED


def test_what_is_below_a_stem_is_one_name_where_robots_may_meet() -> None:
    plugin = '<plugin name="p" filename="libgazebo_ros_camera.so"/>'
    text = (
        f"<robot name='r'><gazebo><sensor name='s' type='camera'>{plugin}</sensor></gazebo></robot>"
    )
    found = read(text.encode(), "r.urdf", load_definitions((), NEWEST_LTS)).names
    assert [it.name for it in found if it.kind == "topics below"] == ["/s"]
