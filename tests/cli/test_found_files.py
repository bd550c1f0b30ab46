# SPDX-License-Identifier: Apache-2.0
"""Which files a command reads that is given files and folders."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from multibot_rewrite.cli.walk import find_files

SUFFIXES = (".urdf", ".sdf")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def found(*paths: str) -> list[str]:
    return find_files(paths, SUFFIXES, everything=True).files


def make(*names: str) -> None:
    for name in names:
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).touch()


def test_folders_are_searched_by_suffix_and_named_files_are_read_as_they_are() -> None:
    make("a.urdf", "b/c.URDF", "b/d.sdf", "b/e.srdf", "b/f.xacro", "b/g.xml", "h.urdf.x")
    assert found(".") == ["./a.urdf", "./b/c.URDF", "./b/d.sdf"]
    assert found("b/f.xacro") == ["b/f.xacro"]
    assert found("b/g.xml", ".") == ["b/g.xml", "./a.urdf", "./b/c.URDF", "./b/d.sdf"]


def test_a_file_counts_once_however_it_is_reached() -> None:
    make("x/a.urdf")
    Path("x/loop").symlink_to("..")
    Path("x/self.urdf").symlink_to("self.urdf")
    Path("link.urdf").symlink_to("x/a.urdf")
    Path("other").symlink_to("x")
    assert found(".", "x/a.urdf", "x", "other") == ["./link.urdf", "./other/self.urdf"]


def test_a_pipe_in_a_folder_is_passed_by() -> None:
    make("a.urdf")
    os.mkfifo("b.urdf")
    assert found(".") == ["./a.urdf"]


def test_the_order_is_that_of_names() -> None:
    names = ["b.urdf", "c.urdf", "a/z.urdf", "a/b/y.urdf", "a/c/y.urdf", "d/x.urdf", "e/x.urdf"]
    make(*sorted(names, key=lambda name: name[::-1]))
    assert found(".") == [f"./{name}" for name in names]
    assert found("e", "c.urdf") == ["e/x.urdf", "c.urdf"]
