# SPDX-License-Identifier: Apache-2.0
"""A prefix that is in front of planned frames: frame_prefix beside a rewritten description.

Source: robot_state_publisher src/robot_state_publisher.cpp: frame_prefix is put in front of parent and
child of every transform, as it is, without a separator.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from multibot_rewrite.system.ownership import NameOwnership
from multibot_rewrite.system.records import Robot


def added_prefixes(robot: Robot, names: Iterable[str]) -> dict[str, str]:
    """Of frames that are not planned: those that are a planned one behind a prefix, with the prefix.

    One frame may be another one of its own (``front_laser`` beside ``laser``); robot_state_publisher
    has it in front of both ends of a transform, and of all that it sends.
    """
    found = {name: _prefix(robot, name) for name in names}
    often = Counter(found.values())
    least = min(len(robot.frames), max(2, len(robot.frames) // 2))
    return {
        name: prefix
        for name, prefix in found.items()
        if prefix and often[prefix] >= (2 if prefix.endswith("/") else least)
    }


def robot_behind_prefix(ownership: NameOwnership, name: str) -> str:
    """The robot of whom a frame is but for a prefix: ``foo_left_tool`` of ``left_tool``; else ""."""
    if name in ownership.exact:
        return ""
    ends = (name[at:] for at in range(1, len(name)))
    return next((ownership.exact[it] for it in ends if it in ownership.exact), "")


def _prefix(robot: Robot, name: str) -> str:
    """What is in front of the longest planned frame that the name ends with."""
    ends = [frame for frame in robot.frames if name.endswith(frame) and name != frame]
    return name.removesuffix(max(ends, key=len)) if ends else ""
