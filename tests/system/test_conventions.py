# SPDX-License-Identifier: Apache-2.0
"""What is everybody's stands in one table, and every command goes by it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest
from parsed import sources

from multibot_rewrite.base.conventions import (
    EVERYBODYS,
    FRAMES,
    TOOLS,
    TOPICS,
    chooses,
    is_from_outside,
    is_tool_word,
    only_looks,
    team,
    tool_patterns,
)
from multibot_rewrite.base.naming import affix, make_naming

FRAME_WORDS = {it.name for it in FRAMES}


def lists() -> Iterator[tuple[str, set[str]]]:
    """Every literal list, tuple or set of the package that holds nothing but texts, with its place."""
    for path, tree in sources().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Tuple | ast.List | ast.Set) and len(node.elts) > 1:
                words = [it.value for it in node.elts if isinstance(it, ast.Constant)]
                if len(words) == len(node.elts) and all(isinstance(it, str) for it in words):
                    yield f"{path}:{node.lineno}", {str(it) for it in words}


@pytest.mark.slow
def test_no_other_list_of_frames_or_of_shared_topics() -> None:
    found = [at for at, words in lists() if words <= FRAME_WORDS or words <= {*EVERYBODYS}]
    assert found == []


def test_every_row_has_its_source() -> None:
    assert all(it.source for rows in (TOPICS, FRAMES, TOOLS) for it in rows)


@pytest.mark.parametrize("frame", ["map", "world", "earth", "/earth", "utm"])
def test_a_frame_of_the_world_is_no_robots(frame: str) -> None:
    assert affix(make_naming("frames-per-robot"), "frame", frame) is None


@pytest.mark.parametrize("frame", ["odom", "odom_combined", "base_link", "local_enu"])
def test_a_frame_of_a_robot_gets_its_name(frame: str) -> None:
    assert affix(make_naming("frames-per-robot"), "frame", frame) is not None


def test_one_who_looks_is_a_tool() -> None:
    looking = [it.pattern.replace("*", "x") for it in TOOLS if it.looks]
    assert [it for it in looking if not (is_tool_word(it) and only_looks(it))] == []


@pytest.mark.parametrize(
    ("node", "tool", "looks"),
    [
        ("rviz2", True, True),
        ("rqt", True, True),
        ("_ros2cli_daemon_0_1f", True, True),
        ("_hidden", True, False),
        # It sends what a robot sends.
        ("rosbag2_player", True, False),
        ("rosbag2_recorder", True, True),
        ("teleop_twist_joy", True, False),
        ("amcl", False, False),
    ],
)
def test_tools(node: str, tool: bool, looks: bool) -> None:
    assert (is_tool_word(node), only_looks(node)) == (tool, looks)


def test_a_pattern_inside_another_is_not_said_twice() -> None:
    assert "rosbag2_*" in tool_patterns()
    assert "rosbag2_recorder*" not in tool_patterns()
    assert "_ros2cli_*" not in tool_patterns()


def test_who_takes_turns_is_one_sender() -> None:
    assert team("/robot1/behavior_server") == team("/velocity_smoother_robot1")
    assert team("/robot1/move_group") != team("/robot1/behavior_server")
    assert team("/robot1/driver") == "/robot1/driver"
    assert chooses("/robot1/twist_mux")
    assert not chooses("/mux/driver")


@pytest.mark.parametrize(("name", "outside"), [("/robot1/cmd_vel", True), ("/joy/scan", False)])
def test_what_a_person_sends(name: str, outside: bool) -> None:
    assert is_from_outside(name) is outside
