# SPDX-License-Identifier: Apache-2.0
"""Learned nodes as a file of nodes and node sets, or as a NoDL document each, checked by reading them.

A NoDL document has no helper nodes, conditions or several types: helpers' endpoints are the node's own,
two types are two entries.
"""

import math
from collections.abc import Iterator, Sequence
from textwrap import wrap
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.model import ProofError, UsageError
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.node_library import NodeLibrary, extend, nodes_of_set
from multibot_rewrite.knowledge.nodl.document import POLICIES
from multibot_rewrite.knowledge.nodl.writing import DEFAULT, UNKNOWN_QOS, NodlFile, document_of
from multibot_rewrite.knowledge.records import TRANSPORTS, Endpoint
from multibot_rewrite.live.learning.learn import EVERY_NODE, LearnedNode
from multibot_rewrite.system.records import ROLES, TOPIC, End, Qos, System

HEAD = """\
# Nodes as they were seen in a running graph, written by multibot snapshot for --nodes.
# The code and the remap rules of a running node are not visible, only the resulting names:
#   /x   may be x or /x in the code: the rule for /x is right for both, in every layout
#   x    was seen in the node's namespace; if the code has /x and a rule remapped it, write /x
#   ~/x  was seen below the node's name; if the code does not have ~/x, write /node/x
# Not visible: conditions (when), parameters, frames, nodes that serve all robots (shared: true).
"""
WIDTH = 100
_NO_WRAP = 1 << 30


def to_yaml(learned: Sequence[LearnedNode], node_set: str, library: NodeLibrary) -> str:
    """Return the text of a file with nodes and a node set; raises ProofError if it reads otherwise."""
    text = "".join(f"{line}\n" for line in _file_lines(learned, node_set))
    facts = tuple(node.facts for node in learned)
    try:
        found = nodes_of_set(extend(library, text, node_set), node_set)
    except UsageError as error:
        raise ProofError(f"the learned nodes cannot be read back: {error}") from None
    # Frames are those of known parameters: the file says nothing of either.
    read = tuple(it._replace(frames=()) for it in found)
    if read != facts:
        wrong = ", ".join(node.name for node in facts if node not in read)
        raise ProofError(f"the learned nodes are read back differently: {wrong}")
    return text


def _file_lines(learned: Sequence[LearnedNode], node_set: str) -> Iterator[str]:
    yield from HEAD.splitlines()
    yield from _comment_lines(f"Of: {' '.join(node.seen for node in learned)}", "")
    yield from ("", "nodes:")
    for node in learned:
        facts = node.facts
        for remark in node.remarks:
            yield from _comment_lines(remark, "  ")
        yield f"  {_scalar(facts.name)}:"
        yield f"    note: {_scalar(facts.note)}"
        yield from ["    apart: true"] * facts.apart
        if node.parts:
            yield f"    with: {_flow(list(node.parts))}"
        for role in ROLES:
            own = [end for end in node.own if end.role == role]
            if own:
                yield f"    {role}:"
            yield from (f"      {_scalar(end.name)}: {_value(end)}" for end in own)
        yield ""
    yield from ("node_sets:", f"  {_scalar(node_set)}:", "    about: Learned from a running graph")
    yield "    nodes:"
    yield from (f"      - {_scalar(node.facts.name)}" for node in learned)


def _value(end: Endpoint) -> str:
    """Return an endpoint's type alone, or all that is known of it."""
    fields = {
        "type": end.type,
        "also": list(end.also),
        "transport": end.transport,
        "when": end.when,
        "helper": end.helper,
        "note": end.note,
    }
    known = {key: value for key, value in fields.items() if value}
    return _scalar(end.type) if list(known) == ["type"] else _flow(known)


def _scalar(text: str) -> str:
    """Return a text as YAML."""
    import yaml

    return str(yaml.safe_dump(text, width=_NO_WRAP)).removesuffix("...\n").rstrip("\n")


def _flow(value: object) -> str:
    """Return a value as YAML in one line."""
    import yaml

    dumped = yaml.safe_dump(value, width=_NO_WRAP, default_flow_style=True, sort_keys=False)
    return str(dumped).rstrip("\n")


def _comment_lines(text: str, indent: str) -> list[str]:
    lead = f"{indent}# "
    return wrap(
        text, WIDTH, initial_indent=lead, subsequent_indent=f"{lead}  ", break_long_words=False
    )


KEEP_LAST = "KEEP_LAST"


def to_nodl(
    node: LearnedNode, graph: System, namespace: str, library: NodeLibrary, json: bool = False
) -> NodlFile:
    """Return the NoDL document of a learned node; raises ProofError if reading it gives another one."""
    usual = {(it.role, it.name) for it in library.parts[EVERY_NODE]} | {("subscribes", CLOCK)}
    ends = [it for it in node.facts.endpoints if (it.role, it.name) not in usual]
    # One entry for each of its types.
    written = [it._replace(type=one, also=()) for it in ends for one in (it.type, *it.also)]
    seen = _Seen(graph, node, namespace.rstrip("/"))
    written += [it for end in ends if end.transport for it in seen.transports(end)]
    description = f"Seen as {node.seen} in a running graph, by multibot snapshot"
    return document_of(
        node.facts.name, description, written, lambda it: _nodl_qos(seen.qos(it)), json
    )


class _Seen(NamedTuple):
    """The graph in which a node was seen, below the namespace ``base``."""

    graph: System
    node: LearnedNode
    base: str

    def ends(self, end: Endpoint, suffix: str = "") -> list[End]:
        """Return what the graph has of an endpoint, by the names that it may be seen under."""
        above, _, own = self.node.facts.name.rpartition("/")
        full = expand(end.name, f"/{above}", own) + suffix
        names = (self.base + full, full)
        found = [it for it in self.graph.ends if it.name in names and it.role == end.role]
        found.sort(key=lambda it: (it.node != self.node.seen, it.name != names[0]))
        return found

    def qos(self, end: Endpoint) -> Qos | None:
        """Return the QoS of an endpoint, if the graph shows it."""
        return next((it.qos for it in self.ends(end) if it.qos), None)

    def transports(self, end: Endpoint) -> Iterator[Endpoint]:
        """Yield the topics of image_transport that an image has."""
        for transport in TRANSPORTS:
            for found in self.ends(end, f"/{transport}")[:1]:
                yield Endpoint(TOPIC, end.role, f"{end.name}/{transport}", found.type)


def _nodl_qos(qos: Qos | None) -> dict[str, object]:
    if qos is None:
        return dict(UNKNOWN_QOS)
    found: dict[str, object] = {"history": DEFAULT, "reliability": DEFAULT}
    # Fast DDS does not announce the depth to other processes.
    if qos.history == KEEP_LAST and qos.depth > 0:
        found = {"history": KEEP_LAST, "depth": qos.depth, "reliability": DEFAULT}
    for key in ("history", "reliability", "durability", "liveliness"):
        word = getattr(qos, key)
        if word in POLICIES[key] and word != KEEP_LAST:
            found[key] = word
    for key in ("deadline", "lifespan", "liveliness_lease_duration"):
        seconds = getattr(qos, key)
        if seconds > 0 and not math.isinf(seconds):
            found[f"{key}_ns"] = round(seconds * 1e9)
    return found
