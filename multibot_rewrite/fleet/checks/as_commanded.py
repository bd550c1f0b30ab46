# SPDX-License-Identifier: Apache-2.0
"""What a fleet is to start and the lines of ``commands.md`` for it -> where they differ.

The lines are read as a shell and rcl read them. A controller that the launch file leaves out has its
line all the same, and so have programs that only a person starts.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.fleet.checks.as_printed import differences
from multibot_rewrite.fleet.launch.starts import FleetStarts, RobotStarts
from multibot_rewrite.producers.launch.performed import Action
from multibot_rewrite.producers.launch.ros_arguments import ros2_run, ros_arguments
from multibot_rewrite.spelling.start import File, Start, keywords, path_of
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


def not_as_commanded(starts: FleetStarts, text: str) -> list[str]:
    """Return in words what the lines of ``commands.md`` and the planned processes do not share."""
    above, *sections = ([*_commands(section)] for section in _SECTION.split(text))
    both = zip(starts.robots, sections, strict=False)
    opened = [it for section in (above, *sections) for it in section if it[:2] == _RVIZ]
    found = (it for robot, section in both for it in _of_robot(robot, section))
    return [*found, *_apart(starts.shown, opened)]


def _of_robot(robot: RobotStarts, printed: Sequence[Start]) -> Iterator[str]:
    planned = [it for it in robot.starts if it.full_name not in robot.nodes]
    left = {name for name, _ in robot.left}
    for program in _TOLD:
        wanted = [it for it in planned if it[:2] == program]
        given = [it for it in printed if it[:2] == program and not left & {*it.arguments}]
        yield from (f"{robot.name}: {it}" for it in _apart(wanted, given))


def _apart(planned: Iterable[Start], printed: Iterable[Start]) -> Iterator[str]:
    wanted, given = (
        [Action("Node", keywords(it)) for it in starts]
        for starts in (map(_as_commanded, planned), printed)
    )
    yield from (it.message for it in differences(wanted, given))


def _as_commanded(it: Start) -> Start:
    """Return a planned process as its line has it: values that are no texts are no words of it."""
    rows = [row for row in it.parameters if isinstance(row, Mapping)]
    values = {name: one for row in rows for name, one in row.items() if isinstance(one, str)}
    names = {"__node": it.name, **dict(it.remappings)}
    return it._replace(
        namespace="" if it.namespace == "/" else it.namespace,
        name=names["__node"],
        parameters=(*(one for one in it.parameters if isinstance(one, File)), values),
        remappings=tuple(pair for pair in it.remappings if not pair[0].startswith("__")),
        arguments=tuple(map(path_of, it.arguments)),
    )


def _commands(text: str) -> Iterator[Start]:
    """Yield the processes of the lines; one under a condition is for a person to judge."""
    for line in text.splitlines():
        words = [] if line.startswith("#") or "  # " in line else _split(line)
        while words and "=" in words[0]:
            del words[0]
        run = (*_RVIZ, tuple(words[1:])) if words[:1] == ["rviz2"] else ros2_run(words)
        if run:
            package, executable, given = *run[:2], ros_arguments(run[2])
            values = {name: one for name, one in given.values if name != SIM_TIME}
            names, files = (given.namespace, given.name), map(File, given.files)
            yield Start(package, executable, *names, (*files, values), given.rules, given.own)


def _split(line: str) -> list[str]:
    try:
        return shlex.split(line)
    except ValueError:
        return []
