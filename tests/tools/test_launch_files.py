# SPDX-License-Identifier: Apache-2.0
"""Nodes of launch files in Python, XML and YAML; the files are written here."""

from __future__ import annotations

import pytest
from paths import fixture_text

from tools.interfaces.launch_files import LaunchedNode, launched_nodes

PYTHON = fixture_text("launch_files_python.txt")


def test_a_launch_file_in_python() -> None:
    found = {it.line: it for it in launched_nodes("a.launch.py", PYTHON)}
    tf = "/tf:=tf /tf_static:=tf_static"
    assert sorted(found) == [5, 6, 8, 12, 14]
    assert found[5] == LaunchedNode(
        "node", "nav", "server", "", "", f"{tf} cmd_vel:=cmd_vel_nav", 5
    )
    assert found[6][:5] == ("lifecycle_node", "nav", "server", "planner", "$(var namespace)")
    assert found[8][3:5] == ("$(var namespace)_box", "")
    assert found[12][:6] == ("component", "nav", "nav::Server", "smoother", "", tf)
    assert found[14][2:6] == ("<...>", "<...>", "", "<...>")


def test_a_launch_file_is_never_run() -> None:
    assert (
        launched_nodes("a.py", "raise SystemExit\nNode(package='a', executable='b')")[0].line == 2
    )


XML = fixture_text("launch_files_xml.xml")


def test_a_launch_file_in_xml() -> None:
    assert launched_nodes("a.launch.xml", XML) == (
        LaunchedNode("node", "joy", "joy_node", "joy", "$(var ns)", "joy:=pad /tf:=tf", 4),
        LaunchedNode("container", "rclcpp_components", "component_container", "box", "", "", 9),
        LaunchedNode("component", "nav", "nav::Server", "planner", "", "", 10),
    )


YAML = fixture_text("launch_files_yaml.yaml")


def test_a_launch_file_in_yaml() -> None:
    assert [it[:6] for it in launched_nodes("a.launch.yaml", YAML)] == [
        ("node", "joy", "joy_node", "joy", "", "joy:=pad"),
        ("container", "rclcpp_components", "component_container", "box", "", ""),
        ("component", "nav", "nav::Server", "planner", "", ""),
    ]


@pytest.mark.parametrize(
    ("file", "text"), [("a.py", "def ("), ("a.xml", "<launch>"), ("a.yaml", "a: [")]
)
def test_a_file_that_cannot_be_read_has_no_nodes(file: str, text: str) -> None:
    assert launched_nodes(file, text) == ()
