# SPDX-License-Identifier: Apache-2.0
"""The plan of what is seen: a picture is drawn by it, and a first fleet file begins with it."""

from __future__ import annotations

import small_fleet
from graph_calls import check, read_plan, to_yaml

from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.seen_plan import NAMELESS, robots_to_plan, seen_plan
from multibot_rewrite.system.records import (
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

SHARED = (
    "/bond", "/clock", "/diagnostics", "/diagnostics_agg", "/localized_scan", "/parameter_events",
    "/rosout",
)  # fmt: skip
TF, JOINTS = "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"
WORLD = ("earth", "map", "utm", "world")


def planned(graph: System) -> System:
    return seen_plan(diagnose(graph))


def end(kind: str, role: str, name: str, node: str, type_: str = "std_msgs/msg/Empty") -> End:
    return End(kind, role, name, type_, "", node, None, "")


def test_all_nodes_but_tools_and_all_names_but_those_of_every_node() -> None:
    graph = small_fleet.healthy("L2")
    more = (
        end(TOPIC, PUBLISHES, "/order", "/manager"), end(SERVICE, SERVES, "/halt", "/manager"),
        end(TOPIC, PUBLISHES, "/rosout", "/manager", "rcl_interfaces/msg/Log"),
        end(SERVICE, SERVES, "/manager/get_parameters", "/manager", "rcl_interfaces/srv/GetParameters"),
        end(SERVICE, SERVES, "/manager/t", "/manager", "type_description_interfaces/srv/X"),
        end(TOPIC, SUBSCRIBES, "/_hidden", "/manager"),
        end(SERVICE, CALLS, "/robot1/reset", "/manager"),
        end(TOPIC, SUBSCRIBES, "/a", "/rviz2"),
    )  # fmt: skip
    nodes = (*graph.nodes, Node("/manager"), Node("/manager"), Node("/rviz2"))
    made = planned(graph._replace(nodes=nodes, ends=(*graph.ends, *more)))
    assert [(it.name, it.robot) for it in made.nodes] == [
        ("/robot1/robot_state_publisher", "robot1"), ("/robot1/driver", "robot1"),
        ("/robot2/robot_state_publisher", "robot2"), ("/robot2/driver", "robot2"), ("/manager", ""),
    ]  # fmt: skip
    own = [(it.kind, it.role, it.name) for it in made.ends if it.node == "/manager"]
    assert own == [
        (TOPIC, PUBLISHES, "/order"), (SERVICE, SERVES, "/halt"), (SERVICE, CALLS, "/robot1/reset"),
    ]  # fmt: skip
    assert made.layout == "frames-per-robot"
    # What is of no robot may be anybody's; a service is no topic.
    assert made.shared_topics == tuple(sorted({*SHARED, "/order", "/a", "/tf"}))
    assert made.shared_frames == WORLD
    (driven,) = (it for it in made.ends if it.name == "/robot2/cmd_vel")
    assert (driven.code_name, driven.type) == ("/cmd_vel", "geometry_msgs/msg/Twist")


def test_each_robot_has_its_frames_and_its_tf() -> None:
    for layout, topics in (
        ("L1", ("/robot1/tf", "/robot2/tf")), ("L2", ("/tf", "/tf")),
        ("L4", ("/tf/robot1", "/tf/robot2")),
    ):  # fmt: skip
        made = planned(small_fleet.healthy(layout))
        assert [(it.name, it.tf_topic) for it in made.robots] == [
            ("robot1", topics[0]), ("robot2", topics[1]),
        ]  # fmt: skip
        seen = {it.child for it in small_fleet.healthy(layout).edges}
        for robot in made.robots:
            assert robot.frames == tuple(sorted(robot.frames))
            mine = {it for it in seen if layout == "L1" or robot.name in it}
            assert mine <= {*robot.frames} and not {*robot.frames} & {*WORLD}


def test_without_a_name_of_a_robot_all_is_of_one() -> None:
    graph = System(
        (Node("/a"), Node("/b")), (end(TOPIC, PUBLISHES, "/x", "/a"),),
        (Edge("/base", "/odom", "/tf", False, ()), Edge("odom", "map", "/tf", False, ())),
    )  # fmt: skip
    assert robots_to_plan(diagnose(graph)) == (NAMELESS,) and NAMELESS.name == "robot1"
    made = planned(graph)
    assert [it.robot for it in made.nodes] == ["robot1", "robot1"]
    assert made.robots == (Robot("robot1", ("base", "odom"), "/tf"),)
    assert made.layout == "postfix"


def arms(*hanging: str) -> System:
    """Two arms, of which these hang from the world."""
    names = ("left", "right")
    nodes = tuple(Node(f"/{it}/robot_state_publisher") for it in names)
    senders = tuple(it.name for it in nodes)
    ends = tuple(
        end(TOPIC, PUBLISHES, topic, it, type_)
        for it in senders
        for topic, type_ in (
            ("/tf", TF),
            ("/tf_static", TF),
            (f"/{it.split('/')[1]}/joint_states", JOINTS),
        )
    )
    above = tuple(Edge(f"{it}/base", "world", "/tf_static", True, senders) for it in hanging)
    own = tuple(Edge(f"{it}/arm", f"{it}/base", "/tf_static", True, senders) for it in names)
    return System(nodes, ends, (*above, *own))


def test_a_robot_that_hangs_from_a_frame_of_all_is_planned_so() -> None:
    whole = arms("left", "right")
    plan = read_plan(to_yaml(planned(whole)).encode(), "plan.yaml")
    assert [str(it) for it in check(plan, whole)] == []
    (found,) = check(plan, arms("right"))
    assert (found.code, found.robot, found.names) == ("MG406", "left", ("left/base", "world"))
    assert "/left/robot_state_publisher sends world -> left/base, and does not" in found.hint
    # What the plan does not have from the start is not asked for.
    assert check(planned(arms("right")), arms("right")) == []


def test_an_error_of_what_is_seen_is_not_its_plan() -> None:
    graph = small_fleet.healthy("L2")
    twist = "geometry_msgs/msg/Twist"
    more = [end(TOPIC, SUBSCRIBES, "/robot2/cmd_vel", "/robot2/driver", twist)]
    more += [end(TOPIC, PUBLISHES, "/robot2/cmd_vel", "/robot1/driver", twist)]
    graph = graph._replace(ends=(*graph.ends, *more))
    (found,) = check(planned(graph), graph)
    assert (found.code, found.node) == ("MG311", "/robot1/driver")
