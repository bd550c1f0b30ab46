# SPDX-License-Identifier: Apache-2.0
"""Finds the launch file that is a robot's bringup, for the simulator or the real robot.

It starts the description's publisher or spawner, and no other file includes it."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.reports.xacro_arguments import names_robots
from multibot_rewrite.description.sources.own_names import ROBOT
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.file.simulator_switch import is_called_as_switch, other_values
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import (
    LaunchArgument,
    LaunchedNode,
    LaunchGraph,
    LaunchOrder,
)
from multibot_rewrite.proposal.launches import (
    Bringup,
    Reading,
    is_of_robot,
    read_any,
    read_as,
    read_named,
    starts_simulator,
)
from multibot_rewrite.proposal.searching import known_names

# Launch files that are read with their own arguments, and orders of one of them with a switch.
_MOST, _MOST_SWITCHES = 16, 8
# Words in the names of launch files.
_WORD = re.compile(r"[a-z0-9]+")


class Robot(NamedTuple):
    """The robot that a launch file is to start: files of its description, those of others, world.

    ``simulator`` is "none" for a real one, and empty where nobody said which it is: then it is
    what ``has_simulator`` says of the description, if there is a launch file for it.
    ``has_control`` is true if it has a controller manager."""

    files: frozenset[str]
    others: frozenset[str]
    simulator: str
    has_simulator: bool
    has_control: bool = False

    @property
    def is_simulated(self) -> bool:
        """Return whether the robot is wanted in a simulator."""
        return self.simulator != REAL if self.simulator else self.has_simulator


def bringup_as_named(order: LaunchOrder) -> Bringup:
    """Return the named launch file; raises InputError if it cannot be read or starts nothing."""
    graph = read_named(order).graph
    return _named_for_each(Bringup(order, graph, starts_simulator(graph)))


def _named_for_each(it: Bringup) -> Bringup:
    """Return a bringup in which an argument that names the vendor's robot names each robot."""
    spaces = _namespaces(it.graph)
    defaults = ((one.name, one.default) for one in it.graph.declared)
    named = {
        name: value
        for name, value in defaults
        if value.strip("/") and any(f"{one}/".startswith(f"/{value.strip('/')}/") for one in spaces)
    }
    own = dict(it.order.arguments)
    said = {**named, **own}
    given = {name: _value_for_each(name, value) for name, value in said.items()}
    changed = {name: value for name, value in given.items() if value != said[name]}
    if not changed:
        return it
    with suppress(InputError):
        order = it.order._replace(arguments=tuple({**own, **changed}.items()))
        graph = read_named(order).graph
        # The file starts the same with it, and the namespace may be called so by chance.
        named_so = not changed.keys() <= own.keys() and _namespaces(graph) == spaces
        if _effects(graph) == _effects(it.graph) and not named_so:
            return it._replace(order=order, graph=graph)
    return it


def _namespaces(graph: LaunchGraph) -> list[str]:
    """Return the namespaces of a robot's own nodes."""
    return [it.namespace for it in _own_nodes(graph)]


def _value_for_each(argument: str, value: str) -> str:
    """Return an argument's value for any robot: ``hippo/`` of ``vehicle_name`` is ``{robot}/``."""
    name = value.strip("/_")
    return value.replace(name, ROBOT, 1) if names_robots(argument) and name else value


def _effects(graph: LaunchGraph) -> tuple[object, ...]:
    """Return a key that is equal for two launches: programs, files read, and how much is unclear."""
    started = sorted((it.package, it.executable) for it in graph.nodes)
    return started, _files_read(graph), len(graph.notes), len(graph.idle)


def bringup_of(robot: Robot, launch: Sequence[str], trust: bool) -> Bringup | None:
    """Return the launch file that starts most of the robot, in its world; None if none does."""
    # One with the name of a trial comes last.
    every = read_any(launch)
    included = _included_files(every)
    roots = [it for it in every if not it.why and it.file not in included]
    # Those that start the publisher or spawner of the description, as far as it is known which one that
    # is, and of one robot.
    publishing = (it for it in roots if any(map(_publishes_or_spawns, it.graph.nodes)))
    likely = [it for it in publishing if not _is_of_another(it.graph, robot)]
    starting = [it for it in likely if _files_read(it.graph) & robot.files] or likely
    if not starting:
        return _only_launch_file(roots, robot, trust)
    starting = sorted(starting, key=_sort_key)[:_MOST]
    read = _with_own_arguments(starting, every, robot, trust)
    # What is not said is simulated where a launch file does it.
    wanted = robot.is_simulated or not robot.simulator
    for simulated in (wanted, *([] if robot.simulator else [not wanted])):
        if fits := [it for it in read if starts_simulator(it.graph) == simulated]:
            first, *others = sorted(fits, key=lambda it: (_is_trial(it, simulated), _sort_key(it)))
            made = Bringup(first.order, first.graph, simulated, tuple(it.order for it in others))
            return _named_for_each(made)
    return None


def processes_of_robot(it: Reading) -> int:
    """Return how many processes a launch file starts for a robot; raises nothing."""
    # Those that only show it count as one; 0 for a test, or without a description.
    starts = starts_simulator(it.graph) or any(map(_publishes_or_spawns, it.graph.nodes))
    own = {one for one in _own_nodes(it.graph) if not _shows(one)}
    own |= {one for one in it.graph.nodes if one.package in programs().simulators}
    return 1 + len(own) if starts and not _is_trial(it, True) else 0


def _with_own_arguments(
    likely: Sequence[Reading], every: Sequence[Reading], robot: Robot, trust: bool
) -> list[Reading]:
    """Return the launch files with arguments that start the robot as wanted, or start it at all."""
    # Their own arguments, otherwise a switch, otherwise files that these include.

    def starting(orders: Iterable[LaunchOrder]) -> list[Reading]:
        """Return the launch files, with these arguments, that start the robot and can be read."""
        read = read_as(it._replace(trusted=trust) for it in orders)
        return [it for it in read if not it.why and _is_bringup(it.graph, robot)]

    def fits(read: Iterable[Reading]) -> bool:
        """Return whether one starts a simulator exactly if the robot is wanted in one."""
        return any(starts_simulator(it.graph) == robot.is_simulated for it in read)

    found = starting(LaunchOrder(it.file) for it in likely)
    if not fits(found):
        # The values that launch files give to the arguments of others.
        includes = (one for it in every for one in it.graph.includes)
        passed = sets_by_key(pair for one in includes for pair in one.arguments)
        found += starting(_switched_orders(likely, passed))
    if not fits(found):
        below = dict.fromkeys(one.file for it in likely for one in it.graph.includes)
        here = (it for it in [*below][:_MOST] if os.path.isabs(it) and os.path.isfile(it))
        found += starting(map(LaunchOrder, here))
    return found


def _included_files(read: Iterable[Reading]) -> frozenset[str]:
    """Return the paths of the launch files that another one includes."""
    files = {os.path.realpath(it.file): it.file for it in read}
    pairs = ((it.file, one.file) for it in read for one in it.graph.includes)
    named = ((os.path.realpath(outer), os.path.realpath(inner)) for outer, inner in pairs)
    return frozenset(files[it] for outer, it in named if it in files and it != outer)


def _switched_orders(
    likely: Iterable[Reading], passed: Mapping[str, set[str]]
) -> Iterator[LaunchOrder]:
    """Yield the launch files with one argument that may choose between simulator and real robot."""
    for it in likely:
        switches = (
            (one.name, value)
            for one in it.graph.declared
            if is_called_as_switch(one.name)
            for value in _other_values(one, passed.get(one.name, set()))
        )
        for pair in [*switches][:_MOST_SWITCHES]:
            yield LaunchOrder(it.file, (pair,))


def _other_values(it: LaunchArgument, passed: set[str]) -> list[str]:
    """Return other values of an argument: given by launch files, among its choices, the opposite."""
    values = [*sorted(passed), *it.choices, *other_values(it.default)]
    return [value for value in dict.fromkeys(values) if value not in ("", it.default)]


def _is_of_another(graph: LaunchGraph, robot: Robot) -> bool:
    """Return whether a launch file reads only another robot's description."""
    read = _files_read(graph)
    return bool(read & robot.others) and not read & robot.files


def _files_read(graph: LaunchGraph) -> set[str]:
    return {it.file for it in graph.read}


def _is_bringup(graph: LaunchGraph, robot: Robot) -> bool:
    """Return whether a launch file starts more than a display of the description, and one robot."""
    homes = {it.namespace for it in graph.nodes if _is_called(it, "publishers")}
    # What is said of a file as a whole starts nothing by itself.
    unread = any(it.place.line > 1 and not it.parameters for it in graph.notes)
    shows = not unread and all(map(_shows, _own_nodes(graph)))
    return len(homes) < 2 and (starts_simulator(graph) or not shows)


def _only_launch_file(roots: Sequence[Reading], robot: Robot, trust: bool) -> Bringup | None:
    """Return the only launch file that starts something of a robot without its description."""
    # A build publishes that, but spawns no controllers.
    own = (it for it in roots if not _is_of_another(it.graph, robot))
    found = [it for it in own if any(map(is_of_robot, it.graph.nodes))]
    if len(found) != 1 or robot.has_control:
        return None
    (read,) = read_as([LaunchOrder(found[0].file, trusted=trust)])
    nodes = any(map(is_of_robot, read.graph.nodes))
    simulated = robot.is_simulated or starts_simulator(read.graph)
    return Bringup(read.order, read.graph, simulated) if nodes else None


def _publishes_or_spawns(it: LaunchedNode) -> bool:
    return _is_called(it, "publishers") or f"{it.package}/{it.executable}" in programs().spawners


def _is_called(it: LaunchedNode, kind: str) -> bool:
    return it.executable in known_names()[kind]


def _shows(it: LaunchedNode) -> bool:
    """Return whether a node shows a description and moves nothing."""
    return _is_called(it, "publishers") or _is_called(it, "showing")


def _own_nodes(graph: LaunchGraph) -> list[LaunchedNode]:
    return [it for it in graph.nodes if is_of_robot(it)]


def _is_trial(it: Reading, simulated: bool) -> bool:
    """Return whether a launch file is named as a trial, or as one of an unknown simulator."""
    words = {*_WORD.findall(os.path.basename(it.file).lower())}
    kinds = ("trials",) if simulated else ("trials", "simulations")
    return any(not words.isdisjoint(known_names()[it]) for it in kinds)


def _sort_key(it: Reading) -> tuple[object, ...]:
    """Return a sort key: most processes of a robot first, then read completely, then a short path."""
    return -len(set(_own_nodes(it.graph))), not it.graph.whole, len(it.file), it.file
