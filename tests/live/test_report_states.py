# SPDX-License-Identifier: Apache-2.0
"""What the head of the report says, which robots a finding concerns, and all that a plan may have."""

from __future__ import annotations

import os
from pathlib import Path

import nav2_graphs
import pytest
import report_pages
from fault_changes import Fault
from graph_calls import to_json, to_yaml
from graph_faults import FAULTS
from lxml import html
from page_calls import (
    CLASH,
    MISSING,
    OK,
    UNEXPECTED,
    Scene,
    ids_of,
    make_ids,
    to_html,
)
from paths import ROOT
from report_pages import FIRST

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.cli import multibot
from multibot_rewrite.cli.pictures import snippets
from multibot_rewrite.lint.catalogue import rules
from multibot_rewrite.live.rehearsal import with_substitutes
from multibot_rewrite.system.records import ACTION, SERVES, End, Node

GRAPHS = ROOT / "fixtures" / "graphs"


def page(scene: Scene) -> html.HtmlElement:
    return html.document_fromstring(to_html(scene, rules()).decode())


def head(scene: Scene) -> tuple[str, str]:
    """Return the colour of the head, and what it says."""
    tree = page(scene)
    return tree.find(".//header").get("class"), tree.find(".//h1").text


def cards(scene: Scene) -> dict[str, str]:
    """Return the first robot of each card, and the card's look."""
    found = page(scene).find_class("card")
    return {it.find(".//h3/a").text: it.get("class").partition(" ")[2] for it in found}


def edge_states(scene: Scene) -> dict[tuple[str, str], str]:
    return {(it.node, it.name): it.state for group in scene.groups for it in group.edges}


def node_states(scene: Scene) -> dict[str, str]:
    return {it.name: it.state for group in scene.groups for it in group.nodes}


# ---------------------------------------------------------------- the head


@pytest.mark.slow
def test_only_a_fleet_without_findings_is_green() -> None:
    assert head(report_pages.healthy()) == ("good", "as planned")
    assert head(report_pages.spoiled()) == ("bad", "not as planned")
    doubt = ("unsure", "inconclusive, the view may be incomplete")
    assert head(report_pages.inconclusive()) == doubt
    open_plan = ("unsure", "nothing wrong seen, but the plan has faults")
    assert head(report_pages.not_closed()) == open_plan


@pytest.mark.more
def test_an_open_end_of_the_plan_is_a_finding_with_its_explanation() -> None:
    tree = page(report_pages.not_closed())
    (found,) = tree.find_class("finding")
    assert "reads scan2, which nothing sends" in found.text_content()
    assert rules()["MF801"].why.replace("`", "") in found.text_content()
    assert cards(report_pages.not_closed()) == {"robot2": "odd", "robot1": "good"}


@pytest.mark.more
def test_the_tree_with_the_fault_is_above_the_nodes() -> None:
    order = ["findings", "tf", "graph", "rules", "environment"]
    assert page(report_pages.tf_collision()).xpath("//section/@id") == order
    order = ["findings", "graph", "tf", "environment"]
    assert page(report_pages.healthy()).xpath("//section/@id") == order


@pytest.mark.sample(5)
@pytest.mark.parametrize("fault", FAULTS, ids=[it.name for it in FAULTS])
def test_a_danger_is_drawn_and_concerns_a_robot(fault: Fault) -> None:
    scene = report_pages.doctors(fault.change(fault.system()))
    ids = make_ids(scene)
    assert scene.rows
    for row in scene.rows:
        # What answers may have no node in a graph that is made up.
        answers = row.finding.node and row.finding.node not in scene.running
        assert answers or ids_of(row.targets, ids), row.finding
        of_all = row.finding.names == ("/clock",) or row.finding.node == "/nav2_container"
        assert row.robots or of_all, row.finding
    nodes = {row.finding.node for row in scene.rows if row.finding.level == ERROR}
    if nodes & {"", *scene.running}:
        drawn = {*edge_states(scene).values(), *node_states(scene).values()}
        in_tf = any(row.faults for tree in scene.trees for row in tree.rows)
        assert in_tf or drawn - {OK, UNEXPECTED}


# ---------------------------------------------------------------- what a plan may have


@pytest.mark.more
def test_a_frame_that_is_not_received_is_drawn_with_its_finding() -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    lost = [it for it in graph.edges if "robot2" not in it.child]
    scene = nav2_graphs.scene(plan, graph._replace(edges=tuple(lost)))
    assert "MG208" in {it.finding.code for it in scene.rows}
    (tree,) = (it for it in scene.trees if not it.received)
    assert {row.state for row in tree.rows} == {MISSING}
    assert any("frame not received" in row.faults for row in tree.rows)
    assert cards(scene)["robot2"] == "bad"


def test_the_action_of_a_stand_in_is_as_planned() -> None:
    """Where its type is not installed, a stub has the parts of an action, and rcl counts an action."""
    plan = nav2_graphs.nav2()
    types = {it.type: "std_msgs/msg/Empty" for it in plan.ends if it.kind == ACTION}
    stubs = with_substitutes(plan, types)
    node, name = "/robot1/behavior_server", "/robot1/backup"
    action = End(ACTION, SERVES, name, "std_msgs/msg/Empty", "", node, None, "")
    odd = action._replace(name="/robot1/fly")
    graph = nav2_graphs.healthy(stubs)
    scene = nav2_graphs.scene(stubs, graph._replace(ends=(*graph.ends, action, odd)))
    assert edge_states(scene)[node, name] == OK
    assert edge_states(scene)[node, "/robot1/fly"] == UNEXPECTED


# ---------------------------------------------------------------- the command


def drawn(tmp_path: Path, *given: str) -> tuple[int, html.HtmlElement]:
    """Return the exit code and the page of a command."""
    file = tmp_path / "page.html"
    code = multibot.main([*given, "--report", str(file)])
    return code, html.document_fromstring(file.read_text())


@pytest.mark.parametrize(
    ("case", "more", "words", "code"),
    [
        ("healthy", (), "as planned", 0),
        ("MG102", (), "not as planned", 1),
        ("MG108", (), "no error, see the warnings", 0),
        ("MG108", ("--fail-on", "warning"), "not as planned", 1),
        ("MG102", ("--ignore", "MG1,MG3"), "as planned", 0),
    ],
)
def test_page_and_command_say_the_same(
    case: str,
    more: tuple[str, ...],
    words: str,
    code: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = ("check", str(GRAPHS / "plan.yaml"), "--from", str(GRAPHS / f"{case}.json"))
    done, tree = drawn(tmp_path, *given, *more)
    assert (done, tree.find(".//h1").text) == (code, words)
    assert f": {words} (" in capsys.readouterr().err
    listed = len(tree.find_class("finding"))
    assert (tree.find(".//header").get("class") == "good") == (listed == 0)


@pytest.mark.more
def test_the_open_ends_of_a_plan_are_on_the_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, graph = tmp_path / "plan.yaml", tmp_path / "graph.json"
    made = nav2_graphs.nav2()
    plan.write_text(to_yaml(made._replace(gaps=(report_pages.OPEN_END,))))
    graph.write_bytes(to_json(nav2_graphs.healthy(made)))
    code, tree = drawn(tmp_path, "check", str(plan), "--from", str(graph))
    words = "nothing wrong seen, but the plan has faults"
    assert (code, tree.find(".//h1").text) == (0, words)
    assert f": {words} (" in capsys.readouterr().err
    assert [it.get("data-robot") for it in tree.find_class("finding")] == ["1"]
    assert tree.find(".//header").get("class") == "unsure"


def test_snippets_are_short_and_of_files_that_are_there(tmp_path: Path) -> None:
    file = tmp_path / "a.urdf"
    file.write_text("\n".join(f"line {at} {'x' * 500}" for at in range(1, 10)))
    (tmp_path / "binary.urdf").write_bytes(b"\xff\xfe\n" * 5)
    (tmp_path / "secret").write_text("a\nb\n")
    os.mkfifo(tmp_path / "pipe.urdf")
    others = (f"{tmp_path}/{it}:2" for it in ("gone.urdf", "binary.urdf", "secret", "pipe.urdf"))
    found = snippets([f"{file}:1", f"{file}:5", f"{file}:99", *others, "node set nav2", ""])
    assert set(found) == {f"{file}:1", f"{file}:5"}
    assert [line.split()[0] for line in found[f"{file}:1"]] == ["1", "2", "3"]
    assert [line.split()[0] for line in found[f"{file}:5"]] == ["3", "4", "5", "6", "7"]
    assert max(map(len, found[f"{file}:5"])) < 200


@pytest.mark.parametrize(("running", "state"), [((), MISSING), (("amcl", "slam_toolbox"), CLASH)])
def test_of_alternatives_none_or_two_run(running: tuple[str, ...], state: str) -> None:
    graph = nav2_graphs.without_node(report_pages.rich_graph(), f"{FIRST}/amcl")
    nodes = (Node(f"{FIRST}/{it}", it) for it in running)
    scene = report_pages.rich(graph._replace(nodes=(*graph.nodes, *nodes)))
    wrong = {node for node, it in node_states(scene).items() if it != OK}
    assert wrong == {f"{FIRST}/amcl", f"{FIRST}/slam_toolbox"}
    assert node_states(scene)[f"{FIRST}/amcl"] == state
    assert cards(scene)["fleet_a/robot1"] == "bad"
