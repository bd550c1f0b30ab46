# SPDX-License-Identifier: Apache-2.0
"""Topics that nodes have for certain, and parameters that their stacks set."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts
from multibot_rewrite.spelling.records import Given
from multibot_rewrite.spelling.table import plugin_nodes
from multibot_rewrite.system.records import NOWHERE
from multibot_rewrite.system.words import PLAIN, STAMPED

COMMANDS = (PLAIN, STAMPED)


def topic_of(node: NodeFacts, end: Endpoint) -> str:
    """Return the topic of an end as the robot alone has it, without a slash in front."""
    return (end.remapped or end.name).replace("~", node.name, 1).strip("/")


def topics_of(nodes: Iterable[NodeFacts], role: str, types: Collection[str] = ()) -> list[str]:
    """Return the topics of this role that the nodes have for certain; only those of ``types``, where
    these are given."""
    ends = ((node, it) for node in nodes for it in node.endpoints if it.role == role)
    return [topic_of(*it) for it in ends if not it[1].when and (not types or it[1].type in types)]


def plugins(member: Member) -> Iterator[NodeFacts]:
    """Yield the nodes that plugins of the description are, with the names that their own rules give."""
    reading = read(member.source.source, member.source.file, member.vocabulary)
    for run in plugin_nodes(reading, ""):
        names = dict(run.rules)
        ends = (it._replace(remapped=names.get(it.name, "")) for it in run.fact.endpoints)
        yield run.fact._replace(endpoints=tuple(ends))


def controllers(nodes: Iterable[NodeFacts]) -> Iterator[NodeFacts]:
    """Yield the controllers that surely run."""
    yield from (it for it in nodes if it.host == MANAGER and not it.when)


def usual_values(node: NodeFacts) -> dict[str, Given]:
    """Return the parameters that the stack of a node sets."""
    return {name: Given(value, NOWHERE) for name, value in node.usual}
