# SPDX-License-Identifier: Apache-2.0
"""Learned nodes as NoDL documents, one for each node, checked by reading them.

A document has no helper nodes, conditions or several types: helpers' endpoints are the node's own, two
types are two entries.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.nodl.document import POLICIES
from multibot_rewrite.knowledge.nodl.writing import DEFAULT, UNKNOWN_QOS, NodlFile, document_of
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint
from multibot_rewrite.live.learning.learn import EVERY_NODE, LearnedNode
from multibot_rewrite.system.records import TOPIC, End, Qos, System

KEEP_LAST = "KEEP_LAST"


def to_nodl(
    node: LearnedNode, graph: System, namespace: str, library: NodeLibrary, json: bool = False
) -> NodlFile:
    """The document of a learned node; raises ProofError if reading it gives something else.

    ``namespace`` is the robot's. QoS is as seen; what a graph does not show is SYSTEM_DEFAULT.
    """
    usual = {(it.role, it.name) for it in library.parts[EVERY_NODE]} | {("subscribes", CLOCK)}
    ends = [it for it in node.facts.endpoints if (it.role, it.name) not in usual]
    written = [it for end in ends for it in _entries(end)]
    seen = _Seen(graph, node, namespace.rstrip("/"))
    written += [it for end in ends if end.transport for it in seen.transports(end)]
    description = f"Seen as {node.seen} in a running graph, by multibot snapshot"
    return document_of(node.facts.name, description, written, lambda it: _qos(seen.qos(it)), json)


class _Seen(NamedTuple):
    """The graph in which a node was seen, below the namespace ``base``."""

    graph: System
    node: LearnedNode
    base: str

    def ends(self, end: Endpoint, suffix: str = "") -> list[End]:
        """What the graph has of an endpoint, by the names that it may be seen under."""
        above, _, own = self.node.facts.name.rpartition("/")
        full = expand(end.name, f"/{above}", own) + suffix
        names = (self.base + full, full)
        found = [it for it in self.graph.ends if it.name in names and it.role == end.role]
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


def _qos(qos: Qos | None) -> dict[str, object]:
    if qos is None:
        return dict(UNKNOWN_QOS)
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
