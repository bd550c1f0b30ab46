# SPDX-License-Identifier: Apache-2.0
"""What a fleet is to start and the lines of ``commands.md`` for it -> where they differ.

The lines are read as a shell and rcl read them. A controller that the launch file leaves out has its
line all the same, and so have programs that only a person starts.
"""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.launch.starts import File, FleetStarts, RobotStarts, Start
from multibot_rewrite.producers.launch.ros_arguments import ros2_run, ros_arguments
from multibot_rewrite.system.records import SIM_TIME

# The programs of which each process has its line, unless it is a node of a stack.
_TOLD = (
    ("tf2_ros", "static_transform_publisher"),
    ("controller_manager", "spawner"),
    ("ros_gz_sim", "create"),
    ("gazebo_ros", "spawn_entity.py"),
    ("topic_tools", "relay"),
    ("tf_namespace_bridge", "tf_namespace_bridge"),
)
_RVIZ = ("rviz2", "rviz2")
_SECTION = re.compile(r"(?m)^## .*$")


class Command(NamedTuple):
    """A process as a line starts it: its program and own words, and what rcl is given."""

    program: tuple[str, str]
    words: tuple[str, ...]
    namespace: str
    name: str
    rules: tuple[tuple[str, str], ...]
    values: tuple[tuple[str, str], ...]
    files: tuple[str, ...]

    def __str__(self) -> str:
        """The line, for people."""
        given = (*self.rules, *self.values, ("__ns", self.namespace), ("__node", self.name))
        words = [*self.program, *self.words, *(f"{old}:={new}" for old, new in given if new)]
        return shlex.join([*words, *self.files])


def not_as_commanded(starts: FleetStarts, text: str) -> list[str]:
    """Return in words what the lines of ``commands.md`` and the planned processes do not share."""
    above, *sections = ([*_commands(section)] for section in _SECTION.split(text))
    found: list[str] = []
    for robot, section in zip(starts.robots, sections, strict=False):
        found += _of_robot(robot, section)
    opened = [it for section in (above, *sections) for it in section if it.program == _RVIZ]
    return [*found, *_apart(map(_planned, starts.shown), opened)]


def _of_robot(robot: RobotStarts, printed: Sequence[Command]) -> Iterator[str]:
    every = (*robot.starts, *robot.bridged_tf, *robot.spawned)
    planned = [_planned(it) for it in every if it.full_name not in robot.nodes]
    left = {name for name, _ in robot.left}
    for program in _TOLD:
        wanted = [it for it in planned if it.program == program]
        given = [it for it in printed if it.program == program and not left & {*it.words}]
        yield from (f"{robot.name}: {it}" for it in _apart(wanted, given))


def _apart(planned: Iterable[Command], printed: Iterable[Command]) -> Iterator[str]:
    wanted, given = Counter(planned), Counter(printed)
    yield from (f"`{it}` is planned, and no line starts it" for it in wanted - given)
    yield from (f"`{it}` is a line, and not planned" for it in given - wanted)


def _planned(it: Start) -> Command:
    """Return a planned process. Its description, and other values that are no texts, are no words of a
    line."""
    pairs = (pair for one in it.parameters if isinstance(one, Mapping) for pair in one.items())
    values = tuple((key, one) for key, one in pairs if isinstance(one, str))
    files = tuple(one.path for one in it.parameters if isinstance(one, File))
    words = tuple(one.path if isinstance(one, File) else one for one in it.arguments)
    names = {"__node": it.name, **dict(it.remappings)}
    rules = tuple(pair for pair in it.remappings if not pair[0].startswith("__"))
    space = "" if it.namespace == "/" else it.namespace
    return Command((it.package, it.executable), words, space, names["__node"], rules, values, files)


def _commands(text: str) -> Iterator[Command]:
    """Yield the processes of the lines; one under a condition is for a person to judge."""
    for line in text.splitlines():
        words = [] if line.startswith("#") or "  # " in line else _split(line)
        while words and "=" in words[0]:
            del words[0]
        run = (*_RVIZ, tuple(words[1:])) if words[:1] == ["rviz2"] else ros2_run(words)
        if run:
            given = ros_arguments(run[2])
            values = tuple(it for it in given.values if it[0] != SIM_TIME)
            names = given.namespace, given.name
            yield Command(run[:2], given.own, *names, given.rules, values, given.files)


def _split(line: str) -> list[str]:
    try:
        return shlex.split(line)
    except ValueError:
        return []
