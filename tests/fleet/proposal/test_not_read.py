# SPDX-License-Identifier: Apache-2.0
"""Descriptions that ``multibot init`` cannot read or use: it says which, and why."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from small_robots import PACKAGE, init, loads, robot, taken

from multibot_rewrite.base.editors import FLEET, schema_name, schema_text
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.proposal.choosing import is_srdf_launched, names_its_package
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.related_files import srdf_of
from multibot_rewrite.proposal.searching import search, text_of

WIKI = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
GZ = (
    f'<robot name="tetra" {WIKI}><xacro:include filename="not_there.xacro"/><gazebo>'
    '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/></gazebo></robot>'
)


@pytest.fixture
def tetra(tmp_path: Path) -> Path:
    """Return a bare base that can be read, and the simulated robot, which cannot."""
    (tmp_path / "package.xml").write_text(PACKAGE.format("acme_tetra"))
    (tmp_path / "base.urdf").write_text(robot("tetra", "left", "right"))
    (tmp_path / "tetra_gz.xacro").write_text(GZ)
    return tmp_path


@pytest.mark.parametrize("launched", [["tetra_gz.xacro"], ["tetra_gz.xacro", "base.urdf"]])
def test_another_one_is_not_taken_for_what_launch_files_load(
    launched: list[str], tetra: Path, capsys: Any
) -> None:
    (tetra / "sim.launch.py").write_text(loads(*launched))
    assert init(tetra) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "not_there.xacro" in said
    assert "the launch files load it; for another one: multibot init" in said
    assert "base.urdf" in said.partition("for another one")[2]
    assert not (tetra / "fleet.yaml").exists()


def test_a_part_that_cannot_be_read_stops_nothing(tetra: Path) -> None:
    (tetra / "tetra_gz.xacro").rename(tetra / "gripper.xacro")
    (tetra / "sim.launch.py").write_text(loads("gripper.xacro", "base.urdf"))
    assert taken(tetra)["description"] == "base.urdf"


@pytest.mark.parametrize(
    ("package", "file", "named"),
    [
        ("tetra_description", "tetra.urdf.xacro", True), ("acme_tetra", "tetra.xacro", True),
        ("acme_tetra_description", "tetra.xacro", True), ("tetra", "tetra.urdf", True),
        ("tetra_description", "tetra_gz.xacro", False), ("acme", "base.urdf", False),
        ("acme_tetra", "description.urdf", False),
    ],
)  # fmt: skip
def test_a_package_is_named_after_its_robot(
    package: str, file: str, named: bool, tmp_path: Path
) -> None:
    (tmp_path / "package.xml").write_text(PACKAGE.format(package))
    assert names_its_package(str(tmp_path / file)) is named


LOADS = [
    "MoveItConfigsBuilder('arm', package_name='arm_moveit_config')", "MoveItConfigsBuilder('arm')",
    "MoveItConfigsBuilder(robot_name='arm')", "load('arm_moveit_config', 'config/arm.srdf')",
]  # fmt: skip


@pytest.mark.parametrize("launch", LOADS)
def test_the_srdf_is_that_of_the_package_that_launch_files_name(
    launch: str, tmp_path: Path
) -> None:
    """The description's package has one as well, which is nearer and out of date."""
    group = '<robot name="arm"><group name="g"><joint name="lift"/></group></robot>'
    for name, folder in (("arm_description", "srdf"), ("arm_moveit_config", "config")):
        (tmp_path / name / folder).mkdir(parents=True)
        (tmp_path / name / "package.xml").write_text(PACKAGE.format(name))
        (tmp_path / name / folder / "arm.srdf").write_text(group)
    (tmp_path / "arm_description/arm.urdf").write_text(robot("arm", "lift"))
    start = "x = 'arm_description', 'arm.urdf'\n"
    (tmp_path / "up.launch.py").write_text(start)
    found = search([str(tmp_path)])
    arm = Looked(str(tmp_path / "arm_description/arm.urdf"), root=None)
    stale, right = found.srdf
    (tmp_path / "move.launch.py").write_text("load('other_config', 'config/arm.srdf')\n")
    found = search([str(tmp_path)])
    assert srdf_of(arm, found) == stale and not is_srdf_launched(right, found)
    text_of.cache_clear()
    (tmp_path / "move.launch.py").write_text(f"{start}{launch}\n")
    assert srdf_of(arm, search([str(tmp_path)])) == right


def test_an_rviz_config_of_the_robots_packages_goes_first(tmp_path: Path) -> None:
    shown = "Visualization Manager: {Displays: []}\n"
    for name in ("car_description", "car_bringup", "aaa_car_tools"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").write_text(PACKAGE.format(name))
        if name != "car_description":
            (tmp_path / name / "car.rviz").write_text(shown)
    (tmp_path / "car_description/car.urdf").write_text(robot("car", "wheel"))
    (tmp_path / "car_bringup/up.launch.py").write_text(loads("../car_description/car.urdf"))
    assert taken(tmp_path)["related_files"]["rviz"] == "car_bringup/car.rviz"


BROKEN = {
    "link": (lambda path: path.symlink_to(path), "it is a link to nothing"),
    "empty": (lambda path: path.write_text(""), "the file is empty"),
    "binary": (lambda path: path.write_bytes(bytes(range(256)) * 9), "not well-formed XML"),
    "UTF-16": (lambda path: path.write_bytes(b"\xff\xfe<\0r\0"), "the text is UTF-16"),
    "no link": (lambda path: path.write_text('<robot name="a"/>'), "it has no link"),
    "folder": (lambda path: path.mkdir(), "no description of a robot is there"),
    "pipe": (os.mkfifo, "it is a pipe"),
    "huge": (lambda path: path.write_bytes(b"<robot>" + b" " * 2**24), "over the limit"),
    "deep": (lambda path: path.write_text("<a>" * 9000), "not well-formed XML"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_a_file_that_is_no_robot(kind: str, tmp_path: Path, capsys: Any) -> None:
    make, says = BROKEN[kind]
    make(tmp_path / "robot.urdf")
    assert main(["init", str(tmp_path / "robot.urdf"), "--yes", "-o", f"{tmp_path}/o/f.yaml"]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and says in said
    assert not (tmp_path / "o").exists()


def test_a_name_that_no_fleet_file_can_have(tmp_path: Path, capsys: Any) -> None:
    odd = os.fsdecode(os.fsencode(tmp_path) + b"/car\xff.urdf")
    Path(odd).write_text(robot("car", "wheel"))
    assert main(["init", odd, "--yes", "-o", "-"]) == 2
    assert "its name is not UTF-8, and YAML takes no other; rename it" in capsys.readouterr().err
    assert search([str(tmp_path)]).every == ()


@pytest.mark.parametrize(("given", "code"), [("kind:=b", 0), ("kin:=b", 2), ("read:=b", 0)])
def test_a_value_that_no_xacro_takes_is_refused(
    given: str, code: int, tmp_path: Path, capsys: Any
) -> None:
    body = '<xacro:arg name="kind" default="a"/><link name="$(arg kind)"/>'
    read = "<!-- $(arg no) --><xacro:if value=\"${'read' == 1}\">$(arg read)</xacro:if>"
    xacro = tmp_path / "a.urdf.xacro"
    xacro.write_text(f'<robot name="a" {WIKI}>{body}{read}</robot>')
    file = tmp_path / "f.yaml"
    assert main(["init", str(xacro), given, "--yes", "-o", str(file)]) == code
    said = capsys.readouterr().err
    assert (f"{given}: no argument of {xacro} has this name" in said) == (code == 2)
    assert file.exists() == (code == 0)
    urdf = tmp_path / "car.urdf"
    urdf.write_text(robot("car", "wheel"))
    assert main(["init", str(urdf), "x:=1", "--yes", "-o", "-"]) == 2


def test_the_schema_is_beside_the_fleet_file(tmp_path: Path, capsys: Any) -> None:
    """Its comment is the same on every machine; what is printed has nothing beside it."""
    urdf, folder = tmp_path / "car.urdf", tmp_path / "new"
    urdf.write_text(robot("car", "wheel"))
    schema = folder / schema_name(FLEET)
    words = ["init", str(urdf), "--yes", "--force", "-o"]
    assert main([*words, f"{folder}/f.yaml"]) == 0
    line = "# yaml-language-server: $schema=.fleet.schema.json\n"
    assert (folder / "f.yaml").read_text().startswith(line)
    assert schema.read_bytes() == schema_text(FLEET)
    # That of an older release is replaced, a file of somebody else stays.
    schema.write_text('{"$id": "urn:multibot_rewrite:fleet", "old": 1}')
    assert main([*words, f"{folder}/f.yaml"]) == 0 and schema.read_bytes() == schema_text(FLEET)
    for other in ('{"$id": "mine"}', "[1]", "no JSON"):
        schema.write_text(other)
        assert main([*words, f"{folder}/f.yaml"]) == 0 and schema.read_text() == other
        assert "yaml-language-server" not in (folder / "f.yaml").read_text()
    capsys.readouterr()
    assert main([*words, "-"]) == 0 and "yaml-language-server" not in capsys.readouterr().out
    assert main([*words, "/dev/null"]) == 0
