# SPDX-License-Identifier: Apache-2.0
"""On macOS, and where the kernel has no fences, everything can be imported and a file is linted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from paths import fixture_text

# What the standard library has on Linux alone, and of ``os`` that a Mac does not have.
_PROGRAM = fixture_text("elsewhere_program.txt")
XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/>'
    '<xacro:property name="n" value="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="${n}"/></joint></robot>'
)


@pytest.mark.deep
def test_nothing_asks_for_what_only_linux_has(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf.xacro"
    file.write_text(XACRO)
    words = [sys.executable, "-c", _PROGRAM, str(file), "--select", "MB202"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=100, check=False)
    first, _, rest = done.stdout.partition("\n")
    assert first.endswith(" []") and int(first.split()[0]) > 500, done.stdout + done.stderr
    assert done.returncode == 1 and "MB202" in rest, done.stdout + done.stderr
