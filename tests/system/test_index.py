# SPDX-License-Identifier: Apache-2.0
"""What rules look up in a system: ends by name, trees by topic, whose each of them is."""

from __future__ import annotations

from multibot_rewrite.system.index import (
    NO_NAMESPACE,
    Known,
    Sent,
    Tree,
    at_work,
    beside,
    ends_of,
    index,
    nodes_of,
    robots_of,
)
from multibot_rewrite.system.ownership import ALONE, whose_by_plan
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    MAY,
    OFF,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Environment,
    Node,
    Parameter,
    Robot,
    System,
)

TF, TWIST, TEXT = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/Twist", "std_msgs/msg/String"


def end(node: str, role: str, name: str, type_: str = TEXT, kind: str = TOPIC) -> End:
    return End(kind, role, name, type_, "", node, None, "")


SENT = end("/a/driver", PUBLISHES, "/a/out")
HEARD = end("/a/tool", SUBSCRIBES, "/a/out")
SERVED = end("/a/driver", SERVES, "/a/out", kind=SERVICE)
CALLED = end("/a/tool", CALLS, "/a/out", kind=SERVICE)
ORDER = end("/a/driver", SUBSCRIBES, "/a/cmd_vel", TWIST)
HIDDEN = end("/a/driver", PUBLISHES, "/a/_hidden")
CLOCK = end("/a/driver", SUBSCRIBES, "/clock")
PLAN = System(
    nodes=(Node("/a/driver", robot="a"), Node("/a/tool", sure=MAY), Node("/map_server")),
    ends=(SENT, HEARD, SERVED, CALLED, ORDER, HIDDEN, CLOCK),
    edges=(Edge("a/base", "a/odom", "", False, ("/a/driver", "/a/tool")),),
    parameters=(Parameter("/a/driver", "use_sim_time", "true"), Parameter("/x", "rate", "1")),
    robots=(Robot("a", ("a/base",), "/a/tf_static", ("a/gps",)),),
    shared_topics=("/clock",),
    ignored_nodes=("helper*",),
)
IT = index(PLAN, whose_by_plan(PLAN))


def test_the_ends_of_a_name_by_what_they_do() -> None:
    topic, service = IT.by_name[TOPIC, "/a/out"], IT.by_name[SERVICE, "/a/out"]
    assert topic == (TOPIC, "/a/out", TEXT, (SENT,), (HEARD,), (), ())
    assert service == (SERVICE, "/a/out", TEXT, (), (), (SERVED,), (CALLED,))
    assert (TOPIC, "/a/_hidden") not in IT.by_name
    assert IT.by_key["/a/driver", TOPIC, PUBLISHES, "/a/_hidden"] is HIDDEN
    assert IT.by_node["/a/driver"] == [SENT, SERVED, ORDER, HIDDEN, CLOCK]
    assert list(ends_of(IT, "/a/out")) == [SENT, HEARD, SERVED, CALLED]
    assert list(ends_of(IT, "/a/none")) == []


def test_topics_are_without_tf_and_what_every_node_has() -> None:
    tf = end("/a/driver", PUBLISHES, "/a/tf", TF)
    asked = index(PLAN._replace(ends=(*PLAN.ends, tf)), whose_by_plan(PLAN))
    assert [it.name for it in asked.topics] == ["/a/out", "/a/cmd_vel"]
    assert list(asked.orders) == ["/a/cmd_vel"]
    assert asked.published == {"/a/out", "/a/tf"}


def test_an_action_moves_no_robot_by_its_name() -> None:
    action = end("/a/driver", SERVES, "/a/cmd_vel", TWIST, ACTION)
    assert index(System(ends=(action,)), ALONE).orders == {}


def test_what_a_plan_says_of_its_nodes() -> None:
    assert IT.nodes == {"/a/driver": 1, "/a/tool": 1, "/map_server": 1}
    assert IT.node["/a/tool"].sure == MAY
    assert IT.own == {"a": ["/a/driver"], "": ["/a/tool", "/map_server"]}
    assert IT.robot_of == {"/a/driver": "a"}
    assert IT.may_miss == {"/a/tool"}
    assert IT.declared == {"a": PLAN.robots[0]}
    assert IT.frames_of == {"a": {"a/base", "a/gps"}}
    assert IT.sent == [
        Sent("/a/driver", "a/odom", "a/base"),
        Sent("/a/tool", "a/odom", "a/base"),
    ]
    assert str(IT.sent[0]) == "a/odom -> a/base"


def test_a_name_of_a_robot_is_found_without_it() -> None:
    assert IT.of_robot("a", TOPIC, "/cmd_vel") == IT.by_name[TOPIC, "/a/cmd_vel"]
    assert IT.of_robot("", TOPIC, "/clock") == IT.by_name[TOPIC, "/clock"]
    assert IT.of_robot("a", TOPIC, "/clock") is None


def test_a_tool_is_called_like_one_and_in_no_plan() -> None:
    names = ("/a/driver", "/a/rviz2", "/b/rviz2", "/helper1", "/driver")
    planned = PLAN._replace(nodes=(*PLAN.nodes, Node("/a/rviz2", robot="a")))
    seen = beside(index(planned, ALONE), System())
    assert [it for it in names if seen.is_tool(it)] == ["/b/rviz2", "/helper1"]
    alone = index(PLAN, ALONE)
    assert [it for it in names if alone.is_tool(it)] == ["/a/rviz2", "/b/rviz2"]


def test_beside_its_plan_a_graph_is_read_as_the_plan_says() -> None:
    graph = System(nodes=(Node("/x"),), environment=Environment(seconds=2.5))
    seen = beside(IT, graph, {"/a/out": 3})
    assert seen.system is graph
    assert seen.nodes == {"/x": 1}
    assert seen.robot("/a/scan") == "a"
    assert seen.expected is IT
    assert seen.home == {"a": "/a/tf"}
    assert seen.senders == {("a/odom", "a/base"): ("/a/driver", "/a/tool")}
    assert seen.relays == {}
    assert seen.known == Known({"/a/out": 3}, 2.5)


def test_transforms_are_in_trees_by_their_topic() -> None:
    def edge(child: str, topic: str, *nodes: str, parent: str = "odom") -> Edge:
        return Edge(child, parent, topic, False, nodes)

    system = System(
        ends=(
            end("/a/ekf", PUBLISHES, "/a/tf", TF),
            end("/a/rsp", PUBLISHES, "/a/tf_static", TF),
            end("/a/nav", SUBSCRIBES, "/a/tf", TF),
            end("/a/map", SUBSCRIBES, "/a/tf_static", TF),
            end("/b/nav", SUBSCRIBES, "/b/tf", TF),
            end("/c/nav", SUBSCRIBES, "/c/tf", TEXT),
        ),
        edges=(
            edge("/base", "/a/tf", "/a/driver", "/a/ekf"),
            edge("lidar", "/a/tf_static", parent="/base"),
            edge("x", "/_hidden/tf"),
            edge("y", "/a/tf")._replace(sure=OFF),
        ),
    )
    base, lidar = edge("base", "/a/tf", "/a/driver", "/a/ekf"), edge("lidar", "/a/tf_static")
    assert index(system, ALONE).trees == [
        Tree(
            "/a/tf",
            (base, lidar._replace(parent="base")),
            ("/a/ekf", "/a/rsp", "/a/driver"),
            ("/a/nav",),
        ),
        Tree("/b/tf", (), (), ("/b/nav",)),
    ]


def test_the_nodes_of_some_ends() -> None:
    looking = end("/a/rviz2", SUBSCRIBES, "/a/out")
    assert nodes_of((HEARD, SENT, SENT)) == ("/a/driver", "/a/tool")
    assert at_work((looking, SENT)) == [SENT]


def test_a_node_without_a_robot_that_is_called_like_one_of_theirs_is_of_one_more() -> None:
    assert robots_of(IT, ("/a/driver", "/a/x", "/map_server")) == ("a",)
    assert robots_of(IT, ("/a/driver", "/driver")) == ("a", NO_NAMESPACE)
    assert robots_of(IT, ("/a/driver", "/driver", "/x")) == ("a", NO_NAMESPACE)
    assert robots_of(IT, ("/driver", "/x")) == ()
