# SPDX-License-Identifier: Apache-2.0
"""From a plan, a graph and its findings to what is drawn: states, groups, crossings, trees."""

from __future__ import annotations

import pytest
from page_calls import (
    BRIDGE,
    CLASH,
    CROSS_TALK,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    Crossing,
    DrawnEdge,
    DrawnGroup,
    DrawnName,
    DrawnNode,
    FrameRow,
    FrameTree,
    Outcome,
    Scene,
    Targets,
    Verdict,
    combined_state,
    find_targets,
    make_scene,
    make_states,
    merged,
    robots_of,
    words_of,
    worst,
)

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.check import side_by_side
from multibot_rewrite.system.records import (
    ACTION,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Node,
    Place,
    Robot,
    Sure,
    System,
    Topic,
)

A, LOG = "x/msg/A", "rcl_interfaces/msg/Log"
ROBOTS = (
    Robot("r1", ("r1/base", "r1/scan"), "/r1/tf"),
    Robot("r2", ("r2/base", "r2/scan"), "/r2/tf"),
)


def end(node: str, role: str, name: str, type_: str = A, kind: str = TOPIC) -> End:
    return End(kind, role, name, type_, "", node, None, "")


ENDS = (
    end("/r1/a", PUBLISHES, "/r1/t"),
    end("/r2/a", SUBSCRIBES, "/r2/t"),
    end("/r2/a", PUBLISHES, "/all"),
    end("/s", SUBSCRIBES, "/all"),
)
NODES = (Node("/r1/a", robot="r1"), Node("/r2/a", robot="r2"), Node("/s"))
PLAN = System(NODES, ENDS, robots=ROBOTS, layout="both", shared_topics=("/all",))
GRAPH = System(tuple(Node(it.name) for it in NODES), ENDS)


def found(code: str, node: str = "", *names: str, level: str = "error", **more: object) -> Finding:
    return Finding(code, level, "it", node=node, names=names)._replace(**more)  # type: ignore[arg-type]


def scene(*findings: Finding, plan: System = PLAN, graph: System = GRAPH) -> Scene:
    return make_scene(plan, graph, findings)


def more(*ends: End, edges: tuple[Edge, ...] = ()) -> System:
    nodes = dict.fromkeys((*(it.name for it in GRAPH.nodes), *(it.node for it in ends)))
    return GRAPH._replace(nodes=tuple(map(Node, nodes)), ends=(*ENDS, *ends), edges=edges)


def nodes(made: Scene) -> dict[str, str]:
    return {it.name: it.state for group in made.groups for it in group.nodes if not it.is_robot}


def edges(made: Scene) -> dict[tuple[str, str], str]:
    return {(it.node, it.name): it.state for group in made.groups for it in group.edges}


def drawn(
    node: str, role: str, name: str, type_: str = A, state: str = OK, common: bool = False
) -> DrawnEdge:
    return DrawnEdge(node, TOPIC, role, name, type_, state, common)


def test_a_group_for_each_robot_and_one_for_the_rest() -> None:
    """Among what is shared a robot's nodes are one robot."""
    log = end("/r1/a", PUBLISHES, "/rosout", LOG)
    made = scene(graph=more(log))
    own, logged = (
        drawn("/r1/a", PUBLISHES, "/r1/t"),
        drawn("/r1/a", PUBLISHES, "/rosout", LOG, common=True),
    )
    to_all, heard = drawn("/r2/a", PUBLISHES, "/all"), drawn("/r2/a", SUBSCRIBES, "/r2/t")
    first, second = DrawnNode("/r1/a", "r1", OK, False, False), DrawnNode("/r2/a", "r2", OK)
    every = DrawnName(TOPIC, "/all", "", OK, (A,))
    rosout = DrawnName(TOPIC, "/rosout", "", OK, (LOG,))
    assert made.groups == (
        DrawnGroup(
            "r1", (first,), (DrawnName(TOPIC, "/r1/t", "r1", OK, (A,)), rosout), (own, logged)
        ),
        DrawnGroup(
            "r2", (second,), (every, DrawnName(TOPIC, "/r2/t", "r2", OK, (A,))), (to_all, heard)
        ),
        DrawnGroup(
            "",
            (
                DrawnNode("/s", "", OK),
                DrawnNode("r1", "r1", OK, True),
                DrawnNode("r2", "r2", OK, True),
            ),
            (every, rosout),
            (
                drawn("/s", SUBSCRIBES, "/all"),
                logged._replace(node="r1", type=""),
                to_all._replace(node="r2", type=""),
            ),
        ),
    )
    assert (made.crossings, made.trees, made.rows) == ((), (), ())
    assert (made.layout, made.robots) == ("both", ("r1", "r2"))
    assert made.outcome == Outcome(Verdict.PLANNED, "as planned")
    assert made.running == {"/r1/a", "/r2/a", "/s"}


def test_a_command_may_say_the_outcome() -> None:
    said = Outcome(Verdict.WRONG, "so")
    assert make_scene(PLAN, GRAPH, [], said).outcome == said
    assert scene(found("MG301")).outcome == Outcome(Verdict.WRONG, "not as planned")


def test_what_is_not_planned_is_unexpected() -> None:
    graph = more(end("/r1/new", PUBLISHES, "/r1/n"), end("/r1/a", SUBSCRIBES, "/r1/n"))
    made = scene(graph=graph)
    assert nodes(made) == {"/r1/a": OK, "/r1/new": UNEXPECTED, "/r2/a": OK, "/s": OK}
    assert edges(made)["/r1/new", "/r1/n"] == edges(made)["/r1/a", "/r1/n"] == UNEXPECTED
    states = {it.name: it.state for it in made.groups[0].names}
    assert states == {"/r1/t": OK, "/r1/n": UNEXPECTED}
    assert [it.is_tool for it in made.groups[0].nodes] == [False, True]


def test_a_helper_of_a_robots_node_is_expected() -> None:
    helper = "/r1/transform_listener_impl_55d0"
    made = scene(graph=more(end(helper, SUBSCRIBES, "/r1/x")))
    assert (nodes(made)[helper], edges(made)[helper, "/r1/x"]) == (OK, OK)
    alone = "/transform_listener_impl_55d0"
    made = scene(graph=more(end(alone, SUBSCRIBES, "/x")))
    assert (nodes(made)[alone], edges(made)[alone, "/x"]) == (UNEXPECTED, UNEXPECTED)


def test_a_shared_node_may_have_anything() -> None:
    assert edges(scene(graph=more(end("/s", PUBLISHES, "/other"))))["/s", "/other"] == OK


def test_an_action_may_be_planned_as_its_parts() -> None:
    part = end("/r1/a", SERVES, "/r1/go/_action/send_goal", "x/action/Go_SendGoal", SERVICE)
    plan = PLAN._replace(ends=(*ENDS, part))
    graph = more(part, end("/r1/a", SERVES, "/r1/go", "x/action/Go", ACTION))
    assert edges(scene(plan=plan, graph=graph))["/r1/a", "/r1/go"] == OK
    assert edges(scene(graph=graph))["/r1/a", "/r1/go"] == UNEXPECTED
    # The parts of an action are what every node has.
    common = {it.name: it.common for it in scene(graph=graph).groups[0].edges}
    assert common == {"/r1/t": False, "/r1/go": False, "/r1/go/_action/send_goal": True}


@pytest.mark.parametrize(
    ("type_", "common"),
    [
        ("rcl_interfaces/msg/Log", True), ("lifecycle_msgs/srv/GetState", True),
        ("type_description_interfaces/srv/X", True), ("bond/msg/Status", True),
        ("tf2_msgs/msg/TFMessage", True), ("std_msgs/msg/Log", False),
    ],
)  # fmt: skip
def test_what_every_node_has(type_: str, common: bool) -> None:
    made = scene(graph=more(end("/r1/a", PUBLISHES, "/r1/n", type_)))
    assert {it.name: it.common for it in made.groups[0].edges}["/r1/n"] is common


def test_a_node_that_is_missing_is_drawn_with_its_names() -> None:
    gone = GRAPH._replace(nodes=GRAPH.nodes[1:], ends=ENDS[1:])
    made = scene(found("MG101", "/r1/a"), graph=gone)
    assert nodes(made)["/r1/a"] == edges(made)["/r1/a", "/r1/t"] == MISSING
    assert edges(scene(graph=gone)).get(("/r1/a", "/r1/t")) is None
    # Its name in place of another is missing too, and what another one still has is there.
    half = GRAPH._replace(ends=ENDS[1:])
    made = scene(found("MG102", "/r1/a", "/r1/t"), graph=half)
    assert (nodes(made)["/r1/a"], edges(made)["/r1/a", "/r1/t"]) == (OK, MISSING)


def test_a_leak_is_at_its_robot_and_among_what_is_shared() -> None:
    graph = more(end("/r1/a", PUBLISHES, "/t"), end("/r2/a", SUBSCRIBES, "/r1/t"))
    made = scene(
        found("MG320", "/r1/a", "/t", robot="r1"), found("MG321", "/r2/a", "/r1/t", robot="r2"),
        graph=graph,
    )  # fmt: skip
    assert nodes(made) == {"/r1/a": LEAK, "/r2/a": CROSS_TALK, "/s": OK}
    assert made.crossings == (
        Crossing("r1", "", "", LEAK, ("publishes /t",)),
        Crossing("r2", "", "r1", CROSS_TALK, ("subscribes /r1/t",)),
    )
    # A faulty end keeps its own node among what is shared.
    assert drawn("/r1/a", PUBLISHES, "/t", state=LEAK) in made.groups[2].edges


def test_a_tool_that_reaches_into_a_robot_crosses() -> None:
    log = end("/tool", PUBLISHES, "/r1/log", LOG)
    graph = more(end("/tool", SUBSCRIBES, "/r1/t"), end("/tool", SUBSCRIBES, "/r2/t"), log)
    made = scene(graph=graph)
    assert made.crossings == (
        Crossing("", "/tool", "r1", UNEXPECTED, ("subscribes /r1/t",)),
        Crossing(
            "",
            "/tool",
            "r2",
            UNEXPECTED,
            ("subscribes /r2/t",),
        ),
    )


def test_what_crosses_is_in_the_order_of_robots_not_of_nodes() -> None:
    graph = more(end("/r1/a", PUBLISHES, "/t"), end("/tool", SUBSCRIBES, "/r1/t"))
    made = scene(found("MG320", "/r1/a", "/t", robot="r1"), graph=graph)
    assert made.crossings == (
        Crossing("", "/tool", "r1", UNEXPECTED, ("subscribes /r1/t",)),
        Crossing("r1", "", "", LEAK, ("publishes /t",)),
    )


def test_a_node_under_another_name_is_a_leak() -> None:
    lost = GRAPH._replace(
        nodes=(Node("/a"), *GRAPH.nodes[1:]), ends=(ENDS[0]._replace(node="/a"), *ENDS[1:])
    )
    made = scene(found("MG101", "/r1/a"), graph=lost)
    assert (nodes(made)["/a"], nodes(made)["/r1/a"]) == (LEAK, MISSING)


def test_a_topic_that_no_bridge_carries_is_missing_at_the_bridge() -> None:
    plan = PLAN._replace(topics=(Topic("/r1/cmd", bridge=(PUBLISHES,), type=A),))
    told = found("MG126", "", "/r1/cmd", robot="r1")
    made = scene(told, plan=plan)
    assert edges(made)[BRIDGE, "/r1/cmd"] == MISSING and nodes(made)[BRIDGE] == MISSING
    assert drawn(BRIDGE, PUBLISHES, "/r1/cmd", state=MISSING) in made.groups[0].edges
    carried = more(end("/ros_gz_bridge", PUBLISHES, "/r1/cmd"))
    assert (BRIDGE, "/r1/cmd") not in edges(scene(told, plan=plan, graph=carried))
    assert edges(scene(plan=plan, graph=carried))["/ros_gz_bridge", "/r1/cmd"] == OK
    assert (BRIDGE, "/r1/cmd") not in edges(scene(plan=plan))


def test_alternatives_are_kept() -> None:
    either = Sure("runs", instead=("/r1/a", "/r1/b"))
    plan = PLAN._replace(nodes=(NODES[0]._replace(sure=either), *NODES[1:]))
    assert scene(plan=plan).one_of == (("/r1/a", "/r1/b"),)


@pytest.mark.parametrize(
    ("node", "place"),
    [
        (Node("/r1/a", robot="r1", plugin=Place("r.urdf", 7), node_set="nav2"), "r.urdf:7"),
        (Node("/r1/a", robot="r1", place=Place("f.yaml", 3), node_set="nav2"), "f.yaml:3"),
        (Node("/r1/a", robot="r1", node_set="nav2"), "node set nav2"),
        (Node("/r1/a", robot="r1"), ""),
    ],
)
def test_where_the_node_of_a_finding_comes_from(node: Node, place: str) -> None:
    plan = PLAN._replace(nodes=(node, *NODES[1:]))
    (row,) = scene(found("MG101", "/r1/a", robot="r1"), plan=plan).rows
    assert (row.place, row.robots) == (place, ("r1",))
    (row,) = scene(found("MG101", "/r1/a", file="p.yaml", line=9), plan=plan).rows
    assert row.place == "p.yaml:9"
    (row,) = scene(found("MG101", "/r1/a", file="p.yaml"), plan=plan).rows
    assert row.place == "p.yaml"
    assert scene(found("MG101", "/none")).rows[0].place == ""


def test_what_is_true_of_two_robots_is_one_row() -> None:
    both = [found("MG101", f"/{it}/a", robot=it) for it in ("r1", "r2")]
    (row,) = scene(*both).rows
    assert row.robots == ("r1", "r2") and row.finding.robots == ("r1", "r2")
    assert row.targets == Targets(("/r1/a", "/r2/a"), (), ())
    assert len(scene(*both).findings) == 2


@pytest.mark.parametrize(
    ("states", "state"),
    [
        ((MISSING,), MISSING), ((UNEXPECTED,), UNEXPECTED), ((OK, MISSING), OK),
        ((OK, UNEXPECTED), OK), ((MISSING, UNEXPECTED), OK), ((OK, CLASH, LEAK), LEAK),
        ((MISSING, CLASH), CLASH),
    ],
)  # fmt: skip
def test_a_name_is_missing_only_where_all_its_ends_are(states: tuple[str, ...], state: str) -> None:
    assert combined_state(states) == state


def test_the_worst_of_some_states() -> None:
    order = ["leak", "cross-talk", "clash", "missing", "unexpected", "ok"]
    for at, state in enumerate(order):
        assert worst(reversed(order[at:])) == state
    assert worst(()) == "ok"


# ---------------------------------------------------------------- what a finding is about


def targets(finding: Finding, graph: System = GRAPH, plan: System = PLAN) -> Targets:
    (it,) = find_targets(*side_by_side(plan, graph), [finding])
    return it


def test_a_finding_is_about_its_node_and_names() -> None:
    graph = more(end("/r2/b", SUBSCRIBES, "/r1/t"), end("/r2/a", SUBSCRIBES, "/r1/t"))
    assert targets(found("MG321", "/r2/b", "/r1/t"), graph) == Targets(("/r2/b",), ("/r1/t",), ())
    named = found("MG321", "/r2/b", "/r1/t", message="reads what /r2/a, has")
    assert targets(named, graph).nodes == ("/r2/b", "/r2/a")
    # Types that differ are a fault of all ends.
    assert targets(found("MG306", "/r2/b", "/r1/t"), graph).nodes == ("/r2/b", "/r1/a", "/r2/a")


def test_a_finding_without_a_node_is_about_its_robot_or_who_has_the_name() -> None:
    assert targets(found("MG109", robot="r1")) == Targets(("/r1/a",), (), ())
    heard = more(end("/a", SUBSCRIBES, "/all"))
    about = targets(found("MG303", "", "/all"), heard)
    assert about == Targets(("/a", "/r2/a", "/s"), ("/all",), ())


def test_a_name_may_be_a_node() -> None:
    assert targets(found("MG301", "/s", "/r1/a", "/r2/a")) == Targets(("/r1/a", "/r2/a"), (), ())
    # What is a topic, too, is one.
    graph = more(end("/r1/t", PUBLISHES, "/x"))
    assert targets(found("MG303", "", "/r1/t"), graph).names == ("/r1/t",)
    either = Sure("runs", instead=("/r1/a", "/r1/b"))
    plan = PLAN._replace(nodes=(NODES[0]._replace(sure=either), *NODES[1:]))
    assert targets(found("MG112", "", "/r1/b"), plan=plan) == Targets(("/r1/b",), (), ())


TREE = (
    Edge("r1/base", "map", "/r1/tf", False, ()),
    Edge("r2/base", "map", "/r2/tf", False, ()),
)


@pytest.mark.parametrize(
    ("robot", "message", "topics"),
    [
        ("r1", "it", ["/r1/tf"]),
        ("", "it", ["/r1/tf", "/r2/tf"]),
        ("r1", "comes on /r2/tf_static: too", ["/r2/tf"]),
        ("r9", "it", ["/r1/tf", "/r2/tf"]),
    ],
)
def test_a_finding_about_frames_is_where_they_are_drawn(
    robot: str, message: str, topics: list[str]
) -> None:
    told = found("MG401", "/r1/a", "base", robot=robot, message=message)
    about = targets(told, GRAPH._replace(edges=TREE))
    assert about == Targets(("/r1/a",), (), tuple((topic, "base") for topic in topics))
    assert targets(told._replace(node=""), GRAPH._replace(edges=TREE)).nodes == ()


def test_a_finding_about_tf_topics_is_about_names() -> None:
    graph = more(end("/r1/a", PUBLISHES, "/tf"), edges=TREE)
    assert targets(found("MG405", "/r1/a", "/tf"), graph) == Targets(("/r1/a",), ("/tf",), ())
    both = targets(found("MG405", "/r1/a", "/tf", "base", robot="r1"), graph)
    assert both.frames == (("/r1/tf", "/tf"), ("/r1/tf", "base"))


def test_states_follow_from_what_findings_are_about() -> None:
    findings = [
        found("MG320"), found("MG102"), found("MG401"), found("MG401"), found("MG208"), found("MX1"),
        found("MX2", level="warning"), found("MX3", level="note"),
    ]  # fmt: skip
    frame = ("/tf", "base")
    about = [
        Targets(("/a",), ("/t",), ()), Targets(("/a",), ("/t", "/u"), ()),
        Targets((), (), (frame,)), Targets((), (), (frame,)), Targets((), (), (frame,)),
        Targets(("/a", "/b"), (), ()), Targets(("/b", "/c"), (), ()), Targets(("/d",), (), ()),
    ]  # fmt: skip
    made = make_states(findings, about)
    assert made.endpoints == {("/a", "/t"): LEAK, ("/a", "/u"): MISSING}
    assert made.nodes == {"/a": CLASH, "/b": CLASH, "/c": UNEXPECTED, "/d": OK}
    assert made.frames == {frame: ("MG401", "MG208")}
    assert made.names == {"/t", "/u"}


def test_targets_of_several_findings_are_each_once() -> None:
    one = Targets(("/a",), ("/t",), (("/tf", "x"),))
    other = Targets(("/b", "/a"), ("/t", "/u"), ())
    assert merged([one, other]) == Targets(("/a", "/b"), ("/t", "/u"), (("/tf", "x"),))


@pytest.mark.parametrize(
    ("finding", "robots"),
    [
        (found("MG301", "/r1/a"), {"r1"}),
        (found("MG301", "/s", robot="r1", robots=("r1", "r2")), {"r1", "r2"}),
        (found("MG301", "/s", "/r2/t"), {"r2"}),
        (found("MG401", "", "r2/base"), {"r2"}),
        (found("MG301", "/s", message="as /r1/a, and r2: do"), {"r1", "r2"}),
        (found("MG301", "/s", robot="r9"), set()),
        (found("MF701", "", message="robot 'r1': a pose", robots=("r1", "r2")), {"r1", "r2"}),
    ],
)
def test_robots_that_a_finding_concerns(finding: Finding, robots: set[str]) -> None:
    assert robots_of(side_by_side(PLAN, GRAPH)[0], finding) == robots


def test_a_frame_has_the_word_that_its_robot_has_in_frames() -> None:
    plan = PLAN._replace(robots=(ROBOTS[0], ROBOTS[1]._replace(frames=("t2/base",), tag="t2")))
    about = side_by_side(plan, GRAPH)[0]
    assert robots_of(about, found("MG401", "", "t2/base")) == {"r2"}
    assert robots_of(about, found("MG301", "", "t2/base")) == set()


def test_words_are_without_punctuation() -> None:
    assert words_of("a, (b) c: d; e? f") == {"a", "b", "c", "d", "e", "f"}


# ---------------------------------------------------------------- frames


def row(frame: str, parent: int, depth: int, robot: str = "r1", **more: object) -> FrameRow:
    return FrameRow(frame, parent, depth, robot, OK, (), False, False)._replace(**more)  # type: ignore[arg-type]


def test_the_tree_of_each_topic_and_what_was_not_received() -> None:
    graph = GRAPH._replace(
        edges=(
            Edge("r1/scan", "r1/base", "/r1/tf_static", True, ()),
            Edge("r1/base", "map", "/r1/tf", False, ()),
            Edge("x", "y", "/other/tf", False, ()),
        )
    )
    faults = found("MG401", "", "r1/base", robot="r1"), found("MG208", "", "r2/scan", robot="r2")
    assert scene(*faults, graph=graph).trees == (
        FrameTree(
            "/r1/tf", "r1", True,
            (
                row("map", -1, 0),
                row("r1/base", 0, 1, state=CLASH, faults=("two parents",)),
                row("r1/scan", 1, 2, static=True),
            ),
        ),
        FrameTree(
            "/r2/tf", "r2", False,
            (
                row("r2/base", -1, 0, "r2", state=MISSING),
                row("r2/scan", -1, 0, "r2", state=MISSING, faults=("frame not received",)),
            ),
        ),
        FrameTree("/other/tf", "", True, (row("y", -1, 0, ""), row("x", 0, 1, ""))),
    )  # fmt: skip


def one_topic(*pairs: str, robots: str = "ab") -> list[tuple[str, str]]:
    """Robot and rows of each tree on /tf: frames, indented by depth, ``+`` where repeated."""
    plan = System(robots=tuple(Robot(it, (), "/tf") for it in robots))
    edges = tuple(
        Edge(child, parent, "/tf", False, ()) for parent, child in (it.split(">") for it in pairs)
    )
    found = make_scene(plan, System(edges=edges), []).trees
    return [
        (it.robot, " ".join(f"{'-' * one.depth}{one.frame}{'+' * one.repeated}" for one in it.rows))
        for it in found
    ]


def test_below_a_root_of_all_each_robot_has_a_tree() -> None:
    trees = one_topic("map>b/x", "map>a/x", "map>a/y", "a/y>a/z", "map>door")
    assert trees == [("a", "map -a/x -a/y --a/z"), ("b", "map -b/x"), ("", "map -door")]


def test_below_a_root_of_a_robot_there_is_one_tree() -> None:
    assert one_topic("a/x>b/x", "a/x>a/y") == [("a", "a/x -a/y -b/x")]


def test_a_frame_below_two_parents_is_shown_whole_once() -> None:
    assert one_topic("a/x>a/z", "a/x>a/y", "a/y>a/z", "a/z>a/w") == [
        ("a", "a/x -a/y --a/z ---a/w -a/z+"),
    ]


def test_frames_in_a_loop_are_shown() -> None:
    assert one_topic("a/x>a/y", "a/y>a/x") == [("a", "a/x -a/y --a/x+")]


def test_a_frame_without_a_robots_name_is_of_the_only_robot() -> None:
    assert one_topic("map>x", robots="a") == [("a", "map -x")]
