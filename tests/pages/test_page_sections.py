# SPDX-License-Identifier: Apache-2.0
"""What the page puts where: sections, what is drawn of a group, ids, and where a finding leads."""

from __future__ import annotations

import pytest
from page_calls import (
    CLASH,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    DrawnEdge,
    DrawnGroup,
    DrawnName,
    DrawnNode,
    FindingRow,
    FrameRow,
    FrameTree,
    Outcome,
    Scene,
    Targets,
    Verdict,
    concerns_of,
    css_class_of,
    has_faults,
    ids_in,
    ids_of,
    link_to,
    make_ids,
    make_scene,
    make_sections,
    only_common,
    summarize,
    to_html,
    without_common,
)

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, Finding
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Environment,
    Robot,
    System,
)

SECTIONS = {"": ("all", {"n1"}), "robot1": ("one", {"n1", "n2"}), "robot2": ("two", {"n1", "n3"})}


# The robot's own section first, another that has it otherwise, and at last the head of its own.
@pytest.mark.parametrize(
    ("robot", "targets", "link"),
    [
        ("robot1", ["n1"], "#one-n1"), ("robot2", ["n1"], "#two-n1"), ("", ["n1"], "#all-n1"),
        ("robot1", ["n3"], "#two-n3"), ("robot3", ["n2"], "#one-n2"), ("robot3", ["n1"], "#all-n1"),
        ("robot1", ["n9", "n3"], "#two-n3"), ("robot2", ["n9"], "#two"), ("robot3", [], "#all"),
        ("robot1", ["f4", "n1"], "#tf-f4"),
    ],
)  # fmt: skip
def test_a_finding_leads_to_its_robot(robot: str, targets: list[str], link: str) -> None:
    finding = Finding("MG301", "error", "it", robot=robot)
    assert link_to(finding, targets, SECTIONS) == link


def test_errors_are_above_what_is_not_certain_and_the_head_says_the_count_and_the_rows() -> None:
    """Codes are sorted the other way round: MG101 is inconclusive, MG301 an error."""
    robots = tuple(Robot(it, (), f"/{it}/tf") for it in ("robot1", "robot2"))
    plan = System(robots=robots, layout="tf-per-robot")
    found = [
        Finding("MG101", INCONCLUSIVE, "missing", node=f"/{it.name}/amcl", robot=it.name)
        for it in robots
    ]
    found.append(Finding("MG301", ERROR, "twice", robot="robot1"))
    scene = make_scene(plan, System(), found)
    assert [it.finding.level for it in scene.rows] == [ERROR, INCONCLUSIVE]
    assert "<li>1 error, 2 inconclusive in 2 rows</li>" in to_html(scene).decode()


def edge(
    node: str,
    name: str,
    role: str = PUBLISHES,
    state: str = OK,
    common: bool = False,
    kind: str = TOPIC,
) -> DrawnEdge:
    return DrawnEdge(node, kind, role, name, "", state, common)


def group(*edges: DrawnEdge, robot: str = "", nodes: tuple[DrawnNode, ...] = ()) -> DrawnGroup:
    known = {it.name for it in nodes}
    more = dict.fromkeys(it.node for it in edges if it.node not in known)
    names = dict.fromkeys((it.kind, it.name) for it in edges)
    return DrawnGroup(
        robot,
        (*nodes, *(DrawnNode(it, robot, OK) for it in more)),
        tuple(DrawnName(kind, name, robot, OK, ()) for kind, name in names),
        edges,
    )


def scene(
    *groups: DrawnGroup, rows: tuple[FindingRow, ...] = (), trees: tuple[FrameTree, ...] = ()
) -> Scene:
    robots = tuple(it.robot for it in groups if it.robot)
    return Scene(
        Outcome(Verdict.PLANNED, "as planned"), "both", robots, groups, (), trees,
        tuple(it.finding for it in rows), rows, Environment(), (), frozenset(),
    )  # fmt: skip


NOTHING = Targets((), (), ())


def row(*robots: str, level: str = "error", targets: Targets = NOTHING) -> FindingRow:
    return FindingRow(Finding("MG301", level, "it"), targets, robots, "")


def names(part: DrawnGroup) -> list[str]:
    return [it.name for it in part.names]


def test_what_every_node_has_is_put_away_unless_it_is_faulty() -> None:
    whole = group(
        edge("a", "own"), edge("a", "log", common=True), edge("a", "bad", common=True, state=CLASH),
        edge("a", "odd", common=True, state=UNEXPECTED),
    )  # fmt: skip
    assert names(without_common(whole)) == ["own", "bad"]
    assert names(only_common(whole)) == ["log", "odd"]
    assert [it.name for it in only_common(whole).nodes] == ["a"]


def test_what_a_missing_node_has_in_common_is_not_missed() -> None:
    gone = DrawnNode("a", "", MISSING)
    whole = group(edge("a", "log", common=True, state=MISSING), nodes=(gone,))
    assert names(without_common(whole)) == []
    assert [it.name for it in without_common(whole).nodes] == ["a"]


def test_robots_and_tools_without_an_edge_are_dropped() -> None:
    nodes = (
        DrawnNode("r", "r", OK, is_robot=True), DrawnNode("tool", "", OK, is_tool=True),
        DrawnNode("idle", "", OK), DrawnNode("used", "r", OK, is_robot=True),
    )  # fmt: skip
    whole = group(edge("used", "t"), edge("r", "log", common=True), nodes=nodes)
    assert [it.name for it in without_common(whole).nodes] == ["idle", "used"]
    assert [it.name for it in only_common(whole).nodes] == ["r"]


def served(node: str, *names: str, **more: str) -> list[DrawnEdge]:
    return [edge(node, it, SERVES, kind=SERVICE, **more) for it in names]  # type: ignore[arg-type]


def test_three_services_without_a_client_are_one() -> None:
    ends = [it._replace(type=f"x/srv/{it.name}") for it in served("a", "x", "y", "z")]
    light = without_common(group(edge("a", "t"), *ends, robot="r"))
    assert light.edges[1].type == "x/srv/x"
    assert light.names[1:] == (DrawnName(SERVICE, "a service", "r", OK, (), ("x", "y", "z")),)
    assert [(it.node, it.name, it.role, it.state) for it in light.edges] == [
        ("a", "t", PUBLISHES, OK), ("a", "a service", SERVES, OK),
    ]  # fmt: skip
    unexpected = without_common(group(*served("a", "x", "y", "z", state=UNEXPECTED)))
    assert [it.state for it in (*unexpected.names, *unexpected.edges)] == [OK, OK]


@pytest.mark.parametrize(
    "ends",
    [
        served("a", "x", "y"),
        [*served("a", "x", "y"), *served("b", "z")],
        [*served("a", "x", "y", "z"), edge("b", "z", CALLS, kind=SERVICE)],
        [*served("a", "x", "y"), *served("a", "z", state=LEAK)],
        [edge("a", it, CALLS, kind=SERVICE) for it in "xyz"],
        [edge("a", it, SUBSCRIBES) for it in "xyz"],
    ],
)
def test_other_names_are_drawn_each(ends: list[DrawnEdge]) -> None:
    whole = group(*ends)
    assert without_common(whole) == whole


def test_faults_are_what_is_missing_or_wrong() -> None:
    assert has_faults(group(edge("a", "t", state=MISSING)))
    assert has_faults(group(nodes=(DrawnNode("a", "", LEAK),)))
    assert not has_faults(group(edge("a", "t", state=UNEXPECTED), edge("a", "u")))


def test_everything_drawn_has_a_short_id_and_what_is_found_an_anchor() -> None:
    tree = FrameTree("/tf", "", True, (FrameRow("b", -1, 0, "", OK, (), False, False),) * 2)
    targets = Targets(("/b", "/none"), ("/u",), (("/tf", "b"), ("/tf", "x")))
    made = scene(
        group(edge("/b", "/u"), robot="r"), group(edge("/a", "/t")),
        trees=(tree, tree._replace(topic="/tf2")), rows=(row(targets=targets),),
    )  # fmt: skip
    ids = make_ids(made)
    assert (ids.nodes, ids.names) == ({"/a": "n0", "/b": "n1"}, {"/t": "t0", "/u": "t1"})
    assert ids.frames == {("/tf", "b"): "f0", ("/tf2", "b"): "f1"}
    assert ids.anchors == {"n1", "t1", "f0"}
    assert ids_of(targets, ids) == ["t1", "n1", "f0"]


def test_a_section_for_each_robot_and_one_for_the_rest() -> None:
    made = scene(
        group(edge("/a/x", "/a/t"), robot="a"), group(edge("/b/x", "/t", state=LEAK), robot="b"),
        group(edge("/c", "/t")),
        rows=(row("a"), row("a", level="warning"), row("a", level="note"), row()),
    )  # fmt: skip
    first, second, rest = make_sections(made)
    assert (first.id, second.id, rest.id) == ("g0", "g1", "shared")
    assert first.levels == {"error": 1, "warning": 1, "inconclusive": 0}
    assert [it.faulty for it in (first, second, rest)] == [True, True, True]
    assert [it.open for it in (first, second, rest)] == [True] * 3
    assert [css_class_of(it) for it in (first, second, rest)] == ["bad", "odd", "bad"]
    assert css_class_of(second._replace(faulty=False)) == "good"
    assert concerns_of(made) == {"a": (0, 1, 2), "": (3,)}
    ids = make_ids(made)
    assert ids_in(first, ids) == {ids.nodes["/a/x"], ids.names["/a/t"]}
    assert ids_in(first._replace(drawn=False), ids) == set()


def fleet(count: int, *rows: FindingRow) -> Scene:
    groups = [group(edge(f"/r{at}/x", f"/r{at}/t"), robot=f"r{at}") for at in range(count)]
    return scene(*groups, group(), rows=rows)


def opened(made: Scene) -> list[str]:
    return [it.id for it in make_sections(made) if it.open]


def test_of_a_larger_fleet_the_faulty_ones_are_unfolded() -> None:
    assert opened(fleet(3)) == ["g0", "g1", "g2", "shared"]
    assert opened(fleet(4)) == []
    assert opened(fleet(4, row("r2"))) == ["g2"]
    # The same findings are seen at the first robot.
    assert opened(fleet(5, row("r1", "r2", "r4"))) == ["g1"]
    assert opened(fleet(5, row("r1", "r2"), row("r2"))) == ["g1", "g2"]
    each = [row(f"r{at}") for at in range(12)]
    assert opened(fleet(12, *each)) == [f"g{at}" for at in range(10)]


def test_of_more_than_thirty_robots_the_faulty_ones_are_drawn() -> None:
    sections = make_sections(fleet(32, row("r31"), row("r30")))
    assert [it.id for it in sections if not it.drawn] == ["g28", "g29"]
    assert all(it.drawn for it in make_sections(fleet(30)))


def test_only_what_is_serious_is_said() -> None:
    levels = {"error": 2, "warning": 1, "inconclusive": 3, "note": 4}
    assert summarize(levels) == "2 errors, 1 warning, 3 inconclusive"
    assert summarize({"error": 0, "warning": 0, "inconclusive": 0}) == ""
