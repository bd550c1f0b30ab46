# SPDX-License-Identifier: Apache-2.0
"""Any fleet as planned is silent; one name moved away is found, and its node is named."""

from __future__ import annotations

from typing import NamedTuple

import pytest
from graph_cases import as_planned, environment, qos, sent
from hypothesis import given, settings, strategies as st
from plans import PlannedRobot, own as nodes_of, planned, planned_end

from multibot_rewrite.base.naming import Naming, affix, make_naming, spelled
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.plan import read_plan, to_yaml
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    ROLES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    System,
)

pytestmark = pytest.mark.slow

# Robots called like one another, and like words of the names.
ROBOTS = ("robot1", "robot2", "robot10", "arm", "arm_left", "left", "scan", "camera", "map", "r")
NODES = ("driver", "scan", "arm_left", "left", "camera/camera", "robot_state_publisher", "arm")
NAMES = (
    "scan",
    "/scan",
    "cmd_vel",
    "/cmd_vel",
    "~/state",
    "arm/left",
    "/camera/image",
    "left_scan",
)
LINKS = ("base_link", "laser", "arm_link", "camera", "left_wheel", "scan")
TYPES = {
    TOPIC: ("std_msgs/msg/String", "nav_msgs/msg/Odometry"),
    SERVICE: ("std_srvs/srv/Trigger",),
}


class Fleet(NamedTuple):
    """A plan, and the graph that is as planned."""

    plan: System
    graph: System


@st.composite
def endpoints(draw: st.DrawFn) -> Endpoint:
    role = draw(st.sampled_from(ROLES))
    kind = SERVICE if role in (SERVES, CALLS) else TOPIC
    # One type a name, as in a fleet that works.
    name = draw(st.sampled_from(NAMES))
    return Endpoint(kind, role, name, TYPES[kind][0])


@st.composite
def fleets(draw: st.DrawFn) -> Fleet:
    layout = draw(st.sampled_from(("L1", "L2", "L3", "L4")))
    affix = draw(st.sampled_from(("postfix", "prefix")))
    naming = make_naming(layout, affix)
    robots = draw(st.lists(st.sampled_from(ROBOTS), min_size=1, max_size=3, unique=True))
    names = draw(st.lists(st.sampled_from(NODES), min_size=1, max_size=3, unique=True))
    some = st.lists(endpoints(), min_size=1, max_size=4, unique=True)
    tf = Endpoint(TOPIC, PUBLISHES, "/tf", "tf2_msgs/msg/TFMessage")
    still = tf._replace(name="/tf_static")
    nodes = [NodeFacts(name, "p", (*draw(some), tf, still)) for name in names]
    links = draw(st.lists(st.sampled_from(LINKS), min_size=1, max_size=4, unique=True))
    frames = {robot: [spelled(naming, robot, "frame", link) for link in links] for robot in robots}
    plan = expect(build_table(robots, nodes, naming, release=NEWEST_LTS), naming, frames)
    return Fleet(plan, beside(plan, as_planned(plan), naming))


def beside(plan: System, graph: System, naming: Naming) -> System:
    """Return what every node brings, a topic of its own that nobody planned, and people's tools."""
    robot_of = {it.name: it.robot for it in plan.nodes if it.robot}
    more = [
        End(kind, role, name, type_, "", node.name, None, "")
        for node in graph.nodes
        for kind, role, name, type_ in (
            (TOPIC, PUBLISHES, "/rosout", "rcl_interfaces/msg/Log"),
            (TOPIC, SUBSCRIBES, "/clock", "rosgraph_msgs/msg/Clock"),
            (SERVICE, SERVES, f"{node.name}/get_parameters", "rcl_interfaces/srv/GetParameters"),
            (TOPIC, PUBLISHES, own("/more/left", robot_of[node.name], naming), "std_msgs/msg/Bool"),
        )
    ]
    tools = (
        "/rviz2",
        "/teleop_twist_keyboard",
        "/rosbag2_recorder",
        "/_ros2cli_1",
        "/ros_gz_bridge",
    )
    clock = ("/clock", "rosgraph_msgs/msg/Clock", "", "/ros_gz_bridge", None, "")
    return graph._replace(
        nodes=(*graph.nodes, *(Node(tool, "") for tool in tools)),
        ends=(*graph.ends, *more, End(TOPIC, PUBLISHES, *clock)),
    )


def own(topic: str, robot: str, naming: Naming) -> str:
    """Return a topic as a robot has it."""
    there = affix(naming, "topic", topic)
    return there.spell(topic, robot) if there else f"/{robot}{topic}"


@settings(max_examples=25, deadline=None)
@given(fleets())
def test_a_fleet_as_planned_is_silent(fleet: Fleet) -> None:
    """But where the plan itself has a reader or client whose name no node sends or serves."""
    sent_by_plan = {
        ("MG303" if it.kind == TOPIC else "MG304", it.name)
        for it in fleet.plan.ends
        if it.role in (PUBLISHES, SERVES)
    }
    found = check(fleet.plan, fleet.graph)
    assert [it for it in found if it.code not in ("MG303", "MG304")] == []
    assert not {(it.code, it.names[0]) for it in found} & sent_by_plan


@settings(max_examples=25, deadline=None)
@given(fleets(), st.data())
def test_a_name_that_was_moved_is_found_at_its_node(fleet: Fleet, data: st.DataObject) -> None:
    planned = [(w.node, w.kind, w.role, w.name) for w in fleet.plan.ends]
    end = data.draw(st.sampled_from(planned))
    new = data.draw(st.sampled_from(("/elsewhere", "/scan", "/robot2/cmd_vel", f"{end[3]}_raw")))
    moved = tuple(
        e._replace(name=new) if (e.node, e.kind, e.role, e.name) == end else e
        for e in fleet.graph.ends
    )
    found = check(fleet.plan, sent(fleet.graph._replace(ends=moved)))
    if (*end[:3], new) in planned:
        return
    # The one that misses it may be the finding's node.
    assert any(end[0] in str(it) and end[3] in str(it) for it in found)


@settings(max_examples=25, deadline=None)
@given(fleets(), st.data())
def test_a_node_that_is_taken_away_is_found(fleet: Fleet, data: st.DataObject) -> None:
    robot = data.draw(st.sampled_from(fleet.plan.robots))
    node = data.draw(st.sampled_from(nodes_of(fleet.plan, robot.name)))
    graph = fleet.graph._replace(
        nodes=tuple(n for n in fleet.graph.nodes if n.name != node),
        ends=tuple(e for e in fleet.graph.ends if e.node != node),
    )
    found = [(f.code, f.robot) for f in check(fleet.plan, graph) if f.code in ("MG101", "MG109")]
    assert found == [
        ("MG101" if len(nodes_of(fleet.plan, robot.name)) > 1 else "MG109", robot.name)
    ]


@settings(max_examples=25, deadline=None)
@given(fleets(), st.data())
def test_a_frame_with_another_parent_is_found(fleet: Fleet, data: st.DataObject) -> None:
    if not fleet.graph.edges:
        return
    edge = data.draw(st.sampled_from(fleet.graph.edges))
    other = edge._replace(parent="somewhere_else")
    found = check(fleet.plan, fleet.graph._replace(edges=(*fleet.graph.edges, other)))
    assert "MG401" in {finding.code for finding in found}


@settings(max_examples=25, deadline=None)
@given(fleets())
def test_plan_and_graph_go_through_files_unchanged(fleet: Fleet) -> None:
    for data in (to_yaml(fleet.plan).encode(), to_json(fleet.plan)):
        assert read_plan(data, "plan") == fleet.plan
    assert from_json(to_json(fleet.graph), "graph") == fleet.graph


SEGMENTS = (
    "robot1",
    "arm",
    "arm_left",
    "scan",
    "tf",
    "tf_static",
    "x_arm",
    "arm_x",
    "",
    "_",
    "{node}",
)
full_names = st.lists(st.sampled_from(SEGMENTS), max_size=4).map(
    lambda parts: "/" + "/".join(parts)
)
any_names = st.one_of(full_names, st.text(max_size=5))
ends = st.sampled_from(
    [(TOPIC, PUBLISHES), (TOPIC, SUBSCRIBES), (SERVICE, SERVES), (SERVICE, CALLS)]
)
types = st.sampled_from(("", "a/msg/A", "a/msg/B"))


@st.composite
def anything(draw: st.DrawFn) -> Fleet:
    """Return a plan that nobody would make and a graph that has little to do with it."""
    names = draw(
        st.lists(st.sampled_from(("robot1", "arm", "arm_left", "")), max_size=3, unique=True)
    )
    nodes = st.lists(full_names, max_size=3, unique=True).map(tuple)
    some = st.lists(any_names, max_size=3).map(tuple)
    robots = [
        draw(st.builds(PlannedRobot, st.just(n), nodes, some, full_names, some)) for n in names
    ]
    there = st.sampled_from([node for robot in robots for node in robot.nodes] or ["/else"])
    node = st.one_of(full_names, there)
    wanted = st.builds(
        lambda n, end, *rest: planned_end(n, *end, *rest),
        there,
        ends,
        full_names,
        types,
        any_names,
    )
    plan = planned(
        "any", tuple(robots), draw(nodes), draw(nodes), draw(some),
        tuple(draw(st.lists(wanted, max_size=5, unique_by=lambda w: (w.node, *w[:3])))),
        ignored_nodes=draw(some),
    )  # fmt: skip
    seen = st.builds(
        lambda end, *rest: End(*end, *rest), ends, full_names, types,
        st.sampled_from(("", "RIHS01_a", "RIHS01_b")), node,
        st.sampled_from((None, qos())), st.just(""),
    )  # fmt: skip
    frame = st.builds(
        Edge,
        any_names,
        any_names,
        full_names,
        st.booleans(),
        st.lists(node, max_size=2).map(tuple),
    )
    graph = System(
        tuple(Node(name, "") for name in draw(st.lists(node, max_size=5))),
        tuple(draw(st.lists(seen, max_size=8))), tuple(draw(st.lists(frame, max_size=5))),
        environment(),
    )  # fmt: skip
    return Fleet(plan, graph)


@settings(max_examples=25, deadline=None)
@given(anything())
def test_each_finding_is_reported_once_for_any_graph(fleet: Fleet) -> None:
    found = check(fleet.plan, fleet.graph)
    assert len(set(found)) == len(found)
    assert found == check(fleet.plan, fleet.graph)
