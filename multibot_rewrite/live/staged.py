# SPDX-License-Identifier: Apache-2.0
"""Stub nodes in a graph of their own, and what a look there sees."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.live.rehearsal import Stub, split_over_processes, to_order
from multibot_rewrite.producers.ros.assemble import BUSY_MACHINE
from multibot_rewrite.producers.ros.child import RUN_STUBS, observe, running
from multibot_rewrite.producers.ros.participants import participants_here
from multibot_rewrite.producers.ros.request import Request, to_text
from multibot_rewrite.system.environment import settings
from multibot_rewrite.system.records import System

# Below the ports that a system gives away by itself.
_DOMAINS = 100
_ELSEWHERE = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS_LOCALHOST_ONLY")
# Looks at nodes that do run until all that they have is seen.
LOOKS = 3


class Started(NamedTuple):
    """What the stub nodes say of themselves: which types are replaced by which, the ends that they
    have (node, role, name), and the frames that they send."""

    replaced: dict[str, str]
    ends: frozenset[tuple[str, str, str]]
    frames: frozenset[str]


def stage(domain: int | None) -> dict[str, str]:
    """An environment where nobody else is: this machine only, the domain that the environment names
    where it is free, else one that is hardly used."""
    environ = {k: v for k, v in os.environ.items() if k not in _ELSEWHERE}
    asked = settings(os.environ).domain if os.environ.get("ROS_DOMAIN_ID") else None
    free = asked is not None and participants_here(asked) == 0
    other = asked if free else 1 + os.getpid() % _DOMAINS
    own = other if domain is None else domain
    return {**environ, "ROS_DOMAIN_ID": str(own), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def stages(domain: int | None, count: int) -> list[dict[str, str]]:
    """So many environments as ``stage`` makes, each in a domain of its own: the next free ones."""
    first = stage(domain)
    numbers = [int(first["ROS_DOMAIN_ID"])]
    while len(numbers) < count:
        own = 1 + numbers[-1] % _DOMAINS
        while participants_here(own):
            own = 1 + own % _DOMAINS
        numbers.append(own)
    return [{**first, "ROS_DOMAIN_ID": str(it)} for it in numbers]


def staged(
    nodes: Iterable[Stub], environ: Mapping[str, str], seconds: float
) -> tuple[System, dict[str, str]]:
    """The graph of the stub nodes, and which types are replaced by which.

    On a busy machine messages of the discovery are lost, so a look that lacks what the nodes say that
    they have is taken again. Raises Unusable where the nodes do not start or the graph is not read.
    """
    request = Request(seconds, substitutes=True)
    with _started(nodes, environ) as started:
        for _ in range(LOOKS):
            graph = observe(request, environ)
            if _has_all(graph, started):
                return _nothing_is_late(graph), started.replaced
    return graph, started.replaced


def _nothing_is_late(graph: System) -> System:
    """The graph without what is said of a busy machine: all nodes that run here were seen whole."""
    here = graph.environment
    caveats = tuple(it for it in here.caveats if it.code != BUSY_MACHINE)
    return graph._replace(environment=here._replace(caveats=caveats))


def _has_all(graph: System, started: Started) -> bool:
    ends = {(end.node, end.role, end.name) for end in graph.ends}
    return started.ends <= ends and started.frames <= {edge.child for edge in graph.edges}


@contextmanager
def _started(nodes: Iterable[Stub], environ: Mapping[str, str]) -> Iterator[Started]:
    """The stub nodes in the graph, and what they say once all are there."""
    with ExitStack() as stack:
        children = [
            stack.enter_context(running(RUN_STUBS, to_text(to_order(own)), environ))
            for own in split_over_processes(nodes)
        ]
        said = [json.loads(child.next_message() or b"[{}, [], []]") for child in children]
        replaced = {old: new for own, _, _ in said for old, new in own.items()}
        ends = frozenset((node, role, name) for _, own, _ in said for node, role, name in own)
        yield Started(replaced, ends, frozenset(it for _, _, own in said for it in own))
