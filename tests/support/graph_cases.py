# SPDX-License-Identifier: Apache-2.0
"""The graphs in ``fixtures/graphs``: a fleet as planned, and one broken for each rule.

``python tests/support/graph_cases.py`` writes them anew, the printed lines beside them included.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import redirect_stdout
from functools import cache
from io import BytesIO, TextIOWrapper
from typing import NamedTuple

from paths import ROOT

from multibot_rewrite.cli.multibot import main as multibot
from multibot_rewrite.system.json import from_yaml, to_json
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    Edge,
    End,
    Environment,
    Node,
    Qos,
    Robot,
    System,
    surely,
)

# As a user names them: messages hold the paths.
GRAPHS, ROVER = "fixtures/graphs", "fixtures/robots/rover.urdf"
_NODES = ("--nodes", f"{GRAPHS}/nodes.yaml", "--node-set", "small", "--distro", "jazzy")
FLEET = (ROVER, "robot1", "robot2", *_NODES)
# Layout -> folder of its plan and graphs.
FOLDERS = {
    "frames-per-robot": GRAPHS,
    "tf-per-robot": f"{GRAPHS}/tf-per-robot",
    "both": f"{GRAPHS}/both",
    "postfix": f"{GRAPHS}/postfix",
}
PARENTS = {
    "base_footprint": "odom",
    "base_link": "base_footprint",
    "camera_optical_frame": "camera_link",
}
MOVING = ("base_footprint", "left_wheel", "right_wheel")
TF = "tf2_msgs/msg/TFMessage"


class Case(NamedTuple):
    """A graph that breaks one rule: the code that is to be found, how it is made, and how often."""

    layout: str
    code: str
    broken: Callable[[System], System]
    times: int = 1

    @property
    def found(self) -> tuple[str, ...]:
        return (self.code,) * self.times

    @property
    def stem(self) -> str:
        """The path of its files without their ending."""
        return f"{FOLDERS[self.layout]}/{self.code}"


@cache
def read_plan(layout: str) -> System:
    """Return the plan of a folder."""
    path = f"{FOLDERS[layout]}/plan.yaml"
    return from_yaml((ROOT / path).read_bytes(), path)


# ---------------------------------------------------------------- a graph as planned


def environment(*caveats: Caveat) -> Environment:
    return Environment(0, "LOCALHOST", (), "rmw_fastrtps_cpp", "", False, 4, "quiet", 3.5, caveats)


def as_planned(plan: System) -> System:
    """Return the graph that a plan is of; a type that is not known is that of the other end."""
    types: dict[tuple[str, str], str] = {}
    planned = surely(plan).ends
    for wanted in planned:
        both = (wanted.kind, wanted.name)
        types[both] = types.get(both) or wanted.type
    ends = [
        End(w.kind, w.role, w.name, types[w.kind, w.name], "", w.node, None, "") for w in planned
    ]
    nodes = [Node(it.name, "") for it in plan.nodes if it.robot]
    edges = [edge for robot in plan.robots for edge in robot_edges(robot)]
    # What the plan itself has above the robots, such as start poses.
    has_parent = {it.child for it in edges}
    above = (it for it in plan.edges if it.static and it.child not in has_parent)
    edges += [it._replace(topic="/tf_static") for it in above]
    ends += bridge(plan)
    return sent(System(tuple(nodes), tuple(ends), tuple(edges), environment()))


def bridge(plan: System) -> Iterable[End]:
    """Yield the ends of a bridge that carries what the plan has for it."""
    for topic in plan.topics:
        for role in topic.bridge:
            node = "/ros_gz_bridge"
            yield End(TOPIC, role, topic.name, topic.type, "", node, None, "")


def robot_edges(robot: Robot) -> Iterator[Edge]:
    """Its frames in one tree: a rover's as its description has them, else all below the first."""
    bare = {unspelled(frame, robot.name): frame for frame in robot.frames}
    root = bare.get("odom") or robot.frames[0]
    for name, frame in bare.items():
        if frame != root:
            parent = bare.get(PARENTS.get(name, "base_link"), root)
            static = name not in MOVING
            topic = robot.tf_topic.replace("tf", "tf_static", 1) if static else robot.tf_topic
            yield Edge(frame, root if parent == frame else parent, topic, static, ())


def unspelled(frame: str, robot: str) -> str:
    """Return a frame without the robot's name."""
    return frame.removesuffix(f"/{robot}").removeprefix(f"{robot}/")


def sent(graph: System) -> System:
    """Return the graph whose frames tell who publishes on their topic, as a real one has it."""
    nodes: dict[str, dict[str, None]] = {}
    for end in graph.ends:
        if (end.kind, end.role) == (TOPIC, PUBLISHES):
            nodes.setdefault(end.name, {})[end.node] = None
    frames = (f._replace(publishers=tuple(sorted(nodes.get(f.topic, ())))) for f in graph.edges)
    return graph._replace(edges=tuple(frames))


# What nobody plans and everybody has: tools, sensors' own topics, parameter services.
BESIDE = (
    (TOPIC, PUBLISHES, "/robot1/scan", "sensor_msgs/msg/LaserScan", "/robot1/lidar_driver"),
    (TOPIC, PUBLISHES, "/robot2/scan", "sensor_msgs/msg/LaserScan", "/robot2/lidar_driver"),
    (TOPIC, PUBLISHES, "/rosout", "rcl_interfaces/msg/Log", "/robot1/pilot"),
    (
        "service",
        "serves",
        "/robot1/pilot/get_parameters",
        "rcl_interfaces/srv/GetParameters",
        "/robot1/pilot",
    ),
    (TOPIC, SUBSCRIBES, "/robot1/scan", "sensor_msgs/msg/LaserScan", "/rviz2"),
    (TOPIC, PUBLISHES, "/goal_pose", "geometry_msgs/msg/PoseStamped", "/rviz2"),
    (TOPIC, SUBSCRIBES, "/robot2/odom", "nav_msgs/msg/Odometry", "/rosbag2_recorder"),
)


def healthy(layout: str) -> System:
    """Return a fleet as planned, with what is beside it."""
    graph = as_planned(read_plan(layout))
    if layout != "frames-per-robot":
        return graph
    ends = [End(k, r, n, t, "", node, None, "") for k, r, n, t, node in BESIDE]
    nodes = [Node(node, "") for node in ("/rviz2", "/rosbag2_recorder", "/_ros2cli_4711")]
    return graph._replace(nodes=(*graph.nodes, *nodes), ends=(*graph.ends, *ends))


# ---------------------------------------------------------------- what can be done to it


def moved(graph: System, old: str, new: str, node: str = "") -> System:
    """One name under another one, at the nodes whose name ends so."""
    ends = (
        e._replace(name=new) if e.name == old and e.node.endswith(node) else e for e in graph.ends
    )
    return sent(graph._replace(ends=tuple(ends)))


def without_node(graph: System, node: str) -> System:
    return sent(
        graph._replace(
            nodes=tuple(n for n in graph.nodes if n.name != node),
            ends=tuple(e for e in graph.ends if e.node != node),
        )
    )


def without_end(graph: System, name: str, node: str) -> System:
    """Return a node that has not one of its names."""
    ends = (e for e in graph.ends if (e.name, e.node) != (name, node))
    return sent(graph._replace(ends=tuple(ends)))


def with_node(graph: System, node: str, *ends: tuple[str, str, str]) -> System:
    """One node more, and its topics as (role, name, type)."""
    more = [End(TOPIC, role, name, type_, "", node, None, "") for role, name, type_ in ends]
    return sent(graph._replace(nodes=(*graph.nodes, Node(node, "")), ends=(*graph.ends, *more)))


def renamed_node(graph: System, old: str, new: str) -> System:
    """Return a node under another name, its private names with it."""
    ends = tuple(
        e._replace(node=new, name=e.name.replace(f"{old}/", f"{new}/", 1)) if e.node == old else e
        for e in graph.ends
    )
    nodes = tuple(n._replace(name=new) if n.name == old else n for n in graph.nodes)
    return sent(graph._replace(nodes=nodes, ends=ends))


def reframed(change: Callable[[Edge], Edge | None], *more: Edge) -> Callable[[System], System]:
    """Return the graph with each of its transforms changed, or left out, and some more."""

    def broken(graph: System) -> System:
        kept = [frame for frame in map(change, graph.edges) if frame is not None]
        return sent(graph._replace(edges=(*kept, *more)))

    return broken


def of(robot: str, frame: Edge) -> bool:
    return robot in frame.child or robot in frame.topic


def qos(**words: object) -> Qos:
    usual = Qos("UNKNOWN", 0, "RELIABLE", "VOLATILE", math.inf, math.inf, "AUTOMATIC", math.inf)
    return usual._replace(**words)  # type: ignore[arg-type]


def with_qos(graph: System, name: str, offered: Qos, asked: Qos) -> System:
    ends = (
        e._replace(qos=offered if e.role == PUBLISHES else asked) if e.name == name else e
        for e in graph.ends
    )
    return graph._replace(ends=tuple(ends))


def with_type(graph: System, name: str, node: str, type_: str) -> System:
    ends = (e._replace(type=type_) if (e.name, e.node) == (name, node) else e for e in graph.ends)
    return graph._replace(ends=tuple(ends))


def without_namespace(graph: System) -> System:
    """Return the plugin of a description that was not rewritten: its node and names in the root."""
    return moved(
        moved(renamed_node(graph, "/robot1/diff_drive", "/diff_drive"), "/robot1/odom", "/odom", "e"),
        "/robot1/cmd_vel", "/cmd_vel", "/diff_drive",
    )  # fmt: skip


def silent(graph: System) -> System:
    for node in [n.name for n in graph.nodes if n.name.startswith("/robot2/")]:
        graph = without_node(graph, node)
    return reframed(lambda f: None if of("robot2", f) else f)(graph)


def captured(graph: System) -> System:
    end = End(
        TOPIC,
        SUBSCRIBES,
        "/robot1/local_costmap/scan",
        "sensor_msgs/msg/LaserScan",
        "",
        "/robot1/local_costmap/local_costmap",
        None,
        "",
    )
    return graph._replace(ends=(*graph.ends, end))


def unheard(graph: System) -> System:
    """Return a system in which a bridge for all brings an order under no robot's name."""
    end = End(TOPIC, PUBLISHES, "/patrol", "std_msgs/msg/String", "", "/order_bridge", None, "")
    nodes = (*graph.nodes, Node("/order_bridge", ""))
    return graph._replace(nodes=nodes, ends=(*graph.ends, end))


def bare(frame: Edge) -> Edge:
    """Return a transform as the description has it that was not rewritten."""
    return frame._replace(child=frame.child.split("/")[0], parent=frame.parent.split("/")[0])


def prefixed(frame: Edge, robot: str) -> Edge:
    """Return a transform under ``frame_prefix``."""
    return frame._replace(child=f"{robot}/{frame.child}", parent=f"{robot}/{frame.parent}")


def on(topic: str, frame: Edge) -> Edge:
    return frame._replace(topic=topic.replace("tf", "tf_static") if frame.static else topic)


def global_tf(graph: System, *robots: str) -> System:
    """Return the robots' nodes without the rule for tf."""
    for robot in robots:
        for topic in ("tf", "tf_static"):
            graph = moved(graph, f"/{robot}/{topic}", f"/{topic}")
    frames = [on("/tf", f) if f.topic.split("/")[1] in robots else f for f in graph.edges]
    return sent(graph._replace(edges=tuple(dict.fromkeys(frames))))


STATIC = "/tf_static"
L2, L1, L3, L4 = FOLDERS
CASES = (
    Case(L2, "MG101", without_namespace),
    Case(L2, "MG102", lambda g: without_end(g, "/robot1/status", "/robot1/pilot")),
    Case(
        L2,
        "MG310",
        lambda g: moved(
            moved(g, "/robot1/cmd_vel", "/cmd_vel", "diff_drive"),
            "/robot2/cmd_vel",
            "/cmd_vel",
            "diff_drive",
        ),
    ),
    Case(L2, "MG320", lambda g: moved(g, "/robot2/status", "/status", "pilot")),
    Case(L2, "MG321", lambda g: moved(g, "/robot1/odom", "/robot2/odom", "pilot")),
    Case(L2, "MG301", lambda g: g._replace(nodes=(*g.nodes, Node("/robot1/pilot", "")))),
    Case(
        L2,
        "MG306",
        lambda g: with_type(
            g, "/robot1/odom", "/robot1/diff_drive", "geometry_msgs/msg/PoseStamped"
        ),
    ),
    Case(
        L2,
        "MG307",
        lambda g: with_qos(g, "/robot1/cmd_vel", qos(reliability="BEST_EFFORT"), qos(deadline=0.5)),
    ),
    Case(
        L2,
        "MG108",
        lambda g: with_node(
            with_node(g, "/robot1/gripper", (PUBLISHES, "/grip", "std_msgs/msg/Bool")),
            "/fleet_manager",
        ),
        2,
    ),
    Case(L2, "MG109", silent),
    Case(L2, "MG303", lambda g: captured(unheard(g)), 3),
    Case(
        L2, "MG401", reframed(lambda f: f, Edge("base_footprint/robot1", "map", "/tf", False, ()))
    ),
    Case(L2, "MG402", reframed(bare)),
    Case(L2, "MG406", reframed(lambda f: None if f.child == "base_link/robot1" else f)),
    Case(
        L2,
        "MG204",
        reframed(
            lambda f: f,
            Edge("laser/robot1", "base_link/robot1", STATIC, True, ()),
            Edge("camera_depth_frame/robot1", "camera_link/robot1", STATIC, True, ()),
        ),
    ),
    Case(
        L2,
        "MG405",
        lambda g: reframed(
            lambda f: on("/robot1/tf", f) if of("robot1", f) and not f.static else f
        )(moved(g, "/tf", "/robot1/tf", "robot1/diff_drive")),
    ),
    Case(
        L2,
        "MG407",
        reframed(lambda f: prefixed(f, "robot1") if of("robot1", f) and f.static else f),
    ),
    Case(L1, "MG402", lambda g: global_tf(g, "robot1", "robot2")),
    Case(L1, "MG405", lambda g: global_tf(g, "robot1")),
    Case(
        L1,
        "MG407",
        reframed(lambda f: prefixed(f, "robot2") if of("robot2", f) and f.static else f),
    ),
    Case(L3, "MG405", lambda g: global_tf(g, "robot2")),
    Case(L3, "MG207", reframed(lambda f: bare(f) if of("robot2", f) else f)),
    Case(
        L4,
        "MG405",
        lambda g: reframed(
            lambda f: f._replace(topic="/tf/robot2") if f.topic == "/tf/robot1" else f
        )(moved(g, "/tf/robot1", "/tf/robot2", "diff_drive_robot1")),
    ),
    Case(L4, "MG407", reframed(lambda f: prefixed(f, "robot1") if of("robot1", f) else f)),
)


# ---------------------------------------------------------------- the files


def check_lines(plan: str, graph: str) -> str:
    return printed("check", plan, "--from", graph, "--verbose")


def printed(*words: str) -> str:
    """Return what the command prints on standard output."""
    data = BytesIO()
    with TextIOWrapper(data, "utf-8") as out, redirect_stdout(out):
        multibot(list(words))
        out.flush()
        return data.getvalue().decode()


def write(path: str, graph: System) -> None:
    (ROOT / path).write_bytes(to_json(graph))


def write_all(cases: Sequence[Case], layouts: Iterable[str]) -> None:
    os.chdir(ROOT)
    for layout in layouts:
        folder = ROOT / FOLDERS[layout]
        folder.mkdir(exist_ok=True)
        (folder / "plan.yaml").write_text(printed("plan", *FLEET, "--layout", layout))
        write(f"{FOLDERS[layout]}/healthy.json", healthy(layout))
    for case in cases:
        write(f"{case.stem}.json", case.broken(healthy(case.layout)))
        lines = check_lines(f"{FOLDERS[case.layout]}/plan.yaml", f"{case.stem}.json")
        (ROOT / f"{case.stem}.txt").write_text(lines)


if __name__ == "__main__":
    write_all(CASES, FOLDERS)
