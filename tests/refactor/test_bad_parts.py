# SPDX-License-Identifier: Apache-2.0
"""Parts and packages that cannot be taken: one line, exit code 2, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.more
SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
BASE = '<robot name="base"><link name="base"/></robot>\n'
# The file of a part -> what is wrong with it.
BAD = {
    "${__import__('os').getcwd()}": "Use of invalid name(s): __import__",
    "$(env PART_LINK)": "'PART_LINK'",
    "$(arg nowhere)": "Undefined substitution argument nowhere",
    "${name}": "name 'name' is not defined",
}
LOOP = f'<robot name="a" {SPACE}><xacro:include filename="OTHER"/><link name="a"/></robot>\n'


@pytest.fixture
def folder(here: Path) -> Path:
    (here / "base.urdf").write_text(BASE)
    return here


def refused(words: list[str], folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """Return the line that says why; nothing is written."""
    before = {it: it.read_bytes() for it in folder.rglob("*") if it.is_file()}
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert {it: it.read_bytes() for it in folder.rglob("*") if it.is_file()} == before
    return told


@pytest.mark.parametrize("set_", [False, True])
@pytest.mark.parametrize("name", BAD)
def test_a_name_that_cannot_be_made_is_refused(
    name: str,
    set_: bool,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if set_:
        monkeypatch.setenv("PART_LINK", "palm")
    (folder / "part.xacro").write_text(f'<robot name="p" {SPACE}><link name="{name}"/></robot>')
    words = ["join", "base.urdf", "part.xacro", "--at", "base", "-o", "robot.urdf"]
    assert BAD[name] in refused(words, folder, capsys)
    (folder / "package.xml").write_text("<package><name>p</name></package>")
    (folder / "base.urdf").unlink()
    assert BAD[name] in refused(["adopt", ".", "--in-place"], folder, capsys)
    assert BAD[name] in refused(["rename", "palm", "hand", "."], folder, capsys)


def test_includes_that_go_round_are_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "a.xacro").write_text(LOOP.replace("OTHER", "b.xacro"))
    (folder / "b.xacro").write_text(LOOP.replace("OTHER", "a.xacro"))
    words = ["join", "base.urdf", "a.xacro", "--at", "base", "-o", "robot.urdf"]
    assert "an include leads back to itself" in refused(words, folder, capsys)
    (folder / "own.xacro").write_text(LOOP.replace("OTHER", "own.xacro"))
    assert "an include leads back to itself" in refused(
        ["join", "base.urdf", "own.xacro", "--at", "base", "-o", "robot.urdf"], folder, capsys
    )
    (folder / "base.urdf").unlink()
    assert "leads back to itself" in refused(["adopt", ".", "--in-place"], folder, capsys)


def test_parts_that_stand_on_the_world_share_it(folder: Path) -> None:
    part = (
        '<robot name="{0}"><link name="world"/><link name="{0}"/><joint name="{0}_stands" type="fixed">'
        '<parent link="world"/><child link="{0}"/></joint></robot>\n'
    )
    for it in ("a", "b"):
        (folder / f"{it}.urdf").write_text(part.format(it))
    assert main(["join", "a.urdf", "b.urdf", "--at", "world", "-o", "robot.urdf", "-q"]) == 0
    root = etree.parse("robot.urdf").getroot()
    assert [it.get("name") for it in root.iter("link")] == ["world", "a", "b"]
    assert [it.get("link") for it in root.iter("parent")] == ["world", "world"]
