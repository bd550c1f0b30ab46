# SPDX-License-Identifier: Apache-2.0
"""What live tests of ``multibot check`` share: robots, their plan, the command."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.records import PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC, End

COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot"]
TEXT, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"
SHARED = ("/clock", "/parameter_events", "/rosout")
NODES = ("drive",)
# For a busy machine; a look ends as soon as the graph is quiet.
PATIENTLY = ("--timeout", "40")


def domain(offset: int) -> int:
    """Return a domain that another run on this machine hardly uses; below 101 as ROS advises."""
    return 1 + (os.getpid() * 7 + offset) % 100


def node(robot: str, name: str = NODES[0], **more: object) -> dict[str, Any]:
    """Return a node as planned, for ``live_fleet``; ``more`` is what differs."""
    return {
        "name": name,
        "namespace": robot,
        "publishers": [["odom", "String"]],
        "subscriptions": [["cmd_vel", "String"]],
        "services": [["reset", "Trigger"]],
        **more,
    }


def write_plan(path: Path, robots: Iterable[str], nodes: Sequence[str] = NODES) -> Path:
    """Return the plan of these robots, each with these nodes, as a file."""
    full = {robot: tuple(f"/{robot}/{name}" for name in nodes) for robot in robots}
    fleet = tuple(PlannedRobot(robot, there, (), f"/{robot}/tf") for robot, there in full.items())
    ends = tuple(end for robot, there in full.items() for it in there for end in _wanted(robot, it))
    path.write_text(to_yaml(planned("both", fleet, (), SHARED, ("map",), ends)))
    return path


def _wanted(robot: str, name: str) -> list[End]:
    return [
        planned_end(name, TOPIC, SUBSCRIBES, f"/{robot}/cmd_vel", TEXT, "/cmd_vel"),
        planned_end(name, TOPIC, PUBLISHES, f"/{robot}/odom", TEXT, "odom"),
        planned_end(name, SERVICE, SERVES, f"/{robot}/reset", TRIGGER, "reset"),
    ]


def multibot(
    *arguments: object, env: Mapping[str, str], inside: Sequence[str] = ()
) -> subprocess.CompletedProcess[str]:
    """Return the command as a user runs it; ``inside`` is put before its command line."""
    return subprocess.run(
        [*inside, *COMMAND, *map(str, arguments)],
        env=env,
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )


def assert_inconclusive(done: subprocess.CompletedProcess[str]) -> None:
    """Exit code 3, and nothing is called wrong."""
    assert done.returncode == 3, done.stdout + done.stderr
    assert [line for line in done.stdout.splitlines() if ": inconclusive: MG" not in line] == []
    # Why a look is incomplete may say that what is missing may be late.
    said = [it for it in done.stderr.splitlines() if ": incomplete: " not in it]
    assert "missing" not in "\n".join([done.stdout, *said])
    assert "inconclusive, the view may be incomplete\n" in done.stderr
