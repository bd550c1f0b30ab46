# SPDX-License-Identifier: Apache-2.0
"""What a launch file reads, and the arguments that it declares and gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.commands import xacro_of
from multibot_rewrite.producers.launch.records import FileRead, LaunchArgument, LaunchOrder

XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="a" default=""/>'
    '<xacro:include filename="part.xacro"/><link name="$(arg a)l"/></robot>'
)
LAUNCH = """\
import os, subprocess, xacro, yaml
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
HERE = os.path.dirname(__file__)
def generate_launch_description():
    path = os.path.join(HERE, 'r.xacro')
    text = {}
    return LaunchDescription([
        DeclareLaunchArgument('sim', default_value='false'),
        DeclareLaunchArgument('mode', default_value=['re', 'al'], choices=['real', 'gz']),
        DeclareLaunchArgument('other', default_value=LaunchConfiguration('sim')),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{{'robot_description': text}}]),
    ])
"""
READS = [
    ("Command(['xacro ', path, ' a:=1'])", [("r.xacro", (("a", "1"),))]),
    ("subprocess.check_output(['xacro', path, 'a:=1'], text=True)", [("r.xacro", (("a", "1"),))]),
    ("xacro.process_file(path, mappings={'a': '1'}).toxml()", [("r.xacro", (("a", "1"),))]),
    ("xacro.process_file(path).toxml()", [("r.xacro", ())]),
    ("(lambda it: os.chdir(HERE) or xacro.process_doc(it, {'a': '1'}) or it.toxml())"
     "(xacro.parse(open(path)))",
     [("r.xacro", (("a", "1"),))]),
    ("open(os.path.join(HERE, 'r.urdf')).read()", [("r.urdf", ())]),
    ("str(yaml.safe_load(open(os.path.join(HERE, 'r.yaml'))))", [("r.yaml", ())]),
    ("open(os.path.join(HERE, 'r.srdf')).read()", [("r.srdf", ())]),
    ("open(os.path.join(HERE, 'r.txt')).read()", []),
    ("'<robot/>'", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "read"), READS)
def test_the_files_that_a_launch_file_reads(
    text: str, read: list[tuple[str, tuple[tuple[str, str], ...]]], tmp_path: Path
) -> None:
    """A part that a xacro includes is not read by the launch file."""
    for name in ("r.xacro", "r.urdf", "r.yaml", "r.srdf", "r.txt", "part.xacro"):
        (tmp_path / name).write_text(XACRO if name == "r.xacro" else "<robot/>")
    file = tmp_path / "up.launch.py"
    file.write_text(LAUNCH.format(text))
    graph = launch_graph(LaunchOrder(str(file)))
    own = [it for it in graph.read if it.file.startswith(str(tmp_path))]
    assert own == [FileRead(str(tmp_path / name), given) for name, given in read]
    assert graph.declared == (
        LaunchArgument("sim", "false", ()),
        LaunchArgument("mode", "real", ("real", "gz")),
        LaunchArgument("other", "", ()),
    )


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("xacro a.xacro", FileRead("a.xacro")),
        ("/opt/bin/xacro -v 'a b.xacro' x:=1 y:=", FileRead("a b.xacro", (("x", "1"), ("y", "")))),
        ("xacro a.xacro b.xacro", None), ("cat a.xacro", None), ("", None), ("xacro 'a", None),
    ],
)  # fmt: skip
def test_a_line_that_expands_a_xacro(line: str, found: FileRead | None) -> None:
    assert xacro_of(line) == found
