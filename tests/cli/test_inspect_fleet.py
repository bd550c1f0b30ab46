# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect FLEET``: each process of the launch files, for each robot or once for all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.cli.multibot import main

LAUNCH = fixture_text("inspect_fleet_launch.txt")
FLEET = """\
layout: both
description: r.urdf
launch: up.launch.py
{}
robots: [{{name: a}}, {{name: b{}}}]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="l"/></robot>')
    (tmp_path / "p.yaml").write_text("driver: {ros__parameters: {a: 1}}\n")
    (tmp_path / "up.launch.py").write_text(LAUNCH.replace("FOLDER", str(tmp_path)))
    return tmp_path


def inspected(
    folder: Path, capsys: pytest.CaptureFixture[str], more: str = "", own: str = ""
) -> list[str]:
    (folder / "fleet.yaml").write_text(FLEET.format(more, own))
    assert main(["inspect", "fleet.yaml", "--form", "json"]) == 0
    rows = json.loads(capsys.readouterr().out)["processes"]
    return [
        " | ".join((it["whose"], it["process"], it["place"], ",".join(it["files"]), it["why"]))
        for it in rows
    ]


MAP = "map_server (nav2_map_server map_server) | up.launch.py:6 | "
SHOWN = [
    f"all robots | {MAP} | all robots have the map that it serves",
    "each robot | own driver: rate | up.launch.py:7 | p.yaml | ",
    "all robots | rviz2 rviz2 | up.launch.py:9 |  | "
    "it only shows data or forwards an operator's commands",
    "each robot | own late | up.launch.py:8 |  | after a time",
]


def test_each_process_is_shown(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert inspected(folder, capsys) == SHOWN
    assert main(["inspect", "fleet.yaml"]) == 0
    assert "up.launch.py:8" in capsys.readouterr().out


def test_a_robot_without_a_launch_file_has_none(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert inspected(folder, capsys, own=", launch: []")[1] == SHOWN[1].replace("each robot", "a")
    (folder / "fleet.yaml").write_text("layout: both\ndescription: r.urdf\nrobots: [{name: a}]\n")
    assert main(["inspect", "fleet.yaml"]) == 2
    said = capsys.readouterr().err
    assert "fleet.yaml: no robot has a launch file" in said and len(said.splitlines()) == 1


def test_what_works_for_one_robot_alone_gives_each_its_window(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In a layout with a tf topic for each robot one rviz2 shows one robot."""
    (folder / "r.rviz").write_text("Visualization Manager: {}\n")
    (found,) = (
        it for it in inspected(folder, capsys, "companions: {rviz: r.rviz}") if "rviz2" in it
    )
    assert found.startswith("each robot | rviz2") and "one rviz2 reads one" in found
