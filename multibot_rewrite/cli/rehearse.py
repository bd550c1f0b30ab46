"""``multibot rehearse``: the plan of a fleet tried on a real graph, without robot or simulator."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from multibot_rewrite.cli import fleet, live, pictures
from multibot_rewrite.cli.check import conclude
from multibot_rewrite.cli.output import note, say, write_files
from multibot_rewrite.cli.process import PROGRAM
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleets.fleet import Fleet, expected
from multibot_rewrite.graph.environment import listed
from multibot_rewrite.graph.live.child import PLAY, RosUnusable, observe, running
from multibot_rewrite.graph.live.request import Request, to_text
from multibot_rewrite.graph.rehearsal import (
    Actor,
    as_played,
    cast,
    dealt,
    to_order,
)
from multibot_rewrite.graph.snapshot import Snapshot, to_json
from multibot_rewrite.graph.transforms import STATE_PUBLISHER, Edges, with_odometry
from multibot_rewrite.plural import plural

# Below the ports that a system gives away by itself.
_DOMAINS = 100


def run(options: argparse.Namespace) -> int:
    """Start the stubs, look, compare, sum up; returns the exit code."""
    _check_use(options)
    made = fleet.build(options, also=[STATE_PUBLISHER])
    table = fleet.findings(options, made)
    actors = list(cast(made.table, _edges(options, made), not options.without_rules))
    environ = stage(options.domain)
    try:
        with _playing(dealt(actors), environ) as replaced:
            note(options, f"{plural(len(actors), 'node')} in domain {environ['ROS_DOMAIN_ID']}")
            graph = _look(Request(options.timeout or live.LOOK_SECONDS, stand_ins=True), environ)
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return live.NO_ROS
    if options.save_snapshot:
        write_files(options, [(options.save_snapshot, to_json(graph))])
    _note_replaced(options, replaced)
    return conclude(options, as_played(expected(made), replaced), graph, table)


def _check_use(options: argparse.Namespace) -> None:
    fleet.check_use(options, printed=False)
    pictures.check(options)
    if options.save_snapshot:
        check_target(options.save_snapshot, [options.input], "--save-snapshot")
        check_folder(options.save_snapshot)


def _look(request: Request, environ: dict[str, str]) -> Snapshot:
    """What is on the graph; nodes were started, so a look that sees none was blind: once more."""
    graph = observe(request, environ)
    return graph if graph.nodes else observe(request, environ)


def _edges(options: argparse.Namespace, made: Fleet) -> Edges:
    """What is sent, with the odometry of a driver that no stack names."""
    edges = made.edges
    for robot in made.inventories:
        edges, added = with_odometry(edges, robot, made.naming)
        if added:
            note(options, f"note: no known node of {robot} sends {added}; it is sent in its place")
    return edges


def stage(domain: int | None) -> dict[str, str]:
    """An environment where nobody else is: this machine only, a domain that is hardly used."""
    environ = {k: v for k, v in os.environ.items() if k not in _ELSEWHERE}
    own = 1 + os.getpid() % _DOMAINS if domain is None else domain
    return {**environ, "ROS_DOMAIN_ID": str(own), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


_ELSEWHERE = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS_LOCALHOST_ONLY")


@contextmanager
def _playing(hands: list[list[Actor]], environ: dict[str, str]) -> Iterator[dict[str, str]]:
    """The actors on the graph, and which types stand in for which."""
    with ExitStack() as stack:
        children = [
            stack.enter_context(running(PLAY, to_text(to_order(hand)), environ)) for hand in hands
        ]
        replaced: dict[str, str] = {}
        for child in children:
            replaced |= json.loads(child.next() or b"{}")
        yield replaced


def _note_replaced(options: argparse.Namespace, replaced: dict[str, str]) -> None:
    if replaced:
        missing = "type is" if len(replaced) == 1 else "types are"
        text = f"{len(replaced)} {missing} not installed here and replaced by a stand-in"
        note(options, f"note: {text}: {listed(sorted(replaced))}; the names are tried all the same")
