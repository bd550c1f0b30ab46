# SPDX-License-Identifier: Apache-2.0
"""A URDF and an SDF of one robot are both named, and files of parameters go by the names they have."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from small_robots import loads

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.slow

LINKS = ("base_link", "left_wheel", "right_wheel")
URDF = """<robot name="rover"><link name="base_link"/>
<link name="left_wheel"/><joint name="left" type="continuous"><parent link="base_link"/>
<child link="left_wheel"/><axis xyz="0 1 0"/></joint>
<link name="right_wheel"/><joint name="right" type="continuous"><parent link="base_link"/>
<child link="right_wheel"/><axis xyz="0 1 0"/></joint></robot>"""
BODY = "<inertial><mass>1</mass></inertial>"
SDF = f"""<sdf version="1.9"><model name="rover_sim">
{"".join(f'<link name="{it}">{BODY}</link>' for it in LINKS)}
<joint name="left" type="revolute"><parent>base_link</parent><child>left_wheel</child>
<axis><xyz>0 1 0</xyz></axis></joint>
<joint name="right" type="revolute"><parent>base_link</parent><child>right_wheel</child>
<axis><xyz>0 1 0</xyz></axis></joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>left</left_joint><right_joint>right</right_joint></plugin></model></sdf>"""
SPAWNS = loads("rover.urdf", "rover_sim.sdf")
# Another thing of the same package.
DOCK = '<sdf version="1.9"><model name="dock"><link name="plate"/><link name="post"/></model></sdf>'
GIVES = """import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    file = os.path.join(get_package_share_directory('rover'), 'tb3.yaml')
    return LaunchDescription([Node(package='nav2_amcl', executable='amcl', parameters=[file])])
"""
AMCL = "amcl:\n  ros__parameters: {{base_frame_id: {}, scan_topic: {}}}\n"


def init(folder: Path, *words: str, launched: bool = False) -> int:
    """Without a launch file, but for which description is which."""
    out = str(folder / "fleet.yaml")
    given = ["-n", "2", "--yes", "--force", "--distro", "jazzy", "-o", out]
    launch = [] if launched else ["--launch", "none"]
    return main(["init", *(str(folder / it) for it in words), *launch, *given])


def made(folder: Path, *words: str, launched: bool = False) -> Any:
    assert init(folder, *words, launched=launched) == 0
    return yaml.safe_load((folder / "fleet.yaml").read_text())


@pytest.fixture
def package(tmp_path: Path) -> Path:
    (tmp_path / "package.xml").write_text("<package><name>rover</name></package>")
    (tmp_path / "rover.urdf").write_text(URDF)
    (tmp_path / "rover_sim.sdf").write_text(SDF)
    (tmp_path / "dock.sdf").write_text(DOCK)
    (tmp_path / "sim.launch.py").write_text(SPAWNS)
    return tmp_path


def test_the_file_whose_names_the_robot_has_is_taken(package: Path) -> None:
    (package / "a_husky.yaml").write_text(AMCL.format("husky_base", "scan"))
    (package / "rover.yaml").write_text(AMCL.format("base_link", "scan"))
    assert made(package, "rover.urdf")["related_files"]["params"] == ["rover.yaml"]


def test_without_a_winner_one_is_named(package: Path, capsys: Any) -> None:
    (package / "husky.yaml").write_text(AMCL.format("husky_base", "scan"))
    (package / "tb3.yaml").write_text(AMCL.format("base_link", "tb3/front/scan"))
    assert init(package, "rover.urdf") == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert "husky.yaml (husky_base), " in said and "tb3.yaml (tb3/front/scan)" in said
    assert said.endswith("husky.yaml\n")
    (package / "sim.launch.py").unlink()
    (package / "nav.launch.py").write_text(GIVES)
    launched = made(package, "rover.urdf", launched=True)
    assert launched["launch"] == "nav.launch.py" and "related_files" not in launched
    assert made(package, "rover.urdf", "husky.yaml")["related_files"]["params"] == ["husky.yaml"]
