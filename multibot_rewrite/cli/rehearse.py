"""``multibot rehearse``: the plan of a fleet tried on a real graph, without robot or simulator."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from multibot_rewrite.cli import fleet, live, pictures
from multibot_rewrite.cli.check import conclude
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.walk import check_folder
from multibot_rewrite.fleets.fleet import Fleet, expected
from multibot_rewrite.graph.live.child import RUN_STUBS, RosUnusable, observe, running
from multibot_rewrite.graph.live.request import Request, to_text
from multibot_rewrite.graph.rehearsal import (
    StubNode,
    split_over_processes,
    stub_nodes,
    to_order,
    with_substitutes,
)
from multibot_rewrite.graph.snapshot import Snapshot, to_json
from multibot_rewrite.graph.transforms import STATE_PUBLISHER, Edges, with_odometry
from multibot_rewrite.graph.wording import SEVERAL, shorten

MORE = """\
Starts the nodes of each robot's plugins and stack with the names of their code and hands rcl the
rules of multibot remap; then looks at the graph as multibot check does. A type that is not installed
has a stand-in. robot_state_publisher is added where no stack has it. -o writes the snapshot.
examples:
  multibot rehearse rover.urdf robot1 robot2 --stack nav2 --layout frames-per-robot
  multibot rehearse rover.urdf robot1 robot2 --stack nav2 --report nav2.html
  multibot rehearse rover.urdf robot1 robot2 --stack nav2 --without-rules    what would happen otherwise
exit codes: 0 as planned; 1 something leaks or is missing; 2 wrong use or unreadable input; 3
inconclusive; 4 rclpy or its RMW is missing or does not start
"""
# Below the ports that a system gives away by itself.
_DOMAINS = 100


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    fleet.options(parser)
    live.options(parser)
    pictures.options(parser)
    parser.add_argument(
        "--without-rules", action="store_true", help="give rcl no rules but namespace and node name"
    )


def run(options: argparse.Namespace) -> int:
    """Play, look, compare, sum up; returns the exit code."""
    pictures.check(options)
    if options.output:
        check_folder(options.output)
    made = fleet.build(options, also=[STATE_PUBLISHER])
    nodes = list(stub_nodes(made.table, _edges(made), not options.without_rules))
    environ = stage(options.domain)
    try:
        with _running(split_over_processes(nodes), environ) as replaced:
            say(f"{len(nodes)} nodes in domain {environ['ROS_DOMAIN_ID']}", PROGRAM)
            graph = _look(Request(options.timeout or live.LOOK_SECONDS, substitutes=True), environ)
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return live.NO_ROS
    if options.output:
        write_all([(options.output, to_json(graph))])
    _report_substitutes(replaced)
    code = conclude(options, with_substitutes(expected(made), replaced), graph)
    return code if code != DONE else fleet.verdict(made)


def _look(request: Request, environ: dict[str, str]) -> Snapshot:
    """What is on the graph; nodes were started, so a look that sees none was blind: once more."""
    graph = observe(request, environ)
    return graph if graph.nodes else observe(request, environ)


def _edges(made: Fleet) -> Edges:
    """What is sent, with the odometry of a driver that no stack names."""
    edges = made.edges
    for robot in made.inventories:
        edges, added = with_odometry(edges, robot, made.naming)
        if added:
            say(f"note: no node of {robot} is known to send {added}; it is sent for it", PROGRAM)
    return edges


def stage(domain: int | None) -> dict[str, str]:
    """An environment where nobody else is: this machine only, a domain that is hardly used."""
    environ = {k: v for k, v in os.environ.items() if k not in _ELSEWHERE}
    own = 1 + os.getpid() % _DOMAINS if domain is None else domain
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


def _report_substitutes(replaced: dict[str, str]) -> None:
    if replaced:
        what = "type is" if len(replaced) == 1 else "types are"
        types = shorten(sorted(replaced), SEVERAL)
        text = f"{len(replaced)} {what} not installed here and replaced by others: {types}"
        say(f"note: {text}; this does not change the names", PROGRAM)
