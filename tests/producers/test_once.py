# SPDX-License-Identifier: Apache-2.0
"""What of a launch file runs once for all robots, and how a fleet file says otherwise."""

from __future__ import annotations

from pathlib import Path

import pytest
from rule_examples import DESCRIPTION

from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.launch.performed import Launching, performed
from multibot_rewrite.producers.launch.programs import once_for_all
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.system.records import NOWHERE

LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='nav2_map_server', executable='map_server', name='map_server',
             parameters=[{'yaml_filename': 'MAP'}]),
        Node(package='nav2_amcl', executable='amcl', name='amcl'),
        Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', name='manager',
             parameters=[{'autostart': True, 'node_names': ['map_server', 'amcl']}]),
        Node(package='rosbridge_server', executable='rosbridge_websocket'),
        Node(package='seer', executable='seer_node', name='eyes'),
    ])
"""
FLEET = """\
layout: both
distro: jazzy
simulator: none
{more}
robots:
  - {{name: robot1, description: robot.urdf, launch: up1.launch.py}}
  - {{name: robot2, description: robot.urdf, launch: up{second}.launch.py}}
"""


@pytest.mark.parametrize(
    ("program", "word"),
    [
        ("ros_gz_sim/gzserver", "simulator"),
        ("/gz", "simulator"),
        ("/usr/bin/gzserver", "simulator"),
        ("nav2_map_server/map_server", "map"),
        ("rviz2/rviz2", "shows"),
        ("rqt_gui/rqt_gui", "shows"),
        ("foxglove_bridge/foxglove_bridge", "shows"),
        ("web_video_server/web_video_server", "person"),
        ("/ros2 bag record -a", "person"),
        # Of these each robot has its own.
        ("ros_gz_sim/create", ""),
        ("controller_manager/spawner", ""),
        ("micro_ros_agent/micro_ros_agent", ""),
        ("/MicroXRCEAgent", ""),
        ("/ros2 topic pub", ""),
        ("nav2_amcl/amcl", ""),
        ("acme_bringup/rviz_pose_check.py", ""),
        ("tf2_ros/static_transform_publisher", ""),
        ("joint_state_publisher_gui/joint_state_publisher_gui", ""),
        ("usb_cam/usb_cam_node_exe", ""),
        ("robot_state_publisher/robot_state_publisher", ""),
        ("teleop_twist_joy/teleop_node", ""),
    ],
)
def test_what_runs_once_for_all_robots(program: str, word: str) -> None:
    command, *words = program.split()
    package, _, executable = ("", "", command) if command[0] == "/" else command.partition("/")
    executable = executable.removeprefix("/") if executable.count("/") == 1 else executable
    node = LaunchedNode(package, executable, "", "/", (), (), "", tuple(words), "", NOWHERE)
    why = once_for_all(node)
    assert bool(why) == bool(word)
    assert word in why


def started(folder: Path, more: str = "", second: int = 1) -> list[str]:
    """Return the programs and namespaces that a build starts."""
    (folder / "robot.urdf").write_text(DESCRIPTION)
    for number in (1, 2):
        (folder / f"up{number}.launch.py").write_text(LAUNCH.replace("MAP", f"m{number}.yaml"))
    (folder / "fleet.yaml").write_text(FLEET.format(more=more, second=second))
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    (done,) = performed(str(folder / "out/fleet.launch.py"), [Launching({})])
    values = [it.values for it in done.actions if "executable" in it.values]
    return sorted(f"{it.get('namespace', '')} {it['executable']}" for it in values)


@pytest.mark.parametrize("second", [1, 2])
def test_each_robot_may_have_its_own(tmp_path: Path, second: int) -> None:
    """The fleet file says so, or the robots have other maps."""
    more = "own_nodes: [map_server]" if second == 1 else ""
    found = started(tmp_path, more, second)
    assert [it for it in found if "map_server" in it] == [
        "/robot1 map_server",
        "/robot2 map_server",
    ]


def test_an_unknown_name_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises((AssertionError, InputError)):
        started(tmp_path, "own_nodes: [map_servr]")
    assert "own_nodes: no robot has a node 'map_servr'" in capsys.readouterr().err
