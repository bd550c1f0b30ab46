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
    """What the launch file of a build gives each program or class of the last robot, and of all."""
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
    """The parameters that are in no file."""
    return {
        key: one for row in it["parameters"] if isinstance(row, dict) for key, one in row.items()
    }


def test_a_node_is_started_as_its_launch_file_does(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    it = started(
        tmp_path,
        """Node(
            package='seer', executable='seer_node', name='eyes', namespace=NS,
            arguments=['--fast', NS], remappings=[('scan', 'front')],
            additional_env={'CUDA': '0', 'WHO': NS},
            parameters=[{
                'rate': 5, 'gain': 0.5, 'words': ['a', 'b'], 'deep': {'on': True}, 'text': '7',
                'model': '/opt/seer/m.onnx', 'topic': ['/', NS, '/scan'], 'use_sim_time': True,
            }],
        )""",
    )["seer_node"]
    assert (it["package"], it["name"], it["namespace"]) == ("seer", "eyes", "/robot2")
    assert values(it) == {
        **{"rate": 5, "gain": 0.5, "words": ["a", "b"], "deep.on": True, "text": "7"},
        **{"model": "/opt/seer/m.onnx", "topic": "/robot2/scan", "use_sim_time": False},
    }
    assert it["arguments"] == ["--fast", "robot2"]
    assert it["additional_env"] == {"CUDA": "0", "WHO": "robot2"}
    # Its transforms are its robot's, if it sends or reads any.
    assert it["remappings"] == [["scan", "front"], ["/tf", "tf"], ["/tf_static", "tf_static"]]
    (line,) = [it for it in capsys.readouterr().err.splitlines() if "MF822" in it]
    assert "build hands on rate, gain, words and 8 more" in line


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


def test_a_later_file_counts_and_is_rewritten(tmp_path: Path) -> None:
    own = "[{'rate': 5, 'gain': 2}, 'FOLDER/eyes.yaml', {'gain': 4}]".replace(
        "FOLDER", str(tmp_path)
    )
    text = "eyes:\n  ros__parameters: {rate: 7, gain: 3}\n"
    body = f"Node(package='seer', executable='seer_node', name='eyes', parameters={own})"
    it = started(tmp_path, body, eyes=text)["seer_node"]
    assert values(it) == {"gain": 4, "use_sim_time": False}
    assert str(tmp_path / "out/robot2/eyes.yaml") in it["parameters"]


def test_a_description_is_that_of_the_robot(tmp_path: Path) -> None:
    own = f"{{'robot_description': open('{tmp_path}/robot.urdf').read()}}"
    it = started(tmp_path, f"Node(package='seer', executable='seer_node', parameters=[{own}])")
    told = values(it["seer_node"])["robot_description"]
    assert "robot2" in str(told) and "robot2" not in DESCRIPTION


def test_a_node_of_all_robots_keeps_it(tmp_path: Path) -> None:
    body = "Node(package='seer', executable='seer_node', name='eyes', parameters=[{'rate': 5}])"
    it = started(tmp_path, body, "shared_nodes: [eyes]")["seer_node"]
    assert (it.get("namespace", "/"), values(it)["rate"]) == ("/", 5)


def test_two_nodes_without_a_name_are_told_apart(tmp_path: Path) -> None:
    """In a layout without namespaces both would have the name of their code."""
    body = "Node(package='seer', executable='seer_node')"
    assert started(tmp_path, body, layout="postfix")["seer_node"]["name"] == "seer_node_robot2"


def test_a_section_of_a_node_that_nobody_starts_is_told_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Not what is for every node, a known node, or one that the launch file starts."""
    rows = ("/**", "amcl", "eyes", "lonely", "/*/other")
    text = "".join(f"{it}:\n  ros__parameters: {{gain: 1.0}}\n" for it in rows)
    body = "Node(package='seer', executable='seer_node', name='eyes')"
    started(tmp_path, body, "companions: {params: own.yaml}", own=text)
    told = [it for it in capsys.readouterr().err.splitlines() if "MF858" in it]
    assert [it.removeprefix(f"{tmp_path}/").partition(";")[0] for it in told] == [
        "own.yaml:7:1: note: MF858 no launch file and no node set starts lonely, other"
    ]


@pytest.mark.parametrize("ends", ["", "publishes: {seen: std_msgs/msg/String},"])
def test_a_node_that_only_the_user_describes_keeps_it(
    ends: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A value that holds a name has that of the robot."""
    rows = f"programs: [seer_node], {ends} params: {{base: {{kind: frame}}}}"
    described = f"nodes: {{eyes: {{package: seer, {rows}}}}}"
    own = "{'rate': 5, 'base': 'base_link'}"
    body = f"Node(package='seer', executable='seer_node', name='eyes', parameters=[{own}])"
    it = started(tmp_path, body, "nodes: own.yaml", own=described)["seer_node"]
    assert values(it) == {"rate": 5, "base": "base_link/robot2", "use_sim_time": False}
    assert "MF824" not in capsys.readouterr().err


def test_what_a_person_starts_may_be_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The plan says so, since what is built starts no window and no keyboard."""
    body = """Node(package='rviz2', executable='rviz2'),
        Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', namespace=NS)"""
    programs = started(tmp_path, body)
    assert not {"rviz2", "teleop_twist_keyboard"} & programs.keys()
    built = tmp_path / "out"
    assert main(["check-launch", f"{built}/fleet.launch.py", "--plan", f"{built}/plan.yaml"]) == 0
    assert ": as planned" in capsys.readouterr().err
