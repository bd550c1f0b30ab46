# SPDX-License-Identifier: Apache-2.0
"""The words of ``$(multibot WORD NAME)``: one function for each value of a robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.knowledge.yaml_with_lines import unknown

# Words whose values are numbers.
NUMBERS = frozenset({"pose"})


def _pose(robot: LoadedRobot, axis: str) -> str:
    values = (robot.pose or Pose())._asdict()
    if axis not in values:
        raise UsageError(f"$(multibot pose {axis}): {unknown('axis', axis, values)}")
    return str(values[axis])


WORDS: Mapping[str, Callable[[LoadedRobot, str], str]] = MappingProxyType(
    {
        "name": lambda robot, _: robot.name,
        "namespace": lambda robot, _: robot.namespace,
        "model": lambda robot, _: robot.model,
        "pose": _pose,
        "description": lambda robot, _: robot.description,
        "srdf": lambda robot, _: robot.srdf,
        "frame": LoadedRobot.frame,
        "link": LoadedRobot.link,
        "joint": LoadedRobot.joint,
        "topic": LoadedRobot.topic,
        "node": lambda robot, name: robot.table.full_name(name),
    }
)
