# SPDX-License-Identifier: Apache-2.0
"""The comparison of plan and graph: a healthy fleet is silent, each seeded fault is named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest
from graph_calls import ABSENCE, RULES, check, name_ownership
from graph_cases import (
    moved,
    qos,
    with_node,
    with_qos,
    without_node,
)
from plans import from_plugin, more, planned_end
from small_fleet import LINKS, NODES, healthy, plan

from multibot_rewrite.base.naming import make_naming, spelled
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    System,
)

TF = "tf2_msgs/msg/TFMessage"


def codes(graph: System, layout: str = "L2") -> list[str]:
    return sorted({finding.code for finding in check(plan(layout), graph)})


# ---------------------------------------------------------------- names


def test_a_node_started_without_its_name_has_that_cause() -> None:
    graph = without_node(healthy("L4"), "/driver_robot1")
    graph = graph._replace(nodes=(*graph.nodes, Node("/driver", "x")))
    (found,) = check(plan("L4"), graph)
    assert found.hint == (
        "/driver is running: it was started without the robot's name; "
        "use --ros-args -r __node:=driver_robot1"
    )


# ---------------------------------------------------------------- tf


def edges(change: Callable[[Sequence[Edge]], Sequence[Edge]], layout: str = "L2") -> list[str]:
    graph = healthy(layout)
    return codes(graph._replace(edges=tuple(change(graph.edges))), layout)


def test_a_chain_through_frames_of_nobody_is_one_tree() -> None:
    """TurtleBot 4: static transforms between the frames of the controller and the bare ones."""

    def relayed(frames: Sequence[Edge]) -> Sequence[Edge]:
        odom, *rest = frames
        names = (odom.parent, "own/odom", "own/base", odom.child)
        return [
            *(odom._replace(parent=a, child=b) for a, b in pairwise(names)),
            *rest,
        ]

    assert "MG406" not in edges(relayed, "L1")
    assert "MG406" in edges(lambda f: [*relayed(f)[:1], *relayed(f)[2:]], "L1")


# ---------------------------------------------------------------- an incomplete view


def test_what_an_incomplete_view_cannot_prove() -> None:
    missing = {"MG101", "MG102", "MG109", "MG303", "MG406", "MG207"}
    assert missing <= ABSENCE < RULES.keys()
    assert {"MG310", "MG311", "MG320", "MG301"}.isdisjoint(ABSENCE)


# ---------------------------------------------------------------- causes


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ("robots/rover.urdf:7", ("robots/rover.urdf", 7)),
        ("C:/rover.urdf:7", ("C:/rover.urdf", 7)),
        ("the launch file", ("", 0)),
        ("rover.urdf", ("", 0)),
        ("rover.urdf:" + "9" * 5000, ("", 0)),
    ],
)
def test_the_place_of_a_plan_may_be_written_by_hand(place: str, expected: tuple[str, int]) -> None:
    graph = moved(healthy(), "/robot1/cmd_vel", "/cmd_vel")
    (found,) = check(from_plugin(plan(), "/robot1/driver", place), graph)
    assert (found.file, found.line) == expected
    assert found.hint.endswith(f"see {place}")


# ---------------------------------------------------------------- what nobody planned


def test_one_more_of_a_planned_node_is_called_that() -> None:
    (found,) = check(plan(), with_node(healthy(), "/driver"))
    assert (found.code, found.robot) == ("MG108", "")
    assert "a second one" in found.hint


# ---------------------------------------------------------------- types


@pytest.mark.parametrize(
    ("hashes", "clash"),
    [
        (("RIHS01_aa", "RIHS01_bb"), True),
        (("RIHS01_aa", "RIHS01_aa"), False),
        (("RIHS01_aa", ""), False),
        (("INVALID", "RIHS01_aa"), False),
    ],
)
def test_two_versions_of_a_message(hashes: tuple[str, str], clash: bool) -> None:
    offered, asked = hashes
    ends = tuple(
        e._replace(type_hash=offered if e.role == PUBLISHES else asked)
        if e.name == "/robot1/joint_states"
        else e
        for e in healthy().ends
    )
    found = check(plan(), healthy()._replace(ends=ends))
    assert [f.code for f in found] == (["MG306"] if clash else [])
    assert all("another version of sensor_msgs/msg/JointState" in f.message for f in found)


# ---------------------------------------------------------------- QoS


@pytest.mark.parametrize(
    ("offered", "asked", "words"),
    [
        ({"deadline": 1.0}, {"deadline": 0.5}, "a deadline of 1 s"),
        ({}, {"deadline": 0.5}, "no deadline"),
        ({"deadline": 0.5}, {"deadline": 0.5}, ""),
        ({"deadline": 0.1}, {"deadline": 0.5}, ""),
        ({"deadline": 0.5}, {}, ""),
        ({"deadline": 0.0}, {"deadline": 0.5}, "no deadline"),
        ({"deadline": 1.0}, {"deadline": 0.0}, ""),
        ({}, {"liveliness": "MANUAL_BY_TOPIC"}, "offers AUTOMATIC"),
        ({"liveliness": "MANUAL_BY_TOPIC"}, {}, ""),
        ({}, {"liveliness": "MANUAL_BY_NODE"}, "offers AUTOMATIC"),
        ({"liveliness": "MANUAL_BY_NODE"}, {"liveliness": "MANUAL_BY_TOPIC"}, "MANUAL_BY_NODE"),
        ({}, {"liveliness": "UNKNOWN"}, ""),
        ({"liveliness_lease_duration": 2.0}, {"liveliness_lease_duration": 1.0}, "a lease of 2 s"),
        ({"liveliness_lease_duration": 1.0}, {"liveliness_lease_duration": 2.0}, ""),
        ({"reliability": "BEST_EFFORT"}, {"reliability": "RELIABLE"}, "BEST_EFFORT"),
        ({"reliability": "RELIABLE"}, {"reliability": "BEST_EFFORT"}, ""),
        ({"durability": "VOLATILE"}, {"durability": "TRANSIENT_LOCAL"}, "VOLATILE"),
        ({"durability": "TRANSIENT_LOCAL"}, {"durability": "VOLATILE"}, ""),
        ({"reliability": "SYSTEM_DEFAULT"}, {"reliability": "RELIABLE"}, ""),
        ({"reliability": "BEST_EFFORT"}, {"reliability": "BEST_AVAILABLE"}, ""),
        ({"durability": "UNKNOWN"}, {"durability": "TRANSIENT_LOCAL"}, ""),
        ({"history": "KEEP_LAST", "depth": 1}, {"history": "KEEP_ALL"}, ""),
        ({"lifespan": 1.0}, {"lifespan": 0.5}, ""),
    ],
)
def test_what_dds_connects(
    offered: dict[str, object], asked: dict[str, object], words: str
) -> None:
    graph = with_qos(healthy(), "/robot1/joint_states", qos(**offered), qos(**asked))
    found = check(plan(), graph)
    assert [f.code for f in found] == (["MG307"] if words else [])
    assert all(words in f.message for f in found)


def test_many_publishers_are_one_finding_for_a_listener() -> None:
    graph = with_qos(healthy(), "/robot1/joint_states", qos(), qos(durability="TRANSIENT_LOCAL"))
    driver = next(e for e in graph.ends if e.name == "/robot1/joint_states" and e.qos == qos())
    more = tuple(driver._replace(node=f"/robot1/_more{at}") for at in range(5))
    (found,) = check(plan(), graph._replace(ends=(*graph.ends, *more)))
    assert "_more0, /robot1/_more1, /robot1/_more2 and 3 more offers VOLATILE" in found.message


# ---------------------------------------------------------------- below its own namespace

SCAN = "sensor_msgs/msg/LaserScan"
COSTMAP = "/robot1/local_costmap/local_costmap"


def with_costmap(*names: str, published: str = "/robot1/scan") -> tuple[System, System]:
    """Return a planned costmap that hears these, and somebody who publishes."""
    wanted = more(plan(), "robot1", COSTMAP)
    graph = with_node(healthy(), COSTMAP, *((SUBSCRIBES, name, SCAN) for name in names))
    end = End(TOPIC, PUBLISHES, published, SCAN, "", "/robot1/driver", None, "")
    return wanted, graph._replace(ends=(*graph.ends, end))


def test_a_topic_that_is_planned_above_is_enough() -> None:
    wanted, graph = with_costmap("/robot1/local_costmap/scan", published="/robot1/other")
    (other,) = check(wanted, graph)
    assert (other.code, other.level, other.names[1]) == ("MG303", "error", "/robot1/other")
    end = planned_end(COSTMAP, TOPIC, SUBSCRIBES, "/robot1/scan", SCAN, "/scan")
    found = check(wanted._replace(ends=(*wanted.ends, end)), graph)
    assert [f.code for f in found] == ["MG303"]
    assert "resolves a relative name in its own namespace" in found[0].hint


# ---------------------------------------------------------------- tf, layout by layout


@pytest.mark.parametrize("layout", ["L3", "L4"])
def test_what_is_meant_to_be_on_the_tf_of_another_is_silent(layout: str) -> None:
    """Where one robot sees the other, what a node brings there that hears it, and what the plan has."""
    wanted, graph = plan(layout), healthy(layout)
    (own, odd) = (it.tf_topic for it in wanted.robots)
    seen = Edge("base_link/robot1", "laser/robot2", odd)
    assert check(wanted, graph._replace(edges=(*graph.edges, seen))) == []
    copies = [it._replace(topic=odd) for it in graph.edges if it.topic == own]
    both = graph._replace(edges=(*graph.edges, *copies))
    assert {it.code for it in check(wanted, both)} == {"MG405"}
    relay = with_node(both, "/relay", (SUBSCRIBES, own, TF), (PUBLISHES, odd, TF))
    assert {it.code for it in check(wanted, relay)} == {"MG108"}
    node = next(it.name for it in wanted.nodes if it.robot == "robot1")
    meant = wanted._replace(ends=(*wanted.ends, planned_end(node, TOPIC, PUBLISHES, odd, TF)))
    sends = with_node(both, node, (PUBLISHES, odd, TF))
    assert "MG405" not in {it.code for it in check(meant, sends)}


@pytest.mark.parametrize(
    ("layout", "name"),
    [
        ("L1", "robot1/laser"), ("L1", "robot1/odom"), ("L1", "robot1_laser"),
        ("L2", "robot1/laser/robot1"), ("L2", "robot1/robot1/laser"), ("L2", "laser/robot1/robot1"),
        ("L2", "robot1laser/robot1"), ("L2", "robot1/odom/robot1"), ("L3", "robot1/laser/robot1"),
        ("L4", "robot1_laser/robot1"),
    ],
)  # fmt: skip
def test_a_name_put_in_twice(layout: str, name: str) -> None:
    graph = healthy(layout)
    edge = next(f for f in graph.edges if f.static)
    found = check(plan(layout), graph._replace(edges=(*graph.edges, edge._replace(child=name))))
    assert [(f.code, f.robot, f.names) for f in found] == [("MG407", "robot1", (name,))]
    assert "prefix" in found[0].hint


def test_a_tf_listener_that_no_rule_reached() -> None:
    node = "/robot1/transform_listener_impl_55e1"
    heard = (SUBSCRIBES, "/tf", "tf2_msgs/msg/TFMessage")
    (found,) = check(plan("L1"), with_node(healthy("L1"), node, heard))
    assert (found.code, found.node) == ("MG405", node)
    assert "whole process" in found.hint
    assert check(plan(), with_node(healthy(), node, heard)) == []


# ---------------------------------------------------------------- size


def robots_called(*names: str, layout: str = "L2") -> System:
    naming = make_naming(layout)
    declared = {name: [spelled(naming, name, "frame", link) for link in LINKS] for name in names}
    return expect(build_table(names, NODES, naming, release=NEWEST_LTS), naming, declared)


@pytest.mark.parametrize(
    ("robots", "layout", "name", "robot"),
    [
        (("arm", "arm_left"), "L2", "/arm_left/x", "arm_left"),
        (("arm", "arm_left"), "L2", "/arm/left", "arm"),
        (("arm", "arm_left"), "L4", "/x/arm_left", "arm_left"),
        (("arm", "arm_left"), "L4", "/gripper_arm_left", "arm_left"),
        (("arm", "arm_left"), "L4", "/gripper_arm", "arm"),
        (("robot1", "joint_states"), "L2", "/robot1/joint_states", "robot1"),
        (("robot1", "joint_states"), "L2", "/joint_states", ""),
        (("robot1", "joint_states"), "L2", "/robot1/more/joint_states", "robot1"),
        (("robot1", "joint_states"), "L2", "/joint_states/scan", "joint_states"),
        (("robot1", "joint_states"), "L4", "/joint_states/robot1", "robot1"),
        (("robot1", "joint_states"), "L4", "/joint_states/more/robot1", "robot1"),
        (("robot1", "joint_states"), "L4", "/joint_states/compressed", ""),
        (("robot1", "robot10"), "L2", "/robot10/x", "robot10"),
        (("robot1", "robot2"), "L2", "/driver_robot1/x", "robot1"),
        (("robot1", "robot2"), "L2", "/robot1", ""),
    ],
)
def test_which_robot_a_name_belongs_to(
    robots: tuple[str, ...], layout: str, name: str, robot: str
) -> None:
    assert name_ownership(robots_called(*robots, layout=layout)).robot(name) == robot
