# SPDX-License-Identifier: Apache-2.0
"""Topics that nodes have for certain, and parameters that their node sets set."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts
from multibot_rewrite.planning.of_runs import asked_alone, with_names
from multibot_rewrite.planning.records import Given
from multibot_rewrite.planning.table import plugin_nodes
from multibot_rewrite.system.records import NOWHERE, PUBLISHES, SUBSCRIBES
from multibot_rewrite.system.words import PLAIN, STAMPED

COMMANDS = (PLAIN, STAMPED)
# What nav2_behaviors passes on while an action asks for it (assisted_teleop.cpp): no way to the drive.
_ASSISTED = "cmd_vel_teleop"
# What the inputs of a mux that a person sends to are called, the best first.
_OF_A_PERSON = ("key", "teleop", "manual", "joy")


class CommandEnd(NamedTuple):
    """A node that sends or obeys velocities on a topic, with its parameter and name in the code."""

    node: str
    role: str
    topic: str
    type: str
    parameter: str = ""
    name: str = ""


def topic_of(node: NodeFacts, end: Endpoint) -> str:
    """Return the topic of an end as the robot alone has it, without a slash in front."""
    return (end.remapped or asked_alone(node, end)).replace("~", node.name, 1).strip("/")


def topics_of(nodes: Iterable[NodeFacts], role: str, types: Collection[str] = ()) -> list[str]:
    """Return the topics of this role that the nodes surely have, of ``types`` if given."""
    ends = ((node, it) for node in nodes for it in node.endpoints if it.role == role)
    return [topic_of(*it) for it in ends if not it[1].when and (not types or it[1].type in types)]


def sent_commands(node: NodeFacts) -> dict[Endpoint, str]:
    """Return the topics of the commands that a node sends, by their ends."""
    ends = (it for it in node.endpoints if it.role == PUBLISHES and it.type in COMMANDS)
    return {it: topic_of(node, it) for it in ends}


def with_rules(node: NodeFacts, targets: Mapping[Endpoint, str]) -> NodeFacts:
    """Return the node with some of its ends on other topics."""
    ends = (it._replace(remapped=targets.get(it, it.remapped)) for it in node.endpoints)
    return node._replace(endpoints=tuple(ends))


def plugins(member: Member) -> Iterator[NodeFacts]:
    """Yield the nodes that plugins of the description are, with the names that they have alone."""
    reading = read(member.source.source, member.source.file, member.definitions)
    for run in map(with_names, plugin_nodes(reading, "")):
        yield run.fact._replace(
            endpoints=tuple(it._replace(remapped=name) for it, name in run.names)
        )


def controllers(nodes: Iterable[NodeFacts]) -> Iterator[NodeFacts]:
    """Yield the controllers that surely run."""
    yield from (it for it in nodes if it.host == MANAGER and not it.when)


def usual_values(node: NodeFacts) -> dict[str, Given]:
    """Return the parameters that the node set of a node sets."""
    return {name: Given(value, NOWHERE) for name, value in node.usual}


def relays_of(ends: Iterable[CommandEnd]) -> dict[str, Sequence[CommandEnd]]:
    """Return the inputs of nodes between senders and the drive, such as muxes, by node."""
    obeys: dict[str, list[CommandEnd]] = defaultdict(list)
    sends = set()
    for it in ends:
        if it.role == PUBLISHES:
            sends.add(it.node)
        elif it.role == SUBSCRIBES and it.parameter != _ASSISTED:
            obeys[it.node].append(it)
    return {node: inputs for node, inputs in obeys.items() if node in sends}


def entry_of(topic: str, ends: Sequence[CommandEnd]) -> str:
    """Return the topic where a user's commands enter the relays before this topic."""
    relays = relays_of(ends)
    sent = {it.topic for it in ends if it.role == PUBLISHES}
    before = {
        it.topic: relays[it.node] for it in ends if it.role == PUBLISHES and it.node in relays
    }
    passed: set[str] = set()
    while topic in before and topic not in passed:
        passed.add(topic)
        topic = _for_a_person(before[topic], sent)
    return topic


def _for_a_person(inputs: Sequence[CommandEnd], sent: Collection[str]) -> str:
    """Return the topic of an input for a user: by its name, else one without a sender."""
    texts = [(f"{it.parameter} {it.topic}".lower(), it.topic) for it in inputs]
    named = (topic for word in _OF_A_PERSON for text, topic in texts if word in text)
    unsent = (it.topic for it in inputs if it.topic not in sent)
    return next(iter((*named, *unsent, *(it.topic for it in inputs))))
