# SPDX-License-Identifier: Apache-2.0
"""What tests of pictures share: plans of real node sets, graphs as planned, ways to spoil them."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from graph_cases import bridge
from paths import ROBOTS
from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.cli import multibot
from multibot_rewrite.pages.scene import Scene, make_scene
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    Edge,
    End,
    Environment,
    Node,
    Robot,
    System,
    surely,
)

ROVER = ROBOTS / "rover.urdf"
LAYOUTS = ("L1", "L2", "L3", "L4")
TEXT = "std_msgs/msg/String"
# What every node has beside what is planned.
EVERYDAY = (
    (TOPIC, PUBLISHES, "/rosout", "rcl_interfaces/msg/Log"),
    (TOPIC, PUBLISHES, "/parameter_events", "rcl_interfaces/msg/ParameterEvent"),
    (SERVICE, SERVES, "{}/get_parameters", "rcl_interfaces/srv/GetParameters"),
    (SERVICE, SERVES, "{}/set_parameters", "rcl_interfaces/srv/SetParameters"),
)
# Names that no ROS program can have, and a snapshot written by hand can.
NASTY = (
    "/robot1/</script><script>window.pwned=1</script>",
    "/robot1/<img src=x onerror=window.pwned=1>",
    "/robot1/&\"'<>`#;]})--%%",
    "/robot1/a b\tc\nd\x00e",
    "/robot1/\u202egnp.\ud800\\N",
    '/robot1/" onmouseover="window.pwned=1',
    "/<b onclick=window.pwned=1>/robot1",
    "/<svg onload=window.pwned=1>_robot1",
    "/robot1/" + "long" * 300,
    "/robot1/機械人" * 20,
)


@cache
def nav2(layout: str = "L2", *robots: str) -> System:
    """Return the plan of two rovers with Nav2, as the command writes it."""
    with TemporaryDirectory() as folder:
        file = f"{folder}/plan.yaml"
        names = robots or ("robot1", "robot2")
        given = ["--node-set", "nav2", "--layout", layout, "--distro", "lyrical", "-o", file]
        assert multibot.main(["plan", str(ROVER), *names, *given]) == 0
        return from_yaml(Path(file).read_bytes(), file)


def fleet(robots: int, topics: int) -> System:
    """Return the plan of a large fleet of small robots: two nodes with ``topics`` between them."""
    names = [f"robot{number}" for number in range(1, robots + 1)]
    return planned(
        "both",
        tuple(
            PlannedRobot(
                robot,
                (f"/{robot}/driver", f"/{robot}/planner"),
                (f"{robot}/base_link", f"{robot}/laser"),
                f"/{robot}/tf",
            )
            for robot in names
        ),
        (),
        ("/clock", "/parameter_events", "/rosout"),
        ("map", "world"),
        tuple(end for robot in names for at in range(topics) for end in _topic(robot, at)),
    )


def _topic(robot: str, at: int) -> tuple[End, End]:
    ends = (f"/{robot}/driver", f"/{robot}/planner")
    name = f"/{robot}/topic{at}"
    giver, taker = ends if at % 2 else ends[::-1]
    return (
        planned_end(giver, TOPIC, PUBLISHES, name, TEXT, f"topic{at}"),
        planned_end(taker, TOPIC, SUBSCRIBES, name, TEXT, f"topic{at}"),
    )


def healthy(plan: System) -> System:
    """Return the graph exactly as planned, with what every node has."""
    nodes = [it.name for it in plan.nodes]
    every = (End(w.kind, w.role, w.name, w.type, "", w.node, None, "") for w in surely(plan).ends)
    usual = (
        End(kind, role, name.format(node), type_, "", node, None, "")
        for node in nodes
        for kind, role, name, type_ in EVERYDAY
    )
    frames = (frame for robot in plan.robots for frame in _chain(robot))
    return System(
        tuple(Node(node, node) for node in nodes),
        (*every, *usual, *bridge(plan)),
        tuple(frames),
        environment(),
    )


def _chain(robot: Robot) -> Iterable[Edge]:
    """map, then the robot's frames below one another."""
    static = "/".join("tf_static" if word == "tf" else word for word in robot.tf_topic.split("/"))
    yield Edge(robot.frames[0], "map", robot.tf_topic, False, ())
    for parent, child in zip(robot.frames, robot.frames[1:], strict=False):
        yield Edge(child, parent, static, True, ())


def environment(*caveats: Caveat) -> Environment:
    return Environment(7, "SUBNET", (), "rmw_fastrtps_cpp", "", False, 4, "quiet", 3.5, caveats)


def moved(graph: System, old: str, new: str, node: str = "") -> System:
    """Return the graph with one name under another one, of the nodes whose name ends so."""
    return graph._replace(
        ends=tuple(
            e._replace(name=new) if e.name == old and e.node.endswith(node) else e
            for e in graph.ends
        )
    )


def without_node(graph: System, node: str) -> System:
    return graph._replace(
        nodes=tuple(n for n in graph.nodes if n.name != node),
        ends=tuple(e for e in graph.ends if e.node != node),
    )


def with_end(graph: System, node: str, name: str, role: str = SUBSCRIBES) -> System:
    """Return the graph with one more topic of a node, which may be a new one."""
    end = End(TOPIC, role, name, TEXT, "", node, None, "")
    there = any(n.name == node for n in graph.nodes)
    nodes = graph.nodes if there else (*graph.nodes, Node(node, ""))
    return graph._replace(nodes=nodes, ends=(*graph.ends, end))


def spoiled(plan: System) -> System:
    """Two rovers of which one leaks, one listens to the other, and a node is not there."""
    graph = moved(healthy(plan), "/robot1/cmd_vel", "/cmd_vel", "collision_monitor")
    graph = moved(graph, "/robot2/scan", "/robot1/scan", "amcl")
    graph = without_node(graph, "/robot2/bt_navigator")
    graph = with_end(graph, "/rviz2", "/robot1/map")
    second = Edge("lidar_link/robot1", "map", "/tf", False, ())
    return graph._replace(edges=(*graph.edges, second))


def nasty(plan: System) -> tuple[System, System]:
    """Return a plan and a graph where robots, nodes, topics, types, frames and caveats have
    names that bite; the odd robot talks across."""
    odd = Robot(f'"></title>{NASTY[1]}', (NASTY[2],), NASTY[0])
    first = plan.nodes[0].name
    missed = (planned_end(first, TOPIC, PUBLISHES, f"{name}/missed", name, name) for name in NASTY)
    worse = plan._replace(
        layout=odd.name,
        robots=(*plan.robots, odd),
        ends=(*plan.ends, *missed),
        nodes=(*plan.nodes, Node("/odd", robot=odd.name)),
    )
    graph = with_end(healthy(plan), "/odd", NASTY[1])
    for name in NASTY:
        graph = with_end(with_end(graph, f"{name}/node", name), first, name, PUBLISHES)
    frames = (Edge(name, "base_link/robot1", name, False, (name,)) for name in NASTY)
    around = environment(*(Caveat("note", True, name) for name in NASTY))._replace(rmw=NASTY[0])
    return worse, graph._replace(edges=(*graph.edges, *frames), environment=around)


def scene(plan: System, graph: System) -> Scene:
    return make_scene(plan, graph, check(plan, graph))
