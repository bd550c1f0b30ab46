# SPDX-License-Identifier: Apache-2.0
"""Folders that have no robot that can be told: one line that says what to give, and nothing written."""

from __future__ import annotations

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
