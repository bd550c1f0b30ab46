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
    is_tool_word,
    only_looks,
    tool_patterns,
)

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
