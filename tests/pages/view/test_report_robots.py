# SPDX-License-Identifier: Apache-2.0
"""The robots in 3D at the head of a report."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import pytest
from graph_cases import as_planned
from paths import ROBOTS

from multibot_rewrite.base.model import Unusable
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.pages.view import models, page, scene
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system.json import to_json


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """Return a fleet file, its plan and a graph as planned."""
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        f"description: {ROBOTS / 'rover.urdf'}\nrobots:\n"
        "  - {name: robot1, pose: {x: 0}}\n  - {name: robot2, pose: {x: 2}}\n"
    )
    made = tmp_path / "plan.yaml"
    assert main(["plan", str(fleet), "-o", str(made), "-q"]) == 0
    graph = as_planned(read_plan(made.read_bytes(), str(made)))
    (tmp_path / "graph.json").write_bytes(to_json(graph))
    return {it.stem: str(it) for it in tmp_path.iterdir()}


def report(files: dict[str, str], plan: str, *words: str) -> str:
    out = Path(files["fleet"]).with_name("report.html")
    main(["check", files[plan], "--from", files["graph"], "--report", str(out), *words])
    return out.read_text()


def robots_in(page: str) -> dict[str, dict[str, str]]:
    """Of each robot in the frame: is its base on tf?"""
    frame = re.search(r'<iframe [^>]*sandbox="allow-scripts" srcdoc="([^"]*)"></iframe>', page)
    assert frame
    inner = html.unescape(frame[1])
    # The frame inherits the policy of the page, so this one has to allow all of its scripts.
    hashes = r"'sha256-[^']*'"
    assert set(re.findall(hashes, inner)) <= set(re.findall(hashes, page.partition("<title>")[0]))
    found = re.search(r'id="data">(.*?)</script>', inner, re.DOTALL)
    assert found
    return {it["name"]: it["heard"] for it in json.loads(found[1])["robots"]}


@pytest.mark.more
def test_a_fleet_is_at_the_head_with_its_frames_as_heard(files: dict[str, str]) -> None:
    page = report(files, "fleet")
    heard = robots_in(page)
    assert heard["robot1"]["base_link/robot1"] == heard["robot2"]["base_link/robot2"] == "heard"
    assert page.index("<h1>") < page.index("<iframe") < page.index('id="environment"')


@pytest.mark.more
def test_a_plan_alone_has_no_robots_in_3d(files: dict[str, str]) -> None:
    assert "<iframe" not in report(files, "plan")


@pytest.mark.more
def test_what_was_built_knows_its_fleet_file(files: dict[str, str], tmp_path: Path) -> None:
    """Until that is changed: then it says something else than the plan."""
    out = tmp_path / "out"
    assert main(["build", files["fleet"], "-o", str(out), "-q"]) == 0
    built = {**files, "plan": str(out / "plan.yaml")}
    assert set(robots_in(report(built, "plan"))) == {"robot1", "robot2"}
    Path(files["fleet"]).write_text(Path(files["fleet"]).read_text().replace("robot2", "robot3"))
    assert "<iframe" not in report(built, "plan")


@pytest.mark.more
def test_a_report_is_written_where_robots_cannot_be_shown(
    files: dict[str, str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing() -> object:
        raise Unusable(models.INSTALL)

    monkeypatch.setattr(page, "prepare_meshes", missing)
    assert "<iframe" not in report(files, "fleet")
    told = capsys.readouterr().err
    assert "the report does not show the robots in 3D" in told and "[view]" in told


@pytest.mark.more
def test_a_check_without_a_report_loads_no_model(
    files: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene, "load_urdf", lambda *_: pytest.fail("loaded"))
    main(["check", files["fleet"], "--from", files["graph"]])
