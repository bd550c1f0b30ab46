# SPDX-License-Identifier: Apache-2.0
"""Healthy systems beside seeded faults: what looks like one and is none."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from fault_changes import LATCHED, offered
from graph_cases import reframed, sent, without_node
from healthy_systems import (
    JOINTS,
    MAP,
    NAVIGATE,
    ODOMETRY,
    SCAN,
    TF,
    TWIST,
    TWO,
    nav2_with_tools,
    simulated,
    single,
    started,
    with_ends,
    with_node,
)
from open_faults import AT, COMPRESSED, IMAGE, at, ekf, heard_all_but, three

from multibot_rewrite.system.records import CALLS, PUBLISHES, SUBSCRIBES, Edge, System

COMMANDS, TEXT = "std_msgs/msg/Float64", "std_msgs/msg/String"


def helper_nodes() -> System:
    """bt_navigator's clients, which take the clock from nobody, and tf2's listeners.
    nav2_util simple_action_server.hpp, tf2_ros transform_listener.cpp."""
    graph = simulated(*TWO)
    for robot in TWO:
        for action in ("navigate_to_pose", "navigate_through_poses"):
            graph = with_node(graph, f"/{robot}/bt_navigator_{action}_rclcpp_node")
        ends = ((SUBSCRIBES, f"/{robot}/{it}", TF) for it in ("tf", "tf_static"))
        graph = with_node(graph, f"/{robot}/transform_listener_impl_5581aa10", *ends)
    return graph


def bridge_both_ways() -> System:
    """Return a ros_gz_bridge whose rows have ``@``: it sends and reads each topic."""
    graph = simulated(*TWO)
    rows = (("cmd_vel", TWIST), ("odom", ODOMETRY), ("scan", SCAN), ("joint_states", JOINTS))
    for robot in TWO:
        for name, type_ in rows:
            both_ways = ((role, f"/{robot}/{name}", type_) for role in (PUBLISHES, SUBSCRIBES))
            graph = with_ends(graph, "/ros_gz_bridge", *both_ways)
        for node in ("diff_drive", "lidar_driver", "joint_states"):
            graph = without_node(graph, f"/{robot}/{node}")
        graph = with_ends(graph, "/ros_gz_bridge", (PUBLISHES, f"/{robot}/tf", TF))
    return sent(graph)


def republished_tf() -> System:
    """TurtleBot 4: the Create 3 sends its tf elsewhere, and a node sends it again
    (irobot_create republisher)."""
    graph = nav2_with_tools()
    for robot in TWO:
        hidden = f"/{robot}/_do_not_use/tf"
        graph = with_ends(graph, f"/{robot}/diff_drive", (PUBLISHES, hidden, TF))
        ends = ((SUBSCRIBES, hidden, TF), (PUBLISHES, f"/{robot}/tf", TF))
        graph = with_node(graph, f"/{robot}/create3_repub", *ends)
        graph = graph._replace(
            edges=(*graph.edges, Edge("base_footprint", "odom", hidden, False, ()))
        )
    return sent(graph)


def slashes() -> System:
    """tf2 takes the slash away (buffer_core.cpp)."""
    return reframed(lambda it: it._replace(parent=f"/{it.parent}") if it.parent == "odom" else it)(
        nav2_with_tools()
    )


def parts() -> System:
    """Wheels, arms and a caster with namespaces and frames of their own: one robot."""
    graph = single()
    for part in ("fl_wheel", "fr_wheel", "arm_l", "arm_r", "caster"):
        own = (PUBLISHES, f"/{part}/state", JOINTS), (SUBSCRIBES, f"/{part}/command", COMMANDS)
        graph = with_node(graph, f"/{part}/driver", *own)
        frames = ((f"{part}/base_link", "base_link"), (f"{part}/tip", f"{part}/base_link"))
        edges = (Edge(child, parent, "/tf", False, ()) for child, parent in frames)
        graph = graph._replace(edges=(*graph.edges, *edges))
    return sent(graph)


def arms_on_a_base() -> System:
    """Two arms with joint states and descriptions of their own, mounted on a robot without a name."""
    graph = single()
    for arm in ("arm_l", "arm_r"):
        joints = f"/{arm}/joint_states"
        graph = with_node(graph, f"/{arm}/driver", (PUBLISHES, joints, JOINTS))
        ends = (SUBSCRIBES, joints, JOINTS), (PUBLISHES, f"/{arm}/robot_description", TEXT)
        graph = with_node(graph, f"/{arm}/robot_state_publisher", *ends)
        mount = Edge(f"{arm}/base_link", "base_link", "/tf", False, ())
        graph = graph._replace(edges=(*graph.edges, mount))
    return sent(graph)


def explorers() -> System:
    """m-explore-ros2: explore reads the map of its robot, map_merge those of all."""
    graph = started(("nav2_slam",))
    for robot in TWO:
        ends = (SUBSCRIBES, f"/{robot}/map", MAP), (CALLS, f"/{robot}/navigate_to_pose", NAVIGATE)
        graph = with_node(graph, f"/{robot}/explore", *ends)
    maps = ((SUBSCRIBES, f"/{robot}/map", MAP) for robot in TWO)
    return with_node(graph, "/map_merge", *maps, (PUBLISHES, "/map", MAP))


def cameras() -> System:
    """Raw and compressed images of two cameras, of which one is read."""
    graph = with_ends(
        single(), "/camera_driver", (PUBLISHES, "/front/image_raw/compressed", COMPRESSED)
    )
    graph = with_node(graph, "/rear_camera", (PUBLISHES, "/rear/image_raw", IMAGE))
    return with_node(graph, "/detector", (SUBSCRIBES, "/front/image_raw", IMAGE))


def isaac() -> System:
    """Isaac Sim waits for joint commands while nobody moves the arm (its ROS 2 bridge's names)."""
    return with_node(single(), "/isaac", (SUBSCRIBES, "/joint_command", JOINTS))


def sent_twice_alike() -> System:
    """Two publishers of one static transform: no harm, so it is a note."""
    more = with_ends(single(), "/static_transform_publisher_x", (PUBLISHES, "/tf_static", TF))
    more = reframed(lambda it: it._replace(several=it.child == "lidar_link"))(more)
    return at("lidar_link", *AT)(more)


TWINS: Mapping[str, Callable[[], System]] = {
    "helper nodes in simulation": helper_nodes,
    "a bridge in both directions": bridge_both_ways,
    "tf that is sent again": republished_tf,
    "slashes in front of frames": slashes,
    "parts of a robot": parts,
    "arms on a base": arms_on_a_base,
    "explorers and a merged map": explorers,
    "two cameras": cameras,
    "joint commands of a simulator": isaac,
    "an EKF with all inputs": lambda: ekf("", "odom", "imu")(single()),
    "a latched map": lambda: offered("/robot1/map", LATCHED, LATCHED, "durability")(
        nav2_with_tools()
    ),
    "every sensor is heard": lambda: heard_all_but()(nav2_with_tools()),
    "a transform as it has to be": lambda: at("lidar_link", *AT)(nav2_with_tools()),
    "three robots with batteries": three,
    "one robot has an arm": lambda: with_node(
        nav2_with_tools(), "/robot1/arm_driver", (PUBLISHES, "/robot1/arm/state", JOINTS)
    ),
}
