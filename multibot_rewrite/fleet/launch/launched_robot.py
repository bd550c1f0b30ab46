# SPDX-License-Identifier: Apache-2.0
"""The launch files of a robot -> its nodes: its node sets as the launch files start them."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from itertools import chain

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.rosnames import RemapRule
from multibot_rewrite.description.sources.expand import once_kept
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.fleet.launch.starts import OWN_ARGUMENTS
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import MANAGER, NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.nodes import RobotNodes, nodes_of, under_plugin
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.known_node import with_sources
from multibot_rewrite.producers.launch.of_robot import Launched, as_launched, with_launched
from multibot_rewrite.producers.launch.programs import may_be_off
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder, joined
from multibot_rewrite.producers.launch.several_robots import of_first_robot, with_extras

NOT_SPAWNED = "no spawner of the launch files loads it"


def launched_robot(
    node_set: Sequence[NodeFacts],
    orders: Sequence[LaunchOrder],
    known: Mapping[str, NodeFacts],
    words: Sequence[str],
    parameters: KnownNodes,
    release: str,
) -> Launched | None:
    """Return the nodes of a robot with these launch files in a release; None without any.

    ``words`` stand for the robot in names, the first one for ``{robot}`` in arguments. Raises
    InputError for a launch file that cannot be read, UsageError for an unknown placeholder."""
    if not orders:
        return None
    graph = launch_of(orders, words[0])
    # What stands for the robot besides its own words: its namespace in a launch.
    values = (value.strip("/") for it in _own_orders(orders, words[0]) for _, value in it.arguments)
    every = {*words, *filter(None, values)}
    return with_launched(node_set, graph, known, every, parameters, release)


def known_here(
    known: Mapping[str, NodeFacts], orders: Sequence[LaunchOrder], robot: str, release: str
) -> dict[str, NodeFacts]:
    """Return known nodes and, by source, those of launch files; raises as ``launched_robot``."""
    return with_sources(known, launch_of(orders, robot).nodes if orders else (), orders, release)


def launch_of(orders: Sequence[LaunchOrder], robot: str) -> LaunchGraph:
    """Return what launch files start, for one of their robots; raises as ``launched_robot``."""
    graph = with_extras(of_first_robot(joined([*map(_read_once, _own_orders(orders, robot))])))
    return _with_switched_on(graph, {name for it in orders for name, _ in it.arguments})


def _with_switched_on(graph: LaunchGraph, given: Collection[str]) -> LaunchGraph:
    """Return launch files with what an argument turns on, if it decides nothing else here."""
    own = (it for it in graph.nodes if not may_be_off(it))
    fixed = {switch.name for it in own for switch in it.process.switches}
    # Of two of one name only one is planned.
    called = Counter((it.namespace, it.name or it.executable) for it in (*graph.nodes, *graph.off))
    fixed |= {
        it.process.off for it in graph.off if called[it.namespace, it.name or it.executable] > 1
    }
    fixed |= {name for it in graph.idle if not it.is_off for name, _ in it.asked}
    fixed.update(OWN_ARGUMENTS, given, (it.process.off for it in graph.off if graph.robots))
    off = tuple(it for it in graph.off if it.process.off not in fixed)
    names = {it.process.off for it in off}
    idle = tuple(it for it in graph.idle if not it.is_off or it.asked[0][0] not in names)
    return graph._replace(nodes=(*graph.nodes, *off), idle=idle)


def _read_once(order: LaunchOrder) -> LaunchGraph:
    """Return the graph of a launch file, read once for all spellings of its path."""
    whole = order._replace(file=os.path.abspath(order.file))
    try:
        graph = once_kept(whole, lambda: _graph(whole, times_of(whole.file)))
    except InputError as error:
        raise InputError(str(error).replace(whole.file, order.file, 1)) from error
    if why := why_not(graph):
        raise InputError(f"{order.file}: the launch file cannot be read: {why}")
    return graph


def why_not(graph: LaunchGraph) -> str:
    """Return why a fleet is not made of a launch file that was read; empty if it is."""
    hint = "source its workspace, or put its sources into this src/ (or below launch_roots:)"
    found = (f"it imports the Python package {it!r}, which is not here" for it in graph.imports)
    # What lacks a file is named beside the rest of the robot; what raises is no bringup.
    raised = (
        it.message for it in graph.notes if it.fails and "FileNotFoundError" not in it.message
    )
    ends = (f"the launch ends here: {it}" for it in raised)
    return next(chain((f"{it}; {hint}" for it in found), ends), "")


def keep(order: LaunchOrder, graph: LaunchGraph) -> None:
    """Keep the graph of a launch file, which is not read again in ``kept_expansions``."""
    once_kept(order._replace(file=os.path.abspath(order.file)), lambda: graph)


@lru_cache
def _graph(order: LaunchOrder, times: tuple[int, ...]) -> LaunchGraph:
    """Return the graph of a launch file, kept for robots that start the same and have its ``times``."""
    return launch_graph(order)


def times_of(file: str) -> tuple[int, ...]:
    """Return a value that differs once a file has changed, and each time for a missing file."""
    try:
        found = os.stat(file)
    except OSError:  # it is told by who reads it
        return (time.monotonic_ns(),)
    return found.st_mtime_ns, found.st_size, found.st_ino


def _own_orders(orders: Sequence[LaunchOrder], robot: str) -> list[LaunchOrder]:
    return [it._replace(arguments=(*filled(dict(it.arguments), robot).items(),)) for it in orders]


def nodes_with(
    launched: Launched | None,
    node_set: Sequence[NodeFacts],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
) -> RobotNodes:
    """Return the nodes that a robot runs, by its launch files, its other files and its node sets."""
    if launched is None:
        return nodes_of(node_set, given, known)
    # Controllers of which launch files say whether they run -> the condition; empty for always.
    later = {name: it.later for name, it in launched.spawned.items()}
    # Spawners that a condition keeps out are not in a missing launch file.
    kept_out = any(it.what.startswith(f"{MANAGER} ") for it in launched.idle)
    if kept_out or (later and launched.whole):
        rest = (it.node for it in given if it.host_name and it.node not in later)
        later |= dict.fromkeys([*rest], NOT_SPAWNED)
    nodes, findings = nodes_of(launched.nodes, given, known, later)
    return RobotNodes(tuple(as_launched(nodes, launched)), (*launched.findings, *findings))


def under_plugins(
    nodes: Sequence[NodeFacts], launched: Launched | None, rules: Sequence[RemapRule], release: str
) -> tuple[NodeFacts, ...]:
    """Return the nodes, controllers with the remap rules of the plugin that loads them."""
    # Not if a launch file starts their controller manager.
    if launched and MANAGER in launched.started:
        return tuple(nodes)
    spawned = launched.spawned if launched else {}
    return tuple(under_plugin(it, rules, release, it.name in spawned) for it in nodes)


def given_with(launched: Launched | None, given: Sequence[Run]) -> tuple[Run, ...]:
    """Return the settings of a robot's files, then those of its launch files, which override them."""
    if launched is None:
        return tuple(given)
    started = {it.node: it for it in launched.given}
    # In the order of the files, so that they can be compared with what is made of them.
    own = [_merged_settings(it, started.pop(it.node)) if it.node in started else it for it in given]
    return (*own, *started.values())


def _merged_settings(own: Run, launched: Run) -> Run:
    """Return two settings as one; a value in both keeps its place in the robot's own file."""
    same = {
        k: it
        for k, it in own.values.items()
        if k in launched.values and launched.values[k].value == it.value
    }
    values = {**own.values, **launched.values, **same}
    # The file may say what the launch alone does not: the type of a controller.
    said = launched if launched.program or not own.program else own
    manager = launched.host_name or own.host_name
    return said._replace(values=values, place=own.place, host_name=manager)
