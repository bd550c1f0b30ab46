# SPDX-License-Identifier: Apache-2.0
"""Seeded faults of what is waited for in vain, of senders side by side, and of robots that differ.

Most are of one robot without a name: what people ask about most.
"""

from __future__ import annotations

from fault_changes import (
    LATCHED,
    STAMPED,
    VOLATILE,
    Change,
    Fault,
    added,
    both,
    nav,
    offered,
    renamed,
    shared_tf,
    simulation,
)
from graph_cases import reframed, with_type, without_node
from healthy_systems import (
    CLOCK,
    NAVIGATE,
    ODOMETRY,
    SCAN,
    TRIGGER,
    TWIST,
    simulated,
    single,
    with_node,
)

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, Heard, System

IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
IMU, FIX, CLOUD = (f"sensor_msgs/msg/{it}" for it in ("Imu", "NavSatFix", "PointCloud2"))
DISTANCE, FOLLOW = "ranger_msgs/srv/GetDistance", "control_msgs/action/FollowJointTrajectory"
TWO = ("robot1", "robot2")
AT = (0.1, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0)


def ekf(space: str, odometry: str, imu: str) -> Change:
    return added(
        f"{space}/ekf_filter_node",
        (SUBSCRIBES, f"{space}/{odometry}", ODOMETRY),
        (SUBSCRIBES, f"{space}/{imu}", IMU),
        (PUBLISHES, f"{space}/odometry/filtered", ODOMETRY),
    )


def without(*nodes: str) -> Change:
    def change(graph: System) -> System:
        for node in nodes:
            graph = without_node(graph, node)
        return graph

    return change


def without_edge(child: str, topic: str) -> Change:
    return reframed(lambda it: None if (it.child, it.topic) == (child, topic) else it)


def at(child: str, *numbers: float) -> Change:
    """Return the transform as it was received."""
    return reframed(lambda it: it._replace(transform=numbers) if it.child == child else it)


def stamped(topic: str, age: float) -> Change:
    """Return the change by which a message comes so many seconds after its stamp."""
    frame = {"scan": "lidar_link", "odom": "odom", "imu": "imu_link"}[topic.rpartition("/")[2]]
    return lambda graph: graph._replace(heard=(*graph.heard, Heard(topic, frame, age)))


def heard_all_but(*silent: str) -> Change:
    """One message came on each topic of a sensor, but not on these."""
    names = (f"/{robot}/{it}" for robot in TWO for it in ("scan", "odom", "imu"))
    frames = {"scan": "lidar_link", "odom": "odom", "imu": "imu_link"}
    came = tuple(Heard(it, frames[it.rpartition("/")[2]]) for it in names if it not in silent)
    return lambda graph: graph._replace(heard=(*graph.heard, *came))


def _compressed(graph: System) -> System:
    graph = renamed("/front/image_raw", "/front/image_raw/compressed", "/camera_driver")(graph)
    return with_type(graph, "/front/image_raw/compressed", "/camera_driver", COMPRESSED)


def open_rows() -> tuple[Fault, ...]:
    """Readers and clients whose robot has what they wait for under another name."""
    return (
        Fault(
            "the lidar is remapped, amcl is not", single,
            renamed("/scan", "/narrow_scan", "/lidar_driver"),
            "MG303", ("/lidar_driver publishes /narrow_scan", "/scan:=/narrow_scan"), ERROR,
        ),
        Fault(
            "the EKF reads imu/data, the driver sends imu", single, ekf("", "odom", "imu/data"),
            "MG303", ("/imu/data", "/imu_driver publishes /imu"), ERROR,
        ),
        Fault(
            "the EKF reads wheel/odometry, the drive sends odom", single,
            ekf("", "wheel/odometry", "imu"),
            "MG303", ("/wheel/odometry", "/diff_drive publishes /odom"), ERROR,
        ),
        Fault(
            "the driver is in another namespace than the commands", single,
            renamed("/cmd_vel", "/robo/cmd_vel", "/diff_drive"),
            "MG303", ("/robo/cmd_vel", "/cmd_vel"), ERROR,
        ),
        Fault(
            "twist_mux sends cmd_vel_out of its default", single,
            both(
                renamed("/cmd_vel", "/nav_vel", "/collision_monitor"),
                renamed("/cmd_vel", "/nav_vel", "/docking_server"),
                added("/twist_mux", (SUBSCRIBES, "/nav_vel", TWIST)),
                added("/twist_mux", (PUBLISHES, "/cmd_vel_out", TWIST)),
            ),
            "MG308", ("/twist_mux", "/cmd_vel_out:=/cmd_vel"),
        ),
        Fault(
            "the drive reads stamped velocities on another topic", single,
            both(
                renamed("/cmd_vel", "/drive/cmd_vel", "/diff_drive"),
                lambda it: with_type(it, "/drive/cmd_vel", "/diff_drive", STAMPED),
            ),
            "MG303", ("/drive/cmd_vel", "/cmd_vel as Twist", "one type"), WARNING,
        ),
        Fault(
            "a raw image is read, a compressed one is sent", single,
            both(_compressed, added("/detector", (SUBSCRIBES, "/front/image_raw", IMAGE))),
            "MG303", ("/front/image_raw", "/front/image_raw/compressed as CompressedImage"), WARNING,
            ("MG316",),
        ),
        Fault(
            "the joints are sent under another name", single,
            renamed("/joint_states", "/joints", "/joint_states"),
            "MG303", ("/robot_state_publisher", "publishes /joints"), ERROR,
        ),
        Fault(
            "the map is in another namespace", single,
            renamed("/map", "/mapping/map", "/map_server"),
            "MG303", ("/amcl", "/map_server publishes /mapping/map"), WARNING,
        ),
        Fault(
            "a description under another name", single,
            both(
                added("/controller_manager", (SUBSCRIBES, "/robot_description", "std_msgs/msg/String")),
                renamed("/robot_description", "/description", "/robot_state_publisher"),
            ),
            "MG303", ("/controller_manager", "publishes /description"), WARNING,
        ),
        Fault(
            "a costmap's points are not those of the camera", single,
            both(
                added("/depth_camera", (PUBLISHES, "/camera/depth/points", CLOUD)),
                added("/local_costmap/local_costmap", (SUBSCRIBES, "/points", CLOUD)),
            ),
            "MG303", ("/points", "/camera/depth/points"), ERROR,
        ),
        Fault(
            "navsat_transform reads gps/fix, the driver sends fix", nav,
            both(
                added("/robot1/navsat_transform", (SUBSCRIBES, "/robot1/gps/fix", FIX)),
                added("/robot1/gps_driver", (PUBLISHES, "/robot1/fix", FIX)),
            ),
            "MG303", ("/robot1/gps/fix", "/robot1/gps_driver publishes /robot1/fix"), ERROR,
        ),
        Fault(
            "a service below its node's name", single,
            both(
                added("/ranger", (SERVES, "/ranger/get_distance", DISTANCE)),
                added("/explorer", (CALLS, "/get_distance", DISTANCE)),
            ),
            "MG304", ("/get_distance", "/ranger serves /ranger/get_distance"), WARNING,
        ),
        Fault(
            "MoveIt calls a controller of another name", single,
            both(
                added("/arm_controller", (SERVES, "/arm_controller/follow_joint_trajectory", FOLLOW)),
                added("/move_group", (CALLS, "/arm/follow_joint_trajectory", FOLLOW)),
            ),
            "MG304", ("/arm/follow_joint_trajectory", "/arm_controller serves"), ERROR,
        ),
        Fault(
            "a client has a robot's name, the robot has none", single,
            added("/app", (CALLS, "/robot1/navigate_to_pose", NAVIGATE)),
            "MG304", ("/robot1/navigate_to_pose", "/bt_navigator serves /navigate_to_pose"),
        ),
        Fault(
            "a lifecycle manager lists what nothing starts", single, without("/velocity_smoother"),
            "MG304", ("/lifecycle_manager_navigation", "/velocity_smoother is in its list"), ERROR,
            ("MG303", "MG316"),
        ),
    )  # fmt: skip


def sender_rows() -> tuple[Fault, ...]:
    """Two senders of one sensor, and data that no reader gets or tf does not take."""
    return (
        Fault(
            "two lidars on one topic", single, added("/rear_lidar", (PUBLISHES, "/scan", SCAN)),
            "MG325", ("/lidar_driver and /rear_lidar", "/scan"), WARNING,
        ),
        Fault(
            "two cameras on one topic", single,
            added("/usb_cam", (PUBLISHES, "/front/image_raw", IMAGE)),
            "MG325", ("/camera_driver and /usb_cam", "/front/image_raw"), WARNING,
        ),
        Fault(
            "two IMUs on one topic", nav, added("/robot1/rear_imu", (PUBLISHES, "/robot1/imu", IMU)),
            "MG325", ("/robot1/imu_driver and /robot1/rear_imu", "/robot1/imu"), WARNING,
        ),
        Fault(
            "a map that is read without transient_local", nav,
            _volatile_map,
            "MG309", ("/robot1/amcl", "/robot1/map_server sends it once"), WARNING,
        ),
        Fault(
            "a lidar that sends nothing", nav, heard_all_but("/robot2/scan"),
            "MG326", ("/robot2/lidar_driver", "/robot2/scan", "/robot1/scan"), ERROR,
        ),
        Fault(
            "a lidar's clock is 12 s behind", nav, stamped("/robot1/scan", 12.0),
            "MG417", ("/robot1/lidar_driver", "/robot1/scan", "12 s old"),
        ),
        Fault(
            "a machine's clock is a minute ahead", nav, stamped("/robot2/odom", -60.0),
            "MG417", ("/robot2/diff_drive", "60 s in the future"),
        ),
        Fault(
            "stamps of simulated time on a real robot", nav, stamped("/robot1/imu", 1.7e9),
            "MG417", ("/robot1/imu_driver", "another clock"),
        ),
        Fault(
            "stamps of this second of the machine's time in a simulation", simulation,
            both(
                stamped("/robot1/scan", 0.0), stamped("/robot2/scan", 1.7e9),
                offered("/robot1/scan", VOLATILE, VOLATILE, "durability"),
            ),
            "MG417", ("/robot1/lidar_driver", "not of /clock"),
        ),
        Fault(
            "stamps of the machine's time in a simulation", simulation, stamped("/robot1/scan", 2.0),
            "MG417", ("/robot1/lidar_driver", "not of /clock"),
        ),
        Fault(
            "stamps of zero", nav, stamped("/robot1/scan", float("inf")),
            "MG417", ("/robot1/lidar_driver", "0:"), WARNING,
        ),
        Fault(
            "a scan without a frame", nav,
            lambda it: it._replace(heard=(Heard("/robot1/scan", ""),)),
            "MG412", ("/robot1/lidar_driver", "/robot1/scan is empty"),
        ),
        Fault(
            "a quaternion of zeros", single, at("lidar_link", 0.1, 0, 0.2, 0, 0, 0, 0),
            "MG416", ("base_link -> lidar_link", "zeros", "/robot_state_publisher"),
        ),
        Fault(
            "odometry that is not a number", nav,
            at("base_footprint", float("inf"), 0, 0, 0, 0, 0, 1),
            "MG416", ("odom -> base_footprint", "NaN", "/robot1/diff_drive"),
        ),
    )  # fmt: skip


def _volatile_map(graph: System) -> System:
    return offered("/robot1/map", LATCHED, VOLATILE, "durability")(graph)


def place_rows() -> tuple[Fault, ...]:
    """Return the faults in which the map and the robot are not joined."""
    scan = renamed("/robot1/scan", "/robot1/elsewhere/scan_raw", "/robot1/lidar_driver")
    return (
        Fault(
            "amcl waits for a start pose", nav, without_edge("odom", "/robot2/tf"),
            "MG415", ("/robot2/amcl", "no map -> odom", "initial pose", "/robot2/initialpose"),
        ),
        Fault(
            "amcl waits for a start pose, one robot without a name", single,
            without_edge("odom", "/tf"),
            "MG415", ("/amcl", "no map -> odom", "initial pose"),
        ),
        Fault(
            "amcl waits for a start pose on a shared tf", shared_tf,
            without_edge("odom/robot1", "/tf"),
            "MG415", ("/robot1/amcl", "no map -> odom/robot1"),
        ),
        Fault(
            "amcl has no scan", nav, both(scan, without_edge("odom", "/robot1/tf")),
            "MG303", ("/robot1/amcl", "subscribes to /robot1/scan"), ERROR, ("MG415",),
        ),
        Fault(
            "amcl's odom_frame_id is misspelled", single,
            reframed(lambda it: it._replace(child="odom_error") if it.child == "odom" else it),
            "MG415", ("/amcl", "map -> odom_error", "odom_frame_id: odom"),
        ),
    )  # fmt: skip


def three() -> System:
    """Three robots, each with a battery's node that no node reads yet."""
    graph = simulated("robot1", "robot2", "robot3")
    for robot in ("robot1", "robot2", "robot3"):
        row = (PUBLISHES, f"/{robot}/battery_state", "sensor_msgs/msg/BatteryState")
        graph = with_node(graph, f"/{robot}/battery", row, (SUBSCRIBES, "/clock", CLOCK))
    return graph


def like_rows() -> tuple[Fault, ...]:
    """Return the faults in which a robot is not as the others are."""

    def not_of_robot2(graph: System) -> System:
        own = ("odom", "base_footprint")
        gone = without("/robot2/robot_state_publisher")(graph)
        return reframed(
            lambda it: None if it.topic.startswith("/robot2/") and it.child not in own else it
        )(gone)

    def without_end(node: str, name: str) -> Change:
        return lambda it: it._replace(
            ends=tuple(e for e in it.ends if (e.node, e.name) != (node, name))
        )

    return (
        Fault(
            "robot2's robot_state_publisher died", nav, not_of_robot2,
            "MG327", ("robot2 has no robot_state_publisher", "/robot1/robot_state_publisher"), WARNING,
            ("MG316",),
        ),
        Fault(
            "robot2 has no lifecycle manager", nav, without("/robot2/lifecycle_manager_navigation"),
            "MG327", ("robot2 has no lifecycle_manager_navigation",), WARNING,
        ),
        Fault(
            "robot2's drive takes no commands", nav,
            without_end("/robot2/diff_drive", "/robot2/cmd_vel"),
            "MG322", ("/robot2/diff_drive", "lacks /robot2/cmd_vel"), ERROR,
        ),
        Fault(
            "the battery of one of three robots is off", three, without("/robot2/battery"),
            "MG327", ("robot2 has no battery", "/robot1/battery"), WARNING,
        ),
        Fault(
            "robot2's own server is there, and robot1's is called", nav,
            both(
                *(added(f"/{it}/dock", (SERVES, f"/{it}/dock_now", TRIGGER)) for it in TWO),
                *(added(f"/{it}/app", (CALLS, "/robot1/dock_now", TRIGGER)) for it in TWO),
            ),
            "MG311", ("/robot2/app", "/robot1/dock_now"),
        ),
    )  # fmt: skip
