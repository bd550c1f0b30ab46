# SPDX-License-Identifier: Apache-2.0
"""Nodes that nobody knows, started by a launch file: what is built starts them with all they had."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from rule_examples import DESCRIPTION

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.launch.performed import Launching, performed

FLEET = """\
layout: {layout}
distro: jazzy
simulator: none
launch: "up.launch.py ns:={{robot}}"
{more}
robots:
  - {{name: robot1, description: robot.urdf}}
  - {{name: robot2, description: robot.urdf}}
"""
LAUNCH = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, LifecycleNode, Node
from launch_ros.descriptions import ComposableNode

NS = LaunchConfiguration('ns')


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('ns', default_value=''),
        BODY
    ])
"""


def started(
    folder: Path, body: str, more: str = "", layout: str = "both", **files: str
) -> dict[str, dict[str, Any]]:
    """Return what a build's launch file gives each program or class of the last robot, and of all."""
    (folder / "robot.urdf").write_text(DESCRIPTION)
    (folder / "up.launch.py").write_text(LAUNCH.replace("BODY", body))
    (folder / "fleet.yaml").write_text(FLEET.format(more=more, layout=layout))
    for name, text in files.items():
        (folder / f"{name}.yaml").write_text(text)
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    (done,) = performed(str(folder / "out/fleet.launch.py"), [Launching({})])
    assert not done.error
    found = {}
    for it in (action.values for action in done.actions if "executable" in action.values):
        inner = it.get("composable_node_descriptions", ())
        found |= {one.get("executable") or one["plugin"]: one for one in (it, *inner)}
    return found


def values(it: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters that are in no file."""
    return {
        key: one for row in it["parameters"] if isinstance(row, dict) for key, one in row.items()
    }


@pytest.mark.parametrize(
    ("body", "program"),
    [
        ("LifecycleNode(package='p', executable='x', name='n', namespace='', OWN)", "x"),
        ("ExecuteProcess(cmd=['ros2', 'run', 'p', 'x', '--ros-args', '-p', 'rate:=5'])", "x"),
        (
            "ComposableNodeContainer(package='rclcpp_components', executable='component_container',"
            " name='c', namespace='', composable_node_descriptions=["
            "ComposableNode(package='p', plugin='p::X', name='n', OWN)])",
            "p::X",
        ),
    ],
)
def test_each_action_that_starts_a_node_keeps_it(body: str, program: str, tmp_path: Path) -> None:
    found = started(tmp_path, body.replace("OWN", "parameters=[{'rate': 5}]"))
    assert (found[program]["package"], values(found[program])["rate"]) == ("p", 5)
    # Only its code says what a node is called that the launch file gives no name.
    assert found[program].get("name") == (None if "ros2" in body else "n")
