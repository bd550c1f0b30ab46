# SPDX-License-Identifier: Apache-2.0
"""Modes of a node, nodes of one name in two packages, and the release that is compared with."""

from __future__ import annotations

from pathlib import Path

import pytest

from tools.interfaces.__main__ import main

Capture = pytest.CaptureFixture[str]


def printed(folder: Path, text: str, capsys: Capture, *more: str) -> list[list[str]]:
    """Return the rows that the command prints for one C++ file."""
    folder.mkdir(exist_ok=True)
    (folder / "a.cpp").write_text(text)
    main([str(folder), *more])
    return [row.split("\t") for row in capsys.readouterr().out.splitlines()]


def test_a_mode_is_a_condition(tmp_path: Path, capsys: Capture) -> None:
    text = """struct AsynchronousSlamToolbox { void f() { create_client<a::srv::B>("c"); } };
      struct LocalizationSlamToolbox { void f() { create_client<a::srv::B>("d"); } };"""
    rows = printed(tmp_path / "slam_toolbox@1", text, capsys)
    assert {(row[6], row[10]) for row in rows[1:]} == {
        ("c", ""),
        ("d", "class LocalizationSlamToolbox"),
    }


def test_a_main_makes_the_class_of_its_package(tmp_path: Path, capsys: Capture) -> None:
    part = 'struct Made { void f() { create_client<a::srv::B>("c"); } };'
    folder = tmp_path / "twist_mux@4"
    (folder / "joy").mkdir(parents=True)
    (folder / "joy/package.xml").write_text("<package/>")
    (folder / "joy/b.cpp").write_text(part)
    text = part + "\nint main() { std::make_shared<Made>(); }"
    rows = printed(folder, text, capsys, "--compare", "jazzy")
    assert [row[0] for row in rows if row[4] == "not in nodes.txt"] == ["twist_mux/Made"]


# ros2_controllers 6.8 has no dynamic_joint_states any more.
@pytest.mark.parametrize(("release", "lacks"), [("jazzy", True), ("lyrical", False)])
def test_the_release_decides(tmp_path: Path, capsys: Capture, release: str, lacks: bool) -> None:
    text = """struct JointStateBroadcaster { void f() {
      create_publisher<sensor_msgs::msg::JointState>("joint_states", 1); } };"""
    folder = tmp_path / "joint_state_broadcaster@1"
    rows = printed(folder, text, capsys, "--compare", release)
    assert any(row[2] == "dynamic_joint_states" for row in rows) is lacks


def test_the_other_case_in_python(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "key_teleop@1").mkdir()
    (tmp_path / "key_teleop@1/k.py").write_text(
        "from a_msgs.msg import B\n"
        "class SimpleKeyTeleop(Node):\n"
        "  def start(self):\n"
        "    if self.good:\n"
        "      pass\n"
        "    else:\n"
        "      self.create_publisher(B, 'key_vel', 1)\n"
    )
    rows = printed(tmp_path / "key_teleop@1", "", capsys)
    assert [row[6:11] for row in rows[1:]] == [
        ["key_vel", "a_msgs/msg/B", "", "", "not (self.good)"]
    ]
