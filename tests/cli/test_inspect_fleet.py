# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect FLEET``: each process of the launch files, for each robot or once for all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from paths import FIXTURES, fixture_text

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
def folder(here: Path) -> Path:
    (here / "r.urdf").write_text('<robot name="r"><link name="l"/></robot>')
    (here / "p.yaml").write_text("driver: {ros__parameters: {a: 1}}\n")
    (here / "up.launch.py").write_text(LAUNCH.replace("FOLDER", str(here)))
    return here


def inspected(
    folder: Path, capsys: pytest.CaptureFixture[str], more: str = "", own: str = ""
) -> list[str]:
    (folder / "fleet.yaml").write_text(FLEET.format(more, own))
    assert main(["inspect", "fleet.yaml", "--output-kind", "json"]) == 0
    rows = json.loads(capsys.readouterr().out)["processes"]
    return [
        " | ".join((it["whose"], it["process"], it["place"], ",".join(it["files"]), it["why"]))
        for it in rows
    ]


MAP = "map_server (nav2_map_server map_server) | up.launch.py:6 | "
SHOWN = [
    f"all robots | {MAP} | all robots have the map that it serves",
    "each robot | own driver: rate | up.launch.py:7 | p.yaml | ",
    "each robot | rviz2 rviz2 | up.launch.py:9 |  | "
    "each robot has its own tf topic, and one rviz2 reads one",
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
        it for it in inspected(folder, capsys, "related_files: {rviz: r.rviz}") if "rviz2" in it
    )
    assert found.startswith("each robot | rviz2") and "one rviz2 reads one" in found


# ``multibot inspect PACKAGE_FOLDER/PROGRAM``: what a node does by its source, each with its
# place.

OWN = FIXTURES / "own_nodes"


def test_names_parameters_and_what_is_not_known(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(OWN / "by_parameters")]) == 0
    lines = [" ".join(it.split()) for it in capsys.readouterr().out.splitlines()]
    assert lines[0] == "node by_parameters of own_nodes, by 1 file of its source"
    where = "own_nodes/by_parameters.py"
    assert f"subscribes scan sensor_msgs/msg/LaserScan scan_topic {where}:18" in lines
    assert f"publishes /wheels/front/speed std_msgs/msg/Float64 side is not set {where}:20" in lines
    assert f"scan_topic scan topic {where}:13" in lines
    assert f"rate 10.0 {where}:14" in lines
    assert any(
        it.startswith(f"not known: {where}:24: publishes std_msgs/msg/String") for it in lines
    )


def test_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(OWN / "plain"), "--output-kind", "json"]) == 0
    (node,) = json.loads(capsys.readouterr().out)["nodes"]
    assert (node["name"], node["package"], node["not_known"]) == ("plain", "own_nodes", [])
    ends = {it["name"]: it for it in node["ends"]}
    assert ends["/scan"]["source"] == f"{OWN / 'own_nodes/plain.py'}:16"
    assert ends["~/reset"]["kind"] == "service"


def test_a_program_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(OWN / "absent")]) == 2
    said = capsys.readouterr().err
    assert "package 'own_nodes' has no program 'absent' whose source is here" in said
