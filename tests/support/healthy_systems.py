# SPDX-License-Identifier: Apache-2.0
"""Systems in which nothing is wrong, as graphs: plans of real node sets, and the tools that people run.

Nodes, names and types are those of the node sets' facts; tools have what their sources give them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from graph_cases import moved, robot_edges, sent, unspelled
from nav2_graphs import EVERYDAY, ROVER, healthy as as_planned

from multibot_rewrite.cli import multibot
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    Robot,
    System,
)

TWIST, ODOMETRY = "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry"
SCAN, JOINTS, MAP = (
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/JointState",
    "nav_msgs/msg/OccupancyGrid",
)
POSE, START = "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped"
TRIGGER, MOVE = "std_srvs/srv/Trigger", "moveit_msgs/action/MoveGroup"
TF, CLOCK = "tf2_msgs/msg/TFMessage", "rosgraph_msgs/msg/Clock"
NAVIGATE = "nav2_msgs/action/NavigateToPose"
# Role, name, type.
Row = tuple[str, str, str]
TWO = ("robot1", "robot2")


@cache
def plan(
    node_sets: tuple[str, ...],
    layout: str = "L1",
    robots: tuple[str, ...] = TWO,
    release: str = "jazzy",
) -> System:
    """Return the plan of rovers with these node sets, as the command writes it."""
    with TemporaryDirectory() as folder:
        file = f"{folder}/plan.yaml"
        names = ",".join(node_sets)
        given = ["--node-set", names, "--layout", layout, "--distro", release, "-o", file]
        assert multibot.main(["plan", str(ROVER), *robots, *given]) == 0
        return from_yaml(Path(file).read_bytes(), file)


@cache
def started(
    node_sets: tuple[str, ...],
    layout: str = "L1",
    robots: tuple[str, ...] = TWO,
    release: str = "jazzy",
) -> System:
    """Return the graph of such a plan, each robot with its tree of frames."""
    planned = plan(node_sets, layout, robots, release)
    graph = _with_types(as_planned(planned))
    edges = (edge for robot in planned.robots for edge in _edges(robot))
    return sent(graph._replace(edges=tuple(edges)))


def _edges(robot: Robot) -> Iterator[Edge]:
    """Yield the rover's tree, which localization hangs below the map."""
    odom = next(it for it in robot.frames if unspelled(it, robot.name) == "odom")
    yield Edge(odom, "map", robot.tf_topic, False, ())
    yield from robot_edges(robot)


def _with_types(graph: System) -> System:
    """Return the plan with the other side's type for unknown ones; Twist for Twist or TwistStamped."""
    types: dict[tuple[str, str], str] = {}
    for end in graph.ends:
        types[end.kind, end.name] = types.get((end.kind, end.name)) or end.type
    ends = (it._replace(type=types[it.kind, it.name]) for it in graph.ends)
    return graph._replace(ends=tuple(ends))


def with_node(graph: System, node: str, *ends: Row) -> System:
    """One node more, with what every node has; an action's or a service's type says what it is."""
    own = (End(_kind(type_), role, name, type_, "", node, None, "") for role, name, type_ in ends)
    usual = (
        End(kind, role, name.format(node), type_, "", node, None, "")
        for kind, role, name, type_ in EVERYDAY
    )
    known = {it.name for it in graph.nodes}
    nodes = graph.nodes if node in known else (*graph.nodes, Node(node, node))
    more = own if node in known else (*own, *usual)
    return sent(graph._replace(nodes=nodes, ends=(*graph.ends, *more)))


def _kind(type_: str) -> str:
    return {"msg": TOPIC, "srv": SERVICE, "action": ACTION}[type_.split("/")[1]]


def with_tools(graph: System, robots: Iterable[str]) -> System:
    """RViz for each robot, rqt, a recorder, bridges to browsers, a fleet manager, diagnostics."""
    for robot in robots:
        graph = with_node(graph, f"/{robot}/rviz2", *_rviz(f"/{robot}"))
        graph = with_node(
            graph, "/fleet_manager",
            (SUBSCRIBES, f"/{robot}/odom", ODOMETRY), (CALLS, f"/{robot}/navigate_to_pose", NAVIGATE),
        )  # fmt: skip
    topics = sorted({(it.name, it.type) for it in graph.ends if it.kind == TOPIC and it.type})
    everything = [(SUBSCRIBES, name, type_) for name, type_ in topics]
    graph = with_node(graph, "/rosbag2_recorder", *everything)
    graph = with_node(graph, "/foxglove_bridge", *everything)
    graph = with_node(graph, "/rosbridge_websocket", *everything[::3])
    graph = with_node(graph, "/rosapi")
    graph = with_node(graph, "/rqt_gui_py_node_4711", *everything[::5])
    graph = with_node(graph, "/_ros2cli_daemon_7_0123456789")
    diagnostics = "diagnostic_msgs/msg/DiagnosticArray"
    ends = ((SUBSCRIBES, "/diagnostics", diagnostics), (PUBLISHES, "/diagnostics_agg", diagnostics))
    return with_node(graph, "/diagnostic_aggregator", *ends)


def _rviz(space: str) -> Iterator[Row]:
    yield SUBSCRIBES, f"{space}/scan", SCAN
    yield SUBSCRIBES, f"{space}/map", MAP
    yield PUBLISHES, f"{space}/goal_pose", POSE
    yield PUBLISHES, f"{space}/initialpose", START
    yield PUBLISHES, f"{space}/clicked_point", "geometry_msgs/msg/PointStamped"
    yield CALLS, f"{space}/navigate_to_pose", NAVIGATE
    yield CALLS, f"{space}/lifecycle_manager_slam/is_active", TRIGGER


@cache
def nav2_with_tools(layout: str = "L1", release: str = "jazzy") -> System:
    return with_tools(started(("nav2",), layout, TWO, release), TWO)


@cache
def simulated(*robots: str) -> System:
    """All nodes of the robots on the time of one Gazebo, whose bridge sends all sensors."""
    graph = started(("nav2",), "L1", robots)
    for node in [
        it.name for it in graph.nodes if it.name.startswith(tuple(f"/{r}/" for r in robots))
    ]:
        graph = with_ends(graph, node, (SUBSCRIBES, "/clock", CLOCK))
    graph = with_node(graph, "/ros_gz_bridge", (PUBLISHES, "/clock", CLOCK))
    # Tools that nobody told of simulated time.
    return with_tools(graph, robots)


def with_ends(graph: System, node: str, *ends: Row) -> System:
    own = (End(_kind(it[2]), it[0], it[1], it[2], "", node, None, "") for it in ends)
    return sent(graph._replace(ends=(*graph.ends, *own)))


def respelled(graph: System, spelled: Callable[[str], str]) -> System:
    """Return the graph with other names of nodes, topics and services."""
    nodes = (it._replace(name=spelled(it.name)) for it in graph.nodes)
    ends = (it._replace(name=spelled(it.name), node=spelled(it.node)) for it in graph.ends)
    frames = (it._replace(topic=spelled(it.topic)) for it in graph.edges)
    return sent(graph._replace(nodes=tuple(nodes), ends=tuple(ends), edges=tuple(frames)))


@cache
def two_levels() -> System:
    """Robots of two fleets; one name is there in both."""
    spaces = {"/robot1": "/fleet_a/robot1", "/robot2": "/fleet_b/robot1"}

    def spelled(name: str) -> str:
        first = "/" + name.split("/")[1]
        return spaces.get(first, first) + name.removeprefix(first)

    return respelled(nav2_with_tools(), spelled)


def single() -> System:
    """One robot, in no namespace."""
    graph = with_tools(started(("nav2",), "L1", ("robot1",)), ("robot1",))
    return respelled(graph, lambda name: name.replace("/robot1", "", 1) or "/")


SLAM_WITH_FILTERS = ("nav2_slam", "robot_localization_gps")


def slam_with_filters(release: str = "jazzy") -> System:
    """SLAM and two filters a robot: the second's map to odom is switched off."""
    graph = started(SLAM_WITH_FILTERS, release=release)
    for robot in TWO:
        # navsat_transform of Humble reads imu.
        if release != "humble":
            graph = moved(graph, f"/{robot}/imu", f"/{robot}/imu/data", "/imu_driver")
        fix = (PUBLISHES, f"/{robot}/gps/fix", "sensor_msgs/msg/NavSatFix")
        graph = with_node(graph, f"/{robot}/gps_driver", fix)
    return with_tools(graph, TWO)


def arms() -> System:
    """Two arms with MoveIt and ros2_control on one tf, frames with a prefix."""
    graph = started(("moveit", "ros2_control"), "L3", ("left_arm", "right_arm"))
    # Its name ends with an address.
    graph = respelled(graph, lambda name: name.replace("*", "94231"))
    for robot in ("left_arm", "right_arm"):
        space = f"/{robot}"
        listener = f"{space}/transform_listener_impl_55{robot[0]}0"
        graph = with_node(graph, listener, (SUBSCRIBES, f"{space}/tf", TF))
        graph = with_node(graph, f"{space}/rviz2", (CALLS, f"{space}/move_action", MOVE))
    return graph


def arms_in_one_node_space() -> System:
    """Return a bimanual robot without namespaces: one description with prefixes, one joint_states."""
    graph = System((), (), (), as_planned(plan(("nav2",))).environment)
    graph = with_node(
        graph, "/robot_state_publisher", (SUBSCRIBES, "/joint_states", JOINTS), (PUBLISHES, "/tf", TF),
        (PUBLISHES, "/robot_description", "std_msgs/msg/String"),
    )  # fmt: skip
    for side in ("left", "right"):
        graph = with_node(
            graph, f"/{side}_joint_state_broadcaster", (PUBLISHES, "/joint_states", JOINTS)
        )
        trajectory = "trajectory_msgs/msg/JointTrajectory"
        controller = f"/{side}_arm_controller"
        graph = with_node(
            graph, controller, (SUBSCRIBES, f"{controller}/joint_trajectory", trajectory)
        )
        frames = (("world", f"{side}_base_link"), (f"{side}_base_link", f"{side}_link1"))
        new = (Edge(child, parent, "/tf", False, ()) for parent, child in frames)
        graph = graph._replace(edges=(*graph.edges, *new))
    return sent(graph)


def with_mux() -> System:
    """Two joysticks and Nav2 before a twist_mux in each robot."""
    graph = started(("nav2", "teleop"))
    for robot in TWO:
        for node in ("collision_monitor", "docking_server"):
            graph = moved(graph, f"/{robot}/cmd_vel", f"/{robot}/nav_vel", f"/{robot}/{node}")
        for sender in ("joystick_a", "joystick_b"):
            graph = with_node(graph, f"/{robot}/{sender}", (PUBLISHES, f"/{robot}/joy_vel", TWIST))
    return graph


def idle_mux() -> System:
    """Return a twist_mux with an input that no node sends yet, its output on a topic of its own."""
    graph = with_mux()
    for robot in TWO:
        for node in ("twist_mux", "diff_drive"):
            graph = moved(graph, f"/{robot}/cmd_vel", f"/{robot}/cmd_vel_out", f"/{robot}/{node}")
        graph = with_ends(graph, f"/{robot}/twist_mux", (SUBSCRIBES, f"/{robot}/cmd_vel_ui", TWIST))
    return with_tools(graph, TWO)


def beside_the_root() -> System:
    """Return a robot without a namespace, and another one with one; each has its own tf topic."""
    graph = started(("nav2",))

    def spelled(name: str) -> str:
        return name.replace("/robot1", "", 1) or "/"

    return with_tools(respelled(graph, spelled), ("robot2",))


def one_map_for_all() -> System:
    """Return a map server for the fleet, and static frames of the world from nodes of their own."""
    graph = started(("navigation",), "L2")
    graph = with_node(graph, "/map_server", (PUBLISHES, "/map", MAP))
    for robot in TWO:
        graph = with_node(graph, f"/{robot}/amcl", (SUBSCRIBES, "/map", MAP))
    for dock in ("dock_a", "dock_b"):
        graph = with_node(
            graph, f"/static_transform_publisher_{dock}", (PUBLISHES, "/tf_static", TF)
        )
        graph = graph._replace(edges=(*graph.edges, Edge(dock, "map", "/tf_static", True, ())))
    return sent(graph)


def follower() -> System:
    """Return a robot that follows another one: it reads that one's odometry, and its own."""
    graph = nav2_with_tools()
    ends = ((SUBSCRIBES, f"/{robot}/odom", ODOMETRY) for robot in TWO)
    order = (PUBLISHES, "/robot2/cmd_vel_follow", TWIST)
    graph = with_node(graph, "/robot2/follower", *ends, order)
    both = ((CALLS, f"/{robot}/navigate_to_pose", NAVIGATE) for robot in TWO)
    return with_node(graph, "/robot1/convoy", *both, (SERVES, "/robot1/handover", TRIGGER))


SYSTEMS: Mapping[str, Callable[[], System]] = {
    "two robots with Nav2 and tools, tf-per-robot": nav2_with_tools,
    "two robots with Nav2 and tools, frames-per-robot": lambda: nav2_with_tools("L2"),
    "two robots with Nav2 and tools, both": lambda: nav2_with_tools("L3"),
    "two robots with Nav2, postfix": lambda: started(("nav2",), "L4"),
    "two arms with MoveIt": arms,
    "a robot with two arms, no namespaces": arms_in_one_node_space,
    "SLAM with two filters and GPS": slam_with_filters,
    "five robots on simulated time": lambda: simulated("alpha", "Beta", "gamma3", "delta", "eps"),
    "namespaces of two levels": two_levels,
    "one robot": single,
    "twist_mux": with_mux,
    "twist_mux with an idle input": idle_mux,
    "a robot without a namespace next to another": beside_the_root,
    "one map for all": one_map_for_all,
    "a follower and a convoy": follower,
}
# What stands in each release, with its plan: node sets, layout, robots.
OF_EACH_RELEASE = (
    (("nav2",), "L1", TWO),
    (("nav2",), "L2", TWO),
    (("nav2",), "L3", TWO),
    (("nav2",), "L4", TWO),
    (("navigation",), "L2", TWO),
    (("nav2_slam",), "L1", TWO),
    (("teleop",), "L1", TWO),
    (("moveit", "ros2_control"), "L3", ("left_arm", "right_arm")),
)
