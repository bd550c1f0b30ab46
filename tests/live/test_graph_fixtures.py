# SPDX-License-Identifier: Apache-2.0
"""Whole fleets with a fault each, and the lines the command prints; a healthy one has no finding."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import guides
import pytest
from graph_cases import CASES, FOLDERS, GRAPHS, Case, healthy
from paths import ROOT
from pytest import CaptureFixture, MonkeyPatch

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import System

ids = [f"{case.layout}-{case.code}" for case in CASES]


@pytest.fixture(autouse=True)
def at_home(monkeypatch: MonkeyPatch) -> None:
    """Paths stand in the messages."""
    monkeypatch.chdir(ROOT)


def test_a_fault_of_each_sort_is_there() -> None:
    """A new rule has its examples and needs no fleet here."""
    codes = {case.code for case in CASES if FOLDERS[case.layout] == GRAPHS}
    assert codes <= RULES.keys()
    assert len(codes) >= 17, codes
    assert {case.layout for case in CASES} == set(FOLDERS)


def test_nothing_else_is_in_the_folders() -> None:
    there = {p.relative_to(ROOT).as_posix() for p in (ROOT / GRAPHS).rglob("*") if p.is_file()}
    cases = {f"{case.stem}{end}" for case in CASES for end in (".json", ".txt")}
    plans = {f"{f}/{name}" for f in FOLDERS.values() for name in ("plan.yaml", "healthy.json")}
    assert there == cases | plans | {f"{GRAPHS}/nodes.yaml"}


def same(path: str, graph: System) -> None:
    """Assert that the file is this graph: if not, tests/support/graph_cases.py writes it anew."""
    data = (ROOT / path).read_bytes()
    assert data == to_json(graph)
    assert from_json(data, path) == graph


@pytest.mark.parametrize("layout", FOLDERS)
def test_a_healthy_graph_is_silent(layout: str, capsys: CaptureFixture[str]) -> None:
    folder = FOLDERS[layout]
    same(f"{folder}/healthy.json", healthy(layout))
    assert main(["check", f"{folder}/plan.yaml", "--from", f"{folder}/healthy.json"]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", CASES, ids=ids)
def test_a_broken_graph_gives_exactly_its_lines(case: Case, capsys: CaptureFixture[str]) -> None:
    same(f"{case.stem}.json", case.broken(healthy(case.layout)))
    plan = f"{FOLDERS[case.layout]}/plan.yaml"
    code = main(["check", plan, "--from", f"{case.stem}.json", "--verbose"])
    out = capsys.readouterr().out
    assert out == (ROOT / f"{case.stem}.txt").read_text()
    assert tuple(re.findall(r": (MG\d{3}) ", out)) == case.found
    assert case.code in case.found
    assert code == (1 if ": error: " in out else 0)


@pytest.mark.deep
def test_making_the_files_anew_changes_none_of_them(tmp_path: Path) -> None:
    """Whoever adds a case gets no other file into the change."""
    guides.copy_repository(tmp_path)
    before = contents(tmp_path)
    for path in (tmp_path / GRAPHS).rglob("*.txt"):
        path.unlink()
    subprocess.run(
        [sys.executable, "tests/support/graph_cases.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        check=True,
    )
    after = contents(tmp_path)
    assert sorted(path for path in before | after if before.get(path) != after.get(path)) == []


def contents(folder: Path) -> dict[str, bytes]:
    """Every file of the fixtures."""
    files = (path for path in (folder / "fixtures").rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
