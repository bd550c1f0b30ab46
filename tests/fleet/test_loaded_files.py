# SPDX-License-Identifier: Apache-2.0
"""Parameter files that descriptions load: rewritten, and loaded by each robot's own one."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import ROBOTS

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.slow

CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    wheels: {type: diff_drive_controller/DiffDriveController}
wheels:
  ros__parameters:
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
    enable_odom_tf: false
"""
FLEET = "layout: both\naffix: prefix\nnode_sets: gz_ros2_control\ndescription: rover_gz.urdf\n"
ROBOTS_TWO = "robots: [{name: robot1}, {name: robot2, pose: {y: 2}}]\n"


def package(folder: Path, path: str) -> Path:
    """Return a package with a robot that loads ``path``; returns the folder of its description."""
    text = (ROBOTS / "rover_gz.urdf").read_text()
    assert text.count("config/controllers.yaml") == 1
    (folder / "config").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>rover</name></package>")
    (folder / "config" / "c.yaml").write_text(CONTROLLERS)
    (folder / "rover_gz.urdf").write_text(text.replace("config/controllers.yaml", path))
    (folder / "fleet.yaml").write_text(FLEET + ROBOTS_TWO)
    return folder


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "path",
    [
        "config/c.yaml",
        "package://rover/config/c.yaml",
        "/ws/install/rover/share/rover/config/c.yaml",
    ],
)
def test_each_robot_loads_its_own(path: str, tmp_path: Path) -> None:
    folder, out = package(tmp_path / "src", path), tmp_path / "out"
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    for robot in ("robot1", "robot2"):
        text = (out / robot / "rover_gz.urdf").read_text()
        assert f"<parameters>{out}/{robot}/c.yaml</parameters>" in text
        own = (out / robot / "c.yaml").read_text()
        assert f"/{robot}/wheels:" in own
        assert f"{robot}_left_wheel_joint" in own
    assert (folder / "config" / "c.yaml").read_text() == CONTROLLERS


def test_one_that_is_not_there_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = package(tmp_path / "src", "package://nowhere/config/c.yaml")
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().err
    assert said.count("note: MF834") == 1
    assert "'package://nowhere/config/c.yaml', which is not there" in said
