# SPDX-License-Identifier: Apache-2.0
"""Seeded faults of names, data and clocks."""

from __future__ import annotations

from fault_changes import (
    CHANGE_STATE,
    LATCHED,
    LOCAL,
    STAMPED,
    VOLATILE,
    Fault,
    added,
    both,
    in_each,
    nav,
    offered,
    on_simulated_time,
    real_among_simulated,
    renamed,
    simulation,
    without_clock,
)
from graph_cases import with_type, without_node
from healthy_systems import CLOCK, JOINTS, MAP, NAVIGATE, SCAN, TRIGGER, with_node

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, Node


def name_rows() -> tuple[Fault, ...]:
    return (
        Fault(
            "the fleet manager sends goals to /robot_2", nav,
            renamed("/robot2/navigate_to_pose", "/robot_2/navigate_to_pose", "/fleet_manager"),
            "MG304", ("/robot_2/navigate_to_pose", "/robot2/bt_navigator serves"),
        ),
        Fault(
            "the fleet manager sends goals without a robot", nav,
            added("/dispatcher", (CALLS, "/navigate_to_pose", NAVIGATE)),
            "MG304", ("/dispatcher", "/robot1/navigate_to_pose"),
        ),
        Fault(
            "a misspelled namespace of a client", nav,
            added("/dispatcher", (CALLS, "/robto1/navigate_to_pose", NAVIGATE)),
            "MG304", ("/robto1/", "/robot1/navigate_to_pose"),
        ),
        Fault(
            "a lifecycle manager in the root", nav,
            added("/lifecycle_manager", (CALLS, "/amcl/change_state", CHANGE_STATE)),
            "MG304", ("/amcl/change_state", "/robot1/amcl/change_state"),
        ),
        Fault(
            "a costmap's relative scan", nav,
            added(LOCAL, (SUBSCRIBES, "/robot1/local_costmap/scan", SCAN)),
            "MG303", ("/robot1/local_costmap/scan", "/robot1/scan", "parameters"),
        ),
        Fault(
            "a costmap's source misspelled", nav,
            added("/robot1/global_costmap/global_costmap", (SUBSCRIBES, "/robot1/sacn", SCAN)),
            "MG303", ("/robot1/sacn", "/robot1/scan"),
        ),
        Fault(
            "amcl has an absolute scan topic", nav, renamed("/robot2/scan", "/scan", "/robot2/amcl"),
            "MG303", ("/scan", "/robot2/scan"),
        ),
        Fault(
            "a driver outside its robot's namespace", nav,
            lambda g: with_node(
                without_node(g, "/robot1/lidar_driver"), "/lidar_driver", (PUBLISHES, "/scan", SCAN)
            ),
            "MG303", ("/robot1/scan", "/scan:=/robot1/scan"),
        ),
        Fault(
            "two action servers of one name", nav, in_each("navigate_to_pose", "/navigate_to_pose"),
            "MG305", ("/robot1/bt_navigator and /robot2/bt_navigator", "/navigate_to_pose"),
        ),
        Fault(
            "two robots serve /reset", nav,
            both(
                added("/robot1/driver", (SERVES, "/reset", TRIGGER)),
                added("/robot2/driver", (SERVES, "/reset", TRIGGER)),
            ),
            "MG305", ("/reset", "relative"),
        ),
        Fault(
            "stamped velocities on one side", nav,
            lambda g: with_type(g, "/robot1/cmd_vel", "/robot1/diff_drive", STAMPED),
            "MG306", ("/robot1/diff_drive", "stamped"),
        ),
        Fault(
            "a best effort scan, a reliable reader", nav,
            offered("/robot1/scan", "BEST_EFFORT", "RELIABLE", "reliability"),
            "MG307", ("/robot1/amcl", "BEST_EFFORT"), ERROR,
        ),
        Fault(
            "a map that is not latched", nav,
            offered("/robot2/map", VOLATILE, LATCHED, "durability"),
            "MG307", ("/robot2/amcl", LATCHED, VOLATILE), ERROR, ("MG309",),
        ),
    )  # fmt: skip


def data_rows() -> tuple[Fault, ...]:
    return (
        Fault(
            "both lidars on /scan", nav, in_each("scan", "/scan"),
            "MG320", ("robot1 and robot2", "/scan"),
        ),
        Fault(
            "the costmaps of both robots read /scan", nav,
            both(*(
                added(f"/{it}/local_costmap/local_costmap", (SUBSCRIBES, "/scan", SCAN))
                for it in ("robot1", "robot2")
            )),
            "MG320", ("robot1 and robot2 all read /scan", "/scan:=/robot1/scan"),
        ),
        Fault(
            "both map servers on /map", nav, in_each("map", "/map"),
            "MG320", ("map_server", "/map"),
        ),
        Fault(
            "both controllers on /odom", nav, in_each("odom", "/odom"),
            "MG320", ("diff_drive", "/odom"),
        ),
        Fault(
            "both descriptions on /robot_description", nav,
            in_each("robot_description", "/robot_description"),
            "MG320", ("robot_state_publisher", "/robot_description"),
        ),
        Fault(
            "robot1's joints on robot2's topic", nav,
            added("/robot1/arm_driver", (PUBLISHES, "/robot2/joint_states", JOINTS)),
            "MG320", ("/robot1/arm_driver", "/robot2/joint_states"),
        ),
        Fault(
            "map_server beside SLAM", nav,
            added("/robot1/slam_toolbox", (PUBLISHES, "/robot1/map", MAP)),
            "MG323", ("/robot1/map_server and /robot1/slam_toolbox", "/robot1/map"),
        ),
        Fault(
            "robot2's amcl reads robot1's scan", nav,
            renamed("/robot2/scan", "/robot1/scan", "/robot2/amcl"),
            "MG321", ("/robot2/amcl", "/robot1/scan of robot1"),
        ),
        Fault(
            "robot1's controller_server reads robot2's odometry", nav,
            renamed("/robot1/odom", "/robot2/odom", "/robot1/controller_server"),
            "MG321", ("/robot1/controller_server", "/robot2/odom"),
        ),
        Fault(
            "one lidar for both amcl", nav,
            both(
                in_each("scan", "/scan"),
                lambda g: without_node(without_node(g, "/robot1/lidar_driver"), "/robot2/lidar_driver"),
                added("/lidar", (PUBLISHES, "/scan", SCAN)),
            ),
            "MG320", ("robot1 and robot2", "/scan"),
        ),
        Fault(
            "joint_state_publisher beside the driver", nav,
            added("/robot1/joint_state_publisher_gui", (PUBLISHES, "/robot1/joint_states", JOINTS)),
            "MG324", ("joint_state_publisher_gui", "stop it"), WARNING,
        ),
        Fault(
            # Live, both send map -> odom as well.
            "amcl started twice", nav,
            lambda g: g._replace(nodes=(*g.nodes, Node("/robot1/amcl", "x"))),
            "MG301", ("/robot1/amcl", "20 s"), ERROR, ("MG408",),
        ),
        Fault(
            "a robot started with another one's namespace", nav,
            lambda g: g._replace(nodes=(*g.nodes, *(it for it in g.nodes if "/robot1/" in it.name))),
            "MG301", ("more than once", "robot1 was started twice"), ERROR, ("MG402",),
        ),
        Fault(
            "a second lifecycle manager", nav,
            added("/robot1/lifecycle_manager_2", (CALLS, "/robot1/amcl/change_state", CHANGE_STATE)),
            "MG302", ("/robot1/lifecycle_manager_2", "/robot1/amcl"),
        ),
        Fault(
            "robot1's manager has robot2's node in node_names", nav,
            added(
                "/robot1/lifecycle_manager_localization",
                (CALLS, "/robot2/amcl/change_state", CHANGE_STATE),
            ),
            "MG302", ("/robot1/lifecycle_manager_localization", "out of node_names"),
        ),
    )  # fmt: skip


def clock_rows() -> tuple[Fault, ...]:
    bridge = (PUBLISHES, "/clock", CLOCK)
    return (
        Fault(
            "robot2 on simulated time without a clock", nav, on_simulated_time("robot2"),
            "MG501", ("robot2", "use_sim_time"),
        ),
        Fault(
            "the clock bridge was forgotten", simulation, lambda g: without_node(g, "/ros_gz_bridge"),
            "MG501", ("/clock", "bridge"),
        ),
        Fault(
            "a clock bridge for each robot", simulation, added("/robot1/clock_bridge", bridge),
            "MG502", ("/robot1/clock_bridge", "/ros_gz_bridge"),
        ),
        Fault(
            "a bag with --clock into a simulation", simulation, added("/rosbag2_player", bridge),
            "MG502", ("/rosbag2_player", "--clock"),
        ),
        Fault(
            "amcl is not on simulated time", simulation, without_clock("/robot2/amcl"),
            "MG503", ("/robot2/amcl", "use_sim_time"),
        ),
        Fault(
            "a real robot beside simulated ones", simulation, real_among_simulated,
            "MG503", ("robot3", "machine's time"), WARNING,
        ),
    )  # fmt: skip
