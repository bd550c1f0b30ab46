"""Every rule has a graph that breaks it, with the lines the command prints; a healthy one is silent."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from graph_cases import CASES, FLEET, FOLDERS, GRAPHS, Case, healthy, read_plan
from paths import ROOT
from pytest import CaptureFixture, MonkeyPatch

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.graph.plan_file import from_yaml
from multibot_rewrite.graph.snapshot import Snapshot, from_json, to_json

RULES = "".join(p.read_text() for p in (ROOT / "multibot_rewrite" / "graph" / "rules").glob("*.py"))
CODES = sorted(set(re.findall(r'"(MG[12]\d\d)"', RULES)))
ids = [f"{case.layout}-{case.code}" for case in CASES]


@pytest.fixture(autouse=True)
def at_home(monkeypatch: MonkeyPatch) -> None:
    """Paths stand in the messages."""
    monkeypatch.chdir(ROOT)


def test_every_code_has_a_graph() -> None:
    assert len(CODES) >= 17, CODES
    assert sorted(case.code for case in CASES if FOLDERS[case.layout] == GRAPHS) == CODES
    assert {case.layout for case in CASES} == set(FOLDERS)


def test_nothing_else_is_in_the_folders() -> None:
    there = {p.relative_to(ROOT).as_posix() for p in (ROOT / GRAPHS).rglob("*") if p.is_file()}
    cases = {f"{case.stem}{end}" for case in CASES for end in (".json", ".txt")}
    plans = {f"{f}/{name}" for f in FOLDERS.values() for name in ("plan.yaml", "healthy.json")}
    assert there == cases | plans | {f"{GRAPHS}/nodes.yaml"}


@pytest.mark.parametrize("layout", FOLDERS)
def test_the_plan_is_what_the_command_makes(layout: str, tmp_path: Path) -> None:
    made = tmp_path / "plan.yaml"
    assert main(["plan", *FLEET, "--layout", layout, "-o", str(made)]) == 0
    assert from_yaml(made.read_bytes(), "made") == read_plan(layout)


def same(path: str, graph: Snapshot) -> None:
    """The file is this graph: if not, tests/graph_cases.py writes it anew."""
    data = (ROOT / path).read_bytes()
    assert data == to_json(graph)
    assert from_json(data, path) == graph


@pytest.mark.parametrize("layout", FOLDERS)
def test_a_healthy_graph_is_silent(layout: str, capsys: CaptureFixture[str]) -> None:
    folder = FOLDERS[layout]
    same(f"{folder}/healthy.json", healthy(layout))
    assert main(["check", f"{folder}/plan.yaml", "--snapshot", f"{folder}/healthy.json"]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("case", CASES, ids=ids)
def test_a_broken_graph_gives_exactly_its_lines(case: Case, capsys: CaptureFixture[str]) -> None:
    same(f"{case.stem}.json", case.broken(healthy(case.layout)))
    plan = f"{FOLDERS[case.layout]}/plan.yaml"
    code = main(["check", plan, "--snapshot", f"{case.stem}.json", "--verbose"])
    out = capsys.readouterr().out
    assert out == (ROOT / f"{case.stem}.txt").read_text()
    assert tuple(re.findall(r": (MG\d{3}) ", out)) == case.found
    assert case.code in case.found
    assert code == (1 if ": error: " in out else 0)


def rows() -> dict[str, list[str]]:
    """The cells of the page's table of graph codes."""
    page = (ROOT / "docs" / "findings.md").read_text()
    lines = re.findall(r"^\| (MG\d{3}) \| (.*) \|$", page, re.MULTILINE)
    return {code: [cell.strip() for cell in rest.split(" | ")] for code, rest in lines}


@pytest.mark.parametrize("code", CODES)
def test_the_page_has_what_why_and_how(code: str) -> None:
    level, *cells = rows()[code]
    assert level in ("error", "warning", "error, warning")
    assert len(cells) == 3
    assert all(len(cell.split()) >= 3 for cell in cells)
