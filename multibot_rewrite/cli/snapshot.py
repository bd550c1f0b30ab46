"""``multibot snapshot``: the live ROS graph as a table, or as JSON for later."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator

from multibot_rewrite.cli import live
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.tables import Grid, print_report
from multibot_rewrite.graph.live.child import RosUnusable, observe
from multibot_rewrite.graph.live.request import Request
from multibot_rewrite.graph.snapshot import QUIET, Snapshot, incomplete, to_json
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

MORE = """\
The graph is settled when all of --expect are seen, or nothing changed for 3.5 s.
exit codes: 0 done; 2 wrong use; 3 something may be missing in the view, which is written all the
same; 4 rclpy or its RMW is missing or does not start
"""
COLUMNS = (
    ("publishes", TOPIC, PUBLISHES),
    ("subscribes", TOPIC, SUBSCRIBES),
    ("serves", SERVICE, SERVES),
    ("calls", SERVICE, CALLS),
    ("actions", ACTION, SERVES),
)


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument(
        "-o", dest="output", metavar="FILE", help="write JSON (- is standard output)"
    )
    parser.add_argument(
        "--expect",
        nargs="+",
        type=live.full_name,
        default=[],
        metavar="NODE",
        help="/robot1/node ...",
    )
    parser.add_argument(
        "--topic",
        nargs="+",
        type=live.full_name,
        default=[],
        metavar="TOPIC",
        help="tell its QoS too",
    )
    live.options(parser)


def run(options: argparse.Namespace) -> int:
    """Look, tell, say what is to be known about the view; returns the exit code."""
    request = Request(
        options.timeout or live.LOOK_SECONDS, tuple(options.expect), tuple(options.topic)
    )
    try:
        snapshot = observe(request, live.environ(options.domain))
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return live.NO_ROS
    _deliver(snapshot, options.output)
    for caveat in snapshot.environment.caveats:
        say(f"{'incomplete' if caveat.incomplete else 'note'}: {caveat.message}", PROGRAM)
    return live.INCONCLUSIVE if incomplete(snapshot) else DONE


def _deliver(snapshot: Snapshot, output: str | None) -> None:
    if output is None:
        print_report(report(snapshot))
    elif output == "-":
        print_bytes(to_json(snapshot))
    else:
        write_all([(output, to_json(snapshot))])
        say(_headline(snapshot), PROGRAM)


def report(snapshot: Snapshot) -> Iterator[str | Grid]:
    """What is printed: how it was looked, a row a node, a row a tf topic."""
    yield _headline(snapshot)
    short = _short_processes(snapshot)
    counts = Counter((end.node, end.role, end.kind) for end in snapshot.endpoints)
    rows = [(node.name, short[node.process], *_cells(counts, node.name)) for node in snapshot.nodes]
    if rows:
        yield ""
        yield Grid(("node", "process", *(column for column, _, _ in COLUMNS)), rows)
    heard = Counter((frame.topic, frame.publishers) for frame in snapshot.frames)
    if heard:
        yield ""
        tf = [(topic, str(times), ", ".join(who)) for (topic, who), times in sorted(heard.items())]
        yield Grid(("tf topic", "frames", "publishers"), tf)


def _cells(counts: Counter[tuple[str, str, str]], node: str) -> Iterator[str]:
    for _, kind, role in COLUMNS:
        yield str(counts[node, role, kind])


def _short_processes(snapshot: Snapshot) -> dict[str, str]:
    """Small numbers in place of the process groups; nothing where the group is not known."""
    groups = sorted({node.process for node in snapshot.nodes} - {""})
    return {"": "", **{group: str(number) for number, group in enumerate(groups, 1)}}


def _headline(snapshot: Snapshot) -> str:
    around = snapshot.environment
    nodes, many = len(snapshot.nodes), around.participants
    why = "no change any more" if around.settled == QUIET else around.settled
    peers = f", peers {' '.join(around.static_peers)}" if around.static_peers else ""
    return (
        f"{nodes} node{'s' * (nodes != 1)} in {many} participant{'s' * (many != 1)}"
        f" after {around.seconds:.1f} s ({why});"
        f" domain {around.domain}, range {around.range}{peers}, {around.rmw}"
    )
