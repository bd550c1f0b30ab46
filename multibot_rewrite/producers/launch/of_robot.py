# SPDX-License-Identifier: Apache-2.0
"""The nodes of a robot's node sets and what its launch files start -> the nodes that it runs.

A node that is launched runs: that is the surest evidence there is. What a node set has and no
launch file starts is left out, if all of the launch files is known."""

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.base.rosnames import check_topic_name, expand
from multibot_rewrite.base.wording import shorten, unique
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import UNKNOWN, Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.transforms import STATE_PUBLISHER, state_publisher_of
from multibot_rewrite.producers.evidence.nodes import MANAGER, remapped
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.launch.bridges import bridge_rows, passes_topics_on
from multibot_rewrite.producers.launch.describe import SIMULATOR, SIMULATORS
from multibot_rewrite.producers.launch.findings import launch_findings, started_twice
from multibot_rewrite.producers.launch.handed_on import (
    OWN,
    HandedOn,
    Passing,
    document_of,
    handed_on,
    has_sections,
    process_name,
)
from multibot_rewrite.producers.launch.kept_paths import NOT_KNOWN, known_words
from multibot_rewrite.producers.launch.known_node import (
    STATIC,
    check_names,
    frames_in,
    guessed_name,
    known_node,
    own_name,
    with_static_transform,
)
from multibot_rewrite.producers.launch.launched import unread_worlds
from multibot_rewrite.producers.launch.programs import once_for_all, passes, program_of, programs
from multibot_rewrite.producers.launch.records import (
    IdleAction,
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    ParameterText,
)
from multibot_rewrite.producers.launch.spawners import (
    Spawned,
    is_spawner,
    spawned_in,
    texts_of,
    under_managers,
)
from multibot_rewrite.system.records import NO_ORIGIN, TOPIC, Origin, Place

# Packages of launch files alone, and how those of their nodes begin.
_FAMILIES = {"nav2_bringup": "nav2_"}
# What is built gives these their descriptions anyway.
_DESCRIPTION = "robot_description"
_DESCRIBED = ("robot_state_publisher", "move_group", "servo_node")
NO_NAME = "the launch file gives it no name"
NOTHING: Mapping[str, HandedOn] = {}
# rclcpp, qos_overriding_options: qos_overrides.TOPIC.publisher.POLICY.
QOS = "qos_overrides."
NO_QOS: Mapping[str, object] = {}
_SPAWNED = "{} spawns something in addition to the robot, which is not started; add it to a world"


class Launched(NamedTuple):
    """The nodes of node sets and launch files, and what launch files do with them.

    ``given`` is what these set for nodes, ``started`` each launched node and ``spawned`` each
    controller by its name; with ``whole`` that is all that runs. ``simulated``: they start a
    simulator, or what is for one. ``processes`` are no nodes, ``environment`` is what all processes
    have, ``placing`` is what puts the robot into its simulator, ``qos`` what bridges to it set for
    topics."""

    nodes: tuple[NodeFacts, ...]
    given: tuple[Run, ...]
    started: Mapping[str, LaunchedNode]
    spawned: Mapping[str, Spawned]
    whole: bool
    findings: tuple[Finding, ...]
    simulated: bool = False
    handed_on: Mapping[str, HandedOn] = NOTHING
    processes: tuple[Passing, ...] = ()
    environment: tuple[tuple[str, str], ...] = ()
    placing: LaunchedNode | None = None
    idle: tuple[IdleAction, ...] = ()
    qos: Mapping[str, object] = NO_QOS


class _Pair(NamedTuple):
    node: LaunchedNode
    facts: NodeFacts
    number: int
    is_second: bool = False


def with_launched(
    node_set: Sequence[NodeFacts],
    graph: LaunchGraph,
    known: Mapping[str, NodeFacts],
    words: Collection[str],
    parameters: KnownNodes,
    release: str,
) -> Launched:
    """Return the nodes of a robot before its files are asked; ``words`` stand for it in namespaces."""
    spawned, notes = spawned_in(graph.nodes)
    notes = (*graph.notes, *notes, *unread_worlds(graph.nodes))
    graph = _without_lost_arguments(graph._replace(notes=notes))
    each = [(number, it) for number, it in enumerate(graph.nodes) if not passes(it)]
    # The robot's own state publisher is the first one.
    each.sort(key=lambda row: _publishes_another(row[1]))
    pairs, twice = _each_once(_pair(number, it, node_set, known, words) for number, it in each)
    managers = unique(_full_name(it.node, it.facts) for it in pairs if it.facts.known == MANAGER)
    under, lost = under_managers(spawned, managers if graph.whole else ())
    nodes = {it.facts.name: it.facts for it in pairs}
    left = [it for it in node_set if _is_left(it, nodes)] if graph.whole else []
    gone = {it.name for it in left}
    # A node that every robot has, such as robot_state_publisher, may be launched under another name.
    gone |= {it.known for it in nodes.values() if it.known} - {
        it.name for it in node_set if it.origin != NO_ORIGIN
    }
    kept = [it for it in node_set if it.name not in nodes and not {it.name, it.host} & gone]
    hosted = list(_hosted(pairs, known, {it.name for it in kept}))
    inside = [*hosted, *(it for it in kept if it.host)]
    given = list(_controllers(under, pairs, words, parameters))
    given += [it for pair in pairs for it in _launched_values(pair, inside, words, parameters)]
    unknown = {it.facts.name: it.node for it in pairs if not it.facts.is_known}
    of_all = graph.environment
    own = state_publisher_of([it.facts for it in pairs])
    handed = {it.facts.name: _handed_to(it, of_all, own, _is_own(it, release)) for it in pairs}
    numbered = [it._replace(number=at) for at, it in enumerate(graph.nodes)]
    spawning = [it for it in numbered if _is_spawner_of_robot(it)]
    beside = (LaunchNote(it.place, _SPAWNED.format(it.executable)) for it in spawning[1:])
    graph = graph._replace(notes=(*graph.notes, *beside))
    processes = (
        it
        for it in numbered
        if passes(it) and not _is_built(it) and not (it.process.is_include and _stands(it, kept))
    )
    passing = tuple(_passing(it, words, of_all) for it in processes)
    return Launched(
        (*kept, *nodes.values(), *hosted),
        tuple({it.node: it for it in reversed(given)}.values()),
        {it.facts.name: it.node for it in pairs},
        dict(_under_manager(under, pairs, words, release)),
        graph.whole,
        (*launch_findings(graph, unknown, handed, left, passing), *twice, *lost),
        any(it.package in programs().simulators for it in graph.nodes),
        handed,
        passing,
        graph.environment,
        next(iter(spawning), None)
        or next((numbered[it.number] for it in pairs if _may_spawn(it, handed, release)), None),
        graph.idle,
    )


def _publishes_another(it: LaunchedNode) -> bool:
    """Return whether a node publishes another description than the robot's, by a rule for its topic."""
    old = (old.lstrip("/") for old, _ in it.remappings)
    return it.package == STATE_PUBLISHER and _DESCRIPTION in old


def _may_spawn(it: _Pair, handed: Mapping[str, HandedOn], release: str) -> bool:
    """Return whether a vendor's program is named as a spawner and gets the robot's description."""
    own = handed[it.facts.name]
    called = "spawn" in it.node.executable.lower() and _is_own(it, release)
    return called and _DESCRIPTION in (*own.texts, *own.arguments)


def _without_lost_arguments(graph: LaunchGraph) -> LaunchGraph:
    """Return what launch files start, without arguments that name what only a launch makes.

    A missing launch file with such an argument is left out: it does not start without it."""
    nodes: list[LaunchedNode] = []
    notes: list[LaunchNote] = []
    for it in graph.nodes:
        words, lost = known_words(it.arguments)
        if it.process.is_include and lost:
            names = shorten([one.partition(":=")[0] for one in it.arguments if one not in words])
            who = f"{it.executable} of {it.package} is not started"
            notes.append(LaunchNote(it.place, f"{who}: its argument {names} {NOT_KNOWN}"))
            continue
        nodes.append(it._replace(arguments=words))
        said = (f"an argument of {it.executable} {flag}".rstrip() for flag in lost)
        notes += [LaunchNote(it.place, f"{one} {NOT_KNOWN}", parameters=True) for one in said]
    return graph._replace(nodes=tuple(nodes), notes=(*graph.notes, *notes))


def _each_once(pairs: Iterable[_Pair]) -> tuple[list[_Pair], list[Finding]]:
    """Return the nodes, each with a name of its own, and findings about those started twice.

    Of two equal ones the later counts. One without a name, or of another program, gets a new name."""
    found: dict[str, _Pair] = {}
    findings: list[Finding] = []
    for it in pairs:
        name, other = it.facts.name, found.get(it.facts.name)
        if other is None:
            found[name] = it
            continue
        alike = program_of(it.node) == program_of(other.node) and bool(it.node.name)
        same = alike or _given_to(it.node) == _given_to(other.node)
        if it.node.name or same:
            findings.append(started_twice(it.node, other.node, name))
        if not same:
            name = next(one for n in count(2) if (one := f"{name}_{n}") not in found)
        found[name] = it._replace(facts=it.facts._replace(name=name), is_second=not same)
    return [*found.values()], findings


def _given_to(it: LaunchedNode) -> tuple[object, ...]:
    """Return what a launch file sets for a node, without the place."""
    return it.package, it.executable, it.remappings, it.parameters, it.arguments


def _is_own(it: _Pair, release: str) -> bool:
    """Return whether a node is unknown, or known by a file of the user's nodes alone."""
    known = it.facts.known
    return known not in built_in(release).nodes if known else not it.facts.is_known


def _handed_to(
    it: _Pair, of_all: Collection[tuple[str, str]], publisher: str, is_own: bool
) -> HandedOn:
    """Return what its launch file gives a node; publishers of other descriptions keep these."""
    found = handed_on(it.node, it.facts.name, of_all, it.number)
    if it.facts.known == STATIC:
        found = found._replace(values={**found.values, **frames_in(it.node.arguments)})
    texts = () if it.facts.known in _DESCRIBED else found.texts
    is_other = it.facts.package == STATE_PUBLISHER and it.facts.name != publisher
    found = found._replace(description=found.description if is_other else "")
    unnamed = found.is_unnamed and is_own and not it.is_second
    return found._replace(texts=texts, is_unnamed=unnamed, kind=it.facts.known)


def _is_built(it: LaunchedNode) -> bool:
    """Return whether a build makes the process from the robot's own files: a spawner, for example."""
    is_simulator = it.package in SIMULATORS and it.executable == SIMULATOR
    return is_simulator or is_spawner(it) or _is_spawner_of_robot(it)


def _is_spawner_of_robot(it: LaunchedNode) -> bool:
    return program_of(it) in programs().spawners and not it.process.is_extra


def _stands(include: LaunchedNode, node_set: Iterable[NodeFacts]) -> bool:
    """Return whether the robot's node sets have the nodes of a missing launch file."""
    family = _FAMILIES.get(include.package, include.package)
    own = (it.package for it in node_set if it.origin != NO_ORIGIN)
    return any(it == family or (family[-1] == "_" and it.startswith(family)) for it in own)


def _passing(
    it: LaunchedNode, words: Collection[str], of_all: Collection[tuple[str, str]]
) -> Passing:
    """Return a process that is passed on, below the robot's namespace or once for all robots."""
    own = it._replace(environment=tuple(pair for pair in it.environment if pair not in of_all))
    once = bool(once_for_all(it)) and not is_of_robot(it.namespace, words)
    below = own if once else own._replace(namespace=f"/{_below(it.namespace, '', words)}")
    return Passing(below, process_name(it), once)


def _under_manager(
    spawned: Iterable[Spawned], pairs: Iterable[_Pair], words: Collection[str], release: str
) -> Iterator[tuple[str, Spawned]]:
    """Yield the controllers by name, also under the rules of their manager, if these reach them."""
    reached = controller_way(release).of_manager
    wide = {it.facts.name: it.node.remappings for it in pairs if reached}
    for it in spawned:
        manager = _without_word(it.manager.strip("/"), words)
        rules = (*wide.get(manager, ()), *it.rules)
        yield _without_word(it.full_name.strip("/"), words), it._replace(rules=rules)


def without_bridges(launched: Launched) -> Launched:
    """Return all but the bridges to a simulator (a build has its own); their QoS is kept."""
    gone = {
        name for name, it in launched.started.items() if passes_topics_on(it.package, it.executable)
    }
    handed = (launched.handed_on[name].values for name in gone)
    return launched._replace(
        qos={key: it for own in handed for key, it in own.items() if key.startswith(QOS)},
        nodes=tuple(it for it in launched.nodes if it.name not in gone),
        given=tuple(it for it in launched.given if it.node not in gone),
        handed_on={name: it for name, it in launched.handed_on.items() if name not in gone},
    )


def as_launched(nodes: Iterable[NodeFacts], launched: Launched) -> Iterator[NodeFacts]:
    """Yield the nodes under rules and arguments of launch files, without those with only parameters."""
    origins = {it.name: it.origin for it in launched.nodes}
    for it in nodes:
        if it.name in launched.started:
            node = launched.started[it.name]
            made = with_static_transform(it, node.arguments)._replace(origin=origins[it.name])
            yield remapped(made, node.remappings, node.namespace)
        elif it.name in launched.spawned:
            controller = launched.spawned[it.name]
            above = controller.manager.rpartition("/")[0]
            yield remapped(it, controller.rules, above)
        elif it.host in launched.started:
            yield _in_process(it, launched.started[it.host])._replace(
                origin=origins.get(it.name, it.origin)
            )
        elif it.name in origins or it.host or it.name == MANAGER or not launched.whole:
            yield it


def _pair(
    number: int,
    it: LaunchedNode,
    node_set: Sequence[NodeFacts],
    known: Mapping[str, NodeFacts],
    words: Collection[str],
) -> _Pair:
    """Return a launched node and what is known of it, as a node of the robot."""
    base = known_node(it, node_set, known)
    own = own_name(it, base)
    check_names(it)
    name = it.name or own or guessed_name(it)
    facts = base or _unknown(it, name)
    unnamed = "" if it.name or own else NO_NAME
    rows = bridge_rows(it, words)
    # The rules of a node set do not count: those of the launch do.
    ends = (end._replace(remapped="") for end in facts.endpoints)
    found = facts._replace(
        name=_below(it.namespace, name, words),
        endpoints=rows or (*ends, *(_only_named(it, facts, name) if base else ())),
        known=facts.kind if base else "",
        # A node that usually serves all robots, in the namespace of one, is that robot's.
        shared=bool(facts.shared or once_for_all(it)) and not is_of_robot(it.namespace, words),
        when=it.later or unnamed,
        container=_below(it.container, "", words),
        # Without its folder: a plan is the same from every working directory.
        origin=Origin(place=Place(os.path.basename(it.place.file), it.place.line)),
        is_known=facts.is_known or bool(rows),
    )
    return _Pair(it, found, number)


def _unknown(it: LaunchedNode, name: str) -> NodeFacts:
    """Return an unknown node by its launch file: what runs it, and its rules."""
    run = {"component": it.executable} if it.container else {"programs": (it.executable,)}
    # Its rules name topics, as far as anybody can say.
    own = (old for old, _ in it.remappings if not check_topic_name(old))
    # It may send or read transforms: under these rules they are its robot's.
    names = dict.fromkeys((*own, *(f"/{topic}" for topic in TF_TOPICS)))
    ends = tuple(Endpoint(TOPIC, "", old) for old in names)
    return UNKNOWN._replace(name=name, package=it.package, endpoints=ends, **run)


def _only_named(it: LaunchedNode, facts: NodeFacts, name: str) -> Iterator[Endpoint]:
    """Yield topics of a known node that only its rules name: the program may have more than known."""
    there = {expand(end.name, it.namespace, name) for end in facts.endpoints}
    there |= {f"/{topic}" for topic in TF_TOPICS}
    for old in dict.fromkeys(old for old, _ in it.remappings if not check_topic_name(old)):
        if expand(old, it.namespace, name) not in there:
            yield Endpoint(TOPIC, "", old)


def is_of_robot(namespace: str, words: Collection[str]) -> bool:
    """Return whether a namespace is that of a robot, or below it."""
    return namespace.strip("/").partition("/")[0] in words


def _below(namespace: str, name: str, words: Collection[str]) -> str:
    """Return the name of a node as a node set has it: without the robot's namespace."""
    tokens = [*(it for it in namespace.split("/") if it), *([name] if name else [])]
    return "/".join(tokens[1:] if len(tokens) > 1 and tokens[0] in words else tokens)


def _is_left(node: NodeFacts, launched: Mapping[str, NodeFacts]) -> bool:
    """Return whether a launch file should start a node: of a node set, with its own process."""
    own = not node.host and not node.plugin and node.name != MANAGER
    return own and node.name not in launched and node.origin != NO_ORIGIN


def _hosted(
    pairs: Iterable[_Pair], known: Mapping[str, NodeFacts], there: Collection[str]
) -> Iterator[NodeFacts]:
    """Yield the nodes that run inside launched ones, such as costmaps, in the namespaces of these."""
    hosts = {it.facts.known: it.facts for it in pairs}
    for node in known.values():
        if node.host and node.host in hosts and node.host != MANAGER and node.name not in there:
            own = programs().names.get(f"{node.package}/{node.name}", node.name)
            known_as = node.name if own != node.name else node.known
            origin, when = hosts[node.host].origin, node.when or hosts[node.host].when
            yield node._replace(name=own, known=known_as, origin=origin, when=when)


def _controllers(
    spawned: Sequence[Spawned],
    pairs: Iterable[_Pair],
    words: Collection[str],
    parameters: KnownNodes,
) -> Iterator[Run]:
    """Yield what the launch files set for the controllers that they spawn."""
    own = {_full_name(it.node, it.facts): it.node.parameters for it in pairs}
    places = {_without_word(it.full_name.strip("/"), words): it.place for it in spawned}
    for manager, texts in texts_of(spawned, own):
        above = _without_word(manager.strip("/"), words)
        documents = [document_of(it.file, it.text) for it in texts if has_sections(it)]
        found: dict[str, Run] = {}
        for it in given_nodes(documents, parameters):
            name = _without_word(it.node, words)
            if name in places:
                # As it is started, with the type that a manager of any namespace declares.
                one = found.get(name, it)
                found[name] = one if one.program else it._replace(values=one.values)
        for name, it in found.items():
            yield _placed(it, places[name])._replace(node=name, host_name=above)


def _full_name(node: LaunchedNode, facts: NodeFacts) -> str:
    return expand(facts.name.rpartition("/")[2], node.namespace, "")


def _launched_values(
    pair: _Pair, inside: Iterable[NodeFacts], words: Collection[str], parameters: KnownNodes
) -> Iterator[Run]:
    """Yield what the launch file's parameters set for a node, the nodes in it and its controllers."""
    # Sections for any node count, too, so each node gets one of its own.
    first = ParameterText("", f"{_full_name(pair.node, pair.facts)}:\n  ros__parameters: {{}}\n")
    # launch_ros gives a component the values of a file without such a key; it names no node.
    files_ = (it for it in pair.node.parameters if has_sections(it))
    documents = [document_of(it.file, it.text) for it in (first, *files_)]
    names = {pair.facts.name, *(it.name for it in inside if it.host == pair.facts.known)}
    for it in given_nodes(documents, parameters):
        mine = without_robot(it, words)
        if mine.node in names or mine.host_name == pair.facts.name:
            yield _of_any_robot(_placed(mine, pair.node.place), pair.node.namespace, words)


def _of_any_robot(given: Run, namespace: str, words: Collection[str]) -> Run:
    """Return parameters of a robot's launch without the robot: ``/scan`` for ``/robot1/scan``."""
    own = [f"/{it}/" for it in words if f"{namespace}/".startswith(f"/{it}/")]
    if not own:
        return given
    above = max(own, key=len)
    values = dict(given.values)
    for name, it in given.values.items():
        if isinstance(it.value, str) and it.value.startswith(above):
            values[name] = it._replace(value=f"/{it.value.removeprefix(above)}")
    return given._replace(values=values)


def _placed(given: Run, place: Place) -> Run:
    """Return the settings; those of the launch file itself get the place that starts the node."""
    values = {
        name: it if it.place.file != OWN else it._replace(place=place)
        for name, it in given.values.items()
    }
    return given._replace(values=values, place=place if given.place.file == OWN else given.place)


def without_robot(given: Run, words: Collection[str]) -> Run:
    """Return a node of a file that is for one robot, without the namespace of that robot."""
    name, manager = (_without_word(it, words) for it in (given.node, given.host_name))
    return given._replace(node=name, host_name=manager)


def _without_word(name: str, words: Collection[str]) -> str:
    """Return a name without its first segment if this segment is a word for the robot."""
    above, slash, rest = name.partition("/")
    return rest if slash and above in words else name


def _in_process(node: NodeFacts, host: LaunchedNode) -> NodeFacts:
    """Return a node with the rules of its process, which reach all but controllers."""
    if node.host == MANAGER:
        return node
    below = node.name.rpartition("/")[0]
    above = f"{host.namespace.rstrip('/')}/{below}".rstrip("/")
    return remapped(node, host.remappings, above)
