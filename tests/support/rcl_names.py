# SPDX-License-Identifier: Apache-2.0
"""Asks the real rcl about names, in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from typing import Any

from paths import SUPPORT

INSTALL = "pip install ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces"
CHILD = SUPPORT / "rcl_names_child.py"
SECONDS = 120


def ask(cases: Sequence[dict[str, Any]]) -> list[Any]:
    """What rcl says to each case; a case that was asked before is not asked again."""
    told, lines = _told(), [json.dumps(it) for it in cases]
    new = [it for it in dict.fromkeys(lines) if it not in told]
    if new:
        told.update(zip(new, _asked(new), strict=True))
    return [told[it] for it in lines]


@cache
def _told() -> dict[str, Any]:
    """What rcl has said, by case: it depends on nothing else."""
    return {}


def _asked(cases: Sequence[str]) -> list[Any]:
    """What rcl says to each case. One process answers all; it ends when its stdin does."""
    domain = str(150 + os.getpid() % 50)
    here = {
        "ROS_DOMAIN_ID": domain,
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        # Shared memory may hang where several runs start hundreds of participants at once.
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
    }
    done = subprocess.run(
        [sys.executable, str(CHILD)],
        input="".join(f"{it}\n" for it in cases),
        capture_output=True,
        text=True,
        timeout=SECONDS,
        env={**os.environ, **here},
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(answers) == len(cases), done.stderr[-2000:]
    return answers
