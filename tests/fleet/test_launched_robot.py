# SPDX-License-Identifier: Apache-2.0
"""A fleet file with launch files: its plan, its remap rules, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from rule_examples import DESCRIPTION

from multibot_rewrite import InputError
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_file import (
    read_fleet,
)
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.fleet.launch import launched_robot
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.system.records import RUNS

MODEL = """\
structure:
  nodes:
    /x/amcl:
      pkg: nav2_amcl
      exec: amcl
      node_name: amcl
      remaps: [{from: scan, to: front/scan}, {from: /tf, to: tf}]
      params_files: ["/**: {ros__parameters: {set_initial_pose: true}}"]
"""
FLEET = """\
layout: tf-per-robot
distro: jazzy
launch: system_model.yaml namespace:=x
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
"""


def written(folder: Path, text: str = FLEET) -> str:
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "system_model.yaml").write_text(MODEL)
    (folder / "fleet.yaml").write_text(text)
    return str(folder / "fleet.yaml")


BRAIN = """\
    /x/brain:
      pkg: acme
      exec: brain
      node_name: brain
      remaps: [{from: in, to: /scan}, {from: ~/out, to: result}, {from: /tf, to: tf}]
"""


@pytest.mark.parametrize(
    ("layout", "rules"),
    [
        (
            "tf-per-robot",
            [("in", "scan"), ("~/out", "result"), ("/tf", "tf"), ("/tf_static", "tf_static")],
        ),
        ("frames-per-robot", [("in", "scan"), ("~/out", "result")]),
        (
            "postfix",
            [
                *[("in", "/scan/robot2"), ("~/out", "result/robot2"), ("/tf", "/tf/robot2")],
                ("/tf_static", "/tf_static/robot2"),
            ],
        ),
    ],
)
def test_a_node_that_nobody_knows_keeps_its_rules_for_each_robot(
    layout: str, rules: list[tuple[str, str]], tmp_path: Path
) -> None:
    """rcl matches a rule whatever the node does with the name; `/tf` leads where the layout has it."""
    written(tmp_path, FLEET.replace("tf-per-robot", layout))
    (tmp_path / "system_model.yaml").write_text(MODEL + BRAIN)
    fleet = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "", {})).fleet
    (run,) = (it for it in fleet.table.runs if (it.robot, it.node) == ("robot2", "brain"))
    assert [*run.rules] == rules
    (node,) = (it for it in expected(fleet).nodes if it.name == run.full_name)
    amcl = next(it for it in expected(fleet).nodes if "amcl" in it.name)
    assert (node.known, node.sure, amcl.known) == ("", RUNS, "amcl")
    # What it does with them is not known.
    assert not [it for it in expected(fleet).ends if it.node == run.full_name]


@pytest.mark.parametrize(
    ("launch", "said"),
    [
        ("none.yaml", r"fleet.yaml:3: .*none.yaml does not exist"),
        ("system_model.yaml a=b", r"fleet.yaml:5: 'robot1': .*NAME:=VALUE"),
        ("'system_model.yaml a:={name}'", r"fleet.yaml:5: 'robot1': .*{name}"),
    ],
)
def test_a_wrong_entry_is_refused_with_its_line(launch: str, said: str, tmp_path: Path) -> None:
    file = written(tmp_path, FLEET.replace("system_model.yaml namespace:=x", launch))
    with pytest.raises(InputError, match=said):
        read_fleet(file, "", {})


def test_a_launch_file_that_a_fleet_names_is_read_behind_fences(tmp_path: Path) -> None:
    (tmp_path / "a.launch.py").write_text("import os\nos.system('touch started')\n")
    file = written(tmp_path, FLEET.replace("system_model.yaml", "a.launch.py"))
    with pytest.raises(InputError, match="generate_launch_description"):
        planned_fleet(file)
    assert not Path("started").exists() and not (tmp_path / "started").exists()


def test_a_launch_file_that_cannot_be_read_is_read_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.launch.py").write_text("raise RuntimeError\n")
    read: list[LaunchOrder] = []
    own = launched_robot.launch_graph
    monkeypatch.setattr(launched_robot, "launch_graph", lambda it: [read.append(it), own(it)][1])
    with pytest.raises(InputError, match=r"^a\.launch\.py: "):
        launched_robot.launch_of([LaunchOrder("a.launch.py")], "robot1")
    assert len(read) == 1


def test_the_command_takes_a_launch_file_beside_robots(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written(tmp_path)
    model, description = str(tmp_path / "system_model.yaml"), str(tmp_path / "robot.urdf")
    words = ["plan", description, "robot1", "--layout", "L1", "--node-set", "robot_localization"]
    assert main([*words, "--launch", f"{model} namespace:=x"]) == 0
    out, err = capsys.readouterr()
    assert "  - name: /robot1/amcl\n    place: system_model.yaml:3\n" in out
    assert "ekf_filter_node" not in out
    assert "MF821 ekf_filter_node" in err
    assert main(["plan", str(tmp_path / "fleet.yaml"), "--launch", model]) == 2
    assert "leave out --launch" in capsys.readouterr().err
