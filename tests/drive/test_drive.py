"""Built fleets would start, drive, see and plan; folders that were spoiled by hand would not.

Each example is built by the command and judged by ``verdict``, which imports nothing of the package.
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import fleet
import pytest
import rcl_names
import verdict
from paths import ROOT

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not importlib.util.find_spec("rclpy"),
        reason=f"names are resolved by the real rcl; install rclpy: {rcl_names.INSTALL}",
    ),
]
ALL = "starts, drives, sees, plans"
EXAMPLES = {
    "launch_tutorial": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
    "mixed_fleet": {"base1": ALL, "base2": ALL, "arm": "starts, sees"},
    "namespace_and_prefix": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
    "two_arms_moveit": {"left": "starts, sees", "right": "starts, sees"},
    "two_robots_nav2": {"robot1": ALL, "robot2": ALL},
    "two_robots_postfix": {"robot1": "starts, drives, sees", "robot2": "starts, drives, sees"},
}


class Spoiled(NamedTuple):
    """A text of a built file that was changed, and what a robot does not do then."""

    example: str
    file: str
    old: str
    new: str
    robot: str
    what: str
    why: str


FAULTS = [
    Spoiled("two_robots_nav2", "robot1/bridge.yaml", 'ros_topic_name: "/robot1/cmd_vel"',
            'ros_topic_name: "/cmd_vel"', "robot1", "drives", "/robot1/cmd_vel: that moves []"),
    Spoiled("two_robots_nav2", "robot2/bridge.yaml", 'gz_topic_name: "/robot2/cmd_vel"',
            'gz_topic_name: "/robot1/cmd_vel"', "robot2", "drives", "no topic of ROS reaches"),
    Spoiled("two_robots_nav2", "robot2/hexbase.urdf", "<topic>robot2/cmd_vel", "<topic>robot1/cmd_vel",
            "robot1", "drives", "/robot1/cmd_vel moves robot2, too"),
    Spoiled("two_robots_nav2", "robot2/hexbase.urdf", "<topic>robot2/scan", "<topic>scan",
            "robot2", "sees", "/robot2/scan, which nobody sends"),
    Spoiled("two_robots_nav2", "robot2/bridge.yaml", '"/robot2/scan"', '"/robot1/scan"',
            "robot2", "sees", "/robot2/scan, which nobody sends"),
    Spoiled("two_robots_nav2", "robot1/nav2_params.yaml", "odom_topic: odom",
            "odom_topic: /robot2/odom", "robot1", "sees", "which robot2 sends"),
    Spoiled("two_robots_nav2", "robot1/nav2_params.yaml", "robot_base_frame: base_link",
            "robot_base_frame: robot1/base_link", "robot1", "plans", "robot1/base_link on /robot1/tf"),
    Spoiled("two_robots_nav2", "fleet.launch.py", '("/tf", "tf")', '("/tf_", "tf")',
            "robot1", "plans", "on /tf, where it is not"),
    Spoiled("two_robots_nav2", "fleet.launch.py", 'namespace="/robot2"', 'namespace="/robot1"',
            "robot2", "starts", "two nodes are called /robot1/"),
    Spoiled("two_robots_nav2", "fleet.launch.py", '"route_server", ', '"router", ',
            "robot1", "starts", "waits for router"),
    Spoiled("two_robots_nav2", "fleet.launch.py", '"-topic", "/robot1/robot_description"',
            '"-topic", "robot_description"', "robot1", "starts", "waits for /robot_description"),
    Spoiled("two_robots_nav2", "fleet.launch.py", 'file("robot1/nav2_params.yaml")',
            'file("robot1/params.yaml")', "robot1", "starts", "params.yaml, which is not there"),
    Spoiled("two_robots_nav2", "fleet.launch.py", 'text("robot1/hexbase.urdf")',
            'text("robot1/hexbase")', "", "starts", "the launch file raises"),
    Spoiled("two_robots_nav2", "fleet.launch.py", "cmd_vel:=/robot1/cmd_vel",
            "cmd_vel:=/robot2/cmd_vel", "robot1", "drives",
            "to /robot2/cmd_vel: that moves ['robot2']"),
    Spoiled("mixed_fleet", "base1/nav2_params.yaml", "scan_topic: scan", "scan_topic: laser",
            "base1", "sees", "/base1/laser, which nobody sends"),
    Spoiled("two_arms_moveit", "left/controllers.yaml", "arm_controller:\n", "hand:\n",
            "left", "starts", "arm_controller has no joints"),
    Spoiled("two_arms_moveit", "left/arm.urdf", 'command_interface name="position"',
            'command_interface name="effort"', "left", "starts", "the description does not export"),
    Spoiled("two_arms_moveit", "fleet.launch.py",
            'namespace="/right",\n            name="controller_manager"',
            'namespace="/",\n            name="controller_manager"', "right", "starts",
            "a spawner waits for /right/controller_manager"),
    Spoiled("two_robots_postfix", "robot2/scout.urdf", "cmd_vel/robot2", "cmd_vel/robot1",
            "robot1", "drives", "/cmd_vel/robot1 moves robot2, too"),
]  # fmt: skip


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The folders that ``multibot build`` writes for each example."""
    folder = tmp_path_factory.mktemp("drive")
    for name in EXAMPLES:
        file = ROOT / "examples" / name / "fleet.yaml"
        command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "build", str(file)]
        done = subprocess.run(
            [*command, "-o", str(folder / name)], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    return {name: folder / name for name in EXAMPLES}


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_built_fleet_starts_and_drives(name: str, built: dict[str, Path]) -> None:
    found = fleet.read(built[name], "lyrical")
    assert verdict.judged(found) == ()
    assert {robot: verdict.said(it) for robot, it in verdict.done(found).items()} == EXAMPLES[name]
    assert found.unknown == ()


@pytest.mark.parametrize("it", FAULTS, ids=[f"{at} {it.why}" for at, it in enumerate(FAULTS)])
def test_a_spoiled_fleet_does_not(it: Spoiled, built: dict[str, Path], tmp_path: Path) -> None:
    folder = tmp_path / "fleet"
    shutil.copytree(built[it.example], folder)
    text = (folder / it.file).read_text()
    assert it.old in text
    (folder / it.file).write_text(text.replace(it.old, it.new))
    found = verdict.judged(fleet.read(folder, "lyrical"))
    said = [each.why for each in found if (each.robot, each.what) == (it.robot, it.what)]
    assert any(it.why in why for why in said), found
