# SPDX-License-Identifier: Apache-2.0
"""Substitutions about a robot, known when the launch file runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.robots.loaded_robot import LoadedRobot
from multibot_rewrite.knowledge.yaml_with_lines import unknown
from multibot_rewrite.launch.context import (
    Context,
    RobotRef,
    Substitution,
    Text,
    file_of,
    perform,
    robot_of,
)
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros

FILE = "file"
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


def description(robot: Text = None, fleet: Text = None) -> Substitution:
    """Return a robot's description: ``parameters=[{"robot_description": description()}]``."""
    return value("description", robot=robot, fleet=fleet)


def params_file(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's parameter file, rewritten: an item of ``parameters=[...]``."""
    return value(FILE, file, robot, fleet)


def rviz_config(file: Text, robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's RViz config, or of the one that shows all."""
    return value(FILE, file, robot, fleet)


def bridge_config(robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the path of a robot's ros_gz_bridge file, or of the one for all robots."""
    return value(FILE, BRIDGE_FILE, robot, fleet)


def value(word: Text, name: Text = "", robot: Text = None, fleet: Text = None) -> Substitution:
    """Return the substitution ``$(multibot WORD NAME)``: one of ``WORDS``, or the path of a file.
    As the value of a parameter it is a string whatever is in it, and a number for ``pose``:
    launch_ros reads other substitutions as YAML, refuses a description with ``: `` in a comment,
    and takes a robot called ``on`` for true."""
    return substitution_class()([word, name], RobotRef(robot, fleet))


@cache
def substitution_class() -> Any:
    """Return the class of the substitutions of this package; each is a ParameterValue, too."""
    substitution: Any = of_launch().Substitution
    parameter_value: Any = of_launch_ros("parameter_descriptions").ParameterValue

    class Multibot(substitution, parameter_value):  # type: ignore[misc]
        """A value about a robot, known when the launch file runs."""

        def __init__(self, words: Sequence[Text], of: RobotRef) -> None:
            parameter_value.__init__(self, "", value_type=str)
            self.words, self.of = words, of

        def perform(self, context: Context) -> str:
            return _value_of(context, [perform(context, it) for it in self.words], self.of)

        def evaluate(self, context: Context) -> str | float:
            text = self.perform(context)
            return float(text) if perform(context, self.words[0]) in NUMBERS else text

    return Multibot


def as_value(value: Any) -> Any:
    """Return a parameter's value in an XML or YAML file; a substitution of this package as it is."""
    untyped = getattr(value, "value_type", str) is None
    parts: Any = value.value if untyped else ()
    alone = isinstance(parts, list) and len(parts) == 1
    return parts[0] if alone and isinstance(parts[0], substitution_class()) else value


def _value_of(context: Context, words: Sequence[str], of: RobotRef) -> str:
    options = [it for it in words if it.partition(":=")[0] in RobotRef._fields and ":=" in it]
    of = of._replace(**dict(it.split(":=", 1) for it in options))
    word, name = (*(it for it in words if it not in options), "", "")[:2]
    if word == FILE:
        return file_of(context, name, of)
    if word not in WORDS:
        raise UsageError(f"$(multibot {word}): {unknown('word', word, (*WORDS, FILE))}")
    return WORDS[word](robot_of(context, of), name)
