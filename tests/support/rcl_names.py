# SPDX-License-Identifier: Apache-2.0
"""Asks the real rcl about names, in a process of its own that lives as long as the tests."""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from paths import SUPPORT

INSTALL = "pip install ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces"
CHILD = SUPPORT / "rcl_names_child.py"
SECONDS = 120


def needed() -> Any:
    """Return the mark of tests that ask it."""
    import pytest

    why = f"names are resolved by the real rcl; install rclpy: {INSTALL}"
    return pytest.mark.skipif(not find_spec("rclpy"), reason=why)


def ask(cases: Sequence[dict[str, Any]]) -> list[Any]:
    """Return what rcl says to each case; a case that was asked before is not asked again."""
    told, lines = _told(), [json.dumps(it) for it in cases]
    new = [it for it in dict.fromkeys(lines) if it not in told]
    if new:
        told.update(zip(new, _asked(new), strict=True))
    return [told[it] for it in lines]


@cache
def _told() -> dict[str, Any]:
    """Return what rcl has said, by case: it depends on nothing else."""
    return {}


def _asked(cases: Sequence[str]) -> Iterator[Any]:
    """Yield what rcl says to each case. One process answers all of these tests."""
    child, errors = _child()
    assert child.stdin and child.stdout
    watch = threading.Timer(SECONDS, child.kill)
    watch.start()
    try:
        for case in cases:
            child.stdin.write(f"{case}\n")
            child.stdin.flush()
            answer = child.stdout.readline()
            if not answer:
                raise AssertionError(Path(errors).read_text()[-2000:])
            yield json.loads(answer)
    finally:
        watch.cancel()


@cache
def _child() -> tuple[subprocess.Popen[str], str]:
    """Start the process that answers, and the file of what it says besides; it ends when its stdin
    does."""
    here = {
        "ROS_DOMAIN_ID": str(150 + os.getpid() % 50),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        # Shared memory may hang where several runs start hundreds of participants at once.
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
    }
    said, errors = tempfile.mkstemp(prefix="rcl_names_")
    child = subprocess.Popen(
        [sys.executable, str(CHILD)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=said,
        text=True,
        env={**os.environ, **here},
    )
    os.close(said)
    atexit.register(os.unlink, errors)
    atexit.register(child.communicate)
    return child, errors
