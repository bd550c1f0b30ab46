"""The comparison of plan and graph: a healthy fleet is silent, each seeded fault is named."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import pytest

from multibot_rewrite.graph.check import ABSENCE, RULES, check
from multibot_rewrite.graph.comparison import INCONCLUSIVE, owner
from multibot_rewrite.graph.expectation import Expectation, expect
from multibot_rewrite.graph.snapshot import (
    Caveat,
    Environment,
    Frame,
    GraphEndpoint,
    GraphNode,
    Qos,
    Snapshot,
)
from multibot_rewrite.naming import make_naming
from multibot_rewrite.remap.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    NodeFacts,
)
from multibot_rewrite.remap.table import build_table

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
LAYOUTS = ("L1", "L2", "L3", "L4")


def plan(layout: str = "L2") -> Expectation:
    naming = make_naming(layout)
    return expect(build_table(ROBOTS, NODES, naming), naming, frames(layout))


def frames(layout: str) -> dict[str, tuple[str, ...]]:
    bare = layout == "L1"
    return {r: tuple(link if bare else f"{link}/{r}" for link in LINKS) for r in ROBOTS}


def healthy(layout: str = "L2") -> Snapshot:
    """The graph exactly as planned."""
    wanted = plan(layout)
    endpoints = [
        GraphEndpoint(w.kind, w.role, w.name, w.type, "", w.node, None, "")
        for w in wanted.endpoints
    ]
    nodes = [GraphNode(node, node) for robot in wanted.robots for node in robot.nodes]
    edges = [
        edge
        for robot in wanted.robots
        for edge in (
            Frame(robot.frames[0], odom(layout, robot.name), robot.tf, False, ()),
            Frame(
                robot.frames[1], robot.frames[0], f"{robot.tf}".replace("tf", "tf_static"), True, ()
            ),
        )
    ]
    return Snapshot(tuple(nodes), tuple(endpoints), tuple(edges), environment())


def odom(layout: str, robot: str) -> str:
    return "odom" if layout == "L1" else f"odom/{robot}"


def environment(*caveats: Caveat) -> Environment:
    return Environment(0, "LOCALHOST", (), "rmw_fastrtps_cpp", "", False, 4, "quiet", 3.5, caveats)


def moved(graph: Snapshot, old: str, new: str, node: str = "") -> Snapshot:
    """The graph with one name under another one."""
    return graph._replace(
        endpoints=tuple(
            e._replace(name=new) if e.name == old and e.node.endswith(node) else e
            for e in graph.endpoints
        )
    )


def without_node(graph: Snapshot, node: str) -> Snapshot:
    return graph._replace(
        nodes=tuple(n for n in graph.nodes if n.name != node),
        endpoints=tuple(e for e in graph.endpoints if e.node != node),
    )


def codes(graph: Snapshot, layout: str = "L2") -> list[str]:
    return sorted({finding.code for finding in check(plan(layout), graph)})


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_healthy_fleet_is_silent(layout: str) -> None:
    assert check(plan(layout), healthy(layout)) == []


# ---------------------------------------------------------------- names


def test_a_node_that_is_not_there() -> None:
    (found,) = check(plan(), without_node(healthy(), "/robot2/driver"))
    assert (found.code, found.robot, found.node) == ("MG101", "robot2", "/robot2/driver")


def test_a_node_started_without_its_namespace_is_told_so() -> None:
    graph = without_node(healthy(), "/robot1/driver")
    graph = graph._replace(nodes=(*graph.nodes, GraphNode("/driver", "x")))
    (found,) = check(plan(), graph)
    assert found.code == "MG101"
    assert found.cause == (
        "/driver is there: it was started without the robot's namespace; give namespace='robot1' "
        "in the launch file, or --ros-args -r __ns:=/robot1"
    )


def test_a_silent_robot_is_one_finding() -> None:
    graph = healthy()
    for node in ("/robot1/driver", "/robot1/robot_state_publisher"):
        graph = without_node(graph, node)
    found = [f for f in check(plan(), graph) if f.code != "MG203"]
    assert [(f.code, f.robot) for f in found] == [("MG109", "robot1")]


def test_why_we_never_get_cmd_vel() -> None:
    found = check(plan(), moved(healthy(), "/robot1/cmd_vel", "/cmd_vel"))
    assert [(f.code, f.node) for f in found] == [
        ("MG102", "/robot1/driver"),
        ("MG103", "/robot1/driver"),
    ]
    assert "/robot1/cmd_vel" in found[0].message
    assert found[0].cause == (
        "it subscribes /cmd_vel instead: its rule /cmd_vel:=cmd_vel did not reach it; give "
        "--ros-args -r /cmd_vel:=cmd_vel, or remappings=[('/cmd_vel', 'cmd_vel')]"
    )


def test_a_name_spelled_wrongly_is_called_the_nearest() -> None:
    found = check(plan(), moved(healthy(), "/robot1/joint_states", "/robot1/joint_state", "driver"))
    assert found[0].cause == (
        "it publishes /robot1/joint_state instead: a rule or parameter spells it otherwise"
    )


def test_one_robot_listening_to_another() -> None:
    found = check(plan(), moved(healthy(), "/robot1/cmd_vel", "/robot2/cmd_vel"))
    assert ("MG104", "/robot1/driver") in [(f.code, f.node) for f in found]


def test_what_hangs_on_a_parameter_is_not_missed() -> None:
    assert not [w for w in plan().endpoints if w.asked == "extra"]


def test_two_nodes_of_one_name() -> None:
    graph = healthy()
    twice = graph._replace(nodes=(*graph.nodes, GraphNode("/robot1/driver", "other")))
    (found,) = check(plan(), twice)
    assert (found.code, found.robot) == ("MG105", "robot1")


def test_two_types_of_one_topic() -> None:
    graph = healthy()
    first = next(e for e in graph.endpoints if e.name == "/robot1/joint_states")
    other = first._replace(type="std_msgs/msg/String", node="/robot1/driver")
    (found,) = check(plan(), graph._replace(endpoints=(*graph.endpoints, other)))
    assert found.code == "MG106"
    assert "/robot1/driver subscribes std_msgs/msg/String" in found.message


def qos(reliability: str, durability: str = "VOLATILE") -> Qos:
    lease = math.inf
    return Qos("UNKNOWN", 0, reliability, durability, lease, lease, "AUTOMATIC", lease)


@pytest.mark.parametrize(
    ("offered", "wanted", "clash"),
    [
        (qos("RELIABLE"), qos("RELIABLE"), False),
        (qos("RELIABLE"), qos("BEST_EFFORT"), False),
        (qos("BEST_EFFORT"), qos("RELIABLE"), True),
        (qos("RELIABLE", "VOLATILE"), qos("RELIABLE", "TRANSIENT_LOCAL"), True),
        (None, qos("RELIABLE"), False),
    ],
)
def test_qos_that_cannot_connect(offered: Qos | None, wanted: Qos | None, clash: bool) -> None:
    graph = healthy()
    ends = tuple(
        e._replace(qos=offered if e.role == PUBLISHES else wanted)
        if e.name == "/robot1/joint_states"
        else e
        for e in graph.endpoints
    )
    assert codes(graph._replace(endpoints=ends)) == (["MG107"] if clash else [])


# ---------------------------------------------------------------- tf


def edges(change: Callable[[Sequence[Frame]], Sequence[Frame]], layout: str = "L2") -> list[str]:
    graph = healthy(layout)
    return codes(graph._replace(frames=tuple(change(graph.frames))), layout)


def test_a_frame_with_two_parents() -> None:
    assert edges(lambda f: [*f, f[1]._replace(parent="map")]) == ["MG201", "MG203"]


def test_a_torn_tree() -> None:
    assert edges(lambda f: [f[0], f[1]._replace(parent="base_link"), *f[2:]]) == ["MG203"]


def test_a_frame_that_nobody_declares() -> None:
    assert edges(lambda f: [*f, f[1]._replace(child="gripper/robot1")]) == ["MG204"]


def test_a_doubled_prefix_is_called_that() -> None:
    graph = healthy()
    doubled = graph.frames[1]._replace(child="robot1/laser/robot1")
    found = check(plan(), graph._replace(frames=(*graph.frames, doubled)))
    assert [f.code for f in found] == ["MG206"]
    assert "frame_prefix" in found[0].cause


def test_tf_on_the_wrong_topic_for_the_layout() -> None:
    wrong = edges(lambda f: [f[0]._replace(topic="/tf"), *f[1:]], "L3")
    assert "MG205" in wrong


# ---------------------------------------------------------------- an incomplete view


def test_nothing_is_called_missing_in_an_incomplete_view() -> None:
    graph = without_node(healthy(), "/robot2/driver")
    cut = Caveat("participants", True, "the view may be cut off at 32 participants")
    found = check(plan(), graph._replace(environment=environment(cut)))
    assert [(f.code, f.level) for f in found] == [("MG101", INCONCLUSIVE)]


def test_a_leak_stays_a_leak_in_an_incomplete_view() -> None:
    cut = Caveat("participants", True, "cut off")
    graph = moved(healthy(), "/robot1/cmd_vel", "/cmd_vel")._replace(environment=environment(cut))
    levels = {f.code: f.level for f in check(plan(), graph)}
    assert levels == {"MG102": INCONCLUSIVE, "MG103": "error"}


def test_absence_codes_are_codes_of_rules() -> None:
    source = "".join(rule.__module__ for rule in RULES)
    assert source
    assert len(set(ABSENCE)) == len(ABSENCE)


# ---------------------------------------------------------------- whose a name is


@pytest.mark.parametrize(
    ("name", "robot"),
    [
        ("/robot1/cmd_vel", "robot1"),
        ("/cmd_vel/robot2", "robot2"),
        ("/driver_robot1/get_parameters", "robot1"),
        ("/robot2_driver/x", "robot2"),
        ("/cmd_vel", ""),
        ("/robot10/cmd_vel", ""),
    ],
)
def test_the_owner_of_a_name(name: str, robot: str) -> None:
    assert owner(name, plan()) == robot
