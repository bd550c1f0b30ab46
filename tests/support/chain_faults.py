# SPDX-License-Identifier: Apache-2.0
"""Seeded faults between a sender and a robot: relays, limits left out, names twice, two senders."""

from __future__ import annotations

from fault_changes import DESCRIPTION, Change, Fault, added, both, nav, renamed
from healthy_systems import (
    JOINTS,
    NAVIGATE,
    ODOMETRY,
    SCAN,
    START,
    TWIST,
    TWO,
    beside_the_root,
    idle_mux,
)

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.system.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES, Node, System

JOY, BOOL = "sensor_msgs/msg/Joy", "std_msgs/msg/Bool"
LISTED = "/controller_manager/list_controllers"
CONTROLLERS = "controller_manager_msgs/srv/ListControllers"


def chain_rows() -> tuple[Fault, ...]:
    return (
        Fault(
            "one joystick for both teleops", nav,
            both(
                added("/joy_node", (PUBLISHES, "/joy", JOY)),
                *(added(f"/{it}/teleop_node", (SUBSCRIBES, "/joy", JOY)) for it in TWO),
            ),
            "MG310", ("robot1 and robot2", "/joy", "enable_button"), WARNING,
        ),
        Fault(
            "a relay of robot1's commands to robot2", nav,
            added(
                "/relay", (SUBSCRIBES, "/robot1/cmd_vel", TWIST), (PUBLISHES, "/robot2/cmd_vel", TWIST)
            ),
            "MG314", ("/relay", "/robot1/cmd_vel of robot1", "/robot2/cmd_vel"), ERROR, ("MG312",),
        ),
        Fault(
            "a relay of robot1's scan to robot2", nav,
            added("/relay", (SUBSCRIBES, "/robot1/scan", SCAN), (PUBLISHES, "/robot2/scan", SCAN)),
            "MG314", ("/relay", "/robot2/scan of robot2"),
        ),
        Fault(
            "rqt_robot_steering against Nav2", nav,
            added("/rqt_gui_py_node_99", (PUBLISHES, "/robot1/cmd_vel", TWIST)),
            "MG312", ("/rqt_gui_py_node_99", "twist_mux"), ERROR,
        ),
        Fault(
            "robot1's stop button stops robot2", nav,
            both(
                added("/robot1/button", (PUBLISHES, "/robot2/stop", BOOL)),
                *(added(f"/{it}/base", (SUBSCRIBES, f"/{it}/stop", BOOL)) for it in TWO),
            ),
            "MG311", ("/robot1/button", "a name of robot2"), ERROR, ("MG316",),
        ),
        Fault(
            "the controller sends past collision_monitor", nav,
            renamed("/robot2/cmd_vel_nav", "/robot2/cmd_vel", "/robot2/controller_server"),
            "MG315", ("/robot2/controller_server", "collision_monitor", "cmd_vel:=cmd_vel_nav"),
        ),
        Fault(
            "the driver reads an input of twist_mux", idle_mux,
            renamed("/robot2/cmd_vel_out", "/robot2/joy_vel", "/robot2/diff_drive"),
            "MG315", ("/robot2/diff_drive", "/robot2/twist_mux", "joy_vel:=cmd_vel_out"), ERROR,
            ("MG312",),
        ),
        Fault(
            "nothing passes on what twist_mux sends", idle_mux,
            renamed("/robot2/cmd_vel_out", "/robot2/diff_drive/cmd_vel", "/robot2/diff_drive"),
            "MG308", ("/robot2/twist_mux", "/robot2/cmd_vel_out:=/robot2/diff_drive/cmd_vel"),
        ),
        Fault(
            "a recovery alone reaches the drive", nav,
            both(
                renamed("/robot2/cmd_vel", "/robot2/drive/cmd_vel", "/robot2/diff_drive"),
                added("/robot2/recovery", (PUBLISHES, "/robot2/drive/cmd_vel", TWIST)),
            ),
            "MG308", ("/robot2/collision_monitor", "obeys /robot2/recovery there"),
        ),
        Fault(
            "the drive has a topic of its own", nav,
            renamed("/robot2/cmd_vel", "/robot2/diff_drive/cmd_vel", "/robot2/diff_drive"),
            "MG303", ("/robot2/collision_monitor", "/robot2/diff_drive/cmd_vel"),
        ),
        Fault(
            "a start pose to initial_pose", nav,
            added("/starter", (PUBLISHES, "/robot2/initial_pose", START)),
            "MG308", ("/starter", "/robot2/initialpose"),
        ),
        Fault(
            "goals for a robot that is not there", nav,
            added("/fleet_manager", (CALLS, "/robot3/navigate_to_pose", NAVIGATE)),
            "MG304", ("no node is in /robot3", "started"), WARNING,
        ),
        Fault(
            "commands for a robot that is not there", nav,
            added("/fleet_manager", (PUBLISHES, "/robot3/cmd_vel", TWIST)),
            "MG308", ("no node is in /robot3", "started"), WARNING,
        ),
        Fault(
            "a spawner without a manager", nav,
            both(
                added("/robot2/spawner_drive", (CALLS, LISTED, CONTROLLERS)),
                *(
                    added(
                        f"/{it}/controller_manager",
                        (SERVES, f"/{it}{LISTED}", CONTROLLERS),
                    )
                    for it in TWO
                ),
            ),
            "MG304", ("/robot2/spawner_drive", "/robot2/controller_manager serves"),
        ),
        Fault(
            "the namespace twice: /robot2/robot2/scan", nav,
            renamed("/robot2/scan", "/robot2/robot2/scan", "/robot2/lidar_driver"),
            "MG303", ("/robot2/lidar_driver", "twice"),
        ),
        Fault(
            "the namespace twice in a costmap", nav,
            added(
                "/robot2/local_costmap/local_costmap",
                (SUBSCRIBES, "/robot2/local_costmap/robot2/scan", SCAN),
            ),
            "MG303", ("write /robot2/scan in its parameters",),
        ),
        Fault(
            "joint states below the name of their broadcaster", nav,
            lambda g: _sent_by(g, "/robot2/joint_states", "/robot2/broadcaster", JOINTS),
            "MG303", ("/robot2/robot_state_publisher", "/robot2/broadcaster/joint_states"),
        ),
        Fault(
            "a controller that reads velocities below its own name", nav,
            _read_below("/robot1/cmd_vel", "/robot1/diff_drive"),
            "MG303",
            ("subscribes to /robot1/diff_drive/cmd_vel", "/diff_drive/cmd_vel:=/robot1/cmd_vel"),
        ),
        Fault(
            "two containers of one name", nav,
            lambda g: g._replace(nodes=(*g.nodes, *(Node("/nav2_container", it) for it in "ab"))),
            "MG301", ("/nav2_container", "20 s"),
        ),
        Fault(
            "two versions of a message", nav, _two_versions,
            "MG306", ("/robot2/amcl", "another version of sensor_msgs/msg/LaserScan"),
        ),
        Fault(
            "two filters on odometry/filtered", nav,
            both(
                *(
                    added(f"/robot1/{it}", (PUBLISHES, "/robot1/odometry/filtered", ODOMETRY))
                    for it in ("ekf_local", "ekf_global")
                )
            ),
            "MG325", ("/robot1/ekf_global and /robot1/ekf_local", "/robot1/odometry/filtered"),
        ),
        Fault(
            "two descriptions of a robot", nav,
            added("/robot1/arm_description", (PUBLISHES, "/robot1/robot_description", DESCRIPTION)),
            "MG325", ("/robot1/arm_description", "/robot1/robot_description"), WARNING,
        ),
        Fault(
            "a robot without a namespace and robot2 on /tf", beside_the_root,
            both(renamed("/robot2/tf", "/tf"), renamed("/robot2/tf_static", "/tf_static")),
            "MG402", ("robot2 and the robot without a namespace", "/tf:=tf"),
        ),
        Fault(
            "robot2's driver obeys the robot without a namespace", beside_the_root,
            renamed("/robot2/cmd_vel", "/cmd_vel", "/robot2/diff_drive"),
            "MG310", ("robot2 and the robot without a namespace", "/cmd_vel"),
        ),
        Fault(
            "robot2's amcl reads the scan of the robot without a namespace", beside_the_root,
            renamed("/robot2/scan", "/scan", "/robot2/amcl"),
            "MG320", ("/robot2/amcl", "/scan"),
        ),
    )  # fmt: skip


def _sent_by(graph: System, name: str, node: str, type_: str) -> System:
    """Nobody publishes the topic but this node, and that below its own name."""
    kept = (it for it in graph.ends if not (it.name == name and it.role == PUBLISHES))
    own = f"{node}/{name.rpartition('/')[2]}"
    return added(node, (PUBLISHES, own, type_))(graph._replace(ends=tuple(kept)))


def _read_below(name: str, node: str) -> Change:
    """Return the change by which this node reads the topic below its own name, and nobody else."""
    return renamed(name, f"{node}/{name.rpartition('/')[2]}", node)


def _two_versions(graph: System) -> System:
    """Return a system in which the lidar's computer has other messages than its robot's."""
    hashes = {PUBLISHES: "ab", SUBSCRIBES: "cd"}
    ends = (
        it._replace(type_hash=f"RIHS01_{hashes[it.role] * 32}") if it.name == "/robot2/scan" else it
        for it in graph.ends
    )
    return graph._replace(ends=tuple(ends))
