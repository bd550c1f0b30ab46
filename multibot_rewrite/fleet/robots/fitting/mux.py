# SPDX-License-Identifier: Apache-2.0
"""The topics of commands, and the input of a twist_mux for each sender of them: the drive obeys one.

The inputs are those of the user's file, where one has the node; then what a node set adds fits
these."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.fleet.robots.fitting.node_topics import (
    COMMANDS,
    sent_commands,
    topic_of,
    topics_of,
    with_rules,
)
from multibot_rewrite.knowledge.records import TWIST_MUX, Endpoint, NodeFacts
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

# The parameters of an input, and what the stack calls the one of a planner.
_INPUT, _OF_PLANNER = "topics.{}.", "navigation"
# What the output of a mux is called where a drive obeys it.
_DRIVE = "cmd_vel"
# What an input gets behind its name where the mux would hear itself.
_APART = "_in"
Usual = Mapping[str, str | float]


def own_mux(nodes: Iterable[NodeFacts], added: Collection[str]) -> tuple[str, ...]:
    """Return the name of the twist_mux that the build starts, if there is one."""
    return tuple(it.name for it in nodes if it.kind == TWIST_MUX and it.name in added)[:1]


def to_the_drive(node: NodeFacts) -> NodeFacts:
    """Return the twist_mux with its output on the usual topic of a drive, unless a rule has another."""
    return with_rules(node, {it: it.remapped or _DRIVE for it in sent_commands(node)})


def through_a_mux(
    nodes: Sequence[NodeFacts], added: Collection[str], usual: Usual, of_package: NodeFacts
) -> Sequence[NodeFacts]:
    """Return the nodes, ``added`` ones that send commands past the twist_mux with an input of it.

    ``usual`` are the node set's own parameters of the twist_mux, ``of_package`` is what its code
    has. Where the user's file has no input for a sender, the twist_mux gets the node set's."""
    node = next((it for it in nodes if it.name in own_mux(nodes, added)), None)
    if node is None:
        return nodes
    outputs = frozenset(topic_of(node, it) for it in _commands(node, PUBLISHES))
    others = [it for it in nodes if it.name != node.name]
    obeyed = {topic_of(it, end) for it in others for end in _commands(it, SUBSCRIBES)}
    node, apart = _with_own_inputs(node, outputs | obeyed)
    # A file has the ids of the inputs, or the stack.
    ids = ((_id(it.parameter), topic_of(node, it)) for it in _commands(node, SUBSCRIBES))
    inputs = {id_ if id_ != "*" else _role(topic, usual): topic for id_, topic in ids}
    heard = {*inputs.values(), *topics_of(others, SUBSCRIBES)}
    lost = [
        (it.name, topic)
        for it in others
        if it.name in added and not it.host
        for topic in dict.fromkeys(topic_of(it, end) for end in _commands(it, PUBLISHES))
        if topic in outputs or topic not in heard
    ]
    sent = {topic_of(it, end) for it in others for end in _commands(it, PUBLISHES)}
    wanted = {(name, topic): _role(topic, usual) for name, topic in lost}
    places: dict[str, str] = {}
    # The topic of the input for each role: by its id, or by a word in its id or topic. A planner's,
    # the last, was called as what the drive obeys, or it is any that nobody has.
    for role in sorted(dict.fromkeys(wanted.values()), key=lambda it: it == _OF_PLANNER):
        own, word = [inputs[role]] if role in inputs else [], role[:3]
        named = [it for id_, it in inputs.items() if word in id_.lower() or word in it.lower()]
        if role == _OF_PLANNER:
            free = (it for it in inputs.values() if it not in {*sent, *places.values()})
            named = [*apart, *named, *free]
        places[role] = next(iter((*own, *named)), "")
    lacking = [it for it, topic in places.items() if not topic and _name_of_topic(it) in usual]
    node = _with_inputs(node, lacking, usual, of_package)
    places |= {it: str(usual[_name_of_topic(it)]) for it in lacking}
    moves = {key: places[role] for key, role in wanted.items()}
    return [node if it.name == node.name else _moved(it, moves) for it in nodes]


def _commands(node: NodeFacts, role: str) -> Iterator[Endpoint]:
    """Yield the ends with velocities that a node has for certain."""
    ends = (it for it in node.endpoints if it.role == role and not it.when)
    yield from (it for it in ends if it.type in COMMANDS)


def _id(parameter: str) -> str:
    """Return the id of an input, of ``topics.ID.topic``."""
    return parameter.partition(".")[2].rpartition(".")[0]


def _with_own_inputs(node: NodeFacts, taken: Collection[str]) -> tuple[NodeFacts, Sequence[str]]:
    """Return the twist_mux, its inputs that a file puts on topics that are ``taken`` on other ones, and
    these."""
    apart = {
        it: f"{topic}{_APART}"
        for it in _commands(node, SUBSCRIBES)
        if (topic := topic_of(node, it)) in taken and "*" not in it.parameter
    }
    ends = (it._replace(name=apart.get(it, it.name)) for it in node.endpoints)
    values = ((it.parameter, topic) for it, topic in apart.items())
    return node._replace(endpoints=tuple(ends), usual=(*node.usual, *values)), [*apart.values()]


def _role(topic: str, usual: Usual) -> str:
    """Return the id of the input that the node set has for a topic; that of a planner for any other."""
    ids = (_id(name) for name, value in usual.items() if value == topic)
    return next(ids, _OF_PLANNER)


def _name_of_topic(role: str) -> str:
    return f"{_INPUT.format(role)}topic"


def _with_inputs(
    node: NodeFacts, roles: Iterable[str], usual: Usual, of_package: NodeFacts
) -> NodeFacts:
    """Return the twist_mux with inputs that the node set has, in addition to those of the user's
    file."""
    (like,) = _commands(of_package, SUBSCRIBES)
    for role in roles:
        values = [it for it in usual.items() if it[0].startswith(_INPUT.format(role))]
        name = _name_of_topic(role)
        end = like._replace(name=str(usual[name]), fixed="", parameter=name)
        node = node._replace(endpoints=(*node.endpoints, end), usual=(*node.usual, *values))
    return node


def _moved(node: NodeFacts, moves: Mapping[tuple[str, str], str]) -> NodeFacts:
    """Return the node with its commands on other topics."""
    sent = ((it, topic_of(node, it)) for it in _commands(node, PUBLISHES))
    own = {it: moves[node.name, topic] for it, topic in sent if moves.get((node.name, topic))}
    return with_rules(node, own)
