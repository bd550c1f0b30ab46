# SPDX-License-Identifier: Apache-2.0
"""What a launch starts -> its nodes as they run, with their parameters and remap rules.

Every launched node is taken as it is: nothing is known here of robots, node sets and layouts. A
launch file that is wrong is to be seen as it is."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.base.rosnames import (
    BoundNode,
    NameFault,
    RemapRule,
    bind,
    expand,
    read_remap,
    resolve_bound,
)
from multibot_rewrite.description.readback.xml import root_of
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import MANAGER, UNKNOWN, Endpoint, NodeFacts
from multibot_rewrite.planning.records import Rules, Run
from multibot_rewrite.planning.table import plugin_nodes
from multibot_rewrite.planning.ways import COSTMAP_HAS_RULES_OF_ITS_PARENT
from multibot_rewrite.producers.evidence.filling import filled
from multibot_rewrite.producers.evidence.hardware import components, with_hardware
from multibot_rewrite.producers.evidence.parameter_files import OWN_TYPE, given_nodes, values_for
from multibot_rewrite.producers.launch.describe import CLASSIC, SIMULATOR
from multibot_rewrite.producers.launch.handed_on import document_of, has_sections
from multibot_rewrite.producers.launch.known_node import (
    STATIC,
    as_named,
    guessed_name,
    known_node,
    own_name,
    with_options,
    with_static_transform,
)
from multibot_rewrite.producers.launch.models import (
    Model,
    Models,
    Published,
    managers,
    models_of,
    rules_of,
)
from multibot_rewrite.producers.launch.programs import passes
from multibot_rewrite.producers.launch.records import (
    AT_AN_END,
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    ParameterText,
)
from multibot_rewrite.producers.launch.spawners import Spawned, spawned_in, texts_of
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Place

DESCRIPTION = "robot_description"
# What a controller is whose type no file says.
UNTYPED = "a controller"
# The process of the managers that plugins make.
SIMULATED = "simulator"
_CLASSIC_SPAWNER, _INIT = "spawn_entity.py", "gazebo_ros_init"
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"


class Knowledge(NamedTuple):
    """What is known of nodes and their parameters in a release."""

    nodes: Mapping[str, NodeFacts]
    parameters: KnownNodes
    release: str


class Running(NamedTuple):
    """The nodes that a launch starts, hosted ones, controllers, plugins; and their descriptions."""

    nodes: tuple[Run, ...]
    notes: tuple[LaunchNote, ...]
    models: Models
    published: Mapping[str, str]
    spawned: tuple[Spawned, ...]


def running_nodes(graph: LaunchGraph, known: Knowledge) -> Running:
    """Return all that a launch starts."""
    spawned, notes = spawned_in(graph.nodes)
    started = [it for it in graph.nodes if not passes(it)]
    containers = {full_name(it, None): it for it in started}
    found: list[Run] = []
    for at, it in enumerate(started):
        found += _started(it, containers.get(it.container), f"{at}", known)
    unsure = (it for it in started if not it.name or it.later in AT_AN_END)
    found = [*_with_own_names(found, {full_name(it, None) for it in unsure})]
    descriptions = [*_descriptions(found)]
    models = models_of(graph.nodes, descriptions, known.release)
    asked = {it.manager for it in spawned}
    first: dict[str, Rules] = {}
    for model in models.found:
        made = managers(model, dict(graph.files))
        if model.spawned and controller_way(known.release).process_wide:
            # All managers of a program have the rules of the process, which are those of the first.
            rules = ((it, first.setdefault(it.executable, it.remappings)) for it in made)
            made = (it._replace(remappings=own) for it, own in rules)
        # A description may be published, and spawned from its file.
        lost = asked if model.spawned else asked - {it.full_name for it in found}
        wanted = [it for it in made if model.spawned or full_name(it, None) in lost]
        found += [one for it in wanted for one in _started(it, None, SIMULATED, known)]
        found += (*_plugins(model), *_helpers(model, known)) if model.spawned else ()
        started += wanted
    found += _made_by_hardware(found, {it.topic: it.text for it in descriptions}, known)
    found += _clock(graph)
    by_name = {it.full_name: it for it in found if it.fact.known == MANAGER}
    controllers = _controllers(spawned, by_name, started, known)
    alone = [it for it in spawned if it.manager not in by_name]
    nodes, more = (*found, *controllers), (*notes, *_without_manager(alone))
    return Running(nodes, more, models, {it.topic: it.text for it in descriptions}, spawned)


def _with_own_names(found: Sequence[Run], unsure: Collection[str]) -> Iterator[Run]:
    """Yield the nodes; unknown programs whose shared name is a guess get other names."""
    times = Counter(it.full_name for it in found)
    for it in found:
        guessed = not it.has_fact and it.full_name in unsure and times[it.full_name] > 1
        yield it._replace(name=f"{it.name}_{it.process}") if guessed else it


def _descriptions(nodes: Iterable[Run]) -> Iterator[Published]:
    """Yield the descriptions that launched nodes have as parameters."""
    for it in nodes:
        given = it.values.get(DESCRIPTION)
        if given and isinstance(given.value, str):
            with suppress(UsageError):
                topic = resolve_bound(DESCRIPTION, TOPIC, bound_of(it.name, it.namespace, it.rules))
                yield Published(given.value, topic, it.place)


def bound_of(name: str, namespace: str, rules: Rules) -> BoundNode:
    """Return a node under its rules; raises UsageError for one that rcl refuses."""
    found: list[RemapRule] = []
    for text in (f"{old}:={new}" for old, new in rules):
        rule = read_remap(text)
        if isinstance(rule, NameFault):
            raise UsageError(f"rule {text!r}: {rule.reason}")
        found.append(rule)
    return bind(name, namespace, found)


def _plugins(model: Model) -> Iterator[Run]:
    """Yield the nodes of plugins in the simulator."""
    # Of gz the manager is the node of the plugin.
    nodes = [it for it in model.reading.nodes if it.manager != it.full_name]
    facts = {it.node: it.fact for it in plugin_nodes(model.reading, model.name)}
    for it in nodes:
        # Of what only a remap rule names it is not known whether it is sent or read; what a plugin with
        # a manager publishes its controllers do.
        known = () if it.manager else tuple(end for end in facts[it.name].endpoints if end.role)
        own, home = facts[it.name]._replace(endpoints=known), it.namespace or "/"
        at = it.section.names[0], model.place
        yield _simulated(it.name, home, own, *at)._replace(rules=tuple(rules_of(it)))


def _helpers(model: Model, known: Knowledge) -> Iterator[Run]:
    """Yield the nodes that plugins make for themselves, without rules, next to the one they load."""
    for it in (it for it in model.reading.nodes if it.helper):
        above, _, name = it.helper.rpartition("/")
        fact = known.nodes.get(name, UNKNOWN)
        yield _simulated(name, above or "/", fact, it.section.names[0], model.place)


def _simulated(name: str, home: str, fact: NodeFacts, program: str, place: Place) -> Run:
    """Return a node in the process of the simulator."""
    own = Run("", name, home, name, (), fact, process=SIMULATED, process_namespace=home)
    return own._replace(program=program, place=place)


def _made_by_hardware(
    nodes: Sequence[Run], published: Mapping[str, str], known: Knowledge
) -> Iterator[Run]:
    """Yield the nodes that hardware makes in its manager's process, under its process's rules."""
    for it in nodes:
        if it.fact.known != MANAGER or it.process == SIMULATED:
            continue
        root = root_of(it.value(DESCRIPTION) or _described(it, published))
        if root is None:
            continue
        bare = it._replace(values={}, arguments=(), texts=(), untold=(), rules=it.process_rules)
        made = with_hardware((it.fact,), root, it.place.file, known.nodes)[1:]
        for one in (*made, *components(root, it.place.file, known.nodes)):
            yield bare._replace(node=one.name, name=one.name, fact=one)


def _described(manager: Run, published: Mapping[str, str]) -> str:
    """Return the description on the topic of a manager, which is private in Humble; empty for none."""
    with suppress(UsageError):
        bound = bound_of(manager.name, manager.namespace, manager.rules)
        topics = (resolve_bound(it, TOPIC, bound) for it in (DESCRIPTION, f"~/{DESCRIPTION}"))
        return next((published[it] for it in topics if it in published), "")
    return ""


def _clock(graph: LaunchGraph) -> Iterator[Run]:
    """Yield Gazebo Classic as a node that sends the clock (gazebo_ros_init.cpp); gz has a bridge."""
    classic = [it for it in graph.nodes if it.package == CLASSIC]
    # Who spawns has the simulator running, if in another launch file.
    started = [it for it in classic if it.executable == SIMULATOR]
    started = started or [it for it in classic if it.executable == _CLASSIC_SPAWNER]
    for it in started:
        # Its launch files load its plugin for the clock, a command line may not.
        if "-s" not in it.arguments or any(_INIT in word for word in it.arguments):
            clock = Endpoint(TOPIC, PUBLISHES, CLOCK, CLOCK_TYPE)
            fact = NodeFacts("gazebo", it.package, (clock,))
            yield _simulated(fact.name, "/", fact, SIMULATOR, it.place)
            return


def full_name(it: LaunchedNode, facts: NodeFacts | None) -> str:
    """Return the full name of a launched node; by its code if the launch file has none."""
    own = own_name(it, facts) or guessed_name(it)
    # A rule for the one node of the process that its code calls so.
    return expand(it.name or dict(it.remappings).get(f"{own}:__node", own), it.namespace, "")


def _started(
    it: LaunchedNode, container: LaunchedNode | None, process: str, known: Knowledge
) -> Iterator[Run]:
    """Yield a launched node, and the nodes that its code makes in its process."""
    facts = known_node(it, (), known.nodes)
    name = full_name(it, facts)
    if not it.name and facts and facts.kind == STATIC:
        # A name of its own each time (tf2_ros static_transform_broadcaster_node.cpp).
        name = f"{name}_{process}"
    home = container.remappings if container else () if it.container else it.remappings
    inside = () if facts is None else [n for n in known.nodes.values() if n.host == facts.kind]
    hosted = {expand(n.name, it.namespace, ""): n for n in inside if facts and not n.is_controller}
    documents = [document_of(text.file, text.text) for text in it.parameters if has_sections(text)]
    handed_on = it.container and has_release(COSTMAP_HAS_RULES_OF_ITS_PARENT, known.release)
    for full, own in {name: facts or UNKNOWN, **hosted}.items():
        above, _, last = full.rpartition("/")
        rules = it.remappings if full == name or handed_on else home
        run = Run(
            *("", full.strip("/"), above or "/", last, rules, own),
            process=it.container or process,
            process_namespace=(container or it).namespace,
            process_rules=home,
            values=with_options(it.arguments, values_for(full, documents)),
            texts=tuple(text.text for text in it.parameters if not has_sections(text)),
            untold=tuple(text.untold for text in it.parameters if text.untold),
            program=f"{it.package}/{it.executable}",
            arguments=it.arguments if full == name else (),
            place=it.place,
        )
        yield run._replace(node=last, fact=_with_values(run))


def _with_values(run: Run) -> NodeFacts:
    """Return what is known of a node with its values; an end whose type they choose has its default."""
    if not run.has_fact:
        return run.fact
    made = filled(run.fact, run)._replace(known=run.fact.kind)
    if not run.untold:
        ends = (it._replace(also=()) if it.types else it for it in made.endpoints)
        made = made._replace(endpoints=tuple(ends))
    return with_static_transform(as_named(made, run.arguments, run.values), run.arguments)


def _controllers(
    spawned: Sequence[Spawned],
    managers: Mapping[str, Run],
    started: Iterable[LaunchedNode],
    known: Knowledge,
) -> Iterator[Run]:
    """Yield the controllers that spawners load into launched managers, if they are activated."""
    if not spawned:
        return
    facts = ((it, None if it.name else known_node(it, (), known.nodes)) for it in started)
    own = {full_name(it, fact): it for it, fact in facts}
    forwarded = controller_way(known.release)
    for name, texts in texts_of(spawned, {name: it.parameters for name, it in own.items()}):
        if name not in managers:
            continue
        manager = managers[name]
        # What a launch file sets itself is for /**: with a section of its own the manager has it.
        of_all = ParameterText("", f"{name}:\n  ros__parameters: {{}}\n")
        documents = [document_of(it.file, it.text) for it in (of_all, *texts) if has_sections(it)]
        given = given_nodes(documents, known.parameters, managers=(name.strip("/"),))
        active = (it for it in spawned if it.manager == name and not it.inactive)
        # A spawner skips what is loaded already (spawner.py).
        for it in {it.name: it for it in active}.values():
            mine = _settings_of(it, given)
            wide = manager.rules if forwarded.of_manager else ()
            # A name that the launch file gives is a rule for every node of the process.
            is_process = forwarded.process_wide and manager.process != SIMULATED
            is_named = is_process and own[name].name
            fact = known.nodes.get(mine.fact.known, UNKNOWN)
            yield Run(
                *("", it.name, manager.namespace, manager.name if is_named else it.name),
                rules=(*wide, *it.rules),
                fact=_with_values(mine._replace(fact=fact)),
                process=manager.process,
                process_namespace=manager.namespace,
                values=mine.values,
                program=mine.program or UNTYPED,
                place=it.place,
            )


def _settings_of(controller: Spawned, given: Sequence[Run]) -> Run:
    """Return what files set for a controller; its type is in its own or any manager's section."""
    mine = next(it for it in given if f"/{it.node}" == controller.full_name)
    own = mine.values.get(OWN_TYPE)
    if not mine.program and own and isinstance(own.value, str):
        mine = mine._replace(program=own.value)
    typed = (it for it in given if it.program and it.node.rpartition("/")[2] == controller.name)
    declared = mine if mine.program else next(typed, mine)
    return declared._replace(node=mine.node, values={**declared.values, **mine.values})


def _without_manager(lost: Sequence[Spawned]) -> Iterator[LaunchNote]:
    """Note managers that neither the launch nor a plugin of a published description starts."""
    for manager in dict.fromkeys(it.manager for it in lost):
        mine = [it for it in lost if it.manager == manager]
        names = ", ".join(dict.fromkeys(it.name for it in mine))
        who = "no node of the launch and no plugin of a published description"
        text = f"{manager} is started by {who}, so {names} are not known"
        yield LaunchNote(mine[0].place, text)
