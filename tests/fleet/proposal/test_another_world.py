# SPDX-License-Identifier: Apache-2.0
"""What does not build as it is: init writes the world in which it does, and says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from multibot_rewrite.cli.multibot import main

INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
MASS = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
BODY = (
    '<robot name="{0}"><link name="base_link">{1}</link><link name="tip">{1}</link>'
    '<joint name="turn" type="continuous"><parent link="base_link"/><child link="tip"/></joint>'
    "{2}</robot>"
)
PLUGIN = (
    '<gazebo><plugin filename="gz-sim-joint-position-controller-system"'
    ' name="gz::sim::systems::JointPositionController"><joint_name>turn</joint_name></plugin></gazebo>'
)


def init(folder: Path, *words: str) -> tuple[int, Any]:
    file = folder / "fleet.yaml"
    code = main(["init", *words, "-n", "1", "--yes", "--force", "-o", str(file)])
    return code, yaml.safe_load(file.read_text())


def test_a_robot_with_nothing_for_a_simulator_is_real_among_simulated_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a mass no simulator can run it; the other one is simulated."""
    for name, mass, plugin in (("rover", MASS, PLUGIN), ("arm", "", "")):
        (tmp_path / f"{name}.urdf").write_text(BODY.format(name, mass, plugin))
    code, fleet = init(tmp_path, str(tmp_path / "rover.urdf"), str(tmp_path / "arm.urdf"))
    assert code == 0
    assert fleet["simulator"] == "gazebo"
    assert [it.get("simulator") for it in fleet["robots"]] == [None, "none"]
    assert "robots that no simulator is for are real" in capsys.readouterr().err
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-q"]) == 0


def test_a_robot_that_no_simulator_can_run_is_real(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "rover.urdf").write_text(BODY.format("rover", "", PLUGIN))
    code, fleet = init(tmp_path, str(tmp_path / "rover.urdf"))
    assert (code, fleet["simulator"]) == (0, "none")
    assert "the robots are real, since it does not build as it is: MB610" in capsys.readouterr().err
