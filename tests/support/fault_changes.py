# SPDX-License-Identifier: Apache-2.0
"""What a seeded fault is, the systems that faults are put into, and what can be done to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from graph_cases import moved, qos, reframed, with_qos
from healthy_systems import CLOCK, nav2_with_tools, simulated, with_ends, with_node

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.system.records import SUBSCRIBES, Edge, System

CHANGE_STATE = "lifecycle_msgs/srv/ChangeState"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
STAMPED = "geometry_msgs/msg/TwistStamped"
DESCRIPTION = "std_msgs/msg/String"
LEFT, RIGHT = (f"/{it}_arm/arm_controller/joint_trajectory" for it in ("left", "right"))
LOCAL = "/robot1/local_costmap/local_costmap"
LATCHED, VOLATILE = "TRANSIENT_LOCAL", "VOLATILE"
Change = Callable[[System], System]


class Fault(NamedTuple):
    """``words`` are in the finding of ``code``; ``also`` are codes that may come besides."""

    name: str
    system: Callable[[], System]
    change: Change
    code: str
    words: tuple[str, ...]
    level: str = ERROR
    also: tuple[str, ...] = ()


def nav() -> System:
    return nav2_with_tools("L1")


def shared_tf() -> System:
    return nav2_with_tools("L2")


def simulation() -> System:
    return simulated("robot1", "robot2", "robot3")


def added(node: str, *ends: tuple[str, str, str]) -> Change:
    """Return a node more, or more of a node that is there."""

    def change(graph: System) -> System:
        there = any(it.name == node for it in graph.nodes)
        return (with_ends if there else with_node)(graph, node, *ends)

    return change


def renamed(old: str, new: str, *nodes: str) -> Change:
    """Return a name under another one, of these nodes or of all."""

    def change(graph: System) -> System:
        for node in nodes or ("",):
            graph = moved(graph, old, new, node)
        return graph

    return change


def both(*changes: Change) -> Change:
    def change(graph: System) -> System:
        for one in changes:
            graph = one(graph)
        return graph

    return change


def in_each(old: str, new: str) -> Change:
    """``/robot1/OLD`` and ``/robot2/OLD`` under one name."""
    return both(renamed(f"/robot1/{old}", new), renamed(f"/robot2/{old}", new))


def frame(child: str, parent: str, topic: str, static: bool = False) -> Change:
    """One transform more."""
    return reframed(lambda it: it, Edge(child, parent, topic, static, ()))


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


def twice(graph: System) -> System:
    """Every node of a robot runs twice, as when two robots have no namespace."""
    own = [
        it for it in graph.nodes if not it.name.startswith(("/ros", "/rqt", "/_", "/fox", "/fleet"))
    ]
    return graph._replace(nodes=(*graph.nodes, *own))


def bare_odometry(graph: System) -> System:
    """Return the controllers of both robots send the frames of their defaults."""
    more = Edge("base_footprint", "odom", "/tf", False, ())
    return reframed(lambda it: None if it.child.startswith("base_footprint/") else it, more)(graph)


def prefixed_twice(graph: System) -> System:
    """frame_prefix: robot1/ on top of a description that has the name in front already."""

    def change(it: Edge) -> Edge:
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

    def change(graph: System) -> System:
        kept = (it for it in graph.ends if not (it.name == "/clock" and it.node in nodes))
        return graph._replace(ends=tuple(kept))

    return change


def on_simulated_time(robot: str) -> Change:
    def change(graph: System) -> System:
        for node in [it.name for it in graph.nodes if it.name.startswith(f"/{robot}/")]:
            graph = with_ends(graph, node, (SUBSCRIBES, "/clock", CLOCK))
        return graph

    return change


def of_robot(graph: System, robot: str) -> tuple[str, ...]:
    return tuple(it.name for it in graph.nodes if it.name.startswith(f"/{robot}/"))


def real_among_simulated(graph: System) -> System:
    return without_clock(*of_robot(graph, "robot3"))(graph)
