# SPDX-License-Identifier: Apache-2.0
"""What is the same for many robots is said once, and names them in every format."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Remap
from multibot_rewrite.base.findings.selection import grouped

ROBOTS = [f"robot{number}" for number in range(1, 21)]
NAMES = {robot: robot for robot in ROBOTS}


def lost(robot: str, topic: str = "cmd_vel", **more: str) -> Finding:
    """Return a node of the robot that does not subscribe its topic."""
    message = f"it should subscribe topic /{robot}/{topic}, and does not"
    cause = f"its rule /{topic}:=/{robot}/{topic} did not reach it"
    node = f"/{robot}/driver"
    rule = Remap(node, f"/{topic}", f"/{robot}/{topic}")
    found = Finding("MG102", ERROR, message, cause, robot=robot, node=node, remaps=(rule,))
    return found._replace(names=(f"/{robot}/{topic}",), **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(lost("robot2", "scan"), id="topic"),
        pytest.param(lost("robot2", level=WARNING), id="level"),
        pytest.param(lost("robot2", code="MG310"), id="code"),
        pytest.param(lost("robot2", file="rover.urdf"), id="file"),
        pytest.param(lost("robot2")._replace(hint=""), id="cause"),
        pytest.param(lost("robot2")._replace(message="/robot1/cmd_vel is lost"), id="robot"),
    ],
)
def test_another_fault_is_another_finding(other: Finding) -> None:
    assert grouped([lost("robot1"), other], NAMES) == [lost("robot1"), other]
