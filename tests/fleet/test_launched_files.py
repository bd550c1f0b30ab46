# SPDX-License-Identifier: Apache-2.0
"""Parameter files that only launch files name are rewritten, so that plan and files agree."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from rule_examples import DESCRIPTION

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.launch import launched_robot
from multibot_rewrite.fleet.outputs.related_files import launched_values
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchOrder,
    ParameterText,
)
from multibot_rewrite.system.records import Place

FLEET = """\
layout: frames-per-robot
affix: prefix
distro: jazzy
related_files: {{params: [{params}]}}
launch: bringup.launch.py
robots:
  - {{name: robot1, description: robot.urdf}}
  - {{name: robot2, description: robot.urdf}}
"""
DRIVE = """\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    base_frame_id: SIDEbase_link
    left_wheel_names: [wheel_joint]
"""
FILLED = DRIVE.replace("SIDE", "")
AT = Place("bringup.launch.py", 7)


def built(
    folder: Path, monkeypatch: pytest.MonkeyPatch, given: ParameterText, params: str = ""
) -> tuple[dict[str, str], list[Finding]]:
    """Paths and texts of a build, and the findings of its plan."""
    node = LaunchedNode(
        "controller_manager", "ros2_control_node", "", "/", (), (given,), "", (), "", AT
    )
    graphs = {"bringup.launch.py": LaunchGraph((node,))}

    def graph(order: LaunchOrder) -> LaunchGraph:
        return graphs[Path(order.file).name]

    monkeypatch.setattr(launched_robot, "launch_graph", graph)
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "bringup.launch.py").write_text("")
    (folder / "fleet.yaml").write_text(FLEET.format(params=params))
    plan = planned_fleet(folder / "fleet.yaml")
    texts = {it.path: it.data.decode() for it in make_outputs(plan).files}
    return texts, [it for it in plan.fleet.table.problems if it.code == "MF824"]


@pytest.mark.parametrize("filled", [f"{FILLED}\n# more\n", DRIVE.replace("SIDE", "robot1_")])
def test_a_file_that_is_filled_for_one_robot_is_left_out(
    filled: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "drive.yaml"
    file.write_text(DRIVE.replace("SIDE", "$(var side)"))
    found, notes = built(tmp_path, monkeypatch, ParameterText("", filled, str(file)))
    assert "robot1/drive.yaml" not in found
    assert [(it.level, it.file, it.line) for it in notes] == [("warning", *AT[:2])]
    assert str(file) in notes[0].message and "params" in notes[0].hint


def test_the_robots_own_file_of_that_name_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "other").mkdir()
    file, own = tmp_path / "other" / "drive.yaml", tmp_path / "drive.yaml"
    file.write_text(FILLED)
    own.write_text(f"# own\n{FILLED}")
    given = ParameterText(str(file), FILLED, str(file))
    found, notes = built(tmp_path, monkeypatch, given, "drive.yaml")
    assert found["robot1/drive.yaml"].startswith("# own")
    assert [(it.level, it.line) for it in notes] == [("note", 7)]
    same = ParameterText(str(own), FILLED, str(own))
    assert built(tmp_path, monkeypatch, same, "drive.yaml")[1] == []


def test_a_file_without_parameters_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "flat.yaml"
    file.write_text("a: 1\n")
    found, notes = built(tmp_path, monkeypatch, ParameterText(str(file), "a: 1\n", str(file)))
    assert notes == [] and "robot1/flat.yaml" not in found


# By default all robots would have one.
ODOM = {"odom_frame": "robot2/odom"}
EKF = "/ekf_filter_node:\n  ros__parameters: {{{}}}\n"


@pytest.mark.parametrize(
    ("values", "given"),
    [
        (
            "base_link_frame: chassis, world_frame: ground",
            {"base_link_frame": "robot2/chassis", "world_frame": "robot2/ground"} | ODOM,
        ),
        (
            "base_link_frame: base_link, frequency: 20.0",
            {"base_link_frame": "robot2/base_link", "frequency": 20.0} | ODOM,
        ),
    ],
)
def test_what_the_launch_itself_gives_is_given_with_the_names_of_each_robot(
    values: str, given: dict[str, object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = LaunchedNode(
        *("robot_localization", "ekf_node", "ekf_filter_node", "/", ()),
        (ParameterText("", EKF.format(values)),), "", (), "", AT,
    )  # fmt: skip
    monkeypatch.setattr(launched_robot, "launch_graph", lambda _: LaunchGraph((node,)))
    (tmp_path / "robot.urdf").write_text(DESCRIPTION)
    (tmp_path / "bringup.launch.py").write_text("")
    (tmp_path / "fleet.yaml").write_text(FLEET.format(params=""))
    plan = planned_fleet(tmp_path / "fleet.yaml")
    made = launched_values(plan)
    assert made.values["robot2", "ekf_filter_node"] == given
    assert "MF824" not in {it.code for it in (*plan.fleet.table.problems, *made.findings)}
