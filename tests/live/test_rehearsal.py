# SPDX-License-Identifier: Apache-2.0
"""The stub nodes of a rehearsal: names of the code, rules of the table, transforms."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest
from paths import FIXTURES, ROBOTS

from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.closed_plan import bridged_by
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.description.library import rewrite
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.live import rehearsal
from multibot_rewrite.live.rehearsal import (
    PROCESSES,
    Stub,
    action_parts,
    bridge_stub,
    from_order,
    played,
    split_over_processes,
    stub_nodes,
    substitute_type,
    to_order,
    with_own_types,
    with_substitutes,
    without_doubles,
)
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table, plugin_nodes
from multibot_rewrite.planning.transforms import edges_of, frames_of, with_odometry
from multibot_rewrite.system.json import from_json
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    WAYS,
    Edge,
    System,
    edge_of,
)

ROVER = ROBOTS / "rover.urdf"
LASER = "sensor_msgs/msg/LaserScan"
NODE = NodeFacts(
    "drive",
    "drive",
    (
        Endpoint(TOPIC, SUBSCRIBES, "/cmd_vel", "geometry_msgs/msg/Twist"),
        Endpoint(TOPIC, PUBLISHES, "scan"),
        Endpoint(TOPIC, PUBLISHES, "debug", "std_msgs/msg/String", when="debug"),
        Endpoint(ACTION, SERVES, "go", "nav2_msgs/action/Spin"),
        Endpoint(TOPIC, SUBSCRIBES, "/tf", "tf2_msgs/msg/TFMessage", helper=True),
    ),
)
MAPPER = NodeFacts("mapper", "mapper", (Endpoint(TOPIC, SUBSCRIBES, "scan", LASER),))


def table(layout: str = "L2") -> Table:
    return build_table(
        ("robot1", "robot2"), (NODE, MAPPER), make_naming(layout), release=NEWEST_LTS
    )


def drive(layout: str = "L2", left_out: tuple[str, ...] = ()) -> Run:
    stubs = (stub for stub, _ in stub_nodes(table(layout), {}, left_out))
    return next(it for it in stubs if (it.robot, it.code_name) == ("robot2", "drive"))


def ends(stub: Run) -> list[Endpoint]:
    return [end for end, _ in stub.names]


def test_a_stub_has_the_names_of_the_code_and_rcl_gets_the_rules() -> None:
    stub = drive()
    assert ends(stub)[0] == Endpoint(
        TOPIC, SUBSCRIBES, "/cmd_vel", "geometry_msgs/msg/Twist", False
    )
    assert stub.arguments == ("--ros-args", "-r", "__ns:=/robot2", "-r", "/cmd_vel:=cmd_vel")
    assert drive("L4").arguments[:3] == ("--ros-args", "-r", "__node:=drive_robot2")


def test_without_rules_a_node_keeps_only_namespace_and_name() -> None:
    assert drive(left_out=WAYS).arguments == ("--ros-args", "-r", "__ns:=/robot2")


def test_an_endpoint_with_a_condition_is_left_out() -> None:
    assert "debug" not in {part.name for part in ends(drive())}


def test_what_may_run_in_the_place_of_another_node_is_left_out() -> None:
    """loopback_simulator beside the bridge of a simulator: its section is in Nav2's own file."""
    nodes = (NODE, MAPPER._replace(when="its parameters are in nav.yaml"))
    for own, left in (
        ("scan", ["drive"]),
        ("map", ["drive", "mapper"]),
        ("rosout", ["drive", "mapper"]),
    ):
        end = Endpoint(TOPIC, PUBLISHES, own, LASER)
        again = [it._replace(endpoints=(end,)) if it.when else it for it in nodes]
        every = build_table(("robot1",), again, make_naming("L2"), release=NEWEST_LTS)
        stubs = stub_nodes(every, {})
        plan = expect(every, make_naming("L2"), {})
        assert [it.code_name for it, _ in without_doubles(stubs, plan)] == left


def test_an_unknown_type_is_that_of_the_other_endpoint() -> None:
    assert Endpoint(TOPIC, PUBLISHES, "scan", LASER) in ends(drive())


def test_endpoints_of_a_helper_are_marked() -> None:
    assert [part.name for part in ends(drive()) if part.helper] == ["/tf"]


def test_a_node_of_the_plugins_and_of_the_node_set_is_one_with_the_rules_of_its_tag() -> None:
    one = Run("r", "manager", "/r", "manager", (("a", "b"),))
    rules = (("c", "d"),)
    two = one._replace(
        rules=rules, fact=NodeFacts("manager", "acme", (), plugin="acme"), written=True
    )
    ((stub, _),) = stub_nodes(Table("both", (one, two), (), NEWEST_LTS), {})
    assert stub.arguments == ("--ros-args", "-r", "__ns:=/r", "-r", "c:=d")


@pytest.mark.parametrize(
    ("release", "given"), [("humble", True), ("jazzy", True), ("lyrical", False)]
)
def test_a_manager_that_stands_in_for_controllers_has_their_rules(
    release: str, given: bool
) -> None:
    fleet = make_fleet(str(ROBOTS / "rover_gz.urdf"), ["r"], [], {"layout": "L1"}, release=release)
    found = {stub.code_name: stub for stub, _ in stub_nodes(fleet.table, {})}
    assert "/tf" in {it.name for it in ends(found["controller_manager"])}
    assert ("/tf:=tf" in found["controller_manager"].arguments) == given
    assert "/tf:=tf" in found["robot_state_publisher"].arguments


def test_who_has_a_topic_with_a_second_type_is_in_another_process() -> None:
    """A participant of Fast DDS refuses the second type."""
    text, flag = (
        (played(name, [Endpoint(TOPIC, PUBLISHES, "chat", type_)], "robot1"), ())
        for name, type_ in (("talker", "std_msgs/msg/String"), ("listener", "std_msgs/msg/Bool"))
    )
    assert split_over_processes([text, flag]) == [[text], [flag]]
    assert split_over_processes([text, text]) == [[text, text]]
    # Names count as they are in the graph, however the code has them.
    other, _ = flag
    ((end, _),) = other.names
    moved = (other._replace(names=((end._replace(name="/talk"), "chat"),)), ())
    assert split_over_processes([text, moved]) == [[text], [moved]]


def test_robots_share_processes_when_they_are_many() -> None:
    some: list[Stub] = [
        (played(f"node{at}", (), f"robot{at}"), ()) for at in range(3 * PROCESSES + 1)
    ]
    processes = split_over_processes(some)
    assert len(processes) == PROCESSES
    assert sorted(len(process) for process in processes) == [3] * (PROCESSES - 1) + [4]
    assert [len(process) for process in split_over_processes(some[:3])] == [1, 1, 1]


def test_an_order_survives_the_pipe() -> None:
    import json

    stub = drive()._replace(process_namespace="/box", process_rules=(("/tf", "tf"),))
    sent = [edge_of("odom", "base", False)]
    order = json.dumps(to_order([(stub, sent)]))
    ((read, edges),) = from_order(json.loads(order))
    assert (read.code_name, read.arguments) == ("drive", stub.arguments)
    assert [it for it, _ in read.names] == [it for it, _ in stub.names]
    assert (read.process_namespace, [*edges]) == ("/box", sent)
    assert json.dumps(to_order([(read, edges)])) == order


@pytest.mark.parametrize(("role", "parts"), [(SERVES, PUBLISHES), (CALLS, SUBSCRIBES)])
def test_an_action_without_its_type_is_three_services_and_two_topics(role: str, parts: str) -> None:
    made = list(action_parts(Endpoint(ACTION, role, "go", "x/action/Go")))
    assert [(part.kind, part.role, part.name) for part in made] == [
        (SERVICE, role, "go/_action/send_goal"),
        (SERVICE, role, "go/_action/cancel_goal"),
        (SERVICE, role, "go/_action/get_result"),
        (TOPIC, parts, "go/_action/feedback"),
        (TOPIC, parts, "go/_action/status"),
    ]


@pytest.mark.parametrize("layout", ["L2", "L4"])
def test_the_plan_has_the_substituted_types(layout: str) -> None:
    plan = expect(table(layout), make_naming(layout), {})
    replaced = {"nav2_msgs/action/Spin": "", LASER: substitute_type(TOPIC, LASER)}
    played = with_substitutes(plan, replaced).ends
    assert {it.type for it in played if "mapper" in it.node} == {"std_msgs/msg/Empty"}
    there = [it for it in played if "_action" in it.name and "robot2" in it.node]
    action = "/robot2/go" if layout == "L2" else "/go/robot2"
    assert [it.name for it in there] == [
        f"{action}/_action/{part}"
        for part in ("send_goal", "cancel_goal", "get_result", "feedback", "status")
    ]
    assert not [it for it in played if it.kind == ACTION]


def test_the_bridge_of_a_plan_has_its_topics_and_what_the_world_serves() -> None:
    """By the rows of its file (ros_gz_bridge bridge_config.cpp)."""
    rows = """\
- {topic_name: /clock, ros_type_name: rosgraph_msgs/msg/Clock, direction: GZ_TO_ROS}
- {topic_name: /r1/cmd_vel, ros_type_name: geometry_msgs/msg/Twist, direction: ROS_TO_GZ}
- {service_name: /world/hall/control, ros_type_name: ros_gz_interfaces/srv/ControlWorld}
"""
    robot = SimpleNamespace(spec=SimpleNamespace(name="r1", namespace="r1"))
    fleet = SimpleNamespace(maybe_real=())
    plan: Any = SimpleNamespace(fleet=fleet, robots=(robot,), launched_words=())
    topics = bridged_by(plan, [OutputFile("bridge.yaml", rows.encode())])
    ((stub, _),) = bridge_stub(topics)
    assert [it[:4] for it in ends(stub)] == [
        (TOPIC, PUBLISHES, "/clock", "rosgraph_msgs/msg/Clock"),
        (TOPIC, SUBSCRIBES, "/r1/cmd_vel", "geometry_msgs/msg/Twist"),
        (SERVICE, SERVES, "/world/hall/control", "ros_gz_interfaces/srv/ControlWorld"),
    ]


def test_what_is_seen_of_substitutes_has_the_types_of_the_plan() -> None:
    """Also under a name that nobody planned: no two topics are of one type that are not."""
    replaced = {LASER: substitute_type(TOPIC, LASER)}
    plan = expect(table("L2"), make_naming("L2"), {})
    scan = next(it for it in plan.ends if it.type == LASER and "robot1" in it.node)
    seen = with_substitutes(plan, replaced)
    astray = scan._replace(name=f"/{scan.code_name}", type=replaced[LASER])
    # rclpy tells the type of an action by that of its feedback.
    spin = next(it for it in plan.ends if it.kind == ACTION)
    replaced[spin.type] = substitute_type(ACTION, spin.type)
    told = spin._replace(type="std_msgs/msg/Empty")
    own = with_own_types(seen._replace(ends=(*seen.ends, astray, told)), plan, replaced)
    assert own.ends == (*plan.ends, astray._replace(type=LASER), spin)


def rewritten(layout: str) -> tuple[Inventory, Naming]:
    text = rewrite(str(ROVER), "robot1", layout=layout).text
    return collect(
        read_document(text.encode(), "rover.urdf"), builtin_tree((), NEWEST_LTS)
    ), make_naming(layout)


def sent(layout: str, *node_sets: str) -> dict[str, list[Edge]]:
    inventory, naming = rewritten(layout)
    nodes = [node for name in node_sets for node in nodes_of_set(built_in(NEWEST_LTS), name)]
    reading = read(
        inventory.document.source, "rover.urdf", builtin_tree((), NEWEST_LTS).definitions
    )
    plugins = [it.fact for it in plugin_nodes(reading, "robot1")]
    found = edges_of("robot1", inventory, nodes, plugins, naming)
    return {node.removesuffix("_robot1"): edges for (_, node), edges in found.items() if edges}


@pytest.mark.parametrize(("layout", "end"), [("L1", ""), ("L2", "/robot1"), ("L4", "/robot1")])
def test_description_odometry_and_map_are_one_tree(layout: str, end: str) -> None:
    edges = sent(layout, "robot_state", "localization")
    assert edges["amcl"] == [edge_of("map", f"odom{end}", False)]
    assert edges["diff_drive"] == [edge_of(f"odom{end}", f"base_footprint{end}", False)]
    tree = edges["robot_state_publisher"]
    assert tree[0] == edge_of(f"base_footprint{end}", f"base_link{end}", True)
    assert edge_of(f"base_link{end}", f"left_wheel{end}", False) in tree
    parents = {edge.child: edge.parent for edges in edges.values() for edge in edges}
    assert {parent for parent in parents.values() if parent not in parents} == {"map"}


def test_odometry_leads_to_the_root_of_the_description() -> None:
    assert sent("L2", "robot_localization")["ekf_filter_node"] == [
        edge_of("odom/robot1", "base_footprint/robot1", False)
    ]


def test_a_robots_frames_are_declared_or_sent_and_not_shared() -> None:
    inventory, naming = rewritten("L2")
    frames = frames_of(inventory, [edge_of("map", "odom/robot1", False)], naming, "robot1")
    assert "odom/robot1" in frames
    assert "camera_link/robot1" in frames
    assert "map" not in frames


def test_missing_odometry_is_added_and_reported() -> None:
    naming = make_naming("L2")
    tree = [edge_of("base", "arm", True)]
    edges = {
        ("r1", "robot_state_publisher"): tree,
        ("r1", "amcl"): [edge_of("map", "odom", False)],
    }
    filled, added = with_odometry(edges, "r1", naming)
    assert added == "odom -> base"
    assert filled["r1", "robot_state_publisher"] == [*tree, edge_of("odom", "base", False)]
    assert with_odometry(filled, "r1", naming) == (filled, "")
    assert with_odometry({("r1", "robot_state_publisher"): tree}, "r1", naming)[1] == ""
    assert with_odometry(edges, "r2", naming) == (edges, "")
    standing = {**edges, ("r1", "robot_state_publisher"): [edge_of("world", "base", True)]}
    assert with_odometry(standing, "r1", naming) == (standing, "")


def domains(environs: list[dict[str, str]]) -> list[str]:
    return [it["ROS_DOMAIN_ID"] for it in environs]


def test_a_stage_is_a_domain_of_this_machine_where_nobody_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A hundred domains are given away; of what leads elsewhere nothing is left."""
    busy: set[int] = set()
    monkeypatch.setattr(rehearsal, "participants_here", lambda domain: int(domain in busy))
    monkeypatch.setattr(rehearsal.os, "getpid", lambda: 499)
    elsewhere = (
        *("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS_LOCALHOST_ONLY"),
    )
    given = {"HOME": "/h", **dict.fromkeys(elsewhere, "1")}
    monkeypatch.setattr(rehearsal.os, "environ", given)
    alone = {"HOME": "/h", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    assert rehearsal.isolated_environment(None) == {**alone, "ROS_DOMAIN_ID": "100"}
    given["ROS_DOMAIN_ID"] = "0"
    assert domains(
        [
            rehearsal.isolated_environment(None),
            rehearsal.isolated_environment(5),
            rehearsal.isolated_environment(0),
        ]
    ) == [
        "0",
        "5",
        "0",
    ]
    busy |= {0, 100, 1, 2}
    assert domains([rehearsal.isolated_environment(None)]) == ["100"]
    assert domains(rehearsal.isolated_environments(None, 3)) == ["100", "3", "4"]
    assert domains(rehearsal.isolated_environments(99, 2)) == ["99", "3"]
    busy.clear()
    assert rehearsal.isolated_environments(98, 4) == [
        {**alone, "ROS_DOMAIN_ID": it} for it in ("98", "99", "100", "1")
    ]


def _without_endpoints(graph: System) -> System:
    """Robot1's nodes are known, what they have is not: messages of the discovery were lost."""
    left = tuple(end for end in graph.ends if not end.node.startswith("/robot1/"))
    return graph._replace(ends=left)


@pytest.mark.parametrize(
    ("first", "looks"),
    [
        (lambda full: full, 1),
        (lambda full: full._replace(nodes=(), ends=(), edges=()), 2),
        (_without_endpoints, 2),
        (lambda full: full._replace(edges=full.edges[1:]), 2),
        # One end of many, of which no rule would speak.
        (lambda full: full._replace(ends=full.ends[:-1]), 2),
        # The client of a service is there, its server is not.
        (lambda full: full._replace(ends=(*full.ends[:-1], full.ends[-1]._replace(role=CALLS))), 2),
        # What a node has besides is no reason to doubt a look.
        (lambda full: full._replace(ends=(*full.ends, full.ends[0]._replace(name="/other"))), 1),
    ],
)
def test_a_look_without_all_that_the_stubs_have_is_taken_again(
    first: Callable[[System], System], looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = _graph("healthy.json")
    ends = frozenset((end.node, end.role, end.name) for end in full.ends)
    started = rehearsal.Started({"a": "b"}, ends, frozenset(edge.child for edge in full.edges))
    seen = [full, first(full)]
    monkeypatch.setattr(rehearsal, "observe", lambda *_: seen.pop())
    monkeypatch.setattr(rehearsal, "_started", lambda *_: nullcontext(started))
    graph, replaced = rehearsal.graph_of_stubs([], {}, 1.0)
    assert (len(seen), replaced) == (2 - looks, {"a": "b"})
    assert graph == (full if looks == 2 else first(full))


def _graph(name: str) -> System:
    return from_json((FIXTURES / "graphs" / name).read_bytes(), name)
