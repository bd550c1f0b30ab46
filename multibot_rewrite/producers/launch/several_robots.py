# SPDX-License-Identifier: Apache-2.0
"""A launch file that starts several robots, or puts more into a simulator -> what it starts for one."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.producers.launch.programs import program_of, programs
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph

# How the spawner of a robot gets its description, which somebody publishes.
_PUBLISHED = frozenset(("-topic", "-param"))
_NUMBER, _WORDS = re.compile(r"[0-9]+"), re.compile(r"[^\s/:=]+")


def of_first_robot(graph: LaunchGraph) -> LaunchGraph:
    """Return what launch files start for one robot, or the first of several without its name."""
    robots = _robots(graph.nodes)
    if not robots:
        return graph
    others = frozenset(robots[1:])
    kept = [at for at, it in enumerate(graph.nodes) if others.isdisjoint(_names(it))]
    places = {old: new for new, old in enumerate(kept)}
    nodes = (_unnamed(graph.nodes[at], robots[0], places) for at in kept)
    return graph._replace(nodes=tuple(nodes), robots=robots)


def with_extras(graph: LaunchGraph) -> LaunchGraph:
    """Return the graph; what spawns more than the description, first URDF or file is marked."""
    spawning = [it for it in graph.nodes if program_of(it) in programs().spawners]
    filed = [it for it in spawning if _PUBLISHED.isdisjoint(it.arguments)]
    filed.sort(key=lambda it: not any(word.endswith(".urdf") for word in it.arguments))
    extra = filed if len(filed) < len(spawning) else filed[1:]
    nodes = (
        it._replace(process=it.process._replace(is_extra=True)) if it in extra else it
        for it in graph.nodes
    )
    return graph._replace(nodes=tuple(nodes)) if extra else graph


def _robots(nodes: Sequence[LaunchedNode]) -> tuple[str, ...]:
    """Return the namespaces of two or more state publishers that differ by a number alone.

    Otherwise those that one line of a launch file starts, each beside a spawner."""
    published = {_home(it): it.place for it in nodes if it.package == STATE_PUBLISHER}
    spawned = {_home(it) for it in nodes if program_of(it) in programs().spawners}
    named = ((_NUMBER.sub("", home), home) for home in published if home)
    beside = ((place, home) for home, place in published.items() if home in spawned - {""})
    alike = lists_by_key((*named, *beside))
    return next((tuple(it) for it in alike.values() if len(it) > 1), ())


def _home(it: LaunchedNode) -> str:
    return it.namespace.split("/")[1]


def _names(it: LaunchedNode) -> Iterator[str]:
    """Yield texts that may name a node's robot: its first namespace, its own name and arguments."""
    yield _home(it)
    yield it.name
    for word in it.arguments:
        yield from _WORDS.findall(word)


def without(text: str, robot: str) -> str:
    """Return a text in which names of a robot are as those of any: ``/scan`` of ``/robot1/scan``."""
    return text.replace(f"/{robot}/", "/")


def _unnamed(it: LaunchedNode, robot: str, places: Mapping[int, int]) -> LaunchedNode:
    """Return what is started without the name of its robot, and what it waits for by its new place."""

    def home(text: str) -> str:
        return without(f"{text}/", robot).rstrip("/")

    return it._replace(
        namespace=home(it.namespace) or "/",
        container=home(it.container),
        remappings=tuple((without(old, robot), without(new, robot)) for old, new in it.remappings),
        arguments=tuple(without(word, robot) for word in it.arguments),
        parameters=tuple(own._replace(text=without(own.text, robot)) for own in it.parameters),
        process=it.process._replace(after=places.get(it.process.after, -1)),
    )
