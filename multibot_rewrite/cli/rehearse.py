# SPDX-License-Identifier: Apache-2.0
"""``multibot rehearse``: the plan of a fleet tried on a real graph, without robot or simulator."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager

from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.cli import fleet, live, pictures
from multibot_rewrite.cli.check import conclude
from multibot_rewrite.cli.declared.fleet import EVERY_WAY
from multibot_rewrite.cli.output import note, write_files
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleet.fleet import Fleet, expected
from multibot_rewrite.live.rehearsal import (
    StubNode,
    bridge_stub,
    split_over_processes,
    stub_nodes,
    to_order,
    with_substitutes,
)
from multibot_rewrite.producers.ros.child import RUN_STUBS, observe, running
from multibot_rewrite.producers.ros.participants import participants_here
from multibot_rewrite.producers.ros.request import Request, to_text
from multibot_rewrite.rules.check import check
from multibot_rewrite.spelling.transforms import Edges, with_odometry
from multibot_rewrite.spelling.ways import WAYS
from multibot_rewrite.system.environment import settings
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import System

# Below the ports that a system gives away by itself.
_DOMAINS = 100
# What a look finds where it saw too little: no robot, no node, no endpoint, no transform.
_ABSENT = {"MG101", "MG102", "MG109", "MG406", "MG208"}


def run(options: argparse.Namespace) -> int:
    """Start the stubs, look, compare, sum up; returns the exit code."""
    _check_use(options)
    made = fleet.build(options)
    # Nodes that stand in for others have none of their parameters.
    plan, table = expected(made)._replace(parameters=()), fleet.findings(options, made)
    edges, added = _edges(made)
    nodes = [*stub_nodes(made.table, edges, _left_out(options)), *bridge_stub(plan.topics)]
    environ = stage(options.domain)
    with _running(split_over_processes(nodes), environ) as replaced:
        for it in added:
            note(options, f"note: {it} comes from a driver or simulator; the rehearsal sends it")
        note(options, f"{plural(len(nodes), 'node')} in domain {environ['ROS_DOMAIN_ID']}")
        plan = with_substitutes(plan, replaced)
        request = Request(options.timeout or live.LOOK_SECONDS, substitutes=True)
        graph = _without_places(_look(request, environ, plan))
    if options.save_snapshot:
        write_files(options, [(options.save_snapshot, to_json(graph))])
    _note_substitutes(options, replaced)
    return conclude(options, plan, graph, table)


def _left_out(options: argparse.Namespace) -> Sequence[str]:
    """The ways of which no rules are given."""
    return WAYS if EVERY_WAY in options.without_rules else list(options.without_rules)


def _check_use(options: argparse.Namespace) -> None:
    fleet.check_use(options, printed=False)
    pictures.check(options)
    if options.save_snapshot:
        check_target(options.save_snapshot, [options.input], "--save-snapshot")
        check_folder(options.save_snapshot)


def _look(request: Request, environ: dict[str, str], plan: System) -> System:
    """What is on the graph. The nodes do run: a look that only lacks something was too early, as on a
    busy machine where messages of the discovery were lost. So there is a second one."""
    graph = observe(request, environ)
    codes = {finding.code for finding in check(plan, graph)}
    return observe(request, environ) if codes and codes <= _ABSENT else graph


def _without_places(graph: System) -> System:
    """Stubs send which frame hangs on which, not where, and all with one quality of service."""
    ends = tuple(it._replace(qos=None) for it in graph.ends)
    return graph._replace(ends=ends, edges=tuple(it._replace(transform=()) for it in graph.edges))


def _edges(made: Fleet) -> tuple[Edges, list[str]]:
    """What is sent, and which of it no node of the stacks sends: the odometry of a driver."""
    edges, names = made.edges, []
    for robot in made.inventories:
        edges, added = with_odometry(edges, robot, made.naming)
        if added:
            names.append(f"{added} of {robot}")
    return edges, names


def stage(domain: int | None) -> dict[str, str]:
    """An environment where nobody else is: this machine only, the domain that the environment names
    where it is free, else one that is hardly used."""
    environ = {k: v for k, v in os.environ.items() if k not in _ELSEWHERE}
    asked = settings(os.environ).domain if os.environ.get("ROS_DOMAIN_ID") else None
    free = asked is not None and participants_here(asked) == 0
    other = asked if free else 1 + os.getpid() % _DOMAINS
    own = other if domain is None else domain
    return {**environ, "ROS_DOMAIN_ID": str(own), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


_ELSEWHERE = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS_LOCALHOST_ONLY")


@contextmanager
def _running(processes: list[list[StubNode]], environ: dict[str, str]) -> Iterator[dict[str, str]]:
    """The stub nodes in the graph; yields which types are replaced by which."""
    with ExitStack() as stack:
        children = [
            stack.enter_context(running(RUN_STUBS, to_text(to_order(nodes)), environ))
            for nodes in processes
        ]
        replaced: dict[str, str] = {}
        for child in children:
            replaced |= json.loads(child.next_message() or b"{}")
        yield replaced


def _note_substitutes(options: argparse.Namespace, replaced: dict[str, str]) -> None:
    if replaced:
        what = "type is" if len(replaced) == 1 else "types are"
        types = shorten(sorted(replaced), SEVERAL)
        text = f"{len(replaced)} {what} not installed here and replaced by others: {types}"
        note(options, f"note: {text}; this does not change the names")
