# SPDX-License-Identifier: Apache-2.0
"""Two robots of two nodes: their plan, and the graph exactly as planned."""

from __future__ import annotations

from functools import cache

from graph_cases import as_planned, environment, sent, without_node

from multibot_rewrite.base.naming import make_naming, spelled
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.system.records import (
    CHANGING,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    Edge,
    End,
    System,
)

ROBOTS = ("robot1", "robot2")
NODES = (
    NodeFacts(
        "robot_state_publisher",
        "robot_state_publisher",
        (
            Endpoint(TOPIC, PUBLISHES, "/tf", "tf2_msgs/msg/TFMessage"),
            Endpoint(TOPIC, SUBSCRIBES, "joint_states", "sensor_msgs/msg/JointState"),
            Endpoint(TOPIC, PUBLISHES, "/rosout", "rcl_interfaces/msg/Log"),
        ),
    ),
    NodeFacts(
        "driver",
        "driver",
        (
            Endpoint(TOPIC, SUBSCRIBES, "/cmd_vel", "geometry_msgs/msg/Twist"),
            Endpoint(TOPIC, PUBLISHES, "joint_states", "sensor_msgs/msg/JointState"),
            Endpoint(SERVICE, SERVES, "reset", "std_srvs/srv/Trigger"),
            Endpoint(TOPIC, PUBLISHES, "extra", "std_msgs/msg/String", when="debug"),
        ),
    ),
)
LINKS = ("base_link", "laser")


@cache
def plan(layout: str = "L2") -> System:
    naming = make_naming(layout)
    return expect(build_table(ROBOTS, NODES, naming, release=NEWEST_LTS), naming, frames(layout))


def frames(layout: str) -> dict[str, list[str]]:
    naming = make_naming(layout)
    return {robot: [spelled(naming, robot, "frame", link) for link in LINKS] for robot in ROBOTS}


@cache
def healthy(layout: str = "L2") -> System:
    """Return the graph exactly as planned, on odometry."""
    graph = as_planned(plan(layout))
    naming = make_naming(layout)
    odometry = tuple(
        Edge(
            robot.frames[0], spelled(naming, robot.name, "frame", "odom"), robot.tf_topic, False, ()
        )
        for robot in plan(layout).robots
    )
    return sent(graph._replace(edges=(*graph.edges, *odometry)))


ROBOT2 = ("/robot2/driver", "/robot2/robot_state_publisher")


def moving(graph: System) -> System:
    """Return the graph while it changes."""
    around = environment(Caveat("not-settled", True, "the graph is still changing"))
    return graph._replace(environment=around._replace(settled=CHANGING))


def half() -> System:
    """robot2 is not there."""
    graph = healthy()
    for node in ROBOT2:
        graph = without_node(graph, node)
    frames = tuple(frame for frame in graph.edges if "robot2" not in frame.child)
    return graph._replace(edges=frames)


def clash() -> System:
    """Somebody publishes another type on a robot's topic."""
    graph = healthy()
    end = End(
        TOPIC, PUBLISHES, "/robot1/cmd_vel", "std_msgs/msg/Empty", "", "/robot1/driver", None, ""
    )
    return graph._replace(ends=(*graph.ends, end))
