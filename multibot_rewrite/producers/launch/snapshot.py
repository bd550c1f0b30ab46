# SPDX-License-Identifier: Apache-2.0
"""What a launch starts -> the graph that it would make: a snapshot, and what is not known of it.

Names are those that rcl makes of the rules, transforms those that parameters name. An end under a
condition that nobody knows may be there.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.rosnames import resolve_bound
from multibot_rewrite.base.wording import SEVERAL, plural, shorten, unique
from multibot_rewrite.description.readback.xml import root_of
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.knowledge.declared import is_known
from multibot_rewrite.planning.of_runs import each_once, ends_of, lookups_of, with_names
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.addresses import of_hardware, of_parameters
from multibot_rewrite.producers.ends import SensorFrame, sensor_on
from multibot_rewrite.producers.launch.beside_ends import (
    TF_TYPE,
    Sent,
    edges_of,
    interfaces_of,
    passed_on,
    prefix_of,
    publishes_a_tree,
    tree_of,
)
from multibot_rewrite.producers.launch.bridges import bridged_by, bridged_domains, is_bridge
from multibot_rewrite.producers.launch.findings import STOOD_IN
from multibot_rewrite.producers.launch.known_node import STATIC, as_heard, asks_who_listens
from multibot_rewrite.producers.launch.launched import (
    NOT_KNOWN,
    NOT_WHOLE,
    Launched,
    models_in_simulator,
    of_simulator,
    sensors_of,
)
from multibot_rewrite.producers.launch.models import (
    Models,
    frames_of_plugins,
    sent_by_plugins,
    sent_in_simulator,
)
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchNote
from multibot_rewrite.producers.launch.running import (
    CLOCK_TYPE,
    DESCRIPTION,
    SIMULATED,
    Knowledge,
    bound_of,
    running_nodes,
)
from multibot_rewrite.producers.sources.expressions import or_read
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import (
    PUBLISHES,
    RUNS,
    SIM_TIME,
    SUBSCRIBES,
    TOPIC,
    UNTOLD,
    Address,
    Caveat,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Parameter,
    Place,
    System,
)

NO_TREE, REFUSED = "description-not-known", "rcl-refuses"


class _Part(NamedTuple):
    """What one node adds to the graph: its endpoints, and its transforms by topic."""

    name: str
    endpoints: tuple[End, ...]
    edges: tuple[tuple[str, Edge], ...]


def launched(graph: LaunchGraph, known: Knowledge) -> Launched:
    """Return all that the launch starts, and its system, incomplete if something is unknown."""
    nodes, notes, models, published, spawned = running_nodes(graph, known)
    inside = sent_in_simulator(models.found)
    parts, refused = _parts(nodes, inside)
    of_plugins = sent_by_plugins(models.found)
    parts = [it._replace(edges=(*it.edges, *of_plugins.get(it.name, ()))) for it in parts]
    bridged = bridged_domains(nodes)
    every_note = (*graph.notes, *notes, *bridged.notes)
    caveats = (
        *([Caveat(NOT_WHOLE, False, STOOD_IN)] if graph.stood_in else ()),
        *_refused(refused),
        *_caveats(every_note, nodes),
        *_of_bridges(nodes, inside),
        *of_simulator(graph, models),
    )
    system = System(
        tuple(_nodes(nodes, parts)),
        tuple(_without_own_time([end for part in parts for end in part.endpoints])),
        tuple(_frames(parts)),
        Environment(caveats=caveats),
        release=known.release,
        parameters=tuple(_clocks(nodes, graph.notes)),
        lookups=tuple(it for node in nodes for it in lookups_of(node, prefix_of(node))),
        addresses=tuple(it for node in nodes for it in _addresses(node, known, models)),
        interfaces=tuple(interfaces_of(nodes, published, graph)),
    )
    simulated = models_in_simulator(models, known.release)
    found = Launched(graph, nodes, spawned, models, simulated, system, known.release, bridged)
    heard = [*_heard(nodes, sensors_of(simulated, known.release))]
    heard += _measured(parts, frames_of_plugins(models.found))
    return found._replace(system=system._replace(heard=tuple(heard)))


def _parts(nodes: Sequence[Run], inside: Sent) -> tuple[list[_Part], list[str]]:
    """Return what each node adds, asked anew while topics get subscribers; and refused nodes."""
    parts, refused = [], []
    for it in nodes:
        try:
            parts.append(_part(it, inside))
        except UsageError as error:
            refused.append(f"{it.full_name} ({it.place}: {error})")
            parts.append(_Part(it.full_name, (), ()))
    lazy = [at for at, it in enumerate(nodes) if asks_who_listens(it.fact)]
    lazy = [at for at in lazy if parts[at].endpoints]
    heard: Collection[str] = ()
    while lazy and heard != (now := frozenset(_read(parts))):
        heard = now
        for at in lazy:
            it = nodes[at]
            bound = bound_of(it.name, it.namespace, it.rules)
            parts[at] = _part(it._replace(fact=as_heard(it.fact, heard, bound)), inside)
    return parts, refused


def _read(parts: Iterable[_Part]) -> Iterator[str]:
    """Yield the topics that somebody subscribes to."""
    ends = (it for part in parts for it in part.endpoints if it.sure == RUNS)
    yield from (it.name for it in ends if it.role == SUBSCRIBES)


def _heard(nodes: Iterable[Run], sensors: Sequence[SensorFrame]) -> Iterator[Heard]:
    """Yield the frames of what bridges bring from sensors in the simulator."""
    for it in nodes:
        for end, inside in bridged_by(it):
            sensor = sensor_on(inside, sensors)
            # A node with a name that ROS refuses does not start.
            with suppress(UsageError):
                if end.role == PUBLISHES and sensor:
                    bound = bound_of(it.name, it.namespace, it.rules)
                    name = resolve_bound(end.name, end.kind, bound)
                    yield Heard(name, sensor.frame, link=sensor.link)


def _measured(parts: Iterable[_Part], frames: Mapping[str, str]) -> Iterator[Heard]:
    """Yield the frames of sensor data that nodes of plugins send."""
    for end in (it for part in parts if part.name in frames for it in part.endpoints):
        if end.sure == RUNS and end.role == PUBLISHES and end.type.startswith("sensor_msgs/"):
            yield Heard(end.name, frames[end.node])


def _addresses(it: Run, known: Knowledge, models: Models) -> Iterator[Address]:
    """Yield what a node alone can have, by its parameters and by hardware that is not simulated."""
    node = known.parameters.nodes.get(it.fact.known)
    params = node.params if node else {}
    # One file is often given to all nodes; what these read is known, but for that of their plugins.
    whole = is_known(it.program.partition("/")[0])
    own = {name: value for name, value in it.values.items() if name in params or "." in name}
    yield from of_parameters(it.full_name, params, own if whole else it.values)
    text = it.value(DESCRIPTION)
    root = None if any(one.spawned and one.text == text for one in models.found) else root_of(text)
    if root is not None:
        yield from of_hardware(root, it.full_name, it.place, load_definitions((), known.release))


def _nodes(running: Iterable[Run], parts: Iterable[_Part]) -> Iterator[Node]:
    """Yield the nodes, each with those that its code makes (``Endpoint.by``)."""
    for it, part in zip(running, parts, strict=True):
        known, untold = it.fact.kind, tuple(one.text for one in it.fact.untold)
        yield Node(part.name, it.process, place=it.place, known=known, untold=untold)
        own = dict.fromkeys(end.node for end in part.endpoints if end.node != part.name)
        yield from (Node(name, it.process, place=it.place, known=known) for name in own)


def _refused(nodes: Sequence[str]) -> Iterator[Caveat]:
    if nodes:
        text = f"rcl refuses {plural(len(nodes), 'node')}: {shorten(nodes)}"
        yield Caveat(REFUSED, True, text)


def _caveats(notes: Iterable[LaunchNote], nodes: Sequence[Run]) -> Iterator[Caveat]:
    """Yield why something may be missing in the graph of a launch."""
    # What several nodes lack is said once, where the first one does.
    first: dict[str, Place] = {}
    for note in (it for it in notes if not it.fails):
        first.setdefault(note.message, note.place)
    for message, place in first.items():
        yield Caveat(NOT_WHOLE, True, f"{place}: {message}")
    unknown = [
        f"{it.full_name} ({it.program})" for it in nodes if not it.is_known and not is_bridge(it)
    ]
    if unknown:
        listed = shorten(unknown, SEVERAL)
        hint = f"describe them in a file of nodes (--nodes, docs/node-sets.md){or_read()}"
        text = f"{plural(len(unknown), 'node')} not known, with all topics and frames: {listed}"
        yield Caveat(NOT_KNOWN, True, f"{text}; {hint}")
    partly = [it for it in nodes if it.is_known and it.fact.untold]
    if partly:
        told = shorten([f"{it.full_name} ({it.fact.untold[0].text})" for it in partly])
        text = f"{plural(len(partly), 'node')} known in part, by their source: {told}"
        yield Caveat(NOT_KNOWN, True, text)
    treeless = [it.full_name for it in nodes if publishes_a_tree(it) and tree_of(it) is None]
    if treeless:
        text = f"the description is not known, so neither are its frames: {shorten(treeless)}"
        yield Caveat(NO_TREE, True, text)


def _of_bridges(nodes: Sequence[Run], inside: Sent) -> Iterator[Caveat]:
    """Yield a limitation for bridges that pass on topics of the simulator as transforms."""
    bridges = []
    for it in nodes:
        ends = (own for end, own in bridged_by(it) if (end.role, end.type) == (PUBLISHES, TF_TYPE))
        bridges += [it.full_name] if not {*ends} <= inside.keys() else []
    if bridges:
        text = f"the transforms that the simulator sends are not known: {shorten(bridges)}"
        yield Caveat(NOT_KNOWN, True, text)


def _part(it: Run, inside: Sent) -> _Part:
    """Return what a node adds to the graph; raises UsageError for a name that rcl refuses."""
    bound = bound_of(it.name, it.namespace, it.rules)
    name = f"{bound.namespace.rstrip('/')}/{bound.node}"
    bound_of(it.name, it.process_namespace, it.process_rules)
    own = () if is_bridge(it) else ends_of(with_names(it))
    ends = [*own]
    for end, _ in bridged_by(it):
        full = resolve_bound(end.name, end.kind, bound)
        ends.append(End(end.kind, end.role, full, end.type, "", name, None, it.process))
    if it.value(SIM_TIME) is True and all(end.name != CLOCK for end in ends):
        ends.append(End(TOPIC, SUBSCRIBES, CLOCK, CLOCK_TYPE, "", name, None, it.process))
    return _Part(
        name, tuple(each_once(ends)), (*edges_of(it, bound), *passed_on(it, bound, inside))
    )


def _without_own_time(ends: Sequence[End]) -> Iterator[End]:
    """Yield the ends, without ``/clock`` of the simulator's process where nothing publishes it."""
    sent = any(it.role == PUBLISHES and it.name == CLOCK for it in ends if it.sure == RUNS)
    yield from (it for it in ends if sent or it.name != CLOCK or it.process != SIMULATED)


def _frames(parts: Sequence[_Part]) -> Iterator[Edge]:
    """Yield each transform once, with all who send it."""
    senders = lists_by_key((it, part.name) for part in parts for it in dict.fromkeys(part.edges))
    for (topic, edge), who in senders.items():
        yield edge._replace(topic=topic, publishers=unique(who), several=len(who) > 1)


def _clocks(nodes: Iterable[Run], notes: Iterable[LaunchNote]) -> Iterator[Parameter]:
    """Yield use_sim_time by node: as set, false by default, or unknown.

    What sends lasting transforms needs no time, and a bridge passes on the time that is in the
    data."""
    notes = [it for it in notes if it.parameters]
    # A file that is lost is told where components are loaded, not at each of them.
    unknown, lost = {it.place for it in notes}, {it.place.file for it in notes if it.file}
    for it in nodes:
        given = it.value(SIM_TIME)
        # An empty text is the output of a program that is not run here.
        untold = (
            it.is_untold(SIM_TIME)
            or given == ""
            or (given is None and (it.place in unknown or it.place.file in lost))
        )
        if is_bridge(it):
            continue
        if untold:
            yield Parameter(it.full_name, SIM_TIME, UNTOLD)
        elif it.fact.known not in ("", STATIC):
            text = parameter_text(given is True)
            yield Parameter(it.full_name, SIM_TIME, text)
