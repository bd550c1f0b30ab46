# SPDX-License-Identifier: Apache-2.0
"""``multibot init`` on a terminal: what it asks, and what the answers make of the fleet file."""

from __future__ import annotations

import os
import pty
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import ROBOTS, ROOT

pytestmark = pytest.mark.slow

ARM = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <link name="$(arg prefix)base"/><link name="$(arg prefix)hand"/>
  <joint name="$(arg prefix)turn" type="continuous">
    <parent link="$(arg prefix)base"/><child link="$(arg prefix)hand"/>
  </joint>
</robot>
"""


def talked(folder: Path, answers: Sequence[str], *words: str) -> tuple[str, Mapping[str, Any]]:
    """Return what a terminal shows, and the fleet file; every answer ends with Enter."""
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "multibot_rewrite", "init", *words]
    environ = {**os.environ, "TERM": "dumb", "COLUMNS": "200"}
    environ.pop("ROS_DISTRO", None)
    with subprocess.Popen(
        command, cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, env=environ
    ) as child:
        os.close(theirs)
        # The terminal keeps the lines until they are asked for.
        os.write(ours, "".join(f"{it}\n" for it in answers).encode())
        shown = "".join(read_all(ours))
        assert child.wait(60) == 0, shown
    return shown, yaml.safe_load((folder / "fleet.yaml").read_text())


def read_all(file: int) -> Sequence[str]:
    """Until the child closes its side."""
    found = []
    while True:
        try:
            data = os.read(file, 65536)
        except OSError:
            data = b""
        if not data:
            os.close(file)
            return found
        found.append(data.decode("utf-8", "replace"))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    shutil.copy(ROOT / "examples" / "multibot_example" / "config" / "rover.rviz", tmp_path)
    return tmp_path


def test_enter_takes_all_defaults(folder: Path) -> None:
    shown, fleet = talked(folder, [""] * 6)
    asked = ("Robots", "ROS release", "Files to leave out", "Metres", "Layout", "Simulator")
    places = [shown.index(it) for it in asked]
    assert places == sorted(places)
    without = subprocess.run(
        [sys.executable, "-m", "multibot_rewrite", "init", "--yes", "-o", "-"],
        cwd=folder, capture_output=True, check=True, timeout=60,
    )  # fmt: skip
    assert yaml.safe_load(without.stdout) == fleet


def test_answers_are_taken_and_wrong_ones_asked_for_again(folder: Path) -> None:
    answers = ["1robot", "scout, carrier", "jazzy", "7", "1", "wide", "3.5", "both", "none"]
    shown, fleet = talked(folder, answers, "rover.urdf")
    assert "'1robot' does not fit" in shown and "'7' does not fit" in shown
    assert "'wide' does not fit" in shown
    assert {it["name"]: it["pose"]["y"] for it in fleet["robots"]} == {"scout": 0.0, "carrier": 3.5}
    assert (fleet["distro"], fleet["layout"], fleet["simulator"]) == ("jazzy", "both", "none")
    assert "related_files" not in fleet


def test_what_options_say_is_not_asked(folder: Path) -> None:
    words = ("--robots", "a,b", "--distro", "jazzy", "--layout", "both", "--simulator", "gazebo")
    shown, fleet = talked(folder, ["", ""], *words)
    assert "Robots" not in shown and "release" not in shown.lower().replace("releases", "")
    assert [it["name"] for it in fleet["robots"]] == ["a", "b"]


def test_an_argument_that_names_the_robot(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf.xacro").write_text(ARM)
    shown, fleet = talked(tmp_path, ["", "", "{robot}/", "", "", ""])
    assert "Argument prefix of the xacro ({robot}_)" in shown
    assert fleet["arguments"] == {"prefix": "{robot}/"}


@pytest.mark.parametrize(("answer", "taken"), [("", []), ("2", ["b.yaml"])])
def test_of_two_files_that_fit_alike_one_is_asked_for(
    answer: str, taken: Sequence[str], folder: Path
) -> None:
    for name in ("a", "b"):
        text = f"amcl: {{ros__parameters: {{base_frame_id: {name}_base}}}}\n"
        (folder / f"{name}.yaml").write_text(text)
    shown, fleet = talked(folder, ["", "", answer, *[""] * 4], "rover.urdf")
    assert "2 files have parameters of amcl, and names that the robot has not" in shown
    assert "1: a.yaml (a_base)" in shown and "The one that is meant [1/2/none] (none)" in shown
    assert fleet["related_files"].get("params", []) == taken


NODES = """\
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    names = ["driver", "lidar"][:{}]
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher")
    return LaunchDescription([publisher, *(Node(package="own", executable=it) for it in names)])
"""


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("answer", "taken"), [("", "two.launch.py"), ("2", "one.launch.py"), ("none", None)]
)
def test_of_several_launch_files_that_start_it_one_is_asked_for(
    answer: str, taken: str | None, folder: Path
) -> None:
    for at, name in enumerate(("one", "two"), 1):
        (folder / f"{name}.launch.py").write_text(NODES.format(at))
    answers = ["", "", answer, *[""] * 4]
    shown, fleet = talked(folder, answers, "--simulator", "none", "rover.urdf")
    assert "1: two.launch.py" in shown and "2: one.launch.py" in shown
    assert "Launch file that starts the robot [1/2/none] (1)" in shown
    assert fleet.get("launch") == taken


WARNED = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="pi" value="3"/>
  <link name="base"/><link name="hand"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/></joint>
</robot>
"""


@pytest.mark.sample(3)
@pytest.mark.parametrize(("on_a_terminal", "term"), [(True, "xterm"), (True, "dumb"), (False, "")])
def test_what_is_looked_at_is_shown_on_a_terminal(
    on_a_terminal: bool, term: str, tmp_path: Path
) -> None:
    """What xacro warns about is shown nowhere: of the files that are taken the build says it."""
    (tmp_path / "arm.urdf.xacro").write_text(WARNED)
    command = [sys.executable, "-m", "multibot_rewrite", "init", ".", "--yes"]
    ours, theirs = pty.openpty() if on_a_terminal else os.pipe()
    with subprocess.Popen(
        command, cwd=tmp_path, stderr=theirs, env={**os.environ, "TERM": term, "COLUMNS": "200"}
    ) as child:
        os.close(theirs)
        shown = "".join(read_all(ours))
        assert child.wait(60) == 0, shown
    assert ("1 of 1 descriptions: arm.urdf.xacro" in shown) == (term == "xterm")
    assert "redefining" not in shown
    last = shown.rpartition("\r\033[K")[2]
    assert last.splitlines()[-1].startswith("multibot: wrote fleet.yaml: 2 robots")
