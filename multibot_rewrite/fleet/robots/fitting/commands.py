# SPDX-License-Identifier: Apache-2.0
"""Commands of velocity: the topic and the type with which nodes and the drive find each other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import is_tool_word
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.outputs.output_file import own_yaml
from multibot_rewrite.fleet.robots.fitting.node_topics import (
    COMMANDS,
    CommandEnd,
    controllers,
    entry_of,
    sent_commands,
    topic_of,
    topics_of,
    usual_values,
    with_rules,
)
from multibot_rewrite.knowledge.conditions import chosen_type, parse_condition
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.producers.ends import bridge_ends
from multibot_rewrite.producers.evidence.filling import lookup
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import SUBSCRIBES
from multibot_rewrite.system.words import PLAIN


def driving(nodes: Sequence[NodeFacts], own: Collection[str]) -> Sequence[NodeFacts]:
    """Return the nodes; commands of ``own`` ones that nothing hears go to the one controller that
    drives."""
    drives = topics_of(controllers(nodes), SUBSCRIBES, COMMANDS)
    if len(drives) != 1:
        return nodes
    made = []
    for node in nodes:
        if node.name not in own or node.host:
            made.append(node)
            continue
        heard = topics_of((it for it in nodes if it is not node), SUBSCRIBES)
        lost = (it for it, topic in sent_commands(node).items() if topic not in heard)
        made.append(with_rules(node, dict.fromkeys(lost, drives[0])))
    return made


def by_way_of_relays(nodes: Sequence[NodeFacts], own: Collection[str]) -> Sequence[NodeFacts]:
    """Return the nodes; ``own`` ones with which a person drives send to the first of what limits or
    chooses the commands of the drive, and not past it."""
    ends = [
        CommandEnd(node.name, it.role, topic_of(node, it), it.type, it.parameter)
        for node in nodes
        for it in node.endpoints
        if it.type in COMMANDS and not it.when
    ]
    made = []
    for node in nodes:
        is_tool = node.name in own and not node.host and is_tool_word(node.kind)
        sent = sent_commands(node) if is_tool else {}
        entries = {it: (topic, entry_of(topic, ends)) for it, topic in sent.items()}
        moved = {it: entry for it, (topic, entry) in entries.items() if entry != topic}
        made.append(with_rules(node, moved))
    return made


def of_one_type(
    nodes: Sequence[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
    spec: RobotSpec,
) -> list[NodeFacts]:
    """Return the nodes, with commands of one type as far as the build may choose it."""
    choices = {it.node.name: it for it in _choices(nodes, own, free, given, known)}
    wanted = _wanted(tuple(choices.values()), free, nodes, spec)
    made = []
    for node in nodes:
        choice = choices.get(node.name)
        # The parameter for the type, where that is not the default.
        switch = _switch(choice, wanted) if choice and choice.type != wanted else ()
        if choice and choice.is_free and switch is not None:
            ends = (
                it._replace(type=wanted, also=(), types=())
                if it.type in COMMANDS and not it.when
                else it
                for it in node.endpoints
            )
            made.append(node._replace(endpoints=tuple(ends), usual=(*node.usual, *switch)))
        else:
            made.append(node)
    return made


class _Choice(NamedTuple):
    """A node whose commands are stamped or not as a parameter says: its ends that are, as its code has
    them, the type that it has now, whether a file sets the parameter, and whether the build may."""

    node: NodeFacts
    ends: Sequence[Endpoint]
    type: str
    is_set: bool
    is_free: bool


def _choices(
    nodes: Iterable[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
) -> Iterator[_Choice]:
    for node in nodes:
        ends = [*_either(known.get(node.kind, node)), *_either(node)]
        if ends:
            last = f"/{node.name}"
            sections = (it.values for it in given if f"/{it.node}".endswith(last))
            values = next(sections, usual_values(node))
            chosen = chosen_type(ends[0].types, lookup(node, values)) or ends[0].type
            is_set = not _switches(ends).isdisjoint(values)
            is_free = node.name in free or (node.name in own and not is_set)
            yield _Choice(node, ends, chosen, is_set, is_free)


def _either(node: NodeFacts) -> Iterator[Endpoint]:
    """Yield the ends of a node that are of either type, as a parameter says; no open ones."""
    ends = (it for it in node.endpoints if it.types and not it.when)
    yield from (it for it in ends if {it.type, *it.also}.issuperset(COMMANDS))


def _switches(ends: Iterable[Endpoint]) -> set[str]:
    conditions = (condition for it in ends for condition, _ in it.types)
    return {it.parameter for one in conditions for terms in parse_condition(one) for it in terms}


def _wanted(
    choices: Sequence[_Choice], free: Collection[str], nodes: Iterable[NodeFacts], spec: RobotSpec
) -> str:
    """Return the type of the robot's commands: what a file sets, what its bridge or driver takes, what
    the nodes of its files have, and what all nodes have; else the plain one."""
    topics = {topic_of(it.node, end) for it in choices for end in _either(it.node)}
    said = [it.type for it in choices if it.is_set]
    rows = [
        end.type
        for path in spec.companions.get("bridge", ())
        for end in bridge_ends(own_yaml(spec, path))
        if end.role == SUBSCRIBES
    ]
    heard = [
        end.type
        for node in nodes
        for end in node.endpoints
        if end.role == SUBSCRIBES and not (end.when or end.also) and topic_of(node, end) in topics
    ]
    fixed = [it for it in (*said, *rows, *heard) if it in COMMANDS]
    of_files = [it.type for it in choices if it.node.name not in free]
    usual = {it.type for it in choices}
    return next(iter((*fixed, *of_files, *(usual if len(usual) == 1 else ()))), PLAIN)


def _switch(choice: _Choice, wanted: str) -> tuple[tuple[str, bool]] | None:
    """Return the parameter that gives all ends of the node the wanted type; None for no such one."""
    for name in sorted(_switches(choice.ends)):
        for value in (True, False):
            value_of = {name: value}.get
            if all((chosen_type(it.types, value_of) or it.type) == wanted for it in choice.ends):
                return ((name, value),)
    return None
