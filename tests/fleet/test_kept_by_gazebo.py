# SPDX-License-Identifier: Apache-2.0
"""What Gazebo leaves out of a robot that runs in it is an error of the commands that plan for it."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest

from multibot_rewrite.cli.multibot import main

MASS = (
    "<inertial><mass value='1'/>"
    "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"
)
ROBOT = """\
<robot name="rover">
  <link name="base_link">{base}</link>
  <link name="wheel">{wheel}</link>
  <link name="caster"/>
  <joint name="wheel_joint" type="continuous"><parent link="base_link"/><child link="wheel"/></joint>
  <joint name="caster_joint" type="{caster}">
    <parent link="base_link"/><child link="caster"/>
  </joint>
  <gazebo reference="{seen}"><sensor name="lidar" type="gpu_lidar"/></gazebo>
  {more}
</robot>
"""
IGNITION = """<gazebo><plugin filename="ignition-gazebo-imu-system"
    name="ignition::gazebo::systems::Imu"/></gazebo>"""
DRIVE = """<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
    <left_joint>wheel_joint</left_joint><right_joint>wheel_joint</right_joint></plugin></gazebo>"""
WHOLE = {"base": MASS, "wheel": MASS, "caster": "fixed", "seen": "base_link", "more": ""}


def ended(folder: Path, simulator: str, *command: str, **given: str) -> int:
    """Return the exit code of a command for two robots; without one of ``build``."""
    (folder / "rover.urdf").write_text(ROBOT.format(**{**WHOLE, **given}))
    said = f"simulator: {simulator}\n" if simulator else ""
    robots = "".join(f"  - {{name: robot{at}, description: rover.urdf}}\n" for at in (1, 2))
    (folder / "fleet.yaml").write_text(f"{said}robots:\n{robots}")
    first, *words = command or ("build", "-o", str(folder / "out"))
    return main([first, str(folder / "fleet.yaml"), *words])


@pytest.mark.parametrize(("release", "code"), [("lyrical", 1), ("jazzy", 0)])
def test_a_system_that_gazebo_of_the_release_does_not_find_is_an_error(
    release: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """gz-sim 10 takes no library of Ignition any more (its Migration.md)."""
    assert ended(tmp_path, f"gazebo\ndistro: {release}", more=IGNITION) == code
    said = "error: MB172 Gazebo of lyrical finds no 'ignition-gazebo-imu-system'"
    assert (said in capsys.readouterr().err) == bool(code)


@pytest.mark.more
@pytest.mark.parametrize(
    ("given", "code", "what"),
    [
        ({"base": "", "wheel": ""}, "MB610", "no link has an <inertial>"),
        ({"base": "<inertial><mass value='0'/></inertial>", "wheel": ""}, "MB610", "has a mass"),
        ({"base": ""}, "MB603", "with 2 links below it"),
        ({"wheel": "", "more": DRIVE}, "MB603", "joint 'wheel_joint' of a plugin goes with it"),
        ({"wheel": "", "seen": "wheel"}, "MB603", "sensor 'lidar' goes with it"),
        ({"caster": "continuous", "seen": "caster"}, "MB603", "sensor 'lidar' goes with it"),
    ],
)
def test_what_a_simulated_robot_relies_on_is_an_error(
    given: dict[str, str], code: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ended(tmp_path, "gazebo", **given) == 1
    (line,) = [it for it in capsys.readouterr().err.splitlines() if f"error: {code}" in it]
    assert what in line
    assert not (tmp_path / "out").exists()


@pytest.mark.more
def test_a_joint_that_is_preserved_is_no_part_of_its_parent(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keep = "<gazebo reference='caster_joint'><preserveFixedJoint>true</preserveFixedJoint></gazebo>"
    assert ended(tmp_path, "gazebo", seen="caster", more=keep) == 1
    assert "error: MB603 link 'caster'" in capsys.readouterr().err


@pytest.mark.more
@pytest.mark.parametrize(("simulator", "level"), [("", "error"), ("none", ""), ("gazebo", "error")])
def test_it_is_one_unless_the_robot_is_real(
    simulator: str, level: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = ended(tmp_path, simulator, wheel="", more=DRIVE)
    said = [it for it in capsys.readouterr().err.splitlines() if "MB603" in it]
    assert [f"{level}: MB603" in it for it in said] == ([True] if level else [])
    assert ["; for a real robot write simulator: none)" in it for it in said] == (
        [not simulator] if level else []
    )
    assert code == (1 if level == "error" else 0)


@pytest.mark.more
def test_what_nothing_relies_on_is_a_warning(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ended(tmp_path, "gazebo", caster="continuous") == 0
    assert "warning: MB603 link 'caster'" in capsys.readouterr().err


@pytest.mark.live
@pytest.mark.skipif(not find_spec("rclpy"), reason="rehearse starts nodes: install rclpy")
@pytest.mark.parametrize("command", ["plan", pytest.param("rehearse", marks=pytest.mark.deep)])
def test_other_commands_say_it_too(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ended(tmp_path, "gazebo", command, wheel="", more=DRIVE) == 1
    assert "error: MB603 link 'wheel'" in "".join(capsys.readouterr())
