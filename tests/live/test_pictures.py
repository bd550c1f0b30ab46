# SPDX-License-Identifier: Apache-2.0
"""Pictures of a checked graph: what is wrong is drawn as that, and any name may be drawn."""

from __future__ import annotations

import base64
import hashlib
import itertools
import os
import random
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

import nav2_graphs
import pytest
from counted_steps import growth
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import html
from plans import own as nodes_of
from plans import told

from multibot_rewrite.base.findings.finding import INCONCLUSIVE
from multibot_rewrite.cli import multibot
from multibot_rewrite.live.watching import Verdict
from multibot_rewrite.pages.layout import NODE_ROW, ROW, lay_out
from multibot_rewrite.pages.page import to_html
from multibot_rewrite.pages.page_sections import only_common, without_common
from multibot_rewrite.pages.scene import DrawnGroup, Scene, make_scene
from multibot_rewrite.pages.states import (
    CLASH,
    CROSS_TALK,
    FAULTY,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
)
from multibot_rewrite.pages.svg import clipped, columns, visible
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.spelling.plan_file import to_yaml
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import MAY, PUBLISHES, Caveat, Edge, Node, System, surely

LEAKY = ("/robot1/cmd_vel", "/cmd_vel", "collision_monitor")
CROSSED = ("/robot2/scan", "/robot1/scan", "amcl")
ABSENT = "/robot2/bt_navigator"
# What a page is made of.
TAGS = frozenset(
    re.findall(
        r"\w+",
        """html head meta title style script body header main section h1 h2 h3 p ul li div span b em
        a code small pre label select option output input details summary
        dl dt dd svg defs marker g path rect text tspan""",
    )
)


def group(scene: Scene, robot: str) -> DrawnGroup:
    return next(group for group in scene.groups if group.robot == robot)


def states(scene: Scene, robot: str) -> dict[str, set[str]]:
    """The states of a group's edges, by name."""
    found: dict[str, set[str]] = {}
    for edge in group(scene, robot).edges:
        found.setdefault(edge.name, set()).add(edge.state)
    return found


def node_states(scene: Scene) -> dict[str, str]:
    return {node.name: node.state for group in scene.groups for node in group.nodes}


def page(scene: Scene) -> html.HtmlElement:
    return html.document_fromstring(to_html(scene).decode())


def pick(tree: html.HtmlElement, tag: str | None = None, look: str = "") -> list[html.HtmlElement]:
    """The elements of a tag that have these classes."""
    wanted = set(look.split())
    return [it for it in tree.iter(tag) if wanted <= set((it.get("class") or "").split())]


def section(tree: html.HtmlElement, id_: str) -> html.HtmlElement:
    return tree.get_element_by_id(id_)


def swarm() -> System:
    return nav2_graphs.fleet(30, 4)


# ---------------------------------------------------------------- the scene


@pytest.mark.slow
@pytest.mark.parametrize("layout", nav2_graphs.LAYOUTS)
def test_a_healthy_fleet_has_nothing_in_red(layout: str) -> None:
    plan = nav2_graphs.nav2(layout)
    scene = nav2_graphs.scene(plan, nav2_graphs.healthy(plan))
    assert scene.outcome.verdict == Verdict.PLANNED
    assert {edge.state for group in scene.groups for edge in group.edges} == {OK}
    assert set(node_states(scene).values()) == {OK}
    assert [group.robot for group in scene.groups] == ["robot1", "robot2", ""]
    assert scene.crossings == ()
    for robot in plan.robots:
        drawn = {n.name for n in group(scene, robot.name).nodes if n.robot == robot.name}
        assert drawn == set(nodes_of(plan, robot.name))


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", nav2_graphs.LAYOUTS)
def test_a_leak_is_red_at_its_robot_and_among_what_is_shared(layout: str) -> None:
    plan = nav2_graphs.nav2(layout)
    own = next(w for w in plan.ends if "collision_monitor" in w.node and "scan" in w.code_name)
    scene = nav2_graphs.scene(
        plan, nav2_graphs.moved(nav2_graphs.healthy(plan), own.name, "/scan", own.node)
    )
    assert states(scene, "robot1")["/scan"] == {LEAK}
    assert states(scene, "")["/scan"] == {LEAK}
    assert "/scan" not in states(scene, "robot2")
    assert node_states(scene)[own.node] == LEAK
    assert [(r.source, r.target, r.names) for r in scene.crossings] == [
        ("robot1", "", ("subscribes /scan",))
    ]


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("layout", "topics"),
    [
        ("L2", ["/tf and /tf_static"]),
        ("L4", [f"/tf/robot{n} and /tf_static/robot{n}" for n in "12"]),
    ],
)
def test_a_tree_is_told_with_its_two_topics(layout: str, topics: list[str]) -> None:
    plan = nav2_graphs.nav2(layout)
    (section,) = page(nav2_graphs.scene(plan, nav2_graphs.healthy(plan))).xpath(
        "//section[@id='tf']"
    )
    assert [it.text_content() for it in section.xpath("h3")] == topics


@pytest.mark.more
def test_what_is_missing_in_place_of_a_leak_is_drawn() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.moved(nav2_graphs.healthy(plan), *LEAKY))
    assert states(scene, "robot1")["/robot1/cmd_vel"] == {OK, LEAK, MISSING}
    assert node_states(scene)["/robot1/collision_monitor"] == LEAK


@pytest.mark.more
def test_cross_talk_is_red_in_both_groups_and_an_arrow_in_the_overview() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.moved(nav2_graphs.healthy(plan), *CROSSED))
    assert CROSS_TALK in states(scene, "robot1")["/robot1/scan"]
    assert states(scene, "robot2")["/robot1/scan"] == {CROSS_TALK}
    assert scene.crossings == (("robot2", "", "robot1", CROSS_TALK, ("subscribes /robot1/scan",)),)
    drawing = pick(page(scene), "svg", "overview")[0]
    assert len(pick(drawing, "path", "reach bad")) == 1
    assert [tile.get("class") for tile in pick(drawing, "g", "tile")] == ["tile bad", "tile bad"]


def test_a_node_that_is_not_there_is_drawn_with_its_names() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.without_node(nav2_graphs.healthy(plan), ABSENT))
    assert node_states(scene)[ABSENT] == MISSING
    own = {e.name for e in surely(plan).ends if e.node == ABSENT}
    missing = {e.name for e in group(scene, "robot2").edges if e.state == MISSING}
    assert missing == {name for name in own if "robot2" in name} | {"/tf", "/tf_static"}
    shown = {
        edge.name for edge in without_common(group(scene, "robot2")).edges if edge.state == MISSING
    }
    # Nobody misses the life cycle of a node that is not there.
    assert shown == {name for name in missing if "/bt_navigator/" not in name and "tf" not in name}


def test_a_silent_robot_is_drawn_as_missing_whole() -> None:
    plan = nav2_graphs.fleet(2, 4)
    graph = nav2_graphs.without_node(nav2_graphs.healthy(plan), "/robot1/driver")
    scene = nav2_graphs.scene(plan, nav2_graphs.without_node(graph, "/robot1/planner"))
    assert {node.state for node in group(scene, "robot1").nodes} == {MISSING}
    assert {edge.state for edge in group(scene, "robot1").edges} == {MISSING}


def test_what_a_plan_leaves_open_is_not_drawn_as_missing() -> None:
    plan = nav2_graphs.nav2()
    loose = told(plan, "/robot1/amcl", sure=MAY)
    scene = nav2_graphs.scene(
        loose, nav2_graphs.without_node(nav2_graphs.healthy(plan), "/robot1/amcl")
    )
    assert "/robot1/amcl" not in node_states(scene)
    assert FAULTY.isdisjoint(edge.state for edge in group(scene, "robot1").edges)


def test_an_unplanned_node_and_an_unplanned_topic() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.with_end(nav2_graphs.healthy(plan), "/robot1/gripper", "/robot1/grip")
    scene = nav2_graphs.scene(
        plan, nav2_graphs.with_end(graph, "/robot1/amcl", "/robot1/debug", PUBLISHES)
    )
    assert node_states(scene)["/robot1/gripper"] == UNEXPECTED
    assert states(scene, "robot1")["/robot1/grip"] == {UNEXPECTED}
    assert states(scene, "robot1")["/robot1/debug"] == {UNEXPECTED}
    assert node_states(scene)["/robot1/amcl"] == OK


def test_a_tool_with_nothing_of_its_own_is_put_away_and_an_unknown_node_is_not() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    for node in ("/rqt_gui", "/robot1/gripper"):
        log = next(it for it in graph.ends if it.name == "/rosout")._replace(node=node)
        seen = (*graph.nodes, Node(node, ""))
        graph = graph._replace(nodes=seen, ends=(*graph.ends, log))
    scene = nav2_graphs.scene(plan, graph)
    light = {n.name for one in scene.groups for n in without_common(one).nodes}
    more = {n.name for one in scene.groups for n in only_common(one).nodes}
    assert "/robot1/gripper" in light and "/rqt_gui" not in light and "/rqt_gui" in more


def test_a_clash_of_types_marks_all_ends() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    end = next(e for e in graph.ends if e.name == "/robot1/odom" and e.role == PUBLISHES)
    other = end._replace(type="std_msgs/msg/String", node="/robot1/amcl")
    scene = nav2_graphs.scene(plan, graph._replace(ends=(*graph.ends, other)))
    assert states(scene, "robot1")["/robot1/odom"] == {CLASH}
    (name,) = (n for n in group(scene, "robot1").names if n.name == "/robot1/odom")
    assert len(name.types) == 2


def test_two_nodes_of_one_name_clash() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    twin = graph._replace(nodes=(*graph.nodes, Node("/robot1/amcl", "other")))
    assert node_states(nav2_graphs.scene(plan, twin))["/robot1/amcl"] == CLASH


def test_a_node_started_without_its_namespace_is_a_leak() -> None:
    plan = nav2_graphs.fleet(2, 2)
    graph = nav2_graphs.healthy(plan)
    lost = graph._replace(
        nodes=tuple(n._replace(name=n.name.replace("/robot1/d", "/d")) for n in graph.nodes),
        ends=tuple(e._replace(node=e.node.replace("/robot1/d", "/d")) for e in graph.ends),
    )
    found = node_states(nav2_graphs.scene(plan, lost))
    assert (found["/driver"], found["/robot1/driver"]) == (LEAK, MISSING)


def test_among_what_is_shared_a_robot_is_one_box() -> None:
    plan = nav2_graphs.nav2()
    shared = group(nav2_graphs.scene(plan, nav2_graphs.healthy(plan)), "")
    assert {node.name for node in shared.nodes} == {"robot1", "robot2"}
    assert all(node.is_robot for node in shared.nodes)
    assert {name.name for name in shared.names} >= {"/rosout", "/diagnostics", "/tf"}


def test_in_an_incomplete_view_the_verdict_is_open() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.without_node(nav2_graphs.healthy(plan), ABSENT)
    cut = nav2_graphs.environment(
        Caveat("participant-limit", True, "the view may be cut off at 32")
    )
    scene = nav2_graphs.scene(plan, graph._replace(environment=cut))
    assert scene.outcome.verdict == Verdict.INCONCLUSIVE
    assert {finding.level for finding in scene.findings} == {INCONCLUSIVE}
    header = pick(page(scene), "header")[0].text_content()
    assert "inconclusive, the view may be incomplete" in header
    assert "the view may be cut off at 32" in header


def test_the_light_picture_and_the_rest_are_the_whole() -> None:
    plan = nav2_graphs.nav2()
    for one in nav2_graphs.scene(plan, nav2_graphs.spoiled(plan)).groups:
        light, more = without_common(one), only_common(one)
        merged = {name for it in light.names for name in it.merged}
        shown = {n.name for n in light.names if not n.merged}
        assert shown | {name.name for name in more.names} == {name.name for name in one.names}
        assert merged <= {name.name for name in more.names}
        assert not any(name in shown for name in ("/rosout", "/parameter_events"))
        # What is wrong is never put away.
        assert {e.name for e in more.edges if e.state in FAULTY - {MISSING}} == set()


# ---------------------------------------------------------------- places


def scenes() -> Iterable[Scene]:
    for layout in nav2_graphs.LAYOUTS:
        plan = nav2_graphs.nav2(layout)
        yield nav2_graphs.scene(plan, nav2_graphs.healthy(plan))
    plan = nav2_graphs.nav2()
    yield nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    yield nav2_graphs.scene(*nav2_graphs.nasty(plan))
    yield nav2_graphs.scene(swarm(), nav2_graphs.healthy(swarm()))


@pytest.mark.slow
def test_nothing_overlaps_and_everything_has_a_place() -> None:
    for scene in scenes():
        for one in scene.groups:
            for part in (one, without_common(one), only_common(one)):
                place = lay_out(part)
                assert {name.name for name, _ in place.names} == {n.name for n in part.names}
                both = {node.name for node, _ in (*place.left, *place.right)}
                assert both == {node.name for node in part.nodes}
                for column, gap in ((place.left, NODE_ROW), (place.right, NODE_ROW)):
                    assert_apart([y for _, y in column], gap)
                assert_apart([y for _, y in place.names], ROW)
                every = [y for column in place[:3] for _, y in column]
                assert all(0 < y < place.height for y in every)


def assert_apart(places: list[float], gap: float) -> None:
    order = sorted(places)
    assert all(b - a >= gap - 0.01 for a, b in itertools.pairwise(order))


def test_faults_are_at_the_top() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    order = [name for name, _ in lay_out(without_common(group(scene, "robot1"))).names]
    assert [name.name for name in order[:2]] == ["/cmd_vel", "/robot1/cmd_vel"]


def test_the_order_leaves_fewer_crossings_than_the_alphabet() -> None:
    plan = nav2_graphs.nav2()
    one = without_common(group(nav2_graphs.scene(plan, nav2_graphs.healthy(plan)), "robot1"))
    place = lay_out(one)
    rows = {(n.kind, n.name): y for n, y in place.names}
    left = {n.name: y for n, y in place.left}
    alphabet = {key: at for at, key in enumerate(sorted(rows))}
    names = {node: at for at, node in enumerate(sorted(left))}
    ends = [(e.node, (e.kind, e.name)) for e in one.edges if e.role in ("publishes", "serves")]
    mine = crossings([(left[node], rows[key]) for node, key in ends])
    plainly = crossings([(names[node], alphabet[key]) for node, key in ends])
    assert mine < plainly / 4


def crossings(edges: list[tuple[float, float]]) -> int:
    pairs = itertools.combinations(edges, 2)
    return sum((a[0] - b[0]) * (a[1] - b[1]) < 0 for a, b in pairs)


# ---------------------------------------------------------------- tf


@pytest.mark.more
def test_each_robot_has_its_own_tree_below_a_shared_root() -> None:
    plan = nav2_graphs.nav2("L2")
    trees = nav2_graphs.scene(plan, nav2_graphs.healthy(plan)).trees
    assert [(tree.topic, tree.robot, tree.rows[0].frame) for tree in trees] == [
        ("/tf", "robot1", "map"),
        ("/tf", "robot2", "map"),
    ]
    assert {row.robot for row in trees[1].rows[1:]} == {"robot2"}


@pytest.mark.more
def test_a_tf_topic_a_robot_is_a_tree_a_robot() -> None:
    plan = nav2_graphs.nav2("L1")
    trees = nav2_graphs.scene(plan, nav2_graphs.healthy(plan)).trees
    assert [tree.topic for tree in trees] == ["/robot1/tf", "/robot2/tf"]
    assert {row.robot for row in trees[0].rows} == {"robot1"}
    assert [row.static for row in trees[0].rows[:3]] == [False, False, True]


def with_frames(plan: System, *more: Edge) -> Scene:
    graph = nav2_graphs.healthy(plan)
    return nav2_graphs.scene(plan, graph._replace(edges=(*graph.edges, *more)))


def test_a_frame_with_two_parents_is_red_below_both() -> None:
    scene = with_frames(nav2_graphs.nav2(), Edge("imu_link/robot1", "map", "/tf", False, ()))
    (first, second) = (
        row for tree in scene.trees for row in tree.rows if row.frame == "imu_link/robot1"
    )
    assert (first.state, first.faults) == (CLASH, ("two parents",))
    assert second.repeated and not first.repeated
    red = [row.frame for tree in scene.trees for row in tree.rows if row.state == CLASH]
    assert set(red) == {"imu_link/robot1"}


def test_bare_frames_are_red_on_one_robots_topic_only() -> None:
    scene = with_frames(nav2_graphs.nav2("L1"), Edge("imu_link", "map", "/robot1/tf", False, ()))
    red = {t.topic for t in scene.trees for row in t.rows if row.state == CLASH}
    assert red == {"/robot1/tf"}


def test_a_declared_frame_that_was_not_heard() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    last = plan.robots[1].frames[-1]
    silent = graph._replace(edges=tuple(f for f in graph.edges if f.child != last))
    unheard = nav2_graphs.scene(plan, silent).trees[-1]
    assert (unheard.received, unheard.robot) == (False, "robot2")
    assert [(row.frame, row.state) for row in unheard.rows] == [(last, MISSING)]


def test_without_any_tf_no_frame_is_called_missing() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.healthy(plan)._replace(edges=()))
    assert scene.trees == ()
    assert "No tf messages were received" in section(page(scene), "tf").text_content()


@pytest.mark.slow
def test_a_ring_and_a_chain_deeper_than_pythons_stack_end() -> None:
    ring = [Edge(f"r{(at + 1) % 3}", f"r{at}", "/tf", False, ()) for at in range(3)]
    chain = [Edge(f"c{at + 1}", f"c{at}", "/tf", False, ()) for at in range(1500)]
    scene = with_frames(nav2_graphs.nav2(), *ring, *chain)
    rows = {row.frame: row for tree in scene.trees for row in tree.rows}
    assert rows["c1500"].depth == 1500
    assert {"r0", "r1", "r2"} <= set(rows)
    assert to_html(scene)


# ---------------------------------------------------------------- the page


@pytest.mark.more
def test_the_page_is_one_file_that_asks_for_nothing() -> None:
    plan = nav2_graphs.nav2()
    text = to_html(nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))).decode()
    tree = html.document_fromstring(text)
    for element in tree.iter():
        for name, value in element.attrib.items():
            assert name != "src" and not name.startswith("on"), (element.tag, name)
            assert name not in ("style", "xlink:href"), (element.tag, name)
            assert name != "href" or value.startswith("#"), value
    assert "http:" not in text and "https:" not in text and "@import" not in text
    assert set(re.findall(r"url\((.)", text)) <= {"#"}


def test_the_policy_allows_only_the_own_script_and_style() -> None:
    tree = page(nav2_graphs.scene(swarm(), nav2_graphs.healthy(swarm())))
    (policy,) = (it for it in tree.iter("meta") if it.get("http-equiv"))
    rules = dict(rule.split(None, 1) for rule in policy.get("content").split("; "))
    for rule in ("default-src", "base-uri", "form-action"):
        assert rules.pop(rule) == "'none'"
    assert set(rules) == {"script-src", "style-src"}
    for tag, rule in (("script", "script-src"), ("style", "style-src")):
        (element,) = pick(tree, tag)
        digest = base64.b64encode(hashlib.sha256(element.text.encode()).digest()).decode()
        assert rules[rule] == f"'sha256-{digest}'"
    assert len(pick(tree, "script")[0].text.splitlines()) < 160


@pytest.mark.slow
def test_all_links_and_hooks_lead_somewhere() -> None:
    for scene in scenes():
        tree = page(scene)
        ids = [element.get("id") for element in tree.iter() if element.get("id")]
        assert [id_ for id_, times in Counter(ids).items() if times > 1] == []
        links = {a.get("href")[1:] for a in tree.iter("a")}
        assert links <= set(ids)
        hooks = {element.get("data-id") for element in tree.iter()}
        hits = {hit for row in tree.iter("details") for hit in row.get("data-hits", "").split()}
        ends = {end for path in tree.iter("path") for end in path.get("data-e", "").split()}
        assert hits <= hooks and ends <= hooks


@pytest.mark.more
def test_every_finding_is_listed_and_links_to_what_it_is_about() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    tree = page(scene)
    rows = pick(tree, "details", "finding")
    assert len(rows) == len(scene.findings) >= 5
    by_code = {}
    errors_first = sorted(
        scene.findings, key=lambda it: ("error", "warning", "note").index(it.level)
    )
    for row, finding in zip(rows, errors_first, strict=True):
        text = row.text_content()
        assert all(part in text for part in (finding.robot, finding.node, *finding[:4]))
        target = section(tree, pick(row, "a", "place")[0].get("href")[1:])
        by_code[finding.code] = pick(target, "text")[0].text_content()
    assert by_code["MG101"].endswith("/bt_navigator")
    assert by_code["MG308"] == "/cmd_vel"
    assert by_code["MG321"].endswith("/scan")
    assert by_code["MG401"] == "lidar_link/robot1"


@pytest.mark.more
def test_a_code_leads_to_what_it_means() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    tree = page(scene)
    links = {a.text: a.get("href")[1:] for a in pick(tree, "a", "rule")}
    assert set(links) == {finding.code for finding in scene.findings}
    for code, id_ in links.items():
        folded, rule = section(tree, id_), RULES[code]
        assert (folded.tag, folded.get("open")) == ("details", None)
        text = folded.text_content()
        words = (code, rule.name, rule.what, f"Why: {rule.why}", f"Fix: {rule.fix}")
        assert all(part.replace("`", "") in text for part in words)
    assert len(pick(section(tree, "rules"), "details")) == len(links)
    assert pick(section(tree, "rule-MG401"), "code")[0].text == "publish_tf: false"


def test_a_page_without_findings_explains_nothing() -> None:
    plan = nav2_graphs.nav2()
    assert "rules" not in page(nav2_graphs.scene(plan, nav2_graphs.healthy(plan))).xpath("//@id")


def test_a_fault_of_twenty_robots_is_one_row() -> None:
    plan = nav2_graphs.fleet(20, 4)
    graph = nav2_graphs.healthy(plan)
    for robot in plan.robots:
        graph = nav2_graphs.moved(graph, f"/{robot.name}/topic1", "/topic1", "driver")
    scene = nav2_graphs.scene(plan, graph)
    assert Counter(it.code for it in scene.findings) == {"MG303": 20}
    rows = pick(page(scene), "details", "finding")
    assert [pick(row, "a", "rule")[0].text for row in rows] == ["MG303"]
    for row in rows:
        (who,) = pick(row, "b", "who")
        assert who.text == "robot1, robot2, robot3 and 17 more"
        assert who.get("title").split(", ") == list(scene.robots)
        assert row.get("data-robot").split() == [str(at) for at in range(20)]
    (hits,) = (len(row.get("data-hits").split()) for row in rows)
    # Of each robot two nodes and the name that is missing, and the one in its place.
    assert hits == 61


@pytest.mark.more
def test_a_small_fleet_is_open_and_the_healthy_of_a_large_one_are_folded() -> None:
    small = page(
        nav2_graphs.scene(nav2_graphs.fleet(2, 4), nav2_graphs.healthy(nav2_graphs.fleet(2, 4)))
    )
    assert {one.get("open") for one in section(small, "graph").iter("details")} == {""}
    plan = swarm()
    graph = nav2_graphs.moved(nav2_graphs.healthy(plan), "/robot7/topic1", "/topic1")
    tree = page(nav2_graphs.scene(plan, graph))
    assert unfolded(tree) == ["g6", "shared"]
    (away,) = (it for it in tree.iter("b") if it.text == "29 more robots without findings")
    assert len(list(away.getparent().getparent().iter("details"))) == 30


def unfolded(tree: html.HtmlElement) -> list[str]:
    """The ids of the groups that are open."""
    there = section(tree, "graph").iter("details")
    return [one.get("id") for one in there if one.get("open") is not None]


@pytest.mark.slow
def test_the_cost_of_a_page_grows_with_the_fleet_and_not_faster() -> None:
    def prepared(count: int) -> Callable[[], object]:
        plan = nav2_graphs.fleet(count, 20)
        graph = nav2_graphs.moved(nav2_graphs.healthy(plan), "/robot3/topic2", "/topic2")
        return lambda: drawn(nav2_graphs.scene(plan, graph))

    def drawn(scene: Scene) -> None:
        to_html(scene)

    assert growth(prepared, 5, 20) < 1.5


@pytest.mark.slow
def test_a_hundred_robots_are_a_small_page() -> None:
    plan = nav2_graphs.fleet(100, 20)
    graph = nav2_graphs.healthy(plan)
    for at in (3, 50, 99):
        graph = nav2_graphs.moved(graph, f"/robot{at}/topic2", "/topic2")
    scene = nav2_graphs.scene(plan, graph)
    data = to_html(scene)
    assert len(data) < 1_000_000
    assert unfolded(page(scene)) == ["g2", "shared"]


def test_a_plan_without_robots_is_drawn() -> None:
    empty = System(layout="L2")
    scene = nav2_graphs.scene(empty, System((), (), (), nav2_graphs.environment()))
    assert pick(page(scene), "header") and not pick(page(scene), "svg", "overview")


def test_the_environment_is_shown() -> None:
    plan = nav2_graphs.nav2()
    around = nav2_graphs.environment(Caveat("range-word", False, "a word that is no range"))
    around = around._replace(static_peers=("10.0.0.1", "10.0.0.2"), discovery_server="h:11811")
    scene = nav2_graphs.scene(plan, nav2_graphs.healthy(plan)._replace(environment=around))
    text = section(page(scene), "environment").text_content()
    for word in ("SUBNET", "10.0.0.1 10.0.0.2", "rmw_fastrtps_cpp", "h:11811", "3.5 s", "no range"):
        assert word in text


# ---------------------------------------------------------------- the same bytes


@pytest.mark.more
def test_the_order_of_a_snapshot_does_not_show() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.spoiled(plan)
    found = nav2_graphs.scene(plan, graph).findings
    mixed = random.Random(7)
    shuffled = graph._replace(
        nodes=tuple(mixed.sample(graph.nodes, len(graph.nodes))),
        ends=tuple(mixed.sample(graph.ends, len(graph.ends))),
        edges=tuple(mixed.sample(graph.edges, len(graph.edges))),
    )
    assert to_html(make_scene(plan, shuffled, found)) == to_html(make_scene(plan, graph, found))


@pytest.mark.slow
def test_every_process_draws_the_same_bytes(tmp_path: Path) -> None:
    plan = nav2_graphs.nav2()
    (tmp_path / "plan.yaml").write_text(to_yaml(plan))
    (tmp_path / "graph.json").write_bytes(to_json(nav2_graphs.spoiled(plan)))
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "check", "plan.yaml"]
    command += ["--from", "graph.json"]
    results = []
    for seed in ("1", "2"):
        env = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run(
            [*command, "--report", seed], cwd=tmp_path, env=env, capture_output=True, check=False
        )
        assert done.returncode == 1, done.stderr
        results.append((tmp_path / seed).read_bytes())
    assert results[0] == results[1]


# ---------------------------------------------------------------- names that bite


def assert_harmless(scene: Scene) -> None:
    tree = page(scene)
    assert {element.tag for element in tree.iter()} <= TAGS
    assert len(pick(tree, "script")) == len(pick(tree, "style")) == 1
    names = {name for element in tree.iter() for name in element.attrib}
    assert not any(name.startswith("on") for name in names)


@pytest.mark.more
def test_names_from_the_graph_do_not_break_out() -> None:
    scene = nav2_graphs.scene(*nav2_graphs.nasty(nav2_graphs.nav2()))
    assert_harmless(scene)
    text = page(scene).text_content()
    for name in nav2_graphs.NASTY:
        assert visible(name) in text


@pytest.mark.slow
@settings(max_examples=25)
@given(st.lists(st.text(max_size=20), min_size=6, max_size=6))
def test_any_text_may_be_a_name(words: list[str]) -> None:
    node, topic, child, parent, robot, type_ = words
    plan = nav2_graphs.fleet(2, 1)
    first = plan.robots[0]._replace(name=robot or "r")
    graph = nav2_graphs.with_end(nav2_graphs.healthy(plan), f"/{node}", f"/{topic}")
    ends = tuple(e._replace(type=type_) if e.name == f"/{topic}" else e for e in graph.ends)
    frame = Edge(child, parent, f"/{topic}", True, (node,))
    odd = graph._replace(ends=ends, edges=(*graph.edges, frame))
    nodes = tuple(
        it._replace(robot=first.name) if it.robot == plan.robots[0].name else it
        for it in plan.nodes
    )
    named = plan._replace(robots=(first, *plan.robots[1:]), nodes=nodes)
    assert_harmless(nav2_graphs.scene(named, odd))


@pytest.mark.slow
@given(st.text(max_size=60), st.integers(4, 40))
def test_a_clipped_text_fits_and_keeps_its_ends(text: str, room: int) -> None:
    shown = clipped(visible(text), room)
    assert columns(shown) <= room
    assert shown == visible(text) or "…" in shown
    assert shown.isprintable()


def test_a_name_is_clipped_in_its_middle() -> None:
    assert clipped("/robot1/a_very_long_name/costmap", 20) == "/robot1/a…me/costmap"
    assert visible("a\nb\x1b\u202e\ud800é機") == "a\\nb\\x1b\\u202e\\ud800é機"


# ---------------------------------------------------------------- the command


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a plan and a spoiled graph, which the command runs in."""
    plan = nav2_graphs.nav2()
    (tmp_path / "plan.yaml").write_text(to_yaml(plan))
    (tmp_path / "graph.json").write_bytes(to_json(nav2_graphs.spoiled(plan)))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def check(*more: str) -> int:
    return multibot.main(["check", "plan.yaml", "--from", "graph.json", *more])


@pytest.mark.slow
def test_the_command_writes_what_is_asked_for(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = check()
    printed = capsys.readouterr().out
    assert sorted(path.name for path in files.iterdir()) == ["graph.json", "plan.yaml"]
    assert check("--report", "r.html") == code == 1
    assert capsys.readouterr().out == printed
    scene = nav2_graphs.scene(nav2_graphs.nav2(), nav2_graphs.spoiled(nav2_graphs.nav2()))
    assert (files / "r.html").read_bytes() == to_html(scene)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (("--report", "plan.yaml"), "plan.yaml is a file that is read; choose another one for"),
        (("--report", "./graph.json"), "./graph.json is a file that is read"),
        (("--report", "-"), "--report - is not a file; standard output has the findings"),
        (("--report", "."), ".: cannot be written: it is a folder, name a file in it"),
        (("--report", "plan.yaml/d"), "plan.yaml/d: cannot be written: plan.yaml is a file"),
        (("-o", "x", "--report", "x"), "x: two results would go to this one file"),
    ],
)
def test_a_page_that_cannot_be_written_stops_the_check(
    files: Path, capsys: pytest.CaptureFixture[str], wrong: tuple[str, ...], said: str
) -> None:
    before = {path.name: path.read_bytes() for path in files.iterdir()}
    assert check(*wrong) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"multibot: {said}")
    assert {path.name: path.read_bytes() for path in files.iterdir()} == before


@pytest.mark.more
def test_a_snapshot_with_unsafe_names_works_with_the_command(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, graph = nav2_graphs.nasty(nav2_graphs.nav2())
    text = to_json(graph).replace(b"\\ud800", b"?")
    (files / "graph.json").write_bytes(text)
    assert check("--report", "r.html") in (1, 3)
    capsys.readouterr()
    tree = html.document_fromstring((files / "r.html").read_text())
    assert {element.tag for element in tree.iter()} <= TAGS
