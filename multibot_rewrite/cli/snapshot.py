# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot``: the live ROS graph as a table, as JSON for later, or a file of its nodes."""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base import editors
from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import facts_of_release, release_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import live
from multibot_rewrite.cli.output import STANDARD, deliver, goes_to_file, note, say, write_files
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.tables import Grid, deliver_report
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.nodl.lookup import SUFFIXES
from multibot_rewrite.knowledge.nodl.writing import NodlFile, file_name
from multibot_rewrite.live.learning.choosing import choose_nodes, helpers_without_owner, left_out
from multibot_rewrite.live.learning.learn import LearnedNode, learn
from multibot_rewrite.live.learning.nodes_file import to_nodl, to_yaml as to_nodes_yaml
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.rosgraph.writing import to_yaml
from multibot_rewrite.system.environment import machines
from multibot_rewrite.system.json import to_json
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
    System,
    answering,
    clocks,
    doubts,
    incomplete,
)

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
        return write_nodes(options, snapshot)
    if options.output is None and options.output_kind is None:
        deliver_report(options, report(snapshot))
    else:
        deliver(
            options, to_yaml(snapshot) if options.output_kind == "rosgraph" else to_json(snapshot)
        )
        note(options, _headline(snapshot))
    for caveat in snapshot.environment.caveats:
        _remark(options, caveat)
    return live.INCONCLUSIVE if incomplete(snapshot) else DONE


def _check_use(options: argparse.Namespace) -> bool:
    """Return whether nodes are to be described; raises UsageError."""
    live.check_source(options)
    for name in ("expect", "timeout", "domain"):
        if (options.snapshot or options.bag) and getattr(options, name) not in (None, []):
            raise UsageError(f"--{name} is for the live graph, leave out --from")
    if options.output not in (None, STANDARD):
        check_folder(options.output)
        check_target(options.output, options.snapshot)
    return is_asked(options)


def _remark(options: argparse.Namespace, caveat: Caveat) -> None:
    """Print a limitation of the snapshot."""
    if caveat.incomplete:
        say(f"incomplete: {caveat.message}", PROGRAM)
    else:
        note(options, f"note: {caveat.message}")


def report(snapshot: System) -> Iterator[str | Grid]:
    """Yield lines and tables of a snapshot: nodes, tf topics, headers, answers of nodes."""
    yield _headline(snapshot)
    # Small numbers in place of the process groups; nothing where the group is not known.
    groups = sorted({node.process for node in snapshot.nodes} - {""})
    short = {"": "", **{group: str(number) for number, group in enumerate(groups, 1)}}
    counts = Counter((end.node, end.role, end.kind) for end in snapshot.ends)
    rows = [
        (
            it.name,
            short[it.process],
            *(str(counts[it.name, role, kind]) for _, kind, role in COLUMNS),
        )
        for it in snapshot.nodes
    ]
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
    """Yield a row for each node: name, state, use_sim_time, controllers."""
    states = {it.name: it.lifecycle for it in snapshot.nodes}
    timed = {node: str(it).lower() for node, it in clocks(snapshot).items()}
    for node in sorted(nodes):
        own = (it for it in snapshot.controllers if it.manager == node)
        listed = ", ".join(f"{it.name} ({it.state})" for it in own)
        yield node, states.get(node, ""), timed.get(node, ""), listed


def _headline(snapshot: System) -> str:
    """Return one line about what was seen, and for how long."""
    around = snapshot.environment
    nodes, many = len(snapshot.nodes), around.participants
    seen = len(machines(snapshot))
    where = f" on {seen} machines" if seen > 1 else ""
    why = "no change any more" if around.settled == QUIET else around.settled
    # Zenoh has a router in place of a discovery range.
    router = f", router {around.discovery_server}" if around.rmw == ZENOH else ""
    range_ = f", range {around.range}" if around.range else ""
    peers = f", peers {' '.join(around.static_peers)}" if around.static_peers else ""
    return (
        f"{plural(nodes, 'node')} in {plural(many, 'participant')}{where}"
        f" after {around.seconds:.1f} s ({why});"
        f" domain {around.domain}{router}{range_}{peers}, {around.rmw}"
    )


NODES, NODL = "nodes", "nodl"


def is_asked(options: argparse.Namespace) -> bool:
    """Return whether nodes are to be described, not a snapshot written. Raises UsageError."""
    if options.output_kind in (NODES, NODL) or is_nodl(options):
        return True
    given = [it for it in ("node", "namespace", "node_set", "distro") if getattr(options, it)]
    if given:
        option = given[0].replace("_", "-")
        raise UsageError(f"--{option} is for a description of nodes: add --output-kind {NODES}")
    return False


def write_nodes(options: argparse.Namespace, graph: System) -> int:
    """Describe the nodes of a graph and write that; return the exit code."""
    doubtful = doubts(graph)
    for caveat in doubtful:
        say(f"incomplete: {caveat.message}", PROGRAM)
    namespace = options.namespace or "/"
    names = choose_nodes(graph, options.node, namespace)
    release = release_here(options.distro)
    library = built_in(release)
    learned = learn(graph, names, namespace, library)
    remarks = [*_notes(graph, learned, options.namespace, bool(options.node))]
    as_nodl = is_nodl(options)
    node_set = options.node_set or "learned"
    if as_nodl:
        in_json = (options.output or "").endswith(".json")
        made = [to_nodl(it, graph, namespace, library, in_json) for it in learned]
        remarks += _write_nodl(options, made)
    else:
        deliver(options, to_nodes_yaml(learned, node_set, library).encode(), editors.NODES)
    for remark in remarks:
        note(options, f"note: {remark}")
    shape = "NoDL" if as_nodl else f"node set {node_set}"
    what = f"{plural(len(learned), 'node')} learned as {shape}"
    note(options, f"{what}{facts_of_release(release)}")
    return live.INCONCLUSIVE if doubtful else DONE


def is_nodl(options: argparse.Namespace) -> bool:
    """Return whether the result is NoDL, by its kind or by the name of the file. Raises UsageError."""
    named = (options.output or "").endswith(SUFFIXES)
    if named and options.output_kind not in (None, NODL):
        form = f"--output-kind {options.output_kind}"
        raise UsageError(f"{options.output} is the name of a NoDL file; leave out {form}")
    return named or options.output_kind == NODL


def _write_nodl(options: argparse.Namespace, found: Sequence[NodlFile]) -> Iterator[str]:
    """Write NoDL documents to a file or folder; yield what is left out."""
    if not goes_to_file(options) or options.output.endswith(SUFFIXES):
        if len(found) > 1:
            hint = "name one with --node, or a folder with -o"
            raise UsageError(f"a NoDL file is for one node, here are {len(found)}; {hint}")
        deliver(options, found[0].text.encode())
    else:
        items = [(os.path.join(options.output, file_name(it.node)), it.text) for it in found]
        write_files(options, [(path, text.encode()) for path, text in items])
    for it in found:
        if it.left_out:
            yield f"{it.node}: NoDL has no form for {', '.join(it.left_out)}; left out"


def _notes(
    graph: System, learned: Sequence[LearnedNode], namespace: str | None, named: bool
) -> Iterator[str]:
    """Yield what is left out of the description of nodes, and why."""
    for node in learned:
        yield from (f"{node.seen}: {remark}" for remark in node.remarks)
    lost = helpers_without_owner(graph, [node.seen for node in learned])
    if lost:
        yield f"whose helpers these are is not seen, they are left out: {', '.join(lost)}"
    tools = left_out(graph, [node.seen for node in learned], namespace or "/")
    if tools and not named:
        yield f"left out as tools: {', '.join(tools)}; to learn one give its name to --node"
    first = {node.facts.name.partition("/")[0] for node in learned if "/" in node.facts.name}
    if namespace is None and len(first) == 1 and all("/" in node.facts.name for node in learned):
        where = f"/{first.pop()}"
        yield f"all are below {where}; if that is the robot's namespace, add --namespace {where}"
