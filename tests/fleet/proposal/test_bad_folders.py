# SPDX-License-Identifier: Apache-2.0
"""Folders that have no robot that can be told: one line that says what to give, and nothing written."""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path
from typing import Any

import pytest
from paths import write_files

from multibot_rewrite.cli.multibot import main

XACRO = '<robot {}xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
FILES = {
    "no robot": {"README.md": "", "config/nav2.yaml": "amcl: {ros__parameters: {a: 1}}\n"},
    "ignored": {"src/AMENT_IGNORE": "", "src/car.urdf": "<robot name='car'/>"},
    "a thing": {"tree.sdf": '<sdf version="1.9"><model name="t"><link name="t"/></model></sdf>'},
    "macros": {"arm.xacro": XACRO.format('name="arm" ', '<xacro:macro name="arm"/>')},
    "broken": {"car.urdf.xacro": XACRO.format('name="car" ', "<link name='${1 +}'/>")},
    "not XML": {"car.urdf": "<robot name='car'><link name='a'></robot>"},
    "a package": {
        "car.urdf.xacro": XACRO.format(
            'name="car" ', '<xacro:include filename="$(find wheels)/w.xacro"/><link name="a"/>'
        )
    },
    "an argument": {"car.urdf.xacro": XACRO.format('name="car" ', '<link name="$(arg size)"/>')},
}
SAYS = {
    "no robot": "no description of a robot is there; give a URDF, xacro or SDF",
    "ignored": "/src; name that folder",
    "a thing": "nothing in it moves or senses; give the file that has the robot",
    "macros": "it has no link; it defines macros; give the file that has the robot",
    "broken": "car.urdf.xacro",
    "not XML": "car.urdf",
    "a package": "package 'wheels' is not found",
    "an argument": "give it as size:=VALUE",
}


@pytest.mark.parametrize("kind", FILES)
def test_a_folder_without_a_robot_that_can_be_told(kind: str, tmp_path: Path, capsys: Any) -> None:
    write_files(tmp_path, FILES[kind])
    fleet = tmp_path / "out" / "fleet.yaml"
    assert main(["init", str(tmp_path), "--yes", "-o", str(fleet)]) == 2
    said = capsys.readouterr().err
    assert SAYS[kind] in said
    assert len(said.splitlines()) == 1
    assert not fleet.parent.exists()


def test_a_robot_that_only_a_world_has_is_told_with_the_commands(
    tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the tutorials of Gazebo have theirs; what is printed is run, as a shell and init do."""
    launch = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=['gz', 'sim', 'WORLD'])])
"""
    world = """<sdf version="1.8"><world name="w">
<model name="box"><link name="l"/></model>
<model name="car"><link name="l"/><link name="r"/>
<joint name="j" type="revolute"><parent>l</parent><child>r</child></joint>
<plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher"/>
</model>
</world></sdf>
"""
    monkeypatch.chdir(tmp_path)
    files = {"w.sdf": world, "go.launch.py": launch.replace("WORLD", f"{tmp_path}/w.sdf")}
    write_files(tmp_path, files)
    assert main(["init", ".", "--yes"]) == 2
    said = capsys.readouterr().err
    command, _, again = said.partition("a file of its own, ")[2].partition("; multibot ")
    subprocess.run(command, shell=True, check=True)
    assert main([*shlex.split(again), "--yes"]) == 0
    text = (tmp_path / "fleet.yaml").read_text()
    assert "description: car.sdf\n" in text and "launch: go.launch.py\n" in text
