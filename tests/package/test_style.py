# SPDX-License-Identifier: Apache-2.0
"""The code is typed and clean: the same tools a contributor runs by hand."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from paths import ROOT

pytestmark = pytest.mark.slow

# Waiting for a process; when to kill one; a clock that a test puts in place of the real one; seconds
# that a page shows.
# Stamps of messages are held against the time of now.
CLOCKS = {
    "support/waiting.py",
    "fleet/test_build.py",
    "live/test_snapshot.py",
    "producers/test_observing.py",
    "producers/test_rclpy_calls.py",
    "support/walk.py",
    # The stamps of messages are told by the clock.
    "live/test_received.py",
    "live/test_frame_ids.py",
}


def test_no_test_reads_a_clock() -> None:
    """A limit of seconds fails on a busy machine: count calls or steps, or compare two sizes."""
    clock = re.compile(r"\b(perf_counter|process_time|monotonic|thread_time)\b|\btime\.time\b")
    tests = ROOT / "tests"
    own = "package/test_style.py"
    found = {
        path.relative_to(tests).as_posix()
        for path in tests.rglob("*.py")
        if clock.search(path.read_text())
    }
    assert found - {own} == CLOCKS


def test_no_test_module_imports_another() -> None:
    """What several need is in tests/support."""
    found = [
        f"{path.name}: {name}"
        for path in (ROOT / "tests").rglob("*.py")
        for name in re.findall(r"^\s*(?:from|import) (test_\w+)", path.read_text(), re.MULTILINE)
    ]
    assert found == []


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(["ruff", "check", "."], id="ruff"),
        pytest.param(["ruff", "format", "--check", "."], id="format"),
        pytest.param(["mypy"], id="mypy"),
    ],
)
def test_a_tool_finds_nothing(arguments: list[str]) -> None:
    command = [sys.executable, "-m", *arguments]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
