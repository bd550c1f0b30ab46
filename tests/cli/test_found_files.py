# SPDX-License-Identifier: Apache-2.0
"""Which files a command reads that is given files and folders."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.walk import find_files

pytestmark = pytest.mark.usefixtures("here")
SUFFIXES = (".urdf", ".sdf")


def found(*paths: str) -> list[str]:
    return find_files(paths, SUFFIXES, everything=True).files


def make(*names: str) -> None:
    for name in names:
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).touch()


def test_a_file_counts_once_however_it_is_reached() -> None:
    make("x/a.urdf")
    Path("x/loop").symlink_to("..")
    Path("x/self.urdf").symlink_to("self.urdf")
    Path("link.urdf").symlink_to("x/a.urdf")
    Path("other").symlink_to("x")
    assert found(".", "x/a.urdf", "x", "other") == ["./link.urdf", "./other/self.urdf"]
