# SPDX-License-Identifier: Apache-2.0
"""Several snapshots of one system, from several machines -> one snapshot. Pure.

A snapshot from one machine may miss what the network hides from it, so a node is in the result if
any snapshot has it."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.system.environment import UNFINISHED, participants, unfinished
from multibot_rewrite.system.records import (
    CHANGING,
    EXPECTED,
    QUIET,
    TIMEOUT,
    ZENOH,
    Caveat,
    Edge,
    End,
    Environment,
    Node,
    System,
)

# Why looks ended, from good to bad.
WORST_LAST = (EXPECTED, QUIET, TIMEOUT, CHANGING)
_MANY = 4
# The fields that systems have side by side.
_HELD = ("nodes", "ends", "edges", "robots", "heard", "descriptions", "parameters", "controllers")


class Look(NamedTuple):
    """A snapshot and the file that it is in."""

    file: str
    snapshot: System


def merged(looks: Sequence[Look]) -> System:
    """Return all that any snapshot has; raises UsageError for those of two domains or middlewares."""
    if len(looks) == 1:
        return looks[0].snapshot
    _check_one_system(looks)
    nodes = tuple(_merged_nodes([look.snapshot.nodes for look in looks]))
    endpoints = tuple(_merged_ends([look.snapshot.ends for look in looks]))
    frames = tuple(_merged_edges(frame for look in looks for frame in look.snapshot.edges))
    heard = {(it.topic, it.frame, it.joints): it for look in looks for it in look.snapshot.heard}
    described = {it.topic: it for look in looks for it in look.snapshot.descriptions}
    around = _merged_environment(looks, nodes, endpoints)
    parameters = {(it.node, it.name): it for look in looks for it in look.snapshot.parameters}
    controllers = {(it.manager, it.name): it for look in looks for it in look.snapshot.controllers}
    return System(
        nodes,
        endpoints,
        frames,
        around,
        tuple(sorted(heard.values())),
        tuple(parameters[it] for it in sorted(parameters)),
        tuple(controllers[it] for it in sorted(controllers)),
        descriptions=tuple(described[it] for it in sorted(described)),
    )


def joined(first: System, *others: System) -> System:
    """Return the first system with the nodes, ends and other records of the others added."""
    every: dict[str, Any] = {
        key: tuple(it for one in (first, *others) for it in getattr(one, key)) for key in _HELD
    }
    return first._replace(**every)


def _check_one_system(looks: Sequence[Look]) -> None:
    """Raise UsageError for snapshots of two domains, or of DDS and Zenoh."""
    first = looks[0]
    around = first.snapshot.environment
    for look in looks[1:]:
        other = look.snapshot.environment
        if other.domain != around.domain:
            where = f"{first.file} is of domain {around.domain}, {look.file} of {other.domain}"
            raise UsageError(
                f"{where}: nodes of two domains never see each other; merge those of one domain"
            )
        if (other.rmw == ZENOH) != (around.rmw == ZENOH):
            where = f"{first.file} is of {around.rmw}, {look.file} of {other.rmw}"
            raise UsageError(
                f"{where}: their nodes never see each other; merge those of one middleware"
            )


def _merged_nodes(looks: Sequence[Sequence[Node]]) -> Iterator[Node]:
    """Yield each node once; two processes with a node of one name are two nodes."""
    best: dict[tuple[str, str], Node] = {}
    most: Counter[tuple[str, str]] = Counter()
    totals: Counter[str] = Counter()
    for nodes in looks:
        most |= Counter((node.name, node.process) for node in nodes)
        totals |= Counter(node.name for node in nodes)
        for node in nodes:
            key = node.name, node.process
            best[key] = Node._make(
                mine or theirs for mine, theirs in zip(best.get(key, node), node, strict=True)
            )
    known = Counter(name for name, process in most.elements() if process)
    for (name, process), times in sorted(most.items()):
        # The process was not known to one look, and is to another.
        new = times if process else min(times, totals[name] - known[name])
        yield from [best[name, process]] * new


def _merged_ends(looks: Sequence[Sequence[End]]) -> list[End]:
    """Return each endpoint once, from the snapshot with most detail about it."""
    best: dict[tuple[str, ...], list[End]] = {}
    for endpoints in looks:
        found = lists_by_key(
            ((it.kind, it.name, it.role, it.node, it.process), it) for it in endpoints
        )
        for key, ends in found.items():
            if key not in best or _amount_of_detail(ends) > _amount_of_detail(best[key]):
                best[key] = ends
    placed = {key[:-1] for key in best if key[-1]}
    kept = [ends for key, ends in best.items() if key[-1] or key[:-1] not in placed]
    return sorted((end for ends in kept for end in ends), key=repr)


def _amount_of_detail(ends: Sequence[End]) -> tuple[int, int, int]:
    """Return how many ends have a QoS, how many a hash, and how many there are: a sort key."""
    known = sum(end.qos is not None for end in ends)
    return known, sum(bool(end.type_hash) for end in ends), len(ends)


def _merged_edges(frames: Iterable[Edge]) -> Iterator[Edge]:
    """Yield each transform once a topic, with the publishers of all snapshots."""
    found = lists_by_key(((frame.topic, frame.parent, frame.child), frame) for frame in frames)
    for (topic, parent, child), same in sorted(found.items()):
        publishers = {node for frame in same for node in frame.publishers}
        static = any(frame.static for frame in same)
        several = any(frame.several for frame in same)
        transform = next((frame.transform for frame in same if frame.transform), ())
        rate = max(frame.rate for frame in same)
        age = min((frame.age for frame in same), key=abs)
        senders = tuple(sorted(publishers))
        yield Edge(child, parent, topic, static, senders, several, transform, rate, age=age)


def _merged_environment(
    looks: Sequence[Look], nodes: Sequence[Node], endpoints: Sequence[End]
) -> Environment:
    around = [look.snapshot.environment for look in looks]
    asked = around[0]
    peers = dict.fromkeys(peer for one in around for peer in one.static_peers)
    every = zip(*((it.range, it.rmw, it.discovery_server) for it in around), strict=True)
    range_, rmw, server = (", ".join(dict.fromkeys(filter(None, it))) for it in every)
    return asked._replace(
        range=range_,
        static_peers=tuple(peers),
        rmw=rmw,
        discovery_server=server,
        super_client=all(one.super_client for one in around),
        participants=participants(endpoints),
        settled=max((one.settled for one in around), key=WORST_LAST.index),
        seconds=max(one.seconds for one in around),
        caveats=(*_merged_caveats(looks), *unfinished(nodes, endpoints, asked.discovery_server)),
    )


def _merged_caveats(looks: Sequence[Look]) -> Iterator[Caveat]:
    """Yield the limitations of each snapshot, without those that are checked again for all of them."""
    files = [look.file for look in looks]
    more = f" and {len(files) - _MANY} more" if len(files) > _MANY else ""
    text = f"made of {len(files)} snapshots: {', '.join(files[:_MANY])}{more}"
    yield Caveat("looks-merged", False, text)
    for look in looks:
        for caveat in look.snapshot.environment.caveats:
            if caveat.code not in UNFINISHED:
                yield caveat._replace(message=f"{look.file}: {caveat.message}")
