"""Learned nodes as NoDL documents, one for each node, checked by reading them.

A document has no helper nodes, conditions or several types: helpers' endpoints are the node's own, two
types are two entries.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.learning.folding import CLOCK
from multibot_rewrite.graph.learning.learn import EVERY_NODE, LearnedNode
from multibot_rewrite.graph.snapshot import GraphEndpoint, Qos, Snapshot
from multibot_rewrite.model import ProofError, UsageError
from multibot_rewrite.remap.node_library import NodeLibrary
from multibot_rewrite.remap.nodl.document import GROUP, POLICIES, SECTIONS, parse
from multibot_rewrite.remap.nodl.lookup import SUFFIXES
from multibot_rewrite.remap.records import TOPIC, Endpoint
from multibot_rewrite.remap.targets import TRANSPORTS
from multibot_rewrite.rosnames import expand

DEFAULT = "SYSTEM_DEFAULT"
KEEP_LAST = "KEEP_LAST"
_WIDTH = 100
_NAME = re.compile(r"[A-Za-z]|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]")
_TYPE = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*")


class NodlFile(NamedTuple):
    """A document: the node it is for, its text, and the endpoints that NoDL has no form for."""

    node: str
    text: str
    left_out: tuple[str, ...]


def file_name(node: str) -> str:
    """The file of a node below a folder; a node in its own namespace is in a folder of that name."""
    return f"{node}{SUFFIXES[0]}"


def to_nodl(
    node: LearnedNode, graph: Snapshot, namespace: str, library: NodeLibrary, json: bool = False
) -> NodlFile:
    """The document of a learned node; raises ProofError if reading it gives something else.

    ``namespace`` is the robot's. QoS is as seen; what a graph does not show is SYSTEM_DEFAULT.
    """
    usual = {(it.role, it.name) for it in library.parts[EVERY_NODE]} | {("subscribes", CLOCK)}
    ends = [it for it in node.facts.endpoints if (it.role, it.name) not in usual]
    written = [it for end in ends for it in _entries(end)]
    seen = _Seen(graph, node, namespace.rstrip("/"))
    written += [it for end in ends if end.transport for it in seen.transports(end)]
    fitting = [it for it in written if _fits(it)]
    document: dict[str, object] = {
        "nodl_version": 2,
        "description": f"Seen as {node.seen} in a running graph, by multibot learn",
    }
    for section, (kind, role) in SECTIONS.items():
        own = [it for it in fitting if (it.kind, it.role) == (kind, role)]
        if own:
            document[section] = [_entry(it, seen) for it in own]
    text = _dumped(document, json)
    _check(node.facts.name, text, fitting)
    left = [f"{it.role} {it.name}" for it in written if not _fits(it)]
    return NodlFile(node.facts.name, text, tuple(dict.fromkeys(left)))


class _Seen(NamedTuple):
    """The graph in which a node was seen, below the namespace ``base``."""

    graph: Snapshot
    node: LearnedNode
    base: str

    def ends(self, end: Endpoint, suffix: str = "") -> list[GraphEndpoint]:
        """What the graph has of an endpoint, by the names that it may be seen under."""
        above, _, own = self.node.facts.name.rpartition("/")
        full = expand(end.name, f"/{above}", own) + suffix
        names = (self.base + full, full)
        found = [it for it in self.graph.endpoints if it.name in names and it.role == end.role]
        found.sort(key=lambda it: (it.node != self.node.seen, it.name != names[0]))
        return found

    def qos(self, end: Endpoint) -> Qos | None:
        """Its QoS, where the graph shows it."""
        return next((it.qos for it in self.ends(end) if it.qos), None)

    def transports(self, end: Endpoint) -> Iterator[Endpoint]:
        """The topics of image_transport that an image has."""
        for transport in TRANSPORTS:
            for found in self.ends(end, f"/{transport}")[:1]:
                yield Endpoint(TOPIC, end.role, f"{end.name}/{transport}", found.type)


def _entries(end: Endpoint) -> Iterator[Endpoint]:
    """One endpoint for each of its types."""
    yield from (end._replace(type=it, also=()) for it in (end.type, *end.also))


def _fits(end: Endpoint) -> bool:
    """Has NoDL a form for its name and type? Types of an action's parts have none."""
    group = f"/{GROUP[end.kind]}/"
    return bool(_NAME.fullmatch(end.name) and _TYPE.fullmatch(end.type) and group in end.type)


def _entry(end: Endpoint, seen: _Seen) -> dict[str, object]:
    entry: dict[str, object] = {"name": end.name, "type": end.type}
    if end.kind == TOPIC:
        entry["qos"] = _qos(seen.qos(end))
    return {**entry, "description": end.note} if end.note else entry


def _qos(qos: Qos | None) -> dict[str, object]:
    if qos is None:
        return {"history": DEFAULT, "reliability": DEFAULT}
    history = qos.history if qos.history in POLICIES["history"] else DEFAULT
    # Fast DDS does not announce the depth to other processes.
    if history == KEEP_LAST and qos.depth < 1:
        history = DEFAULT
    found: dict[str, object] = {"history": history}
    if history == KEEP_LAST:
        found["depth"] = qos.depth
    known = qos.reliability in POLICIES["reliability"]
    found["reliability"] = qos.reliability if known else DEFAULT
    for key in ("durability", "liveliness"):
        if getattr(qos, key) in POLICIES[key]:
            found[key] = getattr(qos, key)
    for key in ("deadline", "lifespan", "liveliness_lease_duration"):
        seconds = getattr(qos, key)
        if seconds > 0 and not math.isinf(seconds):
            found[f"{key}_ns"] = round(seconds * 1e9)
    return found


def _dumped(document: dict[str, object], json: bool) -> str:
    if json:
        from json import dumps

        return dumps(document, indent=2) + "\n"
    import yaml

    return str(yaml.safe_dump(document, sort_keys=False, width=_WIDTH, allow_unicode=True))


def _check(node: str, text: str, written: Sequence[Endpoint]) -> None:
    try:
        read = parse(text, file_name(node)).endpoints
    except UsageError as error:
        raise ProofError(f"the learned node cannot be read back: {error}") from None
    if _names(read) != _names(written):
        raise ProofError(f"the learned node {node} is read back differently")


def _names(ends: Iterable[Endpoint]) -> set[tuple[str, str, str, str]]:
    return {(it.kind, it.role, it.name, type_) for it in ends for type_ in (it.type, *it.also)}
