# SPDX-License-Identifier: Apache-2.0
"""What a build removes, and another robot's model in the names of a robot's files."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from fleet_folder import SMALL, fleet_folder

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.slow


def build(folder: Path, *more: str) -> int:
    return main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out"), *more])


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with what a build made whose second robot is called otherwise now."""
    folder = tmp_path_factory.mktemp("built")
    fleet = fleet_folder(folder)
    assert build(folder) == 0
    fleet.write_text(fleet.read_text().replace("robot2", "robot3"))
    return folder


@pytest.fixture
def out(built: Path, tmp_path: Path) -> Path:
    """Its output folder, in a copy."""
    shutil.copytree(built, tmp_path, dirs_exist_ok=True)
    return tmp_path / "out"


def stale(out: Path, capsys: pytest.CaptureFixture[str]) -> set[str]:
    """Return the paths of the second robot that ``--check`` lists."""
    capsys.readouterr()
    assert build(out.parent, "--check") == 1
    return set(re.findall(r"robot2/\S+\.(?:urdf|yaml)", capsys.readouterr().out))


# What an earlier build made and this one does not.


def test_what_is_gone_already_is_not_left_over(
    out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (out / "robot2" / "params.yaml").unlink()
    assert stale(out, capsys) == {"robot2/rover.urdf"}
    assert build(out.parent) == 0
    assert not (out / "robot2").exists()


def test_a_folder_in_the_place_of_a_file_is_not_removed(out: Path) -> None:
    """It is not what the build made."""
    path = out / "robot2" / "params.yaml"
    path.unlink()
    path.mkdir()
    (path / "mine.txt").write_text("mine")
    assert build(out.parent) == 0
    assert (path / "mine.txt").read_text() == "mine"
    assert not (out / "robot2" / "rover.urdf").exists()


# The model of another robot, as names of Gazebo's topics hold it.


def foreign(folder: Path, value: str, capsys: pytest.CaptureFixture[str]) -> list[tuple[str, int]]:
    """Where the parameters of the fleet's robots name another robot."""
    params = f"node:\n  ros__parameters:\n    beta: 1\n    source: {value}\n"
    fleet_folder(folder, SMALL, params__yaml=params)
    code = build(folder)
    err = capsys.readouterr().err
    lines = re.findall(r"(\w+\.yaml):(\d+):\d+: \w+: MB863\b", err)
    assert code == (1 if lines else 0)
    assert (folder / "out" / "plan.yaml").exists() == (not lines)
    return [(file, int(line)) for file, line in lines]


@pytest.mark.parametrize(
    "value",
    [
        "/model/robot2/scan",
        "/world/hall/model/robot2/link/base/sensor/lidar/scan",
        "gz:/model/robot1/odometry",
    ],
)
def test_the_model_of_another_robot_is_found_inside_a_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], value: str
) -> None:
    assert foreign(tmp_path, value, capsys) == [("params.yaml", 4)]


@pytest.mark.parametrize(
    "value",
    ["/model/rover/scan", "/world/robot2_hall/model/rover/scan", "/x/models/robot2/scan", "model"],
)
def test_what_is_no_robots_model_is_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], value: str
) -> None:
    assert foreign(tmp_path, value, capsys) == []
