# SPDX-License-Identifier: Apache-2.0
"""What looks like a fault, and is none: the doctor leaves it alone."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fault_changes import CHANGE_STATE, added, both
from graph_calls import diagnose
from healthy_systems import (
    CLOCK,
    NAVIGATE,
    ODOMETRY,
    POSE,
    SCAN,
    TF,
    TRIGGER,
    TWIST,
    TWO,
    idle_mux,
    nav2_with_tools,
)

from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, Node, System

IMU = "sensor_msgs/msg/Imu"


def two_windows(graph: System) -> System:
    return graph._replace(nodes=(*graph.nodes, *(Node("/robot1/rviz2", it) for it in "ab")))


SILENT: dict[str, Callable[[System], System]] = {
    "the ground truth of a simulator is no tree of the robot": added(
        "/robot1/gz_bridge", (PUBLISHES, "/tf_ground_truth", TF)
    ),
    "the poses of a simulator, sent beside the robot's tree": both(
        added("/robot1/gz_bridge", (PUBLISHES, "/robot1/tf", TF)),
        added("/robot1/gz_bridge", (PUBLISHES, "/robot1/gz/tf", TF)),
    ),
    "hidden topics are nobody's business": both(
        added("/robot1/lidar_driver", (PUBLISHES, "/_raw/scan", SCAN)),
        added("/robot2/lidar_driver", (PUBLISHES, "/_raw/scan", SCAN)),
    ),
    "a service that only the other robot has": both(
        added("/robot2/arm", (SERVES, "/robot2/handover", TRIGGER)),
        added("/robot1/arm", (CALLS, "/robot2/handover", TRIGGER)),
    ),
    "rqt listens to a clock that is not there": added(
        "/rqt_gui_py_node_1", (SUBSCRIBES, "/clock", CLOCK)
    ),
    "a joystick node listens to it too": added("/joy_node", (SUBSCRIBES, "/clock", CLOCK)),
    "two windows of RViz": two_windows,
    "the RViz panel of a manager that is not used": added(
        "/robot1/rviz2", (CALLS, "/robot1/lifecycle_manager_slam/manage_nodes", TRIGGER)
    ),
    "a person changes a state": added(
        "/_ros2cli_12", (CALLS, "/robot1/amcl/change_state", CHANGE_STATE)
    ),
    "both robots report to the fleet": both(
        added("/robot1/agent", (PUBLISHES, "/fleet_states", "rmf_fleet_msgs/msg/FleetState")),
        added("/robot2/agent", (PUBLISHES, "/fleet_states", "rmf_fleet_msgs/msg/FleetState")),
    ),
    "one stop button for all": both(
        added("/robot1/safety", (SUBSCRIBES, "/stop", "std_msgs/msg/Bool")),
        added("/robot2/safety", (SUBSCRIBES, "/stop", "std_msgs/msg/Bool")),
        added("/button", (PUBLISHES, "/stop", "std_msgs/msg/Bool")),
    ),
    "a second camera of a numbered pair is off": both(
        added("/robot1/fusion", (SUBSCRIBES, "/robot1/scan_2", SCAN)),
        added("/robot1/laser_1", (PUBLISHES, "/robot1/scan_1", SCAN)),
    ),
    "a camera for all robots": both(
        added("/robot1/tracker", (SUBSCRIBES, "/ceiling/image", "sensor_msgs/msg/Image")),
        added("/robot2/tracker", (SUBSCRIBES, "/ceiling/image", "sensor_msgs/msg/Image")),
    ),
    "battery of two drivers": both(
        added("/robot1/a", (PUBLISHES, "/robot1/joint_states", "sensor_msgs/msg/JointState")),
        added("/robot1/b", (PUBLISHES, "/robot1/joint_states", "sensor_msgs/msg/JointState")),
    ),
    "a recorded run under other names": added(
        "/rosbag2_player", (PUBLISHES, "/recorded/scan", SCAN), (PUBLISHES, "/recorded/tf", TF)
    ),
    "measured velocities are no commands": both(
        added("/robot1/vel_a", (PUBLISHES, "/robot1/twist", TWIST)),
        added("/robot1/vel_b", (PUBLISHES, "/robot1/twist", TWIST)),
        added("/robot1/log", (SUBSCRIBES, "/robot1/twist", TWIST)),
    ),
    "a bridge of all robots to another network": added(
        "/network",
        *((role, f"/{robot}/imu", IMU) for robot in TWO for role in (SUBSCRIBES, PUBLISHES)),
    ),
    "a node that makes poses of a pose which does not come": added(
        "/robot1/collector", (SUBSCRIBES, "/robot1/pose", POSE), (PUBLISHES, "/robot1/poses", POSE)
    ),
    "a second lidar that is not there": both(
        added("/robot1/lidar", (PUBLISHES, "/robot1/lidar_r", SCAN)),
        added("/robot1/merger", *((SUBSCRIBES, f"/robot1/lidar_{it}", SCAN) for it in "lr")),
    ),
    "goals for a robot that has just started": both(
        added("/carrier/drive"),
        added("/fleet_manager", (CALLS, "/carrier/navigate_to_pose", NAVIGATE)),
    ),
    "a side whose version of the message is not known": lambda graph: graph._replace(
        ends=tuple(
            it._replace(type_hash="RIHS01_a") if it.role == PUBLISHES else it for it in graph.ends
        )
    ),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", SILENT)
def test_it_is_no_fault(name: str) -> None:
    assert [str(it) for it in diagnose(SILENT[name](nav2_with_tools())).findings] == []


@pytest.mark.more
def test_an_idle_input_of_a_mux_is_not_one_that_it_has() -> None:
    inputs = [(SUBSCRIBES, f"/robot1/cmd_vel_{it}", TWIST) for it in ("tab", "tag")]
    graph = added("/robot1/twist_mux", *inputs)(idle_mux())
    graph = added("/robot1/tag", (PUBLISHES, "/robot1/cmd_vel_tag", TWIST))(graph)
    assert diagnose(graph).findings == ()


def test_a_bag_with_odometry_is_a_bag() -> None:
    graph = added("/rosbag2_player", (PUBLISHES, "/robot1/odom", ODOMETRY))(nav2_with_tools())
    assert {it.code for it in diagnose(graph).findings} == {"MG313"}
