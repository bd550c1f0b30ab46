# SPDX-License-Identifier: Apache-2.0
"""A layout is a row in one place: with one more row, every command knows it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, make_naming

SMALL = '<robot name="rover"><link name="base"/></robot>'

FIFTH = """\
import sys
from multibot_rewrite.base import naming
row = naming.Layout("bare", "L9", False, False, False, "nothing is renamed but topics")
naming.LAYOUTS = (*naming.LAYOUTS, row)
from importlib import import_module
sys.exit(import_module("multibot_rewrite.cli." + sys.argv[1]).main(sys.argv[2:]))
"""


def python(code: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.slow
@pytest.mark.parametrize("word", ["bare", "L9"])
def test_a_fifth_layout_rewrites(word: str, tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(SMALL)
    arguments = ("urdf_postfix", tmp_path / "r.urdf", "r1", "--layout", word)
    done = python(FIFTH, *arguments)
    assert (done.returncode, done.stdout) == (0, SMALL)
    assert python(FIFTH.replace('"bare"', '"bear"'), *arguments[:-1], "bare").returncode == 2


@pytest.mark.slow
@pytest.mark.parametrize("word", ["bare", "L9"])
def test_a_fifth_layout_builds(word: str, tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(SMALL)
    text = f"layout: {word}\nrobots:\n  - {{name: r1, description: r.urdf}}\n"
    (tmp_path / "fleet.yaml").write_text(text)
    done = python(FIFTH, "multibot", "build", tmp_path / "fleet.yaml", "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "r1" / "r.urdf").read_text() == SMALL


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "command", [("urdf_postfix",), ("urdf_lint",), ("multibot", "plan")], ids=" ".join
)
def test_the_help_lists_a_fifth_layout(command: tuple[str, ...]) -> None:
    done = python(FIFTH, *command, "--help")
    assert done.returncode == 0, done.stderr
    assert "bare (L9" in re.sub(r"\s+", " ", done.stdout)


def test_the_default_layout_is_a_row() -> None:
    assert make_naming().layout.name == DEFAULT_LAYOUT
    assert DEFAULT_LAYOUT in [it.name for it in LAYOUTS]
