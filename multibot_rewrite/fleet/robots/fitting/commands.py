# SPDX-License-Identifier: Apache-2.0
"""Fits commands of velocity: their topic, their type, and a twist_mux input for each sender.

The inputs are those of the user's file, where one has the node; then what a node set adds fits
these."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import is_tool_word
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
from multibot_rewrite.knowledge.records import TWIST_MUX, Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.filling import lookup
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES
from multibot_rewrite.system.words import PLAIN


def driving(
    nodes: Sequence[NodeFacts], own: Collection[str], bridged: Iterable[str]
) -> Sequence[NodeFacts]:
    """Return the nodes; commands of ``own`` ones that nobody reads are sent to the one drive."""
    led = topics_of(controllers(nodes), SUBSCRIBES, COMMANDS)
    drives = led or [*bridged]
    if len(led) > 1 or not drives:
        return nodes
    made = []
    for node in nodes:
        if node.name not in own or node.host:
            made.append(node)
            continue
        heard = {*drives, *topics_of((it for it in nodes if it is not node), SUBSCRIBES)}
        lost = (it for it, topic in sent_commands(node).items() if topic not in heard)
        made.append(with_rules(node, dict.fromkeys(lost, drives[0])))
    return made


def by_way_of_relays(nodes: Sequence[NodeFacts], own: Collection[str]) -> Sequence[NodeFacts]:
    """Return the nodes; ``own`` ones for a person send to what limits the commands of the drive."""
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
    rows: Iterable[str],
) -> list[NodeFacts]:
    """Return the nodes with commands of one type, as far as the build may choose it.

    ``rows`` are the types of the robot's own bridge."""
    choices = {it.node.name: it for it in _choices(nodes, own, free, given, known)}
    wanted = _wanted_type(tuple(choices.values()), free, nodes, rows)
    made = []
    for node in nodes:
        choice = choices.get(node.name)
        # The parameter for the type, where that is not the default.
        switch = _switch_for(choice, wanted) if choice and choice.type != wanted else ()
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
    """A node whose parameter decides if its commands are stamped, with those ends and type.

    ``is_set``: a file sets the parameter; ``is_free``: the build may."""

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
    """Yield the nodes whose parameter decides if commands are stamped."""
    for node in nodes:
        ends = [*_ends_of_either_type(known.get(node.kind, node)), *_ends_of_either_type(node)]
        if ends:
            last = f"/{node.name}"
            sections = (it.values for it in given if f"/{it.node}".endswith(last))
            values = next(sections, usual_values(node))
            chosen = chosen_type(ends[0].types, lookup(node, values)) or ends[0].type
            is_set = not _condition_parameters(ends).isdisjoint(values)
            is_free = node.name in free or (node.name in own and not is_set)
            yield _Choice(node, ends, chosen, is_set, is_free)


def _ends_of_either_type(node: NodeFacts) -> Iterator[Endpoint]:
    """Yield the ends of a node whose type a parameter chooses."""
    ends = (it for it in node.endpoints if it.types and not it.when)
    yield from (it for it in ends if {it.type, *it.also}.issuperset(COMMANDS))


def _condition_parameters(ends: Iterable[Endpoint]) -> set[str]:
    conditions = (condition for it in ends for condition, _ in it.types)
    return {it.parameter for one in conditions for terms in parse_condition(one) for it in terms}


def _wanted_type(
    choices: Sequence[_Choice],
    free: Collection[str],
    nodes: Iterable[NodeFacts],
    rows: Iterable[str],
) -> str:
    """Return the type of the robot's commands, by files, bridge or nodes; else the plain one."""
    topics = {topic_of(it.node, end) for it in choices for end in _ends_of_either_type(it.node)}
    said = [it.type for it in choices if it.is_set]
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


def _switch_for(choice: _Choice, wanted: str) -> tuple[tuple[str, bool]] | None:
    """Return the parameter that gives all ends of the node the wanted type; None for no such one."""
    for name in sorted(_condition_parameters(choice.ends)):
        for value in (True, False):
            value_of = {name: value}.get
            if all((chosen_type(it.types, value_of) or it.type) == wanted for it in choice.ends):
                return ((name, value),)
    return None


# The parameters of an input, and what the node set calls the one of a planner.
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
    outputs = frozenset(topic_of(node, it) for it in _velocity_ends(node, PUBLISHES))
    others = [it for it in nodes if it.name != node.name]
    obeyed = {topic_of(it, end) for it in others for end in _velocity_ends(it, SUBSCRIBES)}
    node, apart = _with_own_inputs(node, outputs | obeyed)
    # A file has the ids of the inputs, or the node set.
    ids = ((_input_id(it.parameter), topic_of(node, it)) for it in _velocity_ends(node, SUBSCRIBES))
    inputs = {id_ if id_ != "*" else _input_role(topic, usual): topic for id_, topic in ids}
    heard = {*inputs.values(), *topics_of(others, SUBSCRIBES)}
    lost = [
        (it.name, topic)
        for it in others
        if it.name in added and not it.host
        for topic in dict.fromkeys(topic_of(it, end) for end in _velocity_ends(it, PUBLISHES))
        if topic in outputs or topic not in heard
    ]
    sent = {topic_of(it, end) for it in others for end in _velocity_ends(it, PUBLISHES)}
    wanted = {(name, topic): _input_role(topic, usual) for name, topic in lost}
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
    lacking = [it for it, topic in places.items() if not topic and _topic_parameter(it) in usual]
    node = _with_inputs(node, lacking, usual, of_package)
    places |= {it: str(usual[_topic_parameter(it)]) for it in lacking}
    moves = {key: places[role] for key, role in wanted.items()}
    return [node if it.name == node.name else _with_moved_commands(it, moves) for it in nodes]


def _velocity_ends(node: NodeFacts, role: str) -> Iterator[Endpoint]:
    """Yield the ends with velocities that a node has for certain."""
    ends = (it for it in node.endpoints if it.role == role and not it.when)
    yield from (it for it in ends if it.type in COMMANDS)


def _input_id(parameter: str) -> str:
    """Return the id of an input, of ``topics.ID.topic``."""
    return parameter.partition(".")[2].rpartition(".")[0]


def _with_own_inputs(node: NodeFacts, taken: Collection[str]) -> tuple[NodeFacts, Sequence[str]]:
    """Return the twist_mux with its inputs moved off topics that are ``taken``, and the moved ones."""
    apart = {
        it: f"{topic}{_APART}"
        for it in _velocity_ends(node, SUBSCRIBES)
        if (topic := topic_of(node, it)) in taken and "*" not in it.parameter
    }
    ends = (it._replace(name=apart.get(it, it.name)) for it in node.endpoints)
    values = ((it.parameter, topic) for it, topic in apart.items())
    return node._replace(endpoints=tuple(ends), usual=(*node.usual, *values)), [*apart.values()]


def _input_role(topic: str, usual: Usual) -> str:
    """Return the id of the mux input for a topic in the node set; for another topic the planner's."""
    ids = (_input_id(name) for name, value in usual.items() if value == topic)
    return next(ids, _OF_PLANNER)


def _topic_parameter(role: str) -> str:
    return f"{_INPUT.format(role)}topic"


def _with_inputs(
    node: NodeFacts, roles: Iterable[str], usual: Usual, of_package: NodeFacts
) -> NodeFacts:
    """Return the twist_mux with the inputs of its node set besides those of the user's file."""
    (like,) = _velocity_ends(of_package, SUBSCRIBES)
    for role in roles:
        values = [it for it in usual.items() if it[0].startswith(_INPUT.format(role))]
        name = _topic_parameter(role)
        end = like._replace(name=str(usual[name]), fixed="", parameter=name)
        node = node._replace(endpoints=(*node.endpoints, end), usual=(*node.usual, *values))
    return node


def _with_moved_commands(node: NodeFacts, moves: Mapping[tuple[str, str], str]) -> NodeFacts:
    """Return the node with its commands on other topics."""
    sent = ((it, topic_of(node, it)) for it in _velocity_ends(node, PUBLISHES))
    own = {it: moves[node.name, topic] for it, topic in sent if moves.get((node.name, topic))}
    return with_rules(node, own)
