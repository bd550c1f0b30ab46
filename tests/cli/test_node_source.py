# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect PACKAGE_FOLDER/PROGRAM``: what a node does by its source, each with its place."""

from __future__ import annotations

import json

import pytest
from paths import FIXTURES

from multibot_rewrite.cli.multibot import main

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
    assert main(["inspect", str(OWN / "plain"), "--form", "json"]) == 0
    (node,) = json.loads(capsys.readouterr().out)["nodes"]
    assert (node["name"], node["package"], node["not_known"]) == ("plain", "own_nodes", [])
    ends = {it["name"]: it for it in node["ends"]}
    assert ends["/scan"]["source"] == f"{OWN / 'own_nodes/plain.py'}:16"
    assert ends["~/reset"]["kind"] == "service"


def test_a_program_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(OWN / "absent")]) == 2
    said = capsys.readouterr().err
    assert "package 'own_nodes' has no program 'absent' whose source is here" in said
