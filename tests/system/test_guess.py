# SPDX-License-Identifier: Apache-2.0
"""Which robots a graph shows, which nodes only copy a tree, what the variables of discovery hide."""

from __future__ import annotations

import pytest
from graph_calls import GuessedRobot, guess_robots

from multibot_rewrite.system.environment import setting_caveats
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    End,
    Node,
    Robot,
    System,
    edge_of,
)
from multibot_rewrite.system.tf_copies import copying_nodes


def end(node: str, role: str, name: str) -> End:
    return End(TOPIC, role, name, "", "", node, None, "")


@pytest.mark.parametrize(
    ("frames", "robots"),
    [
        ("a/base_link b/base_link a/odom", [("a", "a/", ""), ("b", "b/", "")]),
        ("base_link_a base_link_b", [("a", "", "_a"), ("b", "", "_b")]),
        # The way that most words are written in; one word alone may be a part.
        ("a/odom b/odom c/odom odom_x odom_y", [("a", "a/", ""), ("b", "b/", ""), ("c", "c/", "")]),
        ("left/base_link", []),
        # What hangs on a frame of another word is a part of it, however far below.
        ("a/base_link b/base_link a/base_link>x x>b/odom", []),
    ],
)
def test_robots_show_by_their_frames(frames: str, robots: list[tuple[str, str, str]]) -> None:
    pairs = (it.split(">") for it in frames.split())
    graph = System(edges=tuple(edge_of(*(["world", *it][-2:])) for it in pairs))
    assert list(guess_robots(graph)) == [
        GuessedRobot(name, "", before, behind, True) for name, before, behind in robots
    ]


def graph(nodes: str, topics: str, frames: str = "") -> System:
    """Frames are ``parent>child``."""
    edges = (edge_of(*it.split(">")) for it in frames.split())
    ends = tuple(end("", PUBLISHES, it) for it in topics.split())
    return System(tuple(Node(it) for it in nodes.split()), ends, tuple(edges))


@pytest.mark.parametrize(
    ("nodes", "topics", "robots"),
    [
        # Two topics of a body, or one of tf, where nodes are.
        ("/a/x /b/x", "/a/odom /a/scan /b/tf", ["a", "b"]),
        ("/a/x /b/x", "/a/odom /b/tf_static", ["b"]),
        ("/a/x", "/a/chatter /a/rosout", []),
        ("/b/x", "/a/odom /a/scan", []),
        ("/a/rviz2", "/a/odom /a/scan", ["a"]),
        ("/a/x", "/odom /scan /tf", []),
        # A recording has no nodes.
        ("", "/a/cmd_vel /a/joint_states", ["a"]),
        ("", "/a/robot_description /a/initialpose", ["a"]),
        # The private names of a node, and parts of a robot.
        ("/a", "/a/odom /a/scan", []),
        ("/front_camera/x", "/front_camera/tf", []),
        ("/Lidar/x", "/Lidar/tf", []),
        ("/cam/bot/x", "/cam/bot/tf", ["bot"]),
        # Inside another one it is none; outside it is, though their names begin alike.
        ("/a/x /a/b/x", "/a/tf /a/b/tf", ["a"]),
        ("/a/x /ab/x", "/a/tf /ab/tf", ["a", "ab"]),
        # Whole where the last words are alike.
        ("/x/a/n /y/a/n /b/n", "/x/a/tf /y/a/tf /b/tf", ["b", "x/a", "y/a"]),
        # Numbered, with two nodes of the same names, whatever they have.
        ("/robot1/x /robot1/y /robot2/x /robot2/y", "/chatter", ["robot1", "robot2"]),
        ("/robot1/x /robot1/y /robot2/x", "/chatter", []),
        ("/robot1/x /robot2/x /front/a /front/b /rear/a /rear/b", "/chatter", []),
        ("/camera1/x /camera1/y /camera2/x /camera2/y", "/chatter", []),
        # Another number: it has just started.
        ("/a1/x /a2/x /b3/x", "/a1/tf", ["a1", "a2"]),
        ("/a1/x /f/a2/x /a2/arm/x", "/a1/tf", ["a1", "a2"]),
        ("/a/x /b/x", "/a/tf", ["a"]),
        # Words behind topics of a body and at the end of nodes.
        ("/n_a /n_b", "/odom/a /cmd_vel/a /odom/b /scan/b", ["a", "b"]),
        ("/n_a /n_b", "/odom/a /cmd_vel/a /odom/b", ["a"]),
        ("/n", "/odom/a /cmd_vel/a", []),
        ("/n_a /n_odom", "/f/odom/a /f/cmd_vel/a /tf/odom /scan/odom", ["a"]),
    ],
)
def test_robots_show_by_their_topics(nodes: str, topics: str, robots: list[str]) -> None:
    assert [it.name for it in guess_robots(graph(nodes, topics))] == robots


@pytest.mark.parametrize(
    ("ends", "copies"),
    [
        ([(SUBSCRIBES, "/a/tf"), (SUBSCRIBES, "/a/tf_static"), (PUBLISHES, "/tf")], True),
        ([(SUBSCRIBES, "/a/tf"), (PUBLISHES, "/tf"), (PUBLISHES, "/tf_static")], True),
        ([(PUBLISHES, "/tf")], False),
        ([(SUBSCRIBES, "/a/tf"), (PUBLISHES, "/tf"), (PUBLISHES, "/a/odom")], False),
        ([(SUBSCRIBES, "/b/tf"), (PUBLISHES, "/tf")], False),
    ],
)
def test_a_relay_does_nothing_but_copy_its_robots_tree(
    ends: list[tuple[str, str]], copies: bool
) -> None:
    plan = System(
        nodes=(Node("/a/relay", "", robot="a"),),
        ends=tuple(end("/a/relay", role, name) for role, name in ends),
        robots=(Robot("a", tf_topic="/a/tf"), Robot("b", tf_topic="/b/tf")),
    )
    assert copying_nodes(plan) == ({"/a/relay": "a"} if copies else {})


@pytest.mark.parametrize(
    ("variables", "codes"),
    [
        ("", []),
        ("ROS_LOCALHOST_ONLY=1", [("localhost-only", False)]),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE=NEAR", [("range-word", False)]),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE=OFF", [("range-off", True)]),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE=SYSTEM_DEFAULT", []),
        (
            "ROS_AUTOMATIC_DISCOVERY_RANGE=SYSTEM_DEFAULT ROS_STATIC_PEERS=10.0.0.1",
            [("peers-unread", True)],
        ),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET ROS_STATIC_PEERS=10.0.0.1", []),
        ("RMW_IMPLEMENTATION=rmw_fast", [("rmw-word", False)]),
        ("RMW_IMPLEMENTATION=rmw_fastrtps_cpp", []),
        ("ROS_DISCOVERY_SERVER=10.0.0.1:11811", [("no-super-client", False)]),
        ("ROS_DISCOVERY_SERVER=10.0.0.1:11811 ROS_SUPER_CLIENT=TRUE", []),
    ],
)
def test_variables_that_hide_something_have_a_caveat(
    variables: str, codes: list[tuple[str, bool]]
) -> None:
    """rcl discovery_options.c, rmw_fastrtps participant.cpp; the flag: is the view incomplete?"""
    given = dict(it.split("=") for it in variables.split())
    assert [(it.code, it.incomplete) for it in setting_caveats(given)] == codes


@pytest.mark.parametrize(
    ("published", "robots"),
    [
        # Nodes of one name in namespaces beside each other, and what a whole robot has, wherever it is.
        ("/r1/base /cmd_vel, /r2/base /cmd_vel, /r1/base /scan, /r2/base /scan", ["r1", "r2"]),
        ("/r1/base /r1/cmd_vel, /r2/base /r2/cmd_vel", ["r1", "r2"]),
        ("/red/base /odom, /blue/base /odom, /red/eye /scan", ["blue", "red"]),
        ("/a/r/base /odom, /b/r/base /odom", ["a", "b"]),
        # One alone, nodes of other names, and what a part has, too.
        ("/r1/base /cmd_vel, /base /cmd_vel", []),
        ("/r1/base /cmd_vel, /r2/teleop /cmd_vel", []),
        ("/front/lidar /scan, /rear/lidar /scan", []),
        ("/left/eye /tf_static, /right/eye /tf_static", []),
        ("/front_wheel/driver /joint_states, /rear_wheel/driver /joint_states", []),
        # What is above the namespace of a robot is a group of them.
        ("/a/r1/base /a/r1/odom, /a/r1/base /a/r1/scan, /b/r1/base /b/r1/odom, /b/r1/base /b/r1/scan",
         ["a/r1", "b/r1"]),
    ],
)  # fmt: skip
def test_robots_of_one_kind_show_by_their_nodes(published: str, robots: list[str]) -> None:
    ends = [end(node, PUBLISHES, name) for node, name in map(str.split, published.split(","))]
    nodes = dict.fromkeys(it.node for it in ends)
    found = guess_robots(System(tuple(map(Node, nodes)), tuple(ends)))
    assert [it.name for it in found] == robots
