# SPDX-License-Identifier: Apache-2.0
"""Pictures of a checked graph: what is wrong is drawn as that, and any name may be drawn."""

from __future__ import annotations

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
from graph_calls import to_json, to_yaml
from hypothesis import given, settings, strategies as st
from lxml import html
from page_calls import (
    DrawnGroup,
    Scene,
    clipped,
    columns,
    make_scene,
    to_html,
    visible,
    without_common,
)

from multibot_rewrite.cli import multibot
from multibot_rewrite.pages.svg import lay_out
from multibot_rewrite.system.records import Edge, System

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


def page(scene: Scene) -> html.HtmlElement:
    return html.document_fromstring(to_html(scene).decode())


def pick(tree: html.HtmlElement, tag: str | None = None, look: str = "") -> list[html.HtmlElement]:
    """Return the elements of a tag that have these classes."""
    wanted = set(look.split())
    return [it for it in tree.iter(tag) if wanted <= set((it.get("class") or "").split())]


def section(tree: html.HtmlElement, id_: str) -> html.HtmlElement:
    return tree.get_element_by_id(id_)


def swarm() -> System:
    return nav2_graphs.fleet(30, 4)


# ---------------------------------------------------------------- the scene


# ---------------------------------------------------------------- places


def scenes() -> Iterable[Scene]:
    for layout in nav2_graphs.LAYOUTS:
        plan = nav2_graphs.nav2(layout)
        yield nav2_graphs.scene(plan, nav2_graphs.healthy(plan))
    plan = nav2_graphs.nav2()
    yield nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    yield nav2_graphs.scene(*nav2_graphs.nasty(plan))
    yield nav2_graphs.scene(swarm(), nav2_graphs.healthy(swarm()))


# ---------------------------------------------------------------- tf


def with_frames(plan: System, *more: Edge) -> Scene:
    graph = nav2_graphs.healthy(plan)
    return nav2_graphs.scene(plan, graph._replace(edges=(*graph.edges, *more)))


@pytest.mark.slow
def test_a_ring_and_a_chain_deeper_than_pythons_node_set_end() -> None:
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


def unfolded(tree: html.HtmlElement) -> list[str]:
    """Return the ids of the groups that are open."""
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


# ---------------------------------------------------------------- the command


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a plan and a spoiled graph, which the command runs in."""
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


def test_faults_are_at_the_top() -> None:
    plan = nav2_graphs.nav2()
    scene = nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))
    order = [name for name, _ in lay_out(without_common(group(scene, "robot1"))).names]
    assert [name.name for name in order[:2]] == ["/cmd_vel", "/robot1/cmd_vel"]
