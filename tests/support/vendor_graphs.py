# SPDX-License-Identifier: Apache-2.0
"""Two robots of a vendor each, with Nav2 and the nodes that the vendor's own launch files start.

Names and types are those of the sources named beside each; nothing is wrong in any of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from graph_cases import sent, without_node
from healthy_systems import (
    CLOCK,
    JOINTS,
    ODOMETRY,
    SCAN,
    TF,
    TRIGGER,
    TWIST,
    TWO,
    Row,
    started,
    with_ends,
    with_node,
)

from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, Edge, System

RELEASES = ("humble", "jazzy", "kilted", "lyrical", "rolling")
STAMPED, IMU = "geometry_msgs/msg/TwistStamped", "sensor_msgs/msg/Imu"
BATTERY, JOY, TEXT = "sensor_msgs/msg/BatteryState", "sensor_msgs/msg/Joy", "std_msgs/msg/String"
BOOL, IMAGE, POINTS = "std_msgs/msg/Bool", "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"
INFO, DIAGNOSTICS = "sensor_msgs/msg/CameraInfo", "diagnostic_msgs/msg/DiagnosticArray"
# A node below a robot -> its rows, names below it unless they begin with a slash.
Rows = Mapping[str, Sequence[Row]]
DRIVER = ("diff_drive", "joint_states", "lidar_driver", "camera_driver", "imu_driver")
LISTENS = ((SUBSCRIBES, "tf", TF), (SUBSCRIBES, "tf_static", TF))


def of_vendor(rows: Rows, release: str, leave_out: Iterable[str] = DRIVER) -> System:
    """Two robots with Nav2, with these nodes in place of the usual drivers."""
    graph = started(("nav2",), release=release)
    for robot in TWO:
        for node in leave_out:
            graph = without_node(graph, f"/{robot}/{node}")
        for node, own in rows.items():
            placed = ((role, _placed(name, robot), type_) for role, name, type_ in own)
            graph = with_node(graph, f"/{robot}/{node}", *placed)
    return sent(graph)


def _placed(name: str, robot: str) -> str:
    return name if name.startswith("/") else f"/{robot}/{name}"


# The Create 3 itself is hidden below _do_not_use.
# turtlebot4_bringup@humble: robot.launch.py, standard.launch.py.
_CREATE = "irobot_create_msgs/msg"
_HIDDEN = (
    ("battery_state", BATTERY),
    ("cliff_intensity", f"{_CREATE}/IrIntensityVector"),
    ("dock_status", f"{_CREATE}/DockStatus"),
    ("hazard_detection", f"{_CREATE}/HazardDetectionVector"),
    ("imu", IMU),
    ("interface_buttons", f"{_CREATE}/InterfaceButtons"),
    ("odom", ODOMETRY),
    ("tf", TF),
    ("wheel_status", f"{_CREATE}/WheelStatus"),
)
_REPUBLISHED = (
    *((SUBSCRIBES, f"_do_not_use/{name}", type_) for name, type_ in _HIDDEN),
    *((PUBLISHES, name, type_) for name, type_ in _HIDDEN),
    (SUBSCRIBES, "cmd_vel", TWIST), (PUBLISHES, "_do_not_use/cmd_vel", TWIST),
    (SERVES, "e_stop", "irobot_create_msgs/srv/EStop"),
    (CALLS, "_do_not_use/e_stop", "irobot_create_msgs/srv/EStop"),
    (SERVES, "dock", "irobot_create_msgs/action/Dock"),
    (CALLS, "_do_not_use/dock", "irobot_create_msgs/action/Dock"),
)  # fmt: skip
TURTLEBOT4: Rows = {
    "_do_not_use/create3": (
        *((PUBLISHES, f"_do_not_use/{name}", type_) for name, type_ in _HIDDEN),
        (SUBSCRIBES, "_do_not_use/cmd_vel", TWIST),
        (SERVES, "_do_not_use/e_stop", "irobot_create_msgs/srv/EStop"),
        (SERVES, "_do_not_use/dock", "irobot_create_msgs/action/Dock"),
    ),
    "create3_repub": _REPUBLISHED,
    # turtlebot4.cpp
    "turtlebot4_node": (
        (SUBSCRIBES, "battery_state", BATTERY), (SUBSCRIBES, "joy", JOY),
        (SUBSCRIBES, "dock_status", f"{_CREATE}/DockStatus"),
        (SUBSCRIBES, "wheel_status", f"{_CREATE}/WheelStatus"),
        (SUBSCRIBES, "interface_buttons", f"{_CREATE}/InterfaceButtons"),
        (SUBSCRIBES, "hmi/buttons", "turtlebot4_msgs/msg/UserButton"),
        (SUBSCRIBES, "hmi/led", "turtlebot4_msgs/msg/UserLed"),
        (SUBSCRIBES, "hmi/display/message", TEXT),
        (PUBLISHES, "ip", TEXT), (PUBLISHES, "function_calls", TEXT),
        (PUBLISHES, "hmi/display", "turtlebot4_msgs/msg/UserDisplay"),
        (CALLS, "e_stop", "irobot_create_msgs/srv/EStop"),
        (CALLS, "robot_power", "irobot_create_msgs/srv/RobotPower"),
        (CALLS, "start_motor", "std_srvs/srv/Empty"), (CALLS, "oakd/start_camera", TRIGGER),
        (CALLS, "dock", "irobot_create_msgs/action/Dock"),
    ),
    "turtlebot4_base_node": (
        (PUBLISHES, "hmi/buttons", "turtlebot4_msgs/msg/UserButton"),
        (SUBSCRIBES, "hmi/display", "turtlebot4_msgs/msg/UserDisplay"),
        *((SUBSCRIBES, f"hmi/led/_{it}", "std_msgs/msg/Int32") for it in ("power", "motors")),
    ),
    "joy_linux_node": (
        (PUBLISHES, "joy", JOY), (SUBSCRIBES, "joy/set_feedback", "sensor_msgs/msg/JoyFeedback"),
    ),
    "rplidar_composition": (
        (PUBLISHES, "scan", SCAN), (SERVES, "start_motor", "std_srvs/srv/Empty"),
        (SERVES, "stop_motor", "std_srvs/srv/Empty"),
    ),
    "oakd": (
        (PUBLISHES, "oakd/rgb/preview/image_raw", IMAGE),
        (PUBLISHES, "oakd/rgb/preview/camera_info", INFO),
        (SERVES, "oakd/start_camera", TRIGGER), (SERVES, "oakd/stop_camera", TRIGGER),
    ),
    "joint_state_publisher": (
        (SUBSCRIBES, "robot_description", TEXT), (PUBLISHES, "joint_states", JOINTS),
    ),
    "turtlebot4_diagnostics": (
        (SUBSCRIBES, "battery_state", BATTERY), (SUBSCRIBES, "scan", SCAN),
        (PUBLISHES, "diagnostics", DIAGNOSTICS),
    ),
    "analyzers": (
        (SUBSCRIBES, "diagnostics", DIAGNOSTICS), (PUBLISHES, "diagnostics_agg", DIAGNOSTICS),
    ),
}  # fmt: skip


def turtlebot4(release: str) -> System:
    """Return what the Create 3 sends on its own tf comes once more on the robot's.

    Without its teleop_twist_joy, which sends cmd_vel beside Nav2: what MG312 says of that is true.
    """
    graph = of_vendor(TURTLEBOT4, release)
    hidden = (Edge("base_link", "odom", f"/{it}/_do_not_use/tf", False, ()) for it in TWO)
    return sent(graph._replace(edges=(*graph.edges, *hidden)))


# husarion_ugv_ros@ros2: controller.launch.py,
# localization.launch.py, *_node.cpp, system_ros_interface.cpp.
_UGV, _SET_BOOL = "husarion_ugv_msgs/msg", "std_srvs/srv/SetBool"
HUSARION: Rows = {
    "controller_manager": (
        (SUBSCRIBES, "robot_description", TEXT), (PUBLISHES, "diagnostics", DIAGNOSTICS),
    ),
    "joint_state_broadcaster": (
        (PUBLISHES, "joint_states", JOINTS),
        (PUBLISHES, "dynamic_joint_states", "control_msgs/msg/DynamicJointState"),
    ),
    # Chained before drive_controller.
    "twist_mux_controller": (
        (SUBSCRIBES, "manual/cmd_vel", STAMPED), (SUBSCRIBES, "autonomous/cmd_vel", STAMPED),
        (SUBSCRIBES, "cmd_vel", STAMPED),
    ),
    "drive_controller": (
        (PUBLISHES, "odometry/wheels", ODOMETRY),
        (PUBLISHES, "drive_controller/_transition_event", "lifecycle_msgs/msg/TransitionEvent"),
    ),
    "imu_broadcaster": ((PUBLISHES, "imu/data", IMU),),
    "hardware_controller": (
        (PUBLISHES, "hardware/robot_driver_state", f"{_UGV}/RobotDriverState"),
        (PUBLISHES, "hardware/io_state", f"{_UGV}/IOState"), (PUBLISHES, "hardware/e_stop", BOOL),
        (SERVES, "hardware/e_stop_trigger", TRIGGER), (SERVES, "hardware/e_stop_reset", TRIGGER),
        (SERVES, "hardware/led_control_enable", _SET_BOOL),
    ),
    "battery_driver": (
        (SUBSCRIBES, "hardware/robot_driver_state", f"{_UGV}/RobotDriverState"),
        (SUBSCRIBES, "hardware/io_state", f"{_UGV}/IOState"),
        (PUBLISHES, "battery/battery_status", BATTERY),
        (PUBLISHES, "_battery/battery_1_status_raw", BATTERY),
        (PUBLISHES, "_battery/battery_2_status_raw", BATTERY),
    ),
    "ekf_filter": (
        (SUBSCRIBES, "odometry/wheels", ODOMETRY), (SUBSCRIBES, "imu/data", IMU),
        (PUBLISHES, "odom", ODOMETRY), (PUBLISHES, "tf", TF),
        (SUBSCRIBES, "set_pose", "geometry_msgs/msg/PoseWithCovarianceStamped"), *LISTENS,
    ),
    "joy2twist": (
        (SUBSCRIBES, "joy", JOY), (PUBLISHES, "manual/cmd_vel", STAMPED),
        (CALLS, "hardware/e_stop_trigger", TRIGGER), (CALLS, "hardware/e_stop_reset", TRIGGER),
    ),
    "joy_node": ((PUBLISHES, "joy", JOY),),
    "lights_controller": (
        (PUBLISHES, "lights/channel_1_frame", IMAGE), (PUBLISHES, "lights/channel_2_frame", IMAGE),
        (SERVES, "lights/set_animation", "husarion_ugv_msgs/srv/SetLEDAnimation"),
    ),
    "lights_driver": (
        (SUBSCRIBES, "lights/channel_1_frame", IMAGE), (SUBSCRIBES, "lights/channel_2_frame", IMAGE),
        (CALLS, "hardware/led_control_enable", _SET_BOOL),
    ),
    "lights_manager": (
        (SUBSCRIBES, "battery/battery_status", BATTERY), (SUBSCRIBES, "hardware/e_stop", BOOL),
        (CALLS, "lights/set_animation", "husarion_ugv_msgs/srv/SetLEDAnimation"),
    ),
    "safety_manager": (
        (SUBSCRIBES, "battery/battery_status", BATTERY), (SUBSCRIBES, "hardware/e_stop", BOOL),
        (SUBSCRIBES, "hardware/io_state", f"{_UGV}/IOState"),
        (SUBSCRIBES, "hardware/robot_driver_state", f"{_UGV}/RobotDriverState"),
        (SUBSCRIBES, "system_status", f"{_UGV}/SystemStatus"),
        (CALLS, "hardware/e_stop_trigger", TRIGGER),
    ),
    "system_monitor": (
        (PUBLISHES, "system_status", f"{_UGV}/SystemStatus"), (PUBLISHES, "diagnostics", DIAGNOSTICS),
    ),
    "lidar": ((PUBLISHES, "scan", SCAN),),
}  # fmt: skip


def husarion(release: str) -> System:
    """Nav2 with enable_stamped_cmd_vel, which all of Husarion's nodes want."""
    graph = of_vendor(HUSARION, release)
    ends = (it._replace(type=STAMPED) if it.type == TWIST else it for it in graph.ends)
    return sent(graph._replace(ends=tuple(ends)))


# clearpath_common@jazzy, clearpath_control:
# (control, localization, teleop_base, teleop_joy launch files, a200).
_MARKERS = "visualization_msgs/msg/InteractiveMarker"
CLEARPATH: Rows = {
    "controller_manager": (
        (SUBSCRIBES, "robot_description", TEXT), (PUBLISHES, "diagnostics", DIAGNOSTICS),
    ),
    "joint_state_broadcaster": (
        (PUBLISHES, "platform/joint_states", JOINTS),
        (PUBLISHES, "platform/dynamic_joint_states", "control_msgs/msg/DynamicJointState"),
    ),
    "platform_velocity_controller": (
        (SUBSCRIBES, "platform/cmd_vel_unstamped", TWIST), (PUBLISHES, "platform/odom", ODOMETRY),
    ),
    "ekf_node": (
        (SUBSCRIBES, "platform/odom", ODOMETRY), (SUBSCRIBES, "sensors/imu_0/data", IMU),
        (PUBLISHES, "platform/odom/filtered", ODOMETRY), (PUBLISHES, "tf", TF), *LISTENS,
    ),
    "twist_mux": (
        (SUBSCRIBES, "joy_teleop/cmd_vel", TWIST), (SUBSCRIBES, "twist_marker_server/cmd_vel", TWIST),
        (SUBSCRIBES, "rc_teleop/cmd_vel", TWIST), (SUBSCRIBES, "cmd_vel", TWIST),
        (SUBSCRIBES, "platform/emergency_stop", BOOL), (PUBLISHES, "platform/cmd_vel_unstamped", TWIST),
        (PUBLISHES, "diagnostics", DIAGNOSTICS),
    ),
    "joy_teleop/joy_node": ((PUBLISHES, "joy_teleop/joy", JOY),),
    "joy_teleop/teleop_twist_joy_node": (
        (SUBSCRIBES, "joy_teleop/joy", JOY), (PUBLISHES, "joy_teleop/cmd_vel", TWIST),
    ),
    "twist_server_node": (
        (PUBLISHES, "twist_marker_server/cmd_vel", TWIST),
        (PUBLISHES, "twist_marker_server/update", f"{_MARKERS}Update"),
        (SUBSCRIBES, "twist_marker_server/feedback", f"{_MARKERS}Feedback"),
    ),
    "puma_control": ((PUBLISHES, "platform/emergency_stop", BOOL),),
    "sensors/imu_0/imu_filter_node": (
        (SUBSCRIBES, "sensors/imu_0/data_raw", IMU), (PUBLISHES, "sensors/imu_0/data", IMU),
    ),
    "sensors/imu_0/driver": ((PUBLISHES, "sensors/imu_0/data_raw", IMU),),
    "sensors/lidar2d_0/driver": ((PUBLISHES, "sensors/lidar2d_0/scan", SCAN),),
}  # fmt: skip


def clearpath(release: str) -> System:
    """Nav2 takes the platform's odometry and the lidar's scan by remap rules (clearpath_nav2_demos)."""
    graph = of_vendor(CLEARPATH, release)
    moved = {"odom": "platform/odom/filtered", "scan": "sensors/lidar2d_0/scan"}
    moved["joint_states"] = "platform/joint_states"
    full = {f"/{it}/{old}": f"/{it}/{new}" for it in TWO for old, new in moved.items()}
    ends = (it._replace(name=full.get(it.name, it.name)) for it in graph.ends)
    return sent(graph._replace(ends=tuple(ends)))


# rmf_ros2@main: rmf_fleet_adapter agv/Node.cpp, rmf_traffic_ros2 StandardNames.hpp, rmf_task_ros2;
# free_fleet (nav2 over Zenoh): its adapter is a client of each robot.
_RMF = (
    ("/rmf_traffic_schedule_primary", (
        (PUBLISHES, "/rmf_traffic/participants", "rmf_traffic_msgs/msg/Participants"),
        (PUBLISHES, "/rmf_traffic/heartbeat", "rmf_traffic_msgs/msg/Heartbeat"),
        (SUBSCRIBES, "/rmf_traffic/itinerary_set", "rmf_traffic_msgs/msg/ItinerarySet"),
        (SERVES, "/rmf_traffic/register_participant", "rmf_traffic_msgs/srv/RegisterParticipant"),
    )),
    ("/rmf_traffic_schedule_monitor", (
        (SUBSCRIBES, "/rmf_traffic/heartbeat", "rmf_traffic_msgs/msg/Heartbeat"),
    )),
    ("/rmf_traffic_blockade_node", (
        (SUBSCRIBES, "/rmf_traffic/blockade_set", "rmf_traffic_msgs/msg/BlockadeSet"),
        (PUBLISHES, "/rmf_traffic/blockade_heartbeat", "rmf_traffic_msgs/msg/BlockadeHeartbeat"),
    )),
    ("/building_map_server", (
        (PUBLISHES, "/map", "rmf_building_map_msgs/msg/BuildingMap"),
        (SERVES, "/get_building_map", "rmf_building_map_msgs/srv/GetBuildingMap"),
    )),
    ("/door_supervisor", (
        (SUBSCRIBES, "/adapter_door_requests", "rmf_door_msgs/msg/DoorRequest"),
        (PUBLISHES, "/door_requests", "rmf_door_msgs/msg/DoorRequest"),
        (PUBLISHES, "/door_supervisor_heartbeat", "rmf_door_msgs/msg/SupervisorHeartbeat"),
        (SUBSCRIBES, "/door_states", "rmf_door_msgs/msg/DoorState"),
    )),
    ("/lift_supervisor", (
        (SUBSCRIBES, "/adapter_lift_requests", "rmf_lift_msgs/msg/LiftRequest"),
        (PUBLISHES, "/lift_requests", "rmf_lift_msgs/msg/LiftRequest"),
        (SUBSCRIBES, "/lift_states", "rmf_lift_msgs/msg/LiftState"),
    )),
    ("/rmf_dispatcher_node", (
        (SUBSCRIBES, "/task_api_requests", "rmf_task_msgs/msg/ApiRequest"),
        (PUBLISHES, "/task_api_responses", "rmf_task_msgs/msg/ApiResponse"),
        (PUBLISHES, "/rmf_task/bid_notice", "rmf_task_msgs/msg/BidNotice"),
        (SUBSCRIBES, "/rmf_task/bid_response", "rmf_task_msgs/msg/BidResponse"),
    )),
    ("/fleet_adapter", (
        (SUBSCRIBES, "/door_states", "rmf_door_msgs/msg/DoorState"),
        (PUBLISHES, "/adapter_door_requests", "rmf_door_msgs/msg/DoorRequest"),
        (SUBSCRIBES, "/lift_states", "rmf_lift_msgs/msg/LiftState"),
        (PUBLISHES, "/adapter_lift_requests", "rmf_lift_msgs/msg/LiftRequest"),
        (PUBLISHES, "/fleet_states", "rmf_fleet_msgs/msg/FleetState"),
        (SUBSCRIBES, "/map", "rmf_building_map_msgs/msg/BuildingMap"),
        (PUBLISHES, "/mutex_group_request", "rmf_fleet_msgs/msg/MutexGroupRequest"),
        (SUBSCRIBES, "/mutex_group_request", "rmf_fleet_msgs/msg/MutexGroupRequest"),
        (SUBSCRIBES, "/rmf_task/bid_notice", "rmf_task_msgs/msg/BidNotice"),
        (PUBLISHES, "/rmf_task/bid_response", "rmf_task_msgs/msg/BidResponse"),
        (PUBLISHES, "/rmf_traffic/itinerary_set", "rmf_traffic_msgs/msg/ItinerarySet"),
        (CALLS, "/rmf_traffic/register_participant", "rmf_traffic_msgs/srv/RegisterParticipant"),
    )),
    ("/fleet_manager", tuple(
        row for it in TWO for row in (
            (SUBSCRIBES, f"/{it}/battery_state", BATTERY),
            (CALLS, f"/{it}/navigate_to_pose", "nav2_msgs/action/NavigateToPose"),
            (SUBSCRIBES, f"/{it}/tf", TF),
        )
    )),
)  # fmt: skip


def open_rmf(release: str) -> System:
    graph = started(("nav2",), release=release)
    for robot in TWO:
        graph = with_node(
            graph, f"/{robot}/battery", (PUBLISHES, f"/{robot}/battery_state", BATTERY)
        )
    for node, rows in _RMF:
        graph = with_node(graph, node, *rows)
    return sent(graph)


# Isaac Sim: one process whose OmniGraph nodes are ROS nodes, one an end, named after their place in the
# stage (isaacsim.ros2.bridge); carter_navigation multiple_robot_carter_navigation_hospital.launch.py.
ISAAC: Rows = {
    "ros2_publish_odometry": ((PUBLISHES, "odom", ODOMETRY),),
    "ros2_publish_raw_transform_tree": ((PUBLISHES, "tf", TF),),
    "ros2_publish_transform_tree": ((PUBLISHES, "tf", TF),),
    "ros2_publish_joint_state": ((PUBLISHES, "joint_states", JOINTS),),
    "ros2_subscribe_joint_state": ((SUBSCRIBES, "joint_command", JOINTS),),
    "ros2_subscribe_twist": ((SUBSCRIBES, "cmd_vel", TWIST),),
    "ros2_rtx_lidar_helper": ((PUBLISHES, "front_3d_lidar/lidar_points", POINTS),),
    "ros2_camera_helper": ((PUBLISHES, "front_stereo_camera/left/image_raw", IMAGE),),
    "ros2_camera_info_helper": ((PUBLISHES, "front_stereo_camera/left/camera_info", INFO),),
    "pointcloud_to_laserscan": (
        (SUBSCRIBES, "front_3d_lidar/lidar_points", POINTS), (PUBLISHES, "scan", SCAN), *LISTENS,
    ),
}  # fmt: skip


def isaac(release: str) -> System:
    """All on the simulator's clock; it sends the frames of the description, so nothing else does."""
    graph = of_vendor(ISAAC, release)
    own = [it.name for it in graph.nodes if "/ros2_" not in it.name]
    for node in own:
        graph = with_ends(graph, node, (SUBSCRIBES, "/clock", CLOCK))
    return with_node(graph, "/ros2_publish_clock", (PUBLISHES, "/clock", CLOCK))


VENDORS: Mapping[str, Callable[[str], System]] = {
    "TurtleBot 4": turtlebot4,
    "Husarion": husarion,
    "Clearpath": clearpath,
    "Open-RMF": open_rmf,
    "Isaac Sim": isaac,
}
