# SPDX-License-Identifier: Apache-2.0
"""The comparison of plan and graph: a healthy fleet is silent, each seeded fault is named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest
from graph_calls import ABSENCE, RULES, check, name_ownership
from graph_cases import (
    environment,
    global_tf,
    moved,
    qos,
    renamed_node,
    sent,
    with_node,
    with_qos,
    with_type,
    without_node,
)
from plans import from_plugin, more, own, planned_end, told, without
from small_fleet import LINKS, NODES, ROBOTS, healthy, plan

from multibot_rewrite.base.naming import make_naming, spelled
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.spelling.plan import expect
from multibot_rewrite.spelling.table import build_table
from multibot_rewrite.system.records import (
    MAY,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    Edge,
    End,
    Node,
    System,
)

TF = "tf2_msgs/msg/TFMessage"
LAYOUTS = ("L1", "L2", "L3", "L4")


def codes(graph: System, layout: str = "L2") -> list[str]:
    return sorted({finding.code for finding in check(plan(layout), graph)})


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_healthy_fleet_is_silent(layout: str) -> None:
    assert check(plan(layout), healthy(layout)) == []


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


def test_a_plugin_is_named_with_its_line() -> None:
    graph = moved(healthy(), "/robot1/cmd_vel", "/cmd_vel")
    (found,) = check(from_plugin(plan(), "/robot1/driver", "rover.urdf:120"), graph)
    assert found.hint == (
        "it subscribes to /cmd_vel instead: no remap rule /cmd_vel:=cmd_vel of plugin driver is "
        "applied, see rover.urdf:120"
    )
    assert (found.file, found.line) == ("rover.urdf", 120)
    assert str(found).startswith("/robot1/driver: error: MG310 should subscribe to ")


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


def test_a_finding_with_another_cause_has_no_line() -> None:
    wanted = from_plugin(plan(), "/robot1/driver", "rover.urdf:120")
    found = check(wanted, moved(healthy(), "/robot1/joint_states", "/robot1/joint_state", "driver"))
    assert {it.file for it in found} == {""}
    cut = Caveat("participants", True, "cut off")
    graph = moved(healthy(), "/robot1/cmd_vel", "/cmd_vel")._replace(environment=environment(cut))
    (sure,) = check(wanted, graph)
    assert (sure.level, sure.file) == ("error", "rover.urdf")


def test_a_plugin_without_a_namespace_is_named_with_its_line() -> None:
    graph = renamed_node(healthy(), "/robot1/driver", "/driver")
    wanted = from_plugin(plan(), "/robot1/driver", "rover.urdf:120")
    (found,) = check(wanted, graph)
    assert found.hint == "/driver is running: plugin driver has no namespace, see rover.urdf:120"
    assert (found.file, found.line) == ("rover.urdf", 120)
    (found,) = check(wanted, without_node(healthy(), "/robot1/driver"))
    assert "see rover.urdf:120" in found.hint
    assert (found.file, found.line) == ("rover.urdf", 120)


def test_a_silent_robot_of_plugins_names_the_line_too() -> None:
    graph = healthy()
    for node in ("driver", "robot_state_publisher"):
        graph = renamed_node(graph, f"/robot1/{node}", f"/{node}")
    wanted = from_plugin(plan(), "/robot1/robot_state_publisher", "rover.urdf:120")
    (found,) = check(wanted, graph)
    assert (found.code, found.robot) == ("MG109", "robot1")
    assert "has no namespace, see rover.urdf:120; the same for 1 more of its nodes" in found.hint
    assert (found.file, found.line) == ("rover.urdf", 120)


def test_a_robot_of_conditions_only_is_never_silent() -> None:
    wanted = told(plan(), *own(plan(), "robot1"), sure=MAY)
    graph = without_node(healthy(), "/robot1/driver")
    assert check(wanted, without_node(graph, "/robot1/robot_state_publisher")) == []


def test_a_plugin_of_the_postfix_layout() -> None:
    wanted = from_plugin(plan("L4"), "/driver_robot1", "rover.urdf:120")
    (found,) = check(wanted, renamed_node(healthy("L4"), "/driver_robot1", "/driver"))
    assert found.code == "MG101"
    assert "plugin driver has no separate name for each robot, see rover.urdf:120" in found.hint


def test_an_action_needs_more_than_one_rule() -> None:
    end = planned_end("/robot1/driver", "action", "serves", "/robot1/go", "a/action/B", "/go")
    wanted = plan()._replace(ends=(*plan().ends, end))
    there = End("action", "serves", "/go", "a/action/B", "", end.node, None, "")
    hidden = there._replace(
        kind="service", name="/go/_action/send_goal", type="a/action/B_SendGoal"
    )
    graph = healthy()._replace(ends=(*healthy().ends, there, hidden))
    found = check(wanted, graph)
    assert [f.code for f in found] == ["MG305"]
    assert "one rule for each of its _action/ names" in found[0].hint


def test_a_robot_under_another_namespace() -> None:
    graph = healthy()
    for node in ("driver", "robot_state_publisher"):
        graph = renamed_node(graph, f"/robot1/{node}", f"/robot_1/{node}")
    found = [f for f in check(plan(), graph) if f.code != "MG406"]
    assert [f.code for f in found] == ["MG109"]
    assert "/robot_1/robot_state_publisher is running" in found[0].hint


# ---------------------------------------------------------------- what nobody planned


def test_one_more_of_a_planned_node_is_called_that() -> None:
    (found,) = check(plan(), with_node(healthy(), "/driver"))
    assert (found.code, found.robot) == ("MG108", "")
    assert "a second one" in found.hint


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "node",
    [
        "/_ros2cli_daemon_0_1234", "/launch_ros_4711", "/robot1/transform_listener_impl_55e1",
        "/transform_listener_impl_55e1", "/rqt_gui_py_node_1", "/rviz2", "/robot1/rviz",
        "/rosbag2_recorder", "/foxglove_bridge", "/ros_gz_bridge", "/robot1/_hidden", "/gazebo",
        "/teleop_twist_keyboard", "/teleop_twist_joy_node", "/joy_node",
        "/robot1/bt_navigator_navigate_to_pose_rclcpp_node", "/robot1/spawner_diff_drive",
    ],
)  # fmt: skip
def test_tools_are_no_surprise(node: str) -> None:
    assert check(plan(), with_node(healthy(), node)) == []
    twice = with_node(with_node(healthy(), node), node)
    assert check(plan(), twice) == []


def test_a_tool_may_be_the_planned_one_without_its_namespace() -> None:
    wanted = more(plan(), "robot1", "/robot1/joy_node")
    (found,) = check(wanted, with_node(healthy(), "/joy_node"))
    assert (found.code, found.node) == ("MG101", "/robot1/joy_node")
    assert found.hint.startswith("/joy_node is running")
    twice = with_node(with_node(healthy(), "/robot1/joy_node"), "/robot1/joy_node")
    assert [f.code for f in check(wanted, twice)] == ["MG301"]


def test_a_plan_of_nothing_finds_nothing_unplanned() -> None:
    assert check(plan()._replace(nodes=(), ends=()), healthy()) == []


def test_a_robot_without_planned_nodes_may_have_any() -> None:
    first = own(plan(), "robot1")
    some = without(plan(), "robot2")._replace(
        ends=tuple(w for w in plan().ends if w.node in first),
    )
    assert check(some, healthy()) == []


def test_a_node_under_a_condition_is_not_missed() -> None:
    wanted = told(plan(), "/robot1/driver", sure=MAY)
    assert check(wanted, without_node(healthy(), "/robot1/driver")) == []
    graph = renamed_node(healthy(), "/robot1/driver", "/driver")
    assert [f.code for f in check(wanted, graph)] == ["MG101"]


# ---------------------------------------------------------------- types


def test_a_sender_of_a_type_that_no_reader_takes() -> None:
    """Beside one that all of them hear."""
    topic, odd = "/robot1/joint_states", (PUBLISHES, "/robot1/joint_states", SCAN)
    (found,) = [it for it in check(plan(), with_node(healthy(), "/odd", odd)) if it.code == "MG306"]
    assert (found.node, found.names) == ("/odd", (topic,))


def test_a_type_that_it_may_have_as_well() -> None:
    stamped = "geometry_msgs/msg/TwistStamped"
    ends = tuple(
        w._replace(also=(stamped,)) if w.name == "/robot1/cmd_vel" else w for w in plan().ends
    )
    graph = with_type(healthy(), "/robot1/cmd_vel", "/robot1/driver", stamped)
    assert check(plan()._replace(ends=ends), graph) == []


def test_a_service_and_a_topic_of_one_name_are_no_clash() -> None:
    end = End(
        SERVICE,
        SERVES,
        "/robot1/joint_states",
        "std_srvs/srv/Empty",
        "",
        "/robot1/driver",
        None,
        "",
    )
    assert check(plan(), healthy()._replace(ends=(*healthy().ends, end))) == []


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


# ---------------------------------------------------------------- nobody on the other side


def test_a_teleop_without_a_robot_is_reported_for_each() -> None:
    twist = (PUBLISHES, "/cmd_vel", "geometry_msgs/msg/Twist")
    found = check(plan(), with_node(healthy(), "/teleop_twist_keyboard", twist))
    assert [(f.code, f.node) for f in found] == [
        ("MG303", "/robot1/driver"),
        ("MG303", "/robot2/driver"),
    ]
    assert found[0].message == (
        "subscribes to /robot1/cmd_vel, which no node publishes; /teleop_twist_keyboard publishes "
        "/cmd_vel"
    )
    assert "/cmd_vel:=/robot1/cmd_vel" in found[0].hint


def test_a_teleop_of_one_robot_is_no_fault_of_the_other() -> None:
    twist = (PUBLISHES, "/robot2/cmd_vel", "geometry_msgs/msg/Twist")
    assert check(plan(), with_node(healthy(), "/teleop_twist_keyboard", twist)) == []


def with_pilot(name: str) -> tuple[System, System]:
    """A planned pilot of robot1 that is not there, and one that is, with another topic."""
    end = planned_end("/robot1/pilot", TOPIC, PUBLISHES, "/robot1/cmd_vel", "", "cmd_vel")
    wanted = more(plan(), "robot1", "/robot1/pilot")._replace(ends=(*plan().ends, end))
    twist = (PUBLISHES, name, "geometry_msgs/msg/Twist")
    return wanted, with_node(healthy(), "/robot1/controller_server", twist)


@pytest.mark.parametrize(("name", "code"), [("/robot2/cmd_vel", "MG311"), ("/cmd_vel", "MG303")])
def test_a_publisher_of_nearly_that_name(name: str, code: str) -> None:
    wanted, graph = with_pilot(name)
    said = [f for f in check(plan(), graph) if f.code == code]
    assert any(name in f.message for f in said)
    # Where the pilot is planned, it is what is missing.
    assert "/robot1/pilot" in {f.node for f in check(wanted, graph) if f.code == "MG101"}


# ---------------------------------------------------------------- below its own namespace

SCAN = "sensor_msgs/msg/LaserScan"
COSTMAP = "/robot1/local_costmap/local_costmap"


def with_costmap(*names: str, published: str = "/robot1/scan") -> tuple[System, System]:
    """A planned costmap that hears these, and somebody who publishes."""
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


def test_a_planned_name_below_a_namespace_of_another_node_is_meant_so() -> None:
    arm = "/robot1/arm/controller"
    end = planned_end(arm, TOPIC, SUBSCRIBES, "/robot1/arm/joint_states", "", "joint_states")
    wanted = more(plan(), "robot1", arm)._replace(ends=(*plan().ends, end))
    graph = with_node(healthy(), arm, (SUBSCRIBES, "/robot1/arm/joint_states", ""))
    assert check(wanted, graph) == []


@pytest.mark.parametrize(
    ("names", "published"),
    [
        (["/robot1/scan"], "/robot1/scan"),
        (["/robot1/local_costmap/scan"], "/robot1/local_costmap/scan"),
        (["/robot1/local_costmap/footprint"], "/robot1/scan"),
    ],
)
def test_a_costmap_that_hears_is_silent(names: list[str], published: str) -> None:
    assert check(*with_costmap(*names, published=published)) == []


# ---------------------------------------------------------------- tf, layout by layout


def test_bare_frames_of_one_robot_on_the_global_topic() -> None:
    found = [f for f in check(plan("L1"), global_tf(healthy("L1"), "robot1")) if f.code > "MG2"]
    assert [(f.code, f.robot) for f in found] == [("MG405", "robot1")]


def test_a_node_of_one_robot_on_the_tf_of_another() -> None:
    graph = moved(healthy("L1"), "/robot2/tf", "/robot1/tf", "robot_state_publisher")
    found = [f for f in check(plan("L1"), graph) if f.code == "MG405"]
    assert [(f.robot, f.names) for f in found] == [("robot2", ("/robot1/tf", "/robot2/tf"))]


def on_the_other(layout: str, static: bool, *more: str) -> System:
    """The graph with transforms of robot1 on the tf of robot2 instead, which ``more`` send."""

    def placed(it: Edge) -> Edge:
        moves = it.static is static and "robot1" in it.topic
        topic = it.topic.replace("robot1", "robot2") if moves else it.topic
        return it._replace(topic=topic, publishers=more if moves else it.publishers)

    graph = healthy(layout)
    return graph._replace(edges=tuple(placed(it) for it in graph.edges))


@pytest.mark.parametrize("layout", ["L3", "L4"])
@pytest.mark.parametrize("static", [False, True])
@pytest.mark.parametrize("sender", ["", "/x", "/robot2/driver"])
def test_a_robots_frames_on_the_tf_of_another(sender: str, static: bool, layout: str) -> None:
    """Whoever sends them: a node with the other robot's description does as well."""
    frame, (odd, home) = ("laser" if static else "base_link"), ("/robot2/tf", "/robot1/tf")
    if layout == "L4":
        odd, home = "/tf/robot2", "/tf/robot1"
    (found,) = check(plan(layout), on_the_other(layout, static, *filter(None, [sender])))
    assert (found.code, found.names) == ("MG405", (f"{frame}/robot1", odd, home))
    assert found.message == f"{frame}/robot1 of robot1 is on {odd}, expected on {home}"


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
    assert "frame_prefix" in found[0].hint
    assert "tf_frame_prefix_enable" in found[0].hint


def with_frame(layout: str, child: str, parent: str, static: bool = True) -> System:
    graph = healthy(layout)
    topic = next(f.topic for f in graph.edges if f.static)
    return sent(graph._replace(edges=(*graph.edges, Edge(child, parent, topic, static, ()))))


def test_what_a_camera_sees_is_silent() -> None:
    assert check(plan("L1"), with_frame("L1", "tag36h11:5", "laser", static=False)) == []
    assert check(plan(), with_frame("L2", "tag36h11:5", "laser/robot1", static=False)) == []


def test_map_above_odom_is_silent() -> None:
    assert check(plan(), with_frame("L2", "odom/robot1", "map", static=False)) == []
    assert check(plan("L1"), with_frame("L1", "odom", "map", static=False)) == []


def test_a_copy_of_all_tf_for_rviz_is_silent() -> None:
    graph = with_node(healthy("L3"), "/tf_bridge", (PUBLISHES, "/tf", "tf2_msgs/msg/TFMessage"))
    copies = tuple(f._replace(topic="/tf") for f in graph.edges if not f.static)
    assert copies
    assert check(plan("L3"), sent(graph._replace(edges=(*graph.edges, *copies)))) == []


def test_a_tf_listener_that_no_rule_reached() -> None:
    node = "/robot1/transform_listener_impl_55e1"
    heard = (SUBSCRIBES, "/tf", "tf2_msgs/msg/TFMessage")
    (found,) = check(plan("L1"), with_node(healthy("L1"), node, heard))
    assert (found.code, found.node) == ("MG405", node)
    assert "whole process" in found.hint
    assert check(plan(), with_node(healthy(), node, heard)) == []


# ---------------------------------------------------------------- odd robots


# ---------------------------------------------------------------- size


def test_services_that_a_twin_may_hide_are_not_missed() -> None:
    graph = healthy()
    left = tuple(end for end in graph.ends if end.name != "/robot1/reset")
    twins = (*graph.nodes, Node("/robot1/driver", "other"))
    assert "MG102" in codes(graph._replace(ends=left))
    assert codes(graph._replace(ends=left, nodes=twins)) == ["MG301"]


def test_a_misspelled_name_is_found_by_similarity() -> None:
    found = check(plan(), moved(healthy(), "/robot1/joint_states", "/robot1/joint_state", "driver"))
    assert [f.code for f in found] == ["MG303"]
    assert found[0].hint == (
        "by the plan /robot1/driver should publish topic /robot1/joint_states, but does not: it "
        "publishes /robot1/joint_state instead: is the name misspelled in a remap rule or parameter?"
    )


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_sensors_own_frames_are_silent(layout: str) -> None:
    frame, parent = (
        ("laser_top", "laser") if layout == "L1" else ("laser_top/robot1", "laser/robot1")
    )
    assert check(plan(layout), with_frame(layout, frame, parent)) == []


def test_bare_frames_of_two_robots_on_one_topic() -> None:
    found = check(plan("L1"), global_tf(healthy("L1"), *ROBOTS))
    assert [f.code for f in found] == ["MG402"]
    assert sorted(found[0].names) == ["/tf", "base_link", "laser"]
    assert "robot1 and robot2 send" in found[0].message
    assert "/tf:=tf" in found[0].hint


def test_an_unplanned_node_by_its_affix() -> None:
    (found,) = check(plan("L4"), with_node(healthy("L4"), "/gripper_robot2"))
    assert (found.code, found.robot) == ("MG108", "robot2")


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
