"""Faults put into systems in which nothing was wrong, and what has to be said of each.

They come from thinking about what hurts a fleet, not from the rules. A row has the system, what is done
to it, the code that has to be found, and words that the finding must have: who did it, and the remedy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from graph_cases import global_tf, moved, qos, reframed, with_qos, with_type, without_node
from healthy_systems import (
    CLOCK,
    JOINTS,
    MAP,
    NAVIGATE,
    POSE,
    SCAN,
    TF,
    TRIGGER,
    TWIST,
    arms,
    nav2_with_tools,
    simulated,
    single,
    with_ends,
    with_node,
)

from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.graph.snapshot import GraphFrame, GraphNode, Snapshot
from multibot_rewrite.remap.records import CALLS, PUBLISHES, SERVES, SUBSCRIBES

CHANGE_STATE = "lifecycle_msgs/srv/ChangeState"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
STAMPED = "geometry_msgs/msg/TwistStamped"
DESCRIPTION = "std_msgs/msg/String"
LEFT, RIGHT = (f"/{it}_arm/arm_controller/joint_trajectory" for it in ("left", "right"))
LOCAL = "/robot1/local_costmap/local_costmap"
LATCHED, VOLATILE = "TRANSIENT_LOCAL", "VOLATILE"
Change = Callable[[Snapshot], Snapshot]


class Fault(NamedTuple):
    """``words`` are in the finding of ``code``; ``also`` are codes that may come besides."""

    name: str
    system: Callable[[], Snapshot]
    change: Change
    code: str
    words: tuple[str, ...]
    level: str = ERROR
    also: tuple[str, ...] = ()


def nav() -> Snapshot:
    return nav2_with_tools("L1")


def shared_tf() -> Snapshot:
    return nav2_with_tools("L2")


def simulation() -> Snapshot:
    return simulated("robot1", "robot2", "robot3")


def added(node: str, *ends: tuple[str, str, str]) -> Change:
    """A node more, or more of a node that is there."""

    def change(graph: Snapshot) -> Snapshot:
        there = any(it.name == node for it in graph.nodes)
        return (with_ends if there else with_node)(graph, node, *ends)

    return change


def renamed(old: str, new: str, *nodes: str) -> Change:
    """A name under another one, of these nodes or of all."""

    def change(graph: Snapshot) -> Snapshot:
        for node in nodes or ("",):
            graph = moved(graph, old, new, node)
        return graph

    return change


def both(*changes: Change) -> Change:
    def change(graph: Snapshot) -> Snapshot:
        for one in changes:
            graph = one(graph)
        return graph

    return change


def in_each(old: str, new: str) -> Change:
    """``/robot1/OLD`` and ``/robot2/OLD`` under one name."""
    return both(renamed(f"/robot1/{old}", new), renamed(f"/robot2/{old}", new))


def frame(child: str, parent: str, topic: str, static: bool = False) -> Change:
    """One transform more."""
    return reframed(lambda it: it, GraphFrame(child, parent, topic, static, ()))


def other_parent(child: str, parent: str, topic: str) -> Change:
    return reframed(
        lambda it: it._replace(parent=parent) if (it.child, it.topic) == (child, topic) else it
    )


def sent_twice(child: str, topic: str) -> Change:
    return reframed(
        lambda it: it._replace(several=True) if (it.child, it.topic) == (child, topic) else it
    )


def offered(name: str, publishers: str, subscribers: str, policy: str) -> Change:
    give, ask = qos(**{policy: publishers}), qos(**{policy: subscribers})
    return lambda graph: with_qos(graph, name, give, ask)


def twice(graph: Snapshot) -> Snapshot:
    """Every node of a robot runs twice, as when two robots have no namespace."""
    own = [
        it for it in graph.nodes if not it.name.startswith(("/ros", "/rqt", "/_", "/fox", "/fleet"))
    ]
    return graph._replace(nodes=(*graph.nodes, *own))


def bare_odometry(graph: Snapshot) -> Snapshot:
    """The controllers of both robots send the frames of their defaults."""
    more = GraphFrame("base_footprint", "odom", "/tf", False, ())
    return reframed(lambda it: None if it.child.startswith("base_footprint/") else it, more)(graph)


def prefixed_twice(graph: Snapshot) -> Snapshot:
    """frame_prefix: robot1/ on top of a description that has the name in front already."""

    def change(it: GraphFrame) -> GraphFrame:
        child, parent = (_in_front(name) for name in (it.child, it.parent))
        if it.static and child.startswith("robot1/"):
            child, parent = f"robot1/{child}", f"robot1/{parent}"
        return it._replace(child=child, parent=parent)

    return reframed(change)(graph)


def _in_front(name: str) -> str:
    plain, _, robot = name.partition("/")
    return f"{robot}/{plain}" if robot else name


def without_clock(*nodes: str) -> Change:
    """Nodes that nobody told of simulated time."""

    def change(graph: Snapshot) -> Snapshot:
        kept = (it for it in graph.endpoints if not (it.name == "/clock" and it.node in nodes))
        return graph._replace(endpoints=tuple(kept))

    return change


def on_simulated_time(robot: str) -> Change:
    def change(graph: Snapshot) -> Snapshot:
        for node in [it.name for it in graph.nodes if it.name.startswith(f"/{robot}/")]:
            graph = with_ends(graph, node, (SUBSCRIBES, "/clock", CLOCK))
        return graph

    return change


def of_robot(graph: Snapshot, robot: str) -> tuple[str, ...]:
    return tuple(it.name for it in graph.nodes if it.name.startswith(f"/{robot}/"))


def real_among_simulated(graph: Snapshot) -> Snapshot:
    return without_clock(*of_robot(graph, "robot3"))(graph)


def tf_rows() -> tuple[Fault, ...]:
    tf1, tf2 = "/robot1/tf", "/robot2/tf"
    own_rule = "/tf:=tf"
    return (
        Fault(
            "nobody passed /tf:=tf: both trees on /tf", nav, lambda g: global_tf(g, "robot1", "robot2"),
            "MG402", ("robot1 and robot2", "base_link", own_rule),
        ),
        Fault(
            "one robot_state_publisher lacks /tf:=tf", nav,
            both(
                renamed(tf2, "/tf", "/robot2/robot_state_publisher"),
                renamed("/robot2/tf_static", "/tf_static", "/robot2/robot_state_publisher"),
            ),
            "MG405", ("/robot2/robot_state_publisher", "on /tf", own_rule),
        ),
        Fault(
            "bt_navigator listens to /tf", nav, renamed(tf1, "/tf", "/robot1/bt_navigator"),
            "MG405", ("/robot1/bt_navigator", "hears", own_rule),
        ),
        Fault(
            "robot2's amcl sends tf to robot1", nav, renamed(tf2, tf1, "/robot2/amcl"),
            "MG405", ("/robot2/amcl", "names robot1"),
        ),
        Fault(
            "controllers send bare odom on a shared /tf", shared_tf, bare_odometry,
            "MG402", ("robot1 and robot2", "base_footprint"), ERROR, ("MG406",),
        ),
        Fault(
            "both amcl send map -> odom of their defaults", shared_tf, frame("odom", "map", "/tf"),
            "MG402", ("odom", "robot1 and robot2"),
        ),
        Fault(
            "a static map -> odom beside amcl", nav,
            both(
                added("/robot1/static_transform_publisher_x", (PUBLISHES, "/robot1/tf_static", TF)),
                frame("odom", "map", "/robot1/tf_static", True),
            ),
            "MG404", ("static_transform_publisher_x", "map -> odom"),
        ),
        Fault(
            "a node sends base_link -> map", nav, frame("map", "base_link", tf1),
            "MG403", ("circle", "map -> odom -> base_footprint -> base_link"),
        ),
        Fault(
            "the EKF sends odom_combined beside the controller's odom", nav,
            both(
                added("/robot1/ekf_node", (PUBLISHES, tf1, TF)),
                frame("base_footprint", "odom_combined", tf1),
            ),
            "MG401", ("odom and odom_combined", "base_footprint"),
        ),
        Fault(
            "the EKF calls its frame odom_combined, amcl odom", nav,
            other_parent("base_footprint", "odom_combined", tf1),
            "MG406", ("odom and base_footprint", "not connected"),
        ),
        Fault(
            "frame_prefix on top of a rewritten description", shared_tf, prefixed_twice,
            "MG407", ("robot1/robot1", "frame_prefix"), ERROR, ("MG406",),
        ),
        Fault(
            "robot2 sends a mount with robot1's name", shared_tf,
            frame("imu_link/robot1", "base_link/robot2", "/tf"),
            "MG401", ("imu_link/robot1", "base_link/robot2"),
        ),
        Fault(
            "the EKF sends the controller's odometry as well", nav,
            both(
                added("/robot1/ekf_node", (PUBLISHES, tf1, TF)),
                sent_twice("base_footprint", tf1),
            ),
            "MG408", ("odom -> base_footprint", "/robot1/ekf_node", "publish_tf"),
        ),
        Fault(
            "two robots without any namespace", single, twice,
            "MG301", ("more than once", "without a namespace"), ERROR, ("MG402", "MG502"),
        ),
    )  # fmt: skip


def command_rows() -> tuple[Fault, ...]:
    cmd1 = "/robot1/cmd_vel"
    send1 = (PUBLISHES, cmd1, TWIST)
    return (
        Fault(
            "robot2's teleop drives robot1", nav, added("/robot2/teleop_twist_joy_node", send1),
            "MG311", ("/robot2/teleop_twist_joy_node", "belongs to robot1"),
        ),
        Fault(
            "a joystick called after robot2 drives robot1", nav, added("/teleop_robot2", send1),
            "MG311", ("/teleop_robot2", "belongs to robot1"),
        ),
        Fault(
            "a joystick against Nav2", nav, added("/robot1/teleop_twist_joy_node", send1),
            "MG312", ("teleop_twist_joy_node", "collision_monitor", "twist_mux"), WARNING,
        ),
        Fault(
            "ros2 topic pub on cmd_vel", nav, added("/_ros2cli_4711", send1),
            "MG312", ("/_ros2cli_4711", cmd1), WARNING,
        ),
        Fault(
            "a fleet manager drives as well", nav, added("/fleet_manager", send1),
            "MG312", ("/fleet_manager", cmd1), WARNING,
        ),
        Fault(
            "a joystick in the root", nav, added("/teleop_node", (PUBLISHES, "/cmd_vel", TWIST)),
            "MG308", ("nobody reads", "/cmd_vel:=/robot"),
        ),
        Fault(
            "a joystick in a namespace with a capital", nav,
            added("/teleop_node", (PUBLISHES, "/Robot2/cmd_vel", TWIST)),
            "MG308", ("/Robot2/cmd_vel", "/robot2/cmd_vel"),
        ),
        Fault(
            "RViz's goal in the root", nav, added("/rviz2", (PUBLISHES, "/goal_pose", POSE)),
            "MG308", ("/rviz2", "/robot1/goal_pose"), NOTE,
        ),
        Fault(
            "both drivers obey /cmd_vel", nav, in_each("cmd_vel", "/cmd_vel"),
            "MG310", ("robot1 and robot2", "/cmd_vel"), ERROR, ("MG320",),
        ),
        Fault(
            "both robots obey /goal_pose", nav, in_each("goal_pose", "/goal_pose"),
            "MG310", ("robot1 and robot2", "/goal_pose"),
        ),
        Fault(
            "both amcl take /initialpose", nav,
            both(
                renamed("/robot1/initialpose", "/initialpose", "/robot1/amcl"),
                renamed("/robot2/initialpose", "/initialpose", "/robot2/amcl"),
            ),
            "MG310", ("/initialpose", "amcl"), ERROR, ("MG303", "MG308"),
        ),
        Fault(
            "ros2 bag play into the running robot", nav,
            added("/rosbag2_player", (PUBLISHES, "/robot1/scan", SCAN), (PUBLISHES, "/robot1/tf", TF)),
            "MG313", ("/robot1/scan", "ROS_DOMAIN_ID"),
        ),
        Fault(
            "ros2 bag play with commands", nav, added("/rosbag2_player", send1),
            "MG313", (cmd1,),
        ),
        Fault(
            "two programs send one arm's trajectories", arms,
            both(
                added("/left_arm/arm_controller", (SUBSCRIBES, LEFT, TRAJECTORY)),
                added("/left_arm/demo", (PUBLISHES, LEFT, TRAJECTORY)),
                added("/left_arm/servo_node", (PUBLISHES, LEFT, TRAJECTORY)),
            ),
            "MG312", ("demo", "servo_node"), WARNING,
        ),
        Fault(
            "the left arm's program moves the right arm", arms,
            both(
                added("/right_arm/arm_controller", (SUBSCRIBES, RIGHT, TRAJECTORY)),
                added("/left_arm/demo", (PUBLISHES, RIGHT, TRAJECTORY)),
            ),
            "MG311", ("/left_arm/demo", "belongs to right_arm"),
        ),
        Fault(
            "robot1's patrol sends goals to robot2", nav,
            added("/robot1/patrol", (CALLS, "/robot2/navigate_to_pose", NAVIGATE)),
            "MG311", ("/robot1/patrol", "sends goals", "robot2"),
        ),
        Fault(
            "robot2's watchdog resets robot1", nav,
            both(
                added("/robot1/driver", (SERVES, "/robot1/reset", TRIGGER)),
                added("/robot2/driver", (SERVES, "/robot2/reset", TRIGGER)),
                added("/robot2/watchdog", (CALLS, "/robot1/reset", TRIGGER)),
            ),
            "MG311", ("/robot2/watchdog", "calls /robot1/reset"),
        ),
    )  # fmt: skip


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
            "MG307", ("/robot2/amcl", LATCHED, VOLATILE),
        ),
    )  # fmt: skip


def data_rows() -> tuple[Fault, ...]:
    return (
        Fault(
            "both lidars on /scan", nav, in_each("scan", "/scan"),
            "MG320", ("robot1 and robot2", "/scan"),
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
            "MG322", ("robot1 and robot2", "/scan"),
        ),
        Fault(
            "joint_state_publisher beside the driver", nav,
            added("/robot1/joint_state_publisher_gui", (PUBLISHES, "/robot1/joint_states", JOINTS)),
            "MG324", ("joint_state_publisher_gui", "stop it"), WARNING,
        ),
        Fault(
            "amcl started twice", nav,
            lambda g: g._replace(nodes=(*g.nodes, GraphNode("/robot1/amcl", "x"))),
            "MG301", ("/robot1/amcl", "20 s"),
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
            "MG302", ("/robot1/lifecycle_manager_localization", "another robot"),
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


FAULTS = (*tf_rows(), *command_rows(), *name_rows(), *data_rows(), *clock_rows())
# Those whose types are on PyPI; a fault in an action needs nav2_msgs.
LIVE = (
    "a joystick in the root",
    "robot2's teleop drives robot1",
    "a joystick called after robot2 drives robot1",
    "a joystick against Nav2",
    "ros2 topic pub on cmd_vel",
    "both drivers obey /cmd_vel",
    "both amcl take /initialpose",
    "ros2 bag play into the running robot",
    "two programs send one arm's trajectories",
    "a lifecycle manager in the root",
    "a costmap's relative scan",
    "amcl has an absolute scan topic",
    "a best effort scan, a reliable reader",
    "both lidars on /scan",
    "map_server beside SLAM",
    "robot2's amcl reads robot1's scan",
    "joint_state_publisher beside the driver",
    "amcl started twice",
    "a second lifecycle manager",
    "robot2 on simulated time without a clock",
    "nobody passed /tf:=tf: both trees on /tf",
    "one robot_state_publisher lacks /tf:=tf",
    "a static map -> odom beside amcl",
    "the EKF sends the controller's odometry as well",
    "a node sends base_link -> map",
    "frame_prefix on top of a rewritten description",
)
