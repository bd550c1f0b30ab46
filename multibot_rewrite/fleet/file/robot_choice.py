# SPDX-License-Identifier: Apache-2.0
"""Chooses the robots of a fleet when it starts, by a text or by a number.

A robot of the file with ``count`` is a pattern: ``{name: robot, count: 3, step: {y: 2}}`` stands
for robot1, robot2 and robot3, each 2 m from the one before."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.rosnames import MOST, check_robot_name
from multibot_rewrite.fleet.file.fleet_data import FleetData

COUNT, STEP, POSE, NAME = "count", "step", "pose", "name"
AXES = ("x", "y", "z", "roll", "pitch", "yaw")
# What each robot has for itself.
OWN = ("namespace", "prefix", "postfix", "model")
_NUMBERED = lazy_compile(r"(\w*[A-Za-z_])(\d+)")
_EXAMPLE = "write robot1={x: 1.0, y: 0}; robot2={x: 2.0}"


class Choice(NamedTuple):
    """``robots`` are named with poses, or ``number`` of the pattern; empty or 0: as in the file."""

    # As nav2_common's ParseMultiRobotPose reads them: ``robot1={x: 1.0, y: 0}; robot2={}``.

    robots: str = ""
    number: int = 0


ALL = Choice()
# A robot with the number of the one in the file that its place is.
_Row = tuple[int, dict[str, Any]]


def with_robots(read: FleetData, choice: Choice) -> FleetData:
    """Return the data with all robots of patterns, or the chosen ones."""
    # Raises UsageError for an impossible choice, InputError for a wrong pattern.
    given = read.data["robots"]
    if choice == ALL and not any(COUNT in it or STEP in it for it in given):
        return read
    rows = [row for at in range(len(given)) for row in _repeated(read, at, choice.number)]
    if choice.number and not any(COUNT in it for it in given):
        rows = list(_continued(read, choice.number))
    if choice.robots:
        rows = list(_chosen(choice.robots, rows, given))
    places = {
        at: place for at, place in read.places.items() if at[:1] != ("robots",) or len(at) < 2
    }
    for new, (old, _) in enumerate(rows):
        own = [(at, it) for at, it in read.places.items() if at[:2] == ("robots", old)]
        places |= {("robots", new, *at[2:]): it for at, it in own}
    data = {**read.data, "robots": [robot for _, robot in rows]}
    return read._replace(data=data, places=places)


def _repeated(read: FleetData, at: int, asked: int) -> Iterator[_Row]:
    """Yield a robot of the file, or all robots of its pattern."""
    robot = read.data["robots"][at]
    file, line = read.places["robots", at]
    if COUNT not in robot:
        if STEP in robot:
            raise InputError(f"{file}:{line}: step is of a robot with count; write count, too")
        yield at, robot
        return
    count = asked or robot[COUNT]
    if not 0 < count <= MOST:
        raise UsageError(f"count {count}: write a number from 1 to {MOST}")
    kept = _without(robot)
    for key in OWN:
        if key in robot:
            raise InputError(f"{file}:{line}: robots with count cannot share a {key}; leave it out")
    for number in range(count):
        row = {**kept, NAME: f"{robot[NAME]}{number + 1}"}
        first, step = robot.get(POSE, {}), robot.get(STEP, {})
        pose = {it: first.get(it, 0) + number * step.get(it, 0) for it in {**first, **step}}
        yield at, {**row, POSE: pose} if pose else row


def _continued(read: FleetData, count: int) -> Iterator[_Row]:
    """Yield the first robots of a file, and more like the last, as far apart as the last two."""
    given = read.data["robots"]
    if not 0 < count <= MOST:
        raise UsageError(f"count {count}: write a number from 1 to {MOST}")
    yield from list(enumerate(given))[:count]
    last = len(given) - 1
    if count <= len(given):
        return
    stem, number = _numbered(read, count)
    before, pose = (robot.get(POSE, {}) for robot in (given[last - 1], given[last]))
    kept = {key: it for key, it in _without(given[last]).items() if key not in OWN}
    for more in range(1, count - last):
        place = {}
        for axis in {**before, **pose}:
            step = pose.get(axis, 0) - before.get(axis, 0)
            place[axis] = round(pose.get(axis, 0) + more * step, 6)
        row = {**kept, NAME: f"{stem}{number + more}"}
        yield last, {**row, POSE: place} if place else row


def _numbered(read: FleetData, count: int) -> tuple[str, int]:
    """Return (name without its number, number) of the last robot; raises UsageError."""
    given = read.data["robots"]
    found = [_NUMBERED.fullmatch(robot[NAME]) for robot in given]
    if found[1:] and (last := found[-1]):
        return last[1], max(int(it[2]) for it in found if it and it[1] == last[1])
    hint = f"write count: {count} into one of its robots, or end the name of the last one with a number"
    raise UsageError(f"count {count}: {read.file} does not say what more robots are called; {hint}")


def _without(robot: Mapping[str, Any]) -> dict[str, Any]:
    """Return what all robots of a pattern share."""
    return {key: it for key, it in robot.items() if key not in (COUNT, STEP, POSE, NAME)}


def _chosen(text: str, rows: list[_Row], given: list[dict[str, Any]]) -> Iterator[_Row]:
    """Yield (row, robot) for each robot that a text names, as in the file or like its first pattern."""
    known = {robot[NAME]: (at, robot) for at, robot in rows}
    like = next((at for at, it in enumerate(given) if COUNT in it), 0)
    base = like, {key: it for key, it in _without(given[like]).items() if key not in OWN}
    for name, pose in parse_robots(text):
        at, robot = known.get(name, base)
        yield at, {**robot, NAME: name, **({POSE: pose} if pose else {})}


def parse_robots(text: str) -> Iterator[tuple[str, dict[str, float]]]:
    """Yield (name, pose) of each robot; a pose is empty if none is given; raises UsageError."""
    seen: set[str] = set()
    for part in filter(None, map(str.strip, text.split(";"))):
        name, _, pose = (it.strip() for it in part.partition("="))
        if not name:
            raise UsageError(f"robots: {part!r} has no name; {_EXAMPLE}")
        check_robot_name(name)
        if name in seen:
            raise UsageError(f"robots: {name} is there twice; {_EXAMPLE}")
        seen.add(name)
        try:
            # As Nav2 reads it: {x:1.0} without a space is no number.
            value = load_yaml(pose, "") if pose else {}
        except InputError:
            value = None
        wrong = f"robots: {name}: {pose!r} is no pose"
        if not isinstance(value, dict):
            raise UsageError(f"{wrong}; {_EXAMPLE}")
        for key, number in value.items():
            if key not in AXES:
                raise UsageError(f"{wrong}: {key!r} is none of {', '.join(AXES)}; {_EXAMPLE}")
            if isinstance(number, bool) or not isinstance(number, int | float):
                raise UsageError(f"{wrong}: {key} is {number!r}; write a number")
        yield name, value
