# SPDX-License-Identifier: Apache-2.0
"""A fleet file with launch files: its plan, its remap rules, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from named_ends import named_ends
from plans import sends
from rule_examples import DESCRIPTION

from multibot_rewrite import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_file import (
    input_files,
    read_fleet,
)
from multibot_rewrite.fleet.fleet import Fleet, expected
from multibot_rewrite.fleet.fleet_plan import plan_fleet
from multibot_rewrite.system.records import RUNS, Place

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


def fleet_of(folder: Path, text: str = FLEET) -> Fleet:
    return planned_fleet(written(folder, text)).fleet


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


def test_the_plan_of_every_robot_has_what_is_launched(tmp_path: Path) -> None:
    fleet = fleet_of(tmp_path)
    names = {it.name for it in named_ends(fleet.table) if it.node == "/robot2/amcl"}
    assert "/robot2/front/scan" in names and "/robot2/scan" not in names
    origins = {it.name: it.place for it in expected(fleet).nodes}
    assert origins["/robot1/amcl"] == origins["/robot2/amcl"] == Place("system_model.yaml", 3)
    assert fleet.table.problems == ()


def test_a_rule_of_the_launch_file_leads_where_it_led(tmp_path: Path) -> None:
    table = fleet_of(tmp_path).table
    (amcl,) = (it for it in table.runs if it.full_name == "/robot1/amcl")
    assert {*amcl.rules} >= {("/tf", "tf")}


def test_a_robot_may_have_its_own_launch_files(tmp_path: Path) -> None:
    text = FLEET.replace("robot2, ", "robot2, launch: [], ")
    robots = {it.node for it in named_ends(fleet_of(tmp_path, text).table)}
    assert "/robot1/amcl" in robots and "/robot2/amcl" not in robots


def test_the_launch_files_are_inputs(tmp_path: Path) -> None:
    file = written(tmp_path)
    assert str(tmp_path / "system_model.yaml") in set(input_files(read_fleet(file, "", {})))


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


def test_the_command_takes_a_launch_file_beside_robots(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written(tmp_path)
    model, description = str(tmp_path / "system_model.yaml"), str(tmp_path / "robot.urdf")
    words = ["plan", description, "robot1", "--layout", "L1", "--stack", "robot_localization"]
    assert main([*words, "--launch", f"{model} namespace:=x"]) == 0
    out, err = capsys.readouterr()
    assert "  - name: /robot1/amcl\n    place: system_model.yaml:3\n" in out
    assert "ekf_filter_node" not in out
    assert "MF821 ekf_filter_node" in err
    assert main(["plan", str(tmp_path / "fleet.yaml"), "--launch", model]) == 2
    assert "leave out --launch" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("layout", "moved", "other"),
    [
        ("tf-per-robot", "odom -> dock", "robot1/base_link -> laser"),
        ("frames-per-robot", "robot1/odom -> robot1/dock", "robot1/base_link -> robot1/laser"),
    ],
)
def test_the_plan_has_what_a_static_transform_publisher_sends(
    tmp_path: Path, layout: str, moved: str, other: str
) -> None:
    """A frame with the robot's name in its launch file has it once."""
    text = FLEET.replace("tf-per-robot", f"{layout}\naffix: prefix")
    file = written(tmp_path, text)
    zeros = "0, 0, 0, 0, 0, 0"
    model = MODEL + "".join(
        f"    /x/{name}: {{pkg: tf2_ros, exec: static_transform_publisher, node_name: {name}, "
        f"args: [{zeros}, {words}]}}\n"
        for name, words in (("dock", "odom, dock"), ("laser", "robot1/base_link, laser"))
    )
    (tmp_path / "system_model.yaml").write_text(model)
    sent = sends(expected(planned_fleet(file).fleet))
    where = [next(sent[it] for it in sent if "robot1" in it and w in it) for w in ("dock", "laser")]
    assert where == [moved, other]


def test_the_state_publisher_of_a_dock_does_not_send_the_robot(tmp_path: Path) -> None:
    file = written(tmp_path)
    publisher = "pkg: robot_state_publisher, exec: robot_state_publisher"
    more = "".join(
        f"    /x/{it}: {{{publisher}, node_name: {it}}}\n"
        for it in ("dock_publisher", "robot_state_publisher")
    )
    (tmp_path / "system_model.yaml").write_text(MODEL + more)
    edges = planned_fleet(file).fleet.edges
    assert edges["robot1", "robot_state_publisher"]
    assert edges["robot1", "dock_publisher"] == []
