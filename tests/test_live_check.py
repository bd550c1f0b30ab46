"""``multibot check`` against real nodes: a healthy fleet is as planned, a leak is named."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import live_fleet
import pytest

from multibot_rewrite.graph.expectation import Expectation, Wanted, WantedRobot
from multibot_rewrite.graph.plan_file import to_yaml
from multibot_rewrite.remap.records import PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC

pytest.importorskip(
    "rclpy", reason="no rclpy: pip install '.[ros]' (Python 3.10 to 3.12)", exc_type=ImportError
)
COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "check"]
ROBOTS = ("robot1", "robot2")
TEXT, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"


def domain(offset: int) -> int:
    """A domain of this test's own."""
    return 1 + (os.getpid() * 7 + 50 + offset) % 100


def wanted(robot: str) -> list[Wanted]:
    node = f"/{robot}/drive"
    return [
        Wanted(node, TOPIC, SUBSCRIBES, f"/{robot}/cmd_vel", TEXT, "/cmd_vel"),
        Wanted(node, TOPIC, PUBLISHES, f"/{robot}/odom", TEXT, "odom"),
        Wanted(node, SERVICE, SERVES, f"/{robot}/reset", TRIGGER, "reset"),
    ]


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    robots = tuple(WantedRobot(name, (f"/{name}/drive",), (), f"/{name}/tf") for name in ROBOTS)
    shared = ("/clock", "/parameter_events", "/rosout")
    ends = tuple(end for robot in ROBOTS for end in wanted(robot))
    path = tmp_path / "plan.yaml"
    path.write_text(to_yaml(Expectation("both", robots, (), shared, ("map",), ends)))
    return path


def drive(robot: str, command: str = "cmd_vel") -> list[dict[str, Any]]:
    return [
        {
            "name": "drive",
            "namespace": robot,
            "publishers": [["odom", "String"]],
            "subscriptions": [[command, "String"]],
            "services": [["reset", "Trigger"]],
        }
    ]


def check(plan: Path, offset: int, *specs: list[dict[str, Any]]) -> tuple[int, str, str]:
    """Exit code and output of a check while these processes run."""
    own = domain(offset)
    with live_fleet.running(own, *specs):
        done = subprocess.run(
            [*COMMAND, str(plan)],
            env=live_fleet.environ(own),
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
    return done.returncode, done.stdout, done.stderr


def test_a_healthy_fleet_is_as_planned(plan: Path) -> None:
    code, out, err = check(plan, 0, drive("robot1"), drive("robot2"))
    assert (code, out) == (0, ""), err
    assert "as planned" in err


def test_a_topic_without_its_namespace_is_explained(plan: Path) -> None:
    code, out, err = check(plan, 1, drive("robot1", "/cmd_vel"), drive("robot2"))
    assert code == 1, err
    assert "/robot1/drive: error: MG102" in out
    assert "subscribes /cmd_vel instead" in out
    assert "/robot1/drive: error: MG103 /cmd_vel" in out
    assert "robot2" not in out


def test_one_robot_on_the_topic_of_another(plan: Path) -> None:
    code, out, _ = check(plan, 2, drive("robot1", "/robot2/cmd_vel"), drive("robot2"))
    assert code == 1
    assert "/robot1/drive: error: MG104 it subscribes /robot2/cmd_vel, which is robot2's" in out


def test_a_robot_that_was_not_started(plan: Path) -> None:
    code, out, err = check(plan, 3, drive("robot1"))
    assert code == 1, out + err
    assert "robot2: error: MG109" in out


def test_an_offer_below_what_is_asked_for(plan: Path) -> None:
    speaker, listener = drive("robot1"), drive("robot2")
    speaker[0]["publishers"] = [["odom", "String", "best_effort"]]
    pilot = [{"name": "pilot", "namespace": "robot1", "subscriptions": [["odom", "String"]]}]
    code, out, _ = check(plan, 4, speaker, listener, pilot)
    assert code == 1
    assert "/robot1/pilot: error: MG107 /robot1/odom: /robot1/drive offers BEST_EFFORT" in out


def test_two_nodes_of_one_name_in_two_processes(plan: Path) -> None:
    code, out, _ = check(plan, 5, drive("robot1"), drive("robot2"), drive("robot1"))
    assert code == 1
    assert "/robot1/drive: error: MG105 2 nodes have this name" in out
