"""What the graph of a fleet should look like, by its remap table and its descriptions."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence, Set
from typing import TYPE_CHECKING

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.naming import NAMESPACE, TF_TOPICS, Naming, spelled
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.remap.records import EndpointName, Table
from multibot_rewrite.remap.ways import HOST, PLUGIN, PROCESS, deliveries
from multibot_rewrite.system.conventions import SENT_BY_EVERY_NODE, USUAL_FRAMES

if TYPE_CHECKING:
    from multibot_rewrite.steps.collect import Inventory

NOTHING: Mapping[str, Sequence[str]] = {}
NOWHERE: Mapping[str, str] = {}


class PlannedEndpoint(NamedTuple):
    """An endpoint of the plan; ``node`` and ``name`` are fully qualified.

    ``type`` is empty where it is not known; ``also`` are other types it may have, by parameter or
    release. ``code_name`` is the name in the node's code, before any remap rule.
    """

    node: str
    kind: str
    role: str
    name: str
    type: str
    code_name: str
    also: tuple[str, ...] = ()


class PlannedRobot(NamedTuple):
    """One robot: its nodes, the frames of its description, its tf topic.

    ``other_frames`` are further frames that its nodes may send. ``optional`` are those of its
    nodes that may be missing. ``frame_tag`` is the robot's name in frames, where that is another
    one than its name; else it is empty.
    """

    name: str
    nodes: tuple[str, ...]
    frames: tuple[str, ...]
    tf: str
    other_frames: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    frame_tag: str = ""


class PlannedTopic(NamedTuple):
    """What holds of a topic besides who has it.

    ``senders`` are patterns of the nodes that may publish it, empty where any may; with
    ``one_sender`` only one node at a time does. ``qos`` are policies with the word that each publisher
    offers, both as in ``snapshot.Qos``. ``bridge`` is what a ros_gz_bridge does with it: publishes,
    subscribes, both, or nothing; ``type`` is its type then.
    """

    name: str
    senders: tuple[str, ...] = ()
    one_sender: bool = False
    qos: tuple[tuple[str, str], ...] = ()
    bridge: tuple[str, ...] = ()
    type: str = ""


class PlannedParameter(NamedTuple):
    """A parameter with its value, as ``states.parameter_text`` writes it.

    ``place`` is the ``file:line`` that it is from, empty for the plan itself.
    """

    name: str
    value: str
    place: str = ""


class PlannedState(NamedTuple):
    """What a running node answers: the label of its life cycle, its parameters; and its machine.

    ``host`` is any word: nodes of one host run on one machine, those of two on two.
    """

    node: str
    lifecycle: str = ""
    host: str = ""
    parameters: tuple[PlannedParameter, ...] = ()


class Expectation(NamedTuple):
    """The plan of a fleet.

    ``ignored_nodes`` are patterns of nodes that may come and go, besides the usual tools.
    ``sources`` has for a node ``file:line`` of the plugin that starts it, ``origins`` for any other
    node the file (``file:line``) or stack (``stack nav2``) that names it. ``release`` is that whose
    facts it rests on, empty if that is not known. ``ways`` has for a node without --ros-args of its
    own how it gets rules (``remap.ways``), and from which node, if it is in the process of one.
    ``topics`` say more of some topics; of each group in ``one_of`` one node runs, and not more.
    ``gaps`` are findings about what is open in the robots as they are planned: a name that is read
    and not sent, for example. ``sends`` has for a node the transforms that it sends, but for those of
    the description, as ``odom -> base_link, map -> odom``. ``states`` are compared with what nodes
    answer.
    """

    layout: str
    robots: tuple[PlannedRobot, ...]
    shared_nodes: tuple[str, ...]
    shared_topics: tuple[str, ...]
    shared_frames: tuple[str, ...]
    endpoints: tuple[PlannedEndpoint, ...]
    ignored_nodes: tuple[str, ...] = ()
    sources: tuple[tuple[str, str], ...] = ()
    origins: tuple[tuple[str, str], ...] = ()
    release: str = ""
    ways: tuple[tuple[str, str], ...] = ()
    topics: tuple[PlannedTopic, ...] = ()
    one_of: tuple[tuple[str, ...], ...] = ()
    gaps: tuple[Finding, ...] = ()
    sends: tuple[tuple[str, str], ...] = ()
    states: tuple[PlannedState, ...] = ()


def robot_words(plan: Expectation) -> dict[str, str]:
    """The words that stand for robots, in names and in frames, and the robot of each."""
    return {word: it.name for it in plan.robots for word in (it.name, it.frame_tag) if word}


def vacuous(plan: Expectation) -> str:
    """Why a graph without any node would be as planned; empty for a plan that tests something."""
    if not plan.robots:
        return "no robot is planned"
    needed = {node for group in plan.one_of for node in group}
    may_miss = ((it, set(it.optional) - needed) for it in plan.robots)
    idle = [it.name for it, optional in may_miss if set(it.nodes) <= optional]
    verb = "has" if len(idle) == 1 else "have"
    return f"{', '.join(idle)} {verb} no node that must run" if idle else ""


def expect(
    table: Table,
    naming: Naming,
    frames: Mapping[str, Sequence[str]],
    facts: Sequence[NodeFacts] = (),
    named: Mapping[str, Sequence[str]] = NOTHING,
    sources: Mapping[str, str] = NOWHERE,
    words: Mapping[str, str] = NOWHERE,
    maybe_real: Container[str] = (),
) -> Expectation:
    """The plan that follows from a remap table.

    ``frames`` are the declared frames of each robot, ``named`` further frames in its description.
    ``facts`` describe the nodes that every robot runs. ``words`` has the name of a robot in its
    frames, where that is another one than its name; plugins of ``maybe_real`` robots may be missing.
    """
    plugins = {node.node for node in table.nodes if node.home.written and node.robot in maybe_real}
    usual = dict.fromkeys((*_defaults(facts), *USUAL_FRAMES))
    may_run = _may_run(table, facts)

    def robot(name: str) -> PlannedRobot:
        word = words.get(name, name)
        others = (*named.get(name, ()), *(spelled(naming, word, "frame", frame) for frame in usual))
        optional = plugins if name in maybe_real else frozenset[str]()
        made = _robot(name, may_run, optional, tuple(frames.get(name, ())), others, naming)
        return made._replace(frame_tag=word if word != name else "")

    return Expectation(
        table.layout,
        tuple(map(robot, dict.fromkeys((*frames, *filter(None, may_run.nodes))))),
        tuple(full for _, full in may_run.nodes.get("", ())),
        tuple(sorted(f"/{topic}" for topic in naming.shared_topics)),
        tuple(sorted(naming.shared_frames)),
        tuple(dict.fromkeys(_planned(table.names))),
        # What nodes for all robots make for themselves.
        ignored_nodes=tuple(may_run.made.get("", ())),
        sources=tuple(sources.items()),
        ways=tuple(_ways(table)),
    )


class _MayRun(NamedTuple):
    """The nodes of each robot (name in the stack, full name), those that its nodes make, those of them
    that are always there, and the nodes that run under a condition."""

    nodes: Mapping[str, Sequence[tuple[str, str]]]
    made: Mapping[str, Sequence[str]]
    always: Mapping[str, Sequence[str]]
    conditional: Set[str]


def _may_run(table: Table, facts: Sequence[NodeFacts]) -> _MayRun:
    return _MayRun(
        _nodes(table),
        _private_nodes(table.names),
        _private_nodes(it for it in table.names if not it.endpoint.when),
        {node.name for node in facts if node.when},
    )


def _robot(
    name: str,
    may_run: _MayRun,
    optional: Set[str],
    own: tuple[str, ...],
    others: Iterable[str],
    naming: Naming,
) -> PlannedRobot:
    """One robot; ``own`` are its frames, ``others`` may come besides, ``optional`` nodes may be missing
    besides those under a condition."""
    of_stack, made = may_run.nodes.get(name, ()), may_run.made.get(name, ())
    return PlannedRobot(
        name,
        tuple(dict.fromkeys((*(full for _, full in of_stack), *made))),
        own,
        tf_topic(name, naming),
        _further(others, own, naming),
        _may_miss(of_stack, may_run.conditional | optional, made, may_run.always.get(name, ())),
    )


def _further(others: Iterable[str], own: Iterable[str], naming: Naming) -> tuple[str, ...]:
    """Frames that may come besides a robot's own and those that all share."""
    known = {*own, *naming.shared_frames}
    return tuple(frame for frame in dict.fromkeys(others) if frame not in known)


def _may_miss(
    nodes: Iterable[tuple[str, str]],
    optional: Container[str],
    private: Iterable[str],
    always: Container[str],
) -> tuple[str, ...]:
    """The nodes of a robot that may be missing, and those that these make for themselves."""
    found = tuple(full for stack_name, full in nodes if stack_name in optional)
    return (*found, *(it for it in private if it not in always or it.startswith(found)))


def _ways(table: Table) -> Iterator[tuple[str, str]]:
    """The nodes that are started without --ros-args of their own, each with its way, and behind it the
    full name of the node that takes its rules, if that is another one."""
    found = {it.node.full_name: it for it in reversed(deliveries(table))}
    full = {(it.robot, it.node): it.full_name for it in table.nodes}
    for node in table.nodes:
        it = found.get(node.full_name)
        if it is None or it.way == PROCESS or node.home.plugin:
            continue
        taker = full.get((node.robot, it.taker), "")
        yield node.full_name, f"{it.way} {taker}" if it.way in (HOST, PLUGIN) else it.way


def _nodes(table: Table) -> dict[str, list[tuple[str, str]]]:
    """By robot: the name of each node in the stack, and its full name."""
    found: dict[str, list[tuple[str, str]]] = {}
    for node in table.nodes:
        full = f"{node.namespace.rstrip('/')}/{node.name}"
        found.setdefault(node.robot, []).append((node.node, full))
    return found


def _defaults(facts: Iterable[NodeFacts]) -> Iterator[str]:
    """The default frames of parameters; a name in <> stands for another parameter."""
    for node in facts:
        names = (frame.default.strip("/") for frame in node.frames)
        yield from (name for name in names if name and "<" not in name)


def named_frames(inventory: Inventory) -> tuple[str, ...]:
    """The frames that a description names anywhere, such as those of its plugins' messages."""
    values = (
        claim.value.strip()
        for claim in inventory.claims
        if "frame" in claim.site.kinds and claim.site.form == "whole"
    )
    return tuple(dict.fromkeys(filter(None, values)))


def _private_nodes(names: Iterable[EndpointName]) -> dict[str, tuple[str, ...]]:
    """By robot: patterns of the nodes that its nodes make for themselves."""
    found: dict[str, tuple[str, ...]] = {}
    for name in names:
        full = f"{name.node}{name.endpoint.by}"
        if name.endpoint.by and full not in found.get(name.robot, ()):
            found[name.robot] = (*found.get(name.robot, ()), full)
    return found


def _planned(names: Iterable[EndpointName]) -> Iterator[PlannedEndpoint]:
    """The endpoints that do not depend on parameters."""
    for name in names:
        end = name.endpoint
        if end.when or (end.helper and not end.by):
            continue
        if end.role and name.name not in SENT_BY_EVERY_NODE:
            own = (f"{name.node}{end.by}", end.kind, end.role, name.name)
            yield PlannedEndpoint(*own, end.type, end.name, end.also)


def tf_topic(robot: str, naming: Naming) -> str:
    """The tf topic of a robot in this layout."""
    topic = f"/{TF_TOPICS[0]}"
    if not naming.layout.tf_per_robot:
        return topic
    if naming.topics == NAMESPACE:
        return f"/{robot}{topic}"
    return spelled(naming, robot, "topic", topic)
