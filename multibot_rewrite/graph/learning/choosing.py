"""Which nodes of a graph are a robot's, which are tools, and which help another node."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.snapshot import LISTENER, Snapshot
from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.model import UsageError
from multibot_rewrite.nearest import nearest_few
from multibot_rewrite.rosnames import check_full_name, check_namespace

# A tf2 listener that was made without a node makes one of its own, called by its address.
HELPER = re.compile(LISTENER + "[0-9a-f]+")
# Hidden nodes, launch and tf2 listeners: no part of any robot.
NEVER_MEANT = re.compile(rf".*/(_.*|launch_ros_\d+|{LISTENER}.*)")


class Helpers(NamedTuple):
    """Helper nodes in a node's process; ``sure`` where they can be of no other node."""

    names: tuple[str, ...] = ()
    sure: bool = True


def choose(graph: Snapshot, names: Sequence[str], namespace: str) -> tuple[str, ...]:
    """Full names of the nodes to learn, sorted: ``names``, or all below ``namespace`` that are part
    of a robot.

    Raises UsageError for one that is not there, not below, or there twice, and if there is none.
    """
    base = base_of(namespace)
    times = Counter(node.name for node in graph.nodes)
    for name in names:
        if name not in times:
            raise UsageError(f"{name}: there is no such node; {_near(name, times)}")
        if not name.startswith(f"{base}/"):
            raise UsageError(f"{name}: it is not below {base}, where --namespace says it is")
    below = (name for name in times if name.startswith(f"{base}/") and not is_tool(name))
    chosen = sorted(set(names) or below)
    if not chosen:
        where = f"below {base}" if base else "in this graph"
        raise UsageError(f"there is no node to learn {where}; {_near(base, times)}")
    for name in chosen:
        check_seen_name("node", name)
        if times[name] > 1:
            hint = "end all but one; one that was killed stays in view for 20 s"
            raise UsageError(f"{name}: {times[name]} nodes have this name; {hint}")
    return tuple(chosen)


def left_out(graph: Snapshot, chosen: Iterable[str], namespace: str) -> tuple[str, ...]:
    """Tools below ``namespace`` that are not learned and that somebody may have meant to learn."""
    base = base_of(namespace)
    below = {node.name for node in graph.nodes if node.name.startswith(f"{base}/")}
    tools = (name for name in below.difference(chosen) if is_tool(name))
    return tuple(sorted(name for name in tools if not NEVER_MEANT.fullmatch(name)))


def base_of(namespace: str) -> str:
    """A namespace as the names below it begin, empty for the root; UsageError where it is none."""
    base = namespace.rstrip("/")
    fault = check_namespace(base) if base else None
    if fault:
        raise UsageError(f"namespace {namespace!r}: {fault.reason}")
    return base


def check_seen_name(what: str, name: str) -> None:
    """Raise UsageError where ``name`` can be in no graph."""
    fault = check_full_name(name)
    if fault:
        raise UsageError(f"{what} name {name!r} in the graph: {fault.reason}")


def _near(name: str, known: Iterable[str]) -> str:
    there = sorted(node for node in known if not is_tool(node))
    near = nearest_few(name, there, 3) or there[:3]
    return f"there is {', '.join(near)}" if near else "only tools are there, or none"


def helpers_of(graph: Snapshot, names: Sequence[str]) -> dict[str, Helpers]:
    """The helpers that nodes may have, by process; none of ``names`` is taken for a helper."""
    inside, mains = _processes(graph, names)
    return {
        node.name: Helpers(tuple(sorted(inside[node.process])), mains[node.process] == 1)
        for node in graph.nodes
        if node.name in names and node.process and node.process in inside
    }


def strays(graph: Snapshot, names: Sequence[str]) -> tuple[str, ...]:
    """Helper nodes in whose process no other node is seen: whose they are cannot be told."""
    inside, mains = _processes(graph, names)
    alone = (helpers for process, helpers in inside.items() if not mains[process])
    return tuple(sorted(name for helpers in alone for name in helpers))


def _processes(
    graph: Snapshot, names: Sequence[str]
) -> tuple[Mapping[str, list[str]], Counter[str]]:
    """By process: its helper nodes, and how many others it has."""
    inside: dict[str, list[str]] = defaultdict(list)
    mains: Counter[str] = Counter()
    for node in graph.nodes:
        own = node.name.rpartition("/")[2]
        if HELPER.fullmatch(own) and node.name not in names:
            inside[node.process].append(node.name)
        elif node.process and not own.startswith("_"):
            mains[node.process] += 1
    return inside, mains
