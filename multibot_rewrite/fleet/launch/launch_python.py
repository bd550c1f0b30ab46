# SPDX-License-Identifier: Apache-2.0
"""What a fleet starts -> ``fleet.launch.py``: plain launch and launch_ros, to be read and edited."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from textwrap import wrap

from multibot_rewrite.fleet.launch.each_robot import Function, functions
from multibot_rewrite.fleet.launch.python_actions import OF_ALL, actions, comment, lines, value
from multibot_rewrite.fleet.launch.starts import FleetStarts, RobotStarts, launch_arguments
from multibot_rewrite.planning.start import in_order

# What ament_flake8 allows, and robots of which each has its line to drive.
WIDTH, _DRIVING = 99, 4
_STARTED = "[action for name in words or ROBOTS for action in ROBOTS[name]()]"
_STARTED_APART = "[in_domain(name, ROBOTS[name]()) for name in words or ROBOTS]"


def to_python(it: FleetStarts) -> str:
    """Return the text of a fleet's launch file."""
    body = _joined_lines(_fixed_part("file and text"), *_file_parts(it))
    return _joined_lines(_docstring_lines(it), _import_lines(body)) + body


@cache
def _fixed_part(name: str) -> tuple[str, ...]:
    """Return the lines of a part that is the same in all launch files."""
    text = files("multibot_rewrite.fleet.launch").joinpath("parts.txt").read_text(encoding="utf-8")
    return tuple(text.partition(f"### {name}\n")[2].partition("\n### ")[0].splitlines())


def _joined_lines(*parts: Iterable[str]) -> str:
    return "".join(f"{line}\n" for part in parts for line in part)


def _file_parts(it: FleetStarts) -> Iterator[Iterable[str]]:
    """Yield the functions and tables of the launch file, each as its lines."""
    if any(start.needs for start in it.every):
        yield "", "", *_fixed_part("if_installed")
    if any(start.brought_up for start in it.every):
        yield "", "", *_fixed_part("brought_up")
    if it.values:
        yield "", "", *_fixed_part("one_of")
    if any(led.followers for robot in it.robots for led in in_order(robot.starts)):
        yield "", "", *_fixed_part("then")
    made = functions(it.robots)
    for own in made:
        yield ("", "", *_function_lines(own))
    calls = {name: own for own in made for name in own.calls}
    names = (row for robot in it.robots for row in _call_lines(calls[robot.name], robot.name))
    yield "", "", "ROBOTS = {", *names, "}"
    if it.domains:
        # As an environment has them.
        numbers = ((one.name, f"{it.domains[one.name]}") for one in it.robots)
        domains = (f"    {value(name)}: {value(number)}," for name, number in numbers)
        yield "DOMAINS = {", *domains, "}", "", "", *_fixed_part("in_domain")
    started = _STARTED_APART if it.domains else _STARTED
    yield "", "", *(line.replace("{started}", started) for line in _fixed_part("chosen"))
    yield from (("", "", *_fixed_part(f"{one} switches")) for one in it.simulators)
    yield "", "", *_description_function(it)


def _docstring_lines(it: FleetStarts) -> Iterator[str]:
    # ament_pep257 wants the text of several lines to begin on the second (D213).
    yield from ('"""', it.head, "")
    yield "Plain launch and launch_ros: read it, edit it, or include it from another launch file."
    yield ""
    yield "    ros2 launch fleet.launch.py"
    yield f"    ros2 launch fleet.launch.py robots:={it.robots[0].name}"
    if it.driving:
        yield ""
        shown = it.driving if len(it.driving) <= _DRIVING else it.driving[:1]
        yield "In other terminals, to drive:"
        yield ""
        yield from (line for one in shown for line in _shell_lines(one))
        if len(shown) < len(it.driving):
            yield ""
            yield f"The other robots likewise: with their names in the place of {it.robots[0].name}."
    yield '"""'
    yield ""


def _import_lines(body: str) -> Iterator[str]:
    if "partial(" in body:
        yield "from functools import partial"
    yield from ("from pathlib import Path", "")
    used = frozenset(re.findall(r"\w+", body))
    for module, every in (line.split(": ") for line in _fixed_part("imports")):
        names = [name for name in every.split() if name in used]
        if module == "launch.actions" and names:
            yield from (f"from {module} import (", *(f"    {name}," for name in names), ")")
        elif names:
            yield f"from {module} import {', '.join(names)}"
    yield ""


def _shell_lines(line: str) -> Iterator[str]:
    """Yield the lines of a shell command, at most as wide as the file."""
    words = wrap(line, WIDTH - 6, break_long_words=False, break_on_hyphens=False)
    for number, it in enumerate(words):
        indent, more = "    " * bool(number), " \\" * (number + 1 < len(words))
        yield f"    {indent}{it}{more}"


def _function_lines(it: Function) -> Iterator[str]:
    """Yield the function that starts a robot, or each of several."""
    own = ("name", *it.parameters) if len(it.calls) > 1 else ()
    yield f"def {it.title}({', '.join(own)}):"
    yield f'    """Start {comment(it.starts.description)} in {comment(it.starts.where)}."""'
    yield from _robot_lines(it.starts)


def _call_lines(it: Function, name: str) -> Iterator[str]:
    """Yield the lines of the robots' table for the start of one robot."""
    if len(it.calls) == 1:
        yield f"    {value(name)}: {it.title},"
        return
    named = (f"{key}={own}" for key, own in zip(it.parameters, it.calls[name], strict=True))
    given = (it.title, value(name), *named)
    row = f"    {value(name)}: partial({', '.join(given)}),"
    if len(row) <= WIDTH:
        yield row
    else:
        yield from (f"    {value(name)}: partial(", *(f"        {one}," for one in given), "    ),")


def _robot_lines(it: RobotStarts) -> Iterator[str]:
    for name, why in it.left:
        if why:
            text = comment(f"Not started: {name} ({why})")
            rows = wrap(text, WIDTH - 6, break_long_words=False, break_on_hyphens=False)
            yield from (f"    # {row}" for row in rows)
    if it.files:
        yield from (f"    {line}" for line in lines("params = ", [*it.files]))
    own = OF_ALL._replace(files=it.files)
    if it.clock is not None:
        own = own._replace(clock={"use_sim_time": it.clock})
    yield "    return ["
    yield from actions(it.starts, 8, own, it.not_bridged)
    yield "    ]"


def _environment_lines(it: FleetStarts) -> Iterator[str]:
    for name, given in it.environment.items():
        own = f"{value(name)}, {value(given.strip(':'))}"
        if given.startswith(":"):
            yield f"AppendEnvironmentVariable({own}),"
        elif given.endswith(":"):
            yield f"AppendEnvironmentVariable({own}, prepend=True),"
        else:
            yield f"SetEnvironmentVariable({own}),"


def _description_function(it: FleetStarts) -> Iterator[str]:
    yield "def generate_launch_description():"
    first = "the simulator, then " if it.simulators else ""
    last = ", then the windows for all" if it.windows else ""
    yield f'    """Start {first}robot by robot{last}."""'
    yield "    return LaunchDescription("
    yield "        ["
    for name, default, about in launch_arguments(it):
        yield "            DeclareLaunchArgument("
        yield f"                {value(name)},"
        yield f"                default_value={value(default)},"
        yield f"                description={value(about)},"
        yield "            ),"
    if it.domains:
        number = value(f"{it.domains['']}")
        yield f"            SetEnvironmentVariable('ROS_DOMAIN_ID', {number}),"
    yield from (f"            {line}" for line in _environment_lines(it))
    for simulator in it.simulators:
        rows = (
            line.replace("{options}", it.options) for line in _fixed_part(f"{simulator} simulator")
        )
        yield from (f"            {line}" for line in rows)
    yield from actions(it.shared, 12)
    yield "            OpaqueFunction(function=chosen),"
    yield from actions(it.windows, 12)
    yield "        ]"
    yield "    )"
