# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot``: the live ROS graph as a table, as JSON for later, or a file of its nodes."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Iterator

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import learn, live
from multibot_rewrite.cli.output import STANDARD, deliver, note, say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.tables import Grid, deliver_report
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.rosgraph.writing import to_yaml
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.reach import machines
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    QUIET,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    ZENOH,
    Caveat,
    Environment,
    System,
    answering,
    clocks,
    incomplete,
)

ROSGRAPH = "rosgraph"
COLUMNS = (
    ("publishes", TOPIC, PUBLISHES),
    ("subscribes", TOPIC, SUBSCRIBES),
    ("serves", SERVICE, SERVES),
    ("calls", SERVICE, CALLS),
    ("actions", ACTION, SERVES),
)


def run(options: argparse.Namespace) -> int:
    """Look, write what is seen and what may be missing; returns the exit code."""
    describes = _check_use(options)
    request = Request(options.timeout or live.LOOK_SECONDS, tuple(options.expect))
    snapshot = live.with_states(options, live.graph(options, request))
    if describes:
        return learn.write(options, snapshot)
    if options.output is None and options.form is None:
        deliver_report(options, report(snapshot))
    else:
        deliver(options, to_yaml(snapshot) if options.form == ROSGRAPH else to_json(snapshot))
        note(options, _headline(snapshot))
    for caveat in snapshot.environment.caveats:
        _remark(options, caveat)
    return live.INCONCLUSIVE if incomplete(snapshot) else DONE


def _check_use(options: argparse.Namespace) -> bool:
    """Are nodes to be described? Raises UsageError."""
    live.check_source(options)
    for name in ("expect", "timeout", "domain"):
        if (options.snapshot or options.bag) and getattr(options, name) not in (None, []):
            raise UsageError(f"--{name} is for the live graph, leave out --from")
    if options.output not in (None, STANDARD):
        check_folder(options.output)
        check_target(options.output, options.snapshot)
    return learn.is_asked(options)


def _remark(options: argparse.Namespace, caveat: Caveat) -> None:
    if caveat.incomplete:
        say(f"incomplete: {caveat.message}", PROGRAM)
    else:
        note(options, f"note: {caveat.message}")


def report(snapshot: System) -> Iterator[str | Grid]:
    """What is printed: how it was looked, a row a node, a tf topic, a header, a node's answer."""
    yield _headline(snapshot)
    short = _short_processes(snapshot)
    counts = Counter((end.node, end.role, end.kind) for end in snapshot.ends)
    rows = [(node.name, short[node.process], *_cells(counts, node.name)) for node in snapshot.nodes]
    if rows:
        yield ""
        yield Grid(("node", "process", *(column for column, _, _ in COLUMNS)), rows)
    heard = Counter((frame.topic, frame.publishers) for frame in snapshot.edges)
    if heard:
        yield ""
        tf = [(topic, str(times), ", ".join(who)) for (topic, who), times in sorted(heard.items())]
        yield Grid(("tf topic", "frames", "publishers"), tf)
    if framed := [it[:2] for it in snapshot.heard if not (it.joints or it.topic == CLOCK)]:
        yield ""
        yield Grid(("message on", "frame_id"), framed)
    said = answering(snapshot)
    if said:
        yield ""
        answers = [*_state_rows(snapshot, said)]
        yield Grid(("node", "state", "use_sim_time", "controllers"), answers)


def _state_rows(snapshot: System, nodes: Iterable[str]) -> Iterator[tuple[str, ...]]:
    states = {it.name: it.lifecycle for it in snapshot.nodes}
    timed = {node: str(it).lower() for node, it in clocks(snapshot).items()}
    for node in sorted(nodes):
        own = (it for it in snapshot.controllers if it.manager == node)
        listed = ", ".join(f"{it.name} ({it.state})" for it in own)
        yield node, states.get(node, ""), timed.get(node, ""), listed


def _cells(counts: Counter[tuple[str, str, str]], node: str) -> Iterator[str]:
    for _, kind, role in COLUMNS:
        yield str(counts[node, role, kind])


def _short_processes(snapshot: System) -> dict[str, str]:
    """Small numbers in place of the process groups; nothing where the group is not known."""
    groups = sorted({node.process for node in snapshot.nodes} - {""})
    return {"": "", **{group: str(number) for number, group in enumerate(groups, 1)}}


def _headline(snapshot: System) -> str:
    around = snapshot.environment
    nodes, many = len(snapshot.nodes), around.participants
    seen = len(machines(snapshot))
    where = f" on {seen} machines" if seen > 1 else ""
    why = "no change any more" if around.settled == QUIET else around.settled
    return (
        f"{plural(nodes, 'node')} in {plural(many, 'participant')}{where}"
        f" after {around.seconds:.1f} s ({why});"
        f" domain {around.domain}{_reach(around)}, {around.rmw}"
    )


def _reach(around: Environment) -> str:
    """How the look was made: Zenoh has a router in place of a discovery range."""
    router = f", router {around.discovery_server}" if around.rmw == ZENOH else ""
    range_ = f", range {around.range}" if around.range else ""
    peers = f", peers {' '.join(around.static_peers)}" if around.static_peers else ""
    return f"{router}{range_}{peers}"
