"""Which robots a graph shows, which nodes only copy a tree, what the variables of discovery hide."""

from __future__ import annotations

import pytest

from multibot_rewrite.system.environment import setting_caveats
from multibot_rewrite.system.guess import GuessedRobot, guess_robots
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
    ],
)
def test_robots_show_by_their_frames(frames: str, robots: list[tuple[str, str, str]]) -> None:
    graph = System(edges=tuple(edge_of("world", it) for it in frames.split()))
    assert list(guess_robots(graph)) == [
        GuessedRobot(name, "", before, behind, True) for name, before, behind in robots
    ]


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


def test_what_joins_the_worlds_goes_with_a_relay() -> None:
    """map -> a/map, sent beside the relay by a node that does nothing else."""
    relay = (end("/a/relay", SUBSCRIBES, "/a/tf"), end("/a/relay", PUBLISHES, "/tf"))
    joins = end("/a/world", PUBLISHES, "/tf_static")
    nodes = (Node("/a/relay", "", robot="a"), Node("/a/world", "", robot="a"))
    robots = (Robot("a", tf_topic="/a/tf"),)
    both = copying_nodes(System(nodes=nodes, ends=(*relay, joins), robots=robots))
    assert both == {"/a/relay": "a", "/a/world": "a"}
    assert copying_nodes(System(nodes=nodes, ends=(joins,), robots=robots)) == {}


def test_where_all_robots_share_one_tree_nothing_copies_it() -> None:
    plan = System(
        nodes=(Node("/a/relay", "", robot="a"),),
        ends=(end("/a/relay", SUBSCRIBES, "/tf"), end("/a/relay", PUBLISHES, "/tf")),
        robots=(Robot("a", tf_topic="/tf"),),
    )
    assert copying_nodes(plan) == {}


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
