# SPDX-License-Identifier: Apache-2.0
"""Reads the launch files of a repository in the sandbox, with any or with given arguments."""

import os
import shlex
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import islice, takewhile
from typing import NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.fleet.launch.launched_robot import keep, launch_of, times_of, why_not
from multibot_rewrite.producers.launch.child import read_launch_files
from multibot_rewrite.producers.launch.handed_on import handed_on, process_name
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchOrder
from multibot_rewrite.producers.launch.spawners import is_spawner
from multibot_rewrite.system.words import is_viewer

# A robot to read a launch file for.
ANY = "robot1"
# For each launch file.
_SECONDS = 20.0
# Names of parameters that are shown of one process.
_SHOWN = 3
_DESCRIPTION = "robot_description"
_USUAL_TOPICS = frozenset(("tf", "tf_static", _DESCRIPTION))
# A place and what is said of it.
Row = tuple[str, int, str]


class Reading(NamedTuple):
    """A launch file with what it starts and includes, or why it cannot be read."""

    order: LaunchOrder
    graph: LaunchGraph = LaunchGraph()
    why: str = ""

    @property
    def file(self) -> str:
        """The path of the launch file."""
        return self.order.file


class Bringup(NamedTuple):
    """The launch file that starts a robot, and what it starts; ``others`` start it as well.

    ``is_simulated`` is true if it starts a simulator, or puts the robot into one."""

    order: LaunchOrder
    graph: LaunchGraph
    is_simulated: bool
    others: tuple[LaunchOrder, ...] = ()

    @property
    def name(self) -> str:
        """The name of the launch file, without its folder."""
        return os.path.basename(self.order.file)


def read_named(order: LaunchOrder) -> Reading:
    """Return a named launch file's nodes. Raises InputError if it is unreadable or starts nothing."""
    graph = launch_of([order], ANY)
    unread = [it.message for it in graph.notes if not it.parameters]
    if unread and not graph.nodes:
        raise InputError(f"{order.file}: the launch file cannot be read: {unread[0]}")
    return Reading(order, graph)


def read_any(launch: Sequence[str]) -> list[Reading]:
    """Return what launch files start with any arguments; what one includes is in that one alone."""
    # What others include is read with them.
    texts = {it: data_of_file(it) for it in launch}
    named = {
        it
        for it in launch
        if any(os.fsencode(os.path.basename(it)) in texts[one] for one in launch if one != it)
    }
    ordered = sorted(launch, key=lambda it: it in named)
    return read_as([LaunchOrder(it, every=True) for it in ordered])


def read_as(orders: Iterable[LaunchOrder]) -> list[Reading]:
    """Return what launch files start, each as it is launched."""
    every = tuple(orders)
    read = _read_in_one(every, tuple(times_of(it.file) for it in every)) if every else []
    for it in (one for one in read if one.graph.nodes and not one.order.every):
        keep(it.order, it.graph)
    return [it if it.order.every else it._replace(why=it.why or why_not(it.graph)) for it in read]


@lru_cache(maxsize=16)
def _read_in_one(orders: tuple[LaunchOrder, ...], times: tuple[object, ...]) -> list[Reading]:
    """Read launch files in one process; ``times`` tell their changes."""
    read = read_launch_files(orders, _SECONDS)
    return [
        Reading(order, why=f"{it}".removeprefix(f"{order.file}: the launch file cannot be read: "))
        if isinstance(it, InputError)
        else Reading(order, it)
        for order, it in zip(orders, read, strict=True)
    ]


def order_text(it: LaunchOrder, folder: str) -> str:
    """Return what follows ``ros2 launch``, for a fleet file in a folder."""
    file = [os.path.relpath(it.file, folder)]
    if it.package:
        file = [it.package, os.path.basename(it.file)]
    return shlex.join([*file, *(f"{name}:={value}" for name, value in it.arguments)])


def not_read(read: Iterable[Reading]) -> Iterator[Row]:
    """Yield the first thing in each launch file that could not be read."""
    # What is unknown of one node is reported by the build.
    for it in read:
        notes = [one for one in it.graph.notes if not one.missing]
        notes = [one for one in notes if not one.parameters or one.place.line == 1]
        if it.why:
            yield it.file, 1, it.why
        elif notes:
            more = f" (and {len(notes) - 1} more)" if notes[1:] else ""
            yield notes[0].place.file, notes[0].place.line, f"{notes[0].message}{more}"


def started(nodes: Iterable[LaunchedNode]) -> Iterator[Row]:
    """Yield what is started for robots, each once: no simulators, no programs that end or only look."""
    known = set()
    for it in (one for one in nodes if one.executable and is_of_robot(one)):
        text = said_of(it)
        if text not in known:
            yield it.place.file, it.place.line, text
        known.add(text)


def first_words(it: LaunchedNode) -> list[str]:
    """Return the first argument of a program, of a spawner all that it loads."""
    words = takewhile(lambda word: not word.startswith(("-", os.sep)), it.arguments)
    return [*islice(words, None if is_spawner(it) else 1)]


def said_of(it: LaunchedNode) -> str:
    """Return what a process is: its name, what runs it, its remap rules and given parameters."""
    program = " ".join(filter(None, (it.package, it.executable, *first_words(it))))
    name = it.name or ("" if it.package else process_name(it))
    who = f"{name} ({program})" if it.name or name not in program else program
    rules = (f"{a}:={b}" for a, b in it.remappings if _is_moved(a, b))
    values = handed_on(it, it.name or it.executable).values
    named = [name for name in values if not name.startswith(_DESCRIPTION)]
    given = ", ".join((*rules, *([shorten(named, _SHOWN)] if named else ())))
    return f"{who}: {given}" if given else who


def starts_simulator(graph: LaunchGraph) -> bool:
    """Return whether a launch file starts a simulator, or what only a simulated robot needs."""
    return not graph.packages.isdisjoint(programs().simulators)


def is_of_robot(it: LaunchedNode) -> bool:
    """Return whether a process is a robot's: no simulator, no program that ends or only looks."""
    ways = programs()
    passes = f"{it.package}/{it.executable}" in ways.passing or it.package in ways.simulators
    return not passes and not is_viewer(it.executable)


def _is_moved(topic: str, target: str) -> bool:
    """Return whether a rule renames a topic of which not every robot has its own."""
    is_name = topic.rpartition(":")[2].startswith("__")
    return bool(topic and target) and not is_name and topic.rpartition("/")[2] not in _USUAL_TOPICS
