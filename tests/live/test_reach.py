# SPDX-License-Identifier: Apache-2.0
"""A robot that is not seen: missing, or hidden by the network; and what is said of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from live_commands import write_plan
from looks import ONE, end, look, node

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import End, System


def seen(*robots: tuple[str, str], **around: Any) -> System:
    """Return these robots as planned, each in its process."""
    ends = tuple(
        End(it.kind, it.role, it.name, it.type, "", f"/{robot}/drive", None, process)
        for robot, process in robots
        for it in (
            end(robot, f"/{robot}/odom"),
            end(robot, f"/{robot}/cmd_vel", role="subscribes"),
            end(
                robot, f"/{robot}/reset", kind="service", role="serves", type="std_srvs/srv/Trigger"
            ),
        )
    )
    return look(*(node(robot, process) for robot, process in robots), ends=ends, **around)


def test_the_command_ends_inconclusive(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(seen(("robot1", ONE), range="SUBNET")))
    assert main(["check", str(plan), "--from", str(graph)]) == 3
    shown = capsys.readouterr()
    assert "robot2: inconclusive: MG109" in shown.out
    assert "inconclusive, the view may be incomplete" in shown.err
    assert main(["check", str(plan), "--from", str(graph), "--ignore", "MG109"]) == 0
