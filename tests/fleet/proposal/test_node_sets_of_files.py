# SPDX-License-Identifier: Apache-2.0
"""Which node sets files say, and which of several files goes with a description; by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.proposal import related_files
from multibot_rewrite.proposal.looking import Looked

STATE = ("robot_state", "joint_state_publisher sends the joints until a driver does")


@pytest.mark.parametrize(
    ("simulator", "control", "manager", "found"),
    [
        ("none", True, False, [("ros2_control", "the description has <ros2_control>")]),
        ("gz", True, True,
         [("gz_ros2_control", "the description has <ros2_control> and c.yaml has controllers")]),
        ("classic", True, False, [("gazebo_ros2_control", "the description has <ros2_control>")]),
        ("gz", False, True, []), ("none", False, False, [STATE]),
    ],
)  # fmt: skip
def test_the_node_sets_that_a_description_says(
    simulator: str, control: bool, manager: bool, found: list[tuple[str, str]]
) -> None:
    robot = Looked("r.urdf", simulator=simulator, control=control)
    nodes = {"controller_manager": "p/c.yaml"} if manager else {}
    assert list(related_files._node_sets(robot, nodes, "")) == found
    moveit = ("moveit", "there is r.srdf")
    assert list(related_files._node_sets(robot, nodes, "p/r.srdf")) == [*found, moveit]


def test_the_nearest_file_is_the_first(here: Path) -> None:
    """What the description loads, what is of its package, what is called like it and less otherwise;
    then by name."""
    for package in ("own", "zzz"):
        (here / package).mkdir()
        (here / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
    inside = "<parameters> zzz/loaded.yaml </parameters><parameters/>"
    root = etree.fromstring(f"<robot>{inside}</robot>")
    wanted = [
        "zzz/loaded.yaml", "own/rover.yaml", "own/named.yaml", "own/a_b_c.yaml",
        "zzz/rover.yaml", "zzz/a.yaml", "zzz/b.yaml", "zzz/named.yaml", "zzz/a_more_words.yaml",
    ]  # fmt: skip
    robot = Looked("own/rover.urdf", root=root)
    assert related_files._nearest_first(robot, sorted(wanted, reverse=True)) == wanted
    bare = related_files._nearest_first(Looked("own/rover.urdf"), sorted(wanted))
    assert bare[:3] == ["own/rover.yaml", "own/named.yaml", "own/a_b_c.yaml"]
