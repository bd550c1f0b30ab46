# SPDX-License-Identifier: Apache-2.0
"""The nodes that a robot of a fleet file runs: its node sets, as its own files have them."""

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, Finding, declare
from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.naming import find_layout, make_naming
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.readback.nodes import wheels_in
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources.own_names import ROBOT
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec, Sources
from multibot_rewrite.fleet.fleet import facts_of, known_nodes
from multibot_rewrite.fleet.launch.launched_robot import (
    given_with,
    known_here,
    launched_robot,
    nodes_with,
    under_plugins,
)
from multibot_rewrite.fleet.outputs.output_file import params_of, text_of, yaml_of
from multibot_rewrite.fleet.robots.fitting.fitted import (
    brings_transforms,
    changed_frames,
    described,
    fitted,
    fitting_frames,
    free_nodes,
    have_two_parents,
    is_led_elsewhere,
    sends_too,
    sent_by_controllers,
    with_frames,
)
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in, load_node_set
from multibot_rewrite.knowledge.nodl.lookup import declared
from multibot_rewrite.knowledge.parameters import (
    KnownNodes,
    is_absolute,
    is_below_costmap,
    is_called,
    load_known_nodes,
)
from multibot_rewrite.knowledge.records import CARTOGRAPHER, MANAGER, MOVE_GROUP, UNKNOWN, NodeFacts
from multibot_rewrite.planning.bridged_topics import is_bridged, plugin_libraries
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.ends import BRIDGE_NODE
from multibot_rewrite.producers.evidence.hardware import with_hardware
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.launch.findings import processes_not_known
from multibot_rewrite.producers.launch.handed_on import HandedOn, Passing, for_any
from multibot_rewrite.producers.launch.of_robot import (
    NO_QOS,
    NOTHING,
    Launched,
    without_bridges,
    without_robot,
)
from multibot_rewrite.producers.launch.records import IdleAction, LaunchedNode, LaunchOrder
from multibot_rewrite.producers.launch.spawners import Spawned
from multibot_rewrite.related_files.context import NO_FRAMES, Frames
from multibot_rewrite.related_files.lua import lua_values
from multibot_rewrite.related_files.rviz.display_groups import is_for_one, shown_in
from multibot_rewrite.related_files.rviz.read_config import read_config
from multibot_rewrite.system.records import Edge, Origin, Place

WORLD = "world"
# The node set of a controller manager that no plugin makes.
PROGRAM = "ros2_control"
BY_ARGUMENT = "an argument of the xacro makes it"
# What decides the nodes of a robot.
NodeSources = tuple[
    tuple[str, ...], tuple[tuple[str, ...], ...], tuple[LaunchOrder, ...], str, str, Sources
]
# What a launch hands on for any robot.
_HANDED_ON = ("handed_on", "environment", "placing", "idle", "qos")


def node_sources(spec: RobotSpec) -> NodeSources:
    """Return a key; robots with equal keys run the same nodes."""
    files = tuple(
        spec.related_files.get(it, ()) for it in ("params", "bridge", "rviz", "moveit", "lua")
    )
    files += ((spec.bridge_namespace,), *spec.bridges_below)
    return spec.node_sets, files, spec.launch, spec.srdf, spec.simulator, spec.sources


class RobotEvidence(NamedTuple):
    """What a robot's files set for nodes, what they start, and where they disagree.

    ``known`` are known nodes by name; ``spawned`` are controllers that launch files spawn.
    ``unsimulated``: launch files start all of its nodes and no simulator. ``arguments`` and
    ``environment`` are those of all that they start, ``handed_on`` is what they give to nodes,
    ``processes`` are no nodes, ``placing`` spawns it, ``idle`` is not started on a condition,
    ``qos`` is of their bridges' topics. ``frames`` replace defaults; ``simulated`` are
    transforms of a simulator, ``is_placed``: a node of its files sends one of these, too."""

    given: tuple[Run, ...]
    known: Mapping[str, NodeFacts]
    nodes: tuple[NodeFacts, ...]
    findings: tuple[Finding, ...]
    spawned: Mapping[str, Spawned]
    unsimulated: bool = False
    arguments: tuple[str, ...] = ()
    frames: Frames = NO_FRAMES
    simulated: tuple[Edge, ...] = ()
    is_placed: bool = False
    handed_on: Mapping[str, HandedOn] = NOTHING
    processes: tuple[Passing, ...] = ()
    environment: tuple[tuple[str, str], ...] = ()
    placing: LaunchedNode | None = None
    idle: tuple[IdleAction, ...] = ()
    qos: Mapping[str, object] = NO_QOS


def robot_nodes(
    spec: RobotSpec,
    file: FleetFile,
    notes: Sequence[Finding],
    member: Member,
    topics: Mapping[str, str],
) -> RobotEvidence:
    """Return the nodes of a robot with this description; raises InputError for a parameter file.

    ``notes`` are findings about its files, ``topics`` the full names that xacro arguments make,
    by the names without these."""
    parameters = load_known_nodes(file.nodes, file.distro)
    read = given_nodes(params_of(spec).values(), parameters)
    read = [*(it for it in read if it.name != CARTOGRAPHER), *_runs_of_lua(spec)]
    own = tuple(without_robot(it, spec.words) for it in read)
    known = _known_nodes(own, file)
    node_set = tuple(it for it in nodes_of_sets(spec, file) if _is_needed(it, spec, member))
    if spec.simulator != REAL:
        node_set = (*node_set, *_manager_in_plugin(node_set, own, member, spec, file.distro))
    known = known_here(known, spec.launch, spec.words[0], file.distro)
    launched = launched_robot(node_set, spec.launch, known, spec.words, parameters, file.distro)
    launched = without_bridges(launched) if launched else None
    given = given_with(launched, own)
    spawned = launched.spawned if launched else {}
    # A controller manager that only a parameter file has is as its usual launch files start it.
    started_here = {it.name: it for it in load_node_set(PROGRAM, file.distro) if it.name == MANAGER}
    without, findings = nodes_with(launched, node_set, given, known | started_here)
    managed = _without_idle_manager(without, launched, node_set, member)
    standing = _without_wheel_controllers(managed, given, member)
    wired = under_plugins(standing, launched, member.handed_on, file.distro)
    nodes = with_hardware(wired, member.source.root, member.source.file, known)
    whole = launched is not None and launched.whole
    of_srdf = () if whole else tuple(_srdf_nodes(spec, nodes, known))
    nodes = (*nodes, *of_srdf)
    has, started = described(member, spec), launched.started if launched else {}
    fits = fitting_frames(member, nodes, (*has.sent, *sent_by_controllers(nodes)))
    known = {name: with_frames(it, fits) for name, it in known.items()}
    own_fits = [with_frames(it, fits) for it in nodes]
    mine = frozenset(it.name for it in (*node_set, *of_srdf)) - started.keys()
    free = free_nodes(mine, given)
    # A node set of the user's own says what its nodes hear and send.
    has = has._replace(offered={}) if file.nodes else has
    mine = frozenset() if file.nodes else mine
    fitting = fitted(own_fits, mine, free, given, known, has, spec)
    frames, nodes = changed_frames(fitting, nodes), fitting
    written = _with_written_topics(nodes, own, parameters, file.distro)
    named = _with_topics_of_arguments(written, given, topics) if topics else written
    marked, shared = apart(tuple(named), file, spec)
    is_sent = _is_sent_beside(has.sent, nodes, free, member, bool(launched))
    evidence = RobotEvidence(
        given,
        known,
        marked,
        (*notes, *findings, *shared),
        spawned,
        frames=frames,
        simulated=has.sent,
        is_placed=(is_sent and not brings_transforms(spec)) or is_led_elsewhere(member, spec),
    )
    return _with_launch(evidence, spec, launched, file)


def _is_sent_beside(
    sent: Sequence[Edge],
    nodes: Sequence[NodeFacts],
    free: Collection[str],
    member: Member,
    is_launched: bool,
) -> bool:
    """Return whether something else than the simulator sends a transform that places the robot."""
    # Below another frame as well, where the vendor bridges none.
    if sends_too(nodes, free, sent, is_launched):
        return True
    # A vendor who bridges none of two that place the robot has a node that does.
    held = {it.get("link", "") for it in member.source.root.iterfind("joint/child")}
    return is_launched and (have_two_parents(sent) or any(it.child in held for it in sent))


def _runs_of_lua(spec: RobotSpec) -> Iterator[Run]:
    """Yield what the Lua file of a robot sets for its Cartographer."""
    for path in spec.related_files.get("lua", ()):
        run = Run("", CARTOGRAPHER, "", CARTOGRAPHER, (), UNKNOWN._replace(known=CARTOGRAPHER))
        yield run._replace(values=lua_values(text_of(spec, path), path), place=Place(path, 1))


def _without_idle_manager(
    nodes: tuple[NodeFacts, ...],
    launched: Launched | None,
    node_set: Iterable[NodeFacts],
    member: Member,
) -> tuple[NodeFacts, ...]:
    """Return the nodes without a manager that only has parameters: launch files do not start it."""
    # The spawners wait as they do for one robot.
    runs = any(it.name == MANAGER for it in node_set)
    runs = runs or any(it.manager for it in member.reading.nodes)
    if runs or not (launched and launched.whole and launched.spawned):
        return nodes
    return tuple(it for it in nodes if it.name != MANAGER or it.name in launched.started)


def _without_wheel_controllers(
    nodes: tuple[NodeFacts, ...], given: Iterable[Run], member: Member
) -> tuple[NodeFacts, ...]:
    """Return the nodes, without wheel controllers if the robot has no wheels."""
    root = member.source.root
    held = root.iterfind("joint[@type='fixed']/parent")
    if wheels_in(root) and not any(it.get("link") == WORLD for it in held):
        return nodes
    filed = {it.node for it in given}
    return tuple(
        it for it in nodes if it.name in filed or not (it.host == MANAGER and it.when and it.sends)
    )


def _with_launch(
    it: RobotEvidence, spec: RobotSpec, launched: Launched | None, file: FleetFile
) -> RobotEvidence:
    """Return a robot's evidence with what its launch files start."""
    if not launched:
        return it
    every = (one._replace(once=_runs_once(one.name, one.once, file)) for one in launched.processes)
    own: dict[str, Any] = {it: getattr(launched, it) for it in _HANDED_ON}
    own["processes"] = tuple(every)
    # It may be asked for one robot by name.
    if any(ROBOT in value for one in spec.launch for _, value in one.arguments):
        own = {name: for_any(given, spec.name) for name, given in own.items()}
    return it._replace(
        findings=(*it.findings, *processes_not_known(own["processes"])),
        unsimulated=launched.whole and not launched.simulated,
        arguments=tuple(word for one in launched.started.values() for word in one.arguments),
        **own,
    )


def _with_written_topics(
    nodes: Iterable[NodeFacts], own: Iterable[Run], known: KnownNodes, release: str
) -> Iterator[NodeFacts]:
    """Yield the nodes with costmap topics as the files will have them, absolute if necessary."""
    outside = {it.node: frozenset(_outside_parameters(it, known, release)) for it in own}
    for it in nodes:
        moved = outside.get(it.name, frozenset())
        ends = (
            end._replace(name=f"/{end.name}")
            if end.parameter in moved and end.name[0] not in "/~"
            else end
            for end in it.endpoints
        )
        yield it._replace(endpoints=tuple(ends)) if moved else it


def _with_topics_of_arguments(
    nodes: Iterable[NodeFacts], given: Iterable[Run], topics: Mapping[str, str]
) -> Iterator[NodeFacts]:
    """Yield the nodes with topics in parameters that xacro arguments make, by full names."""
    values = {it.node: it.values for it in given}
    for it in nodes:
        own = values.get(it.name, {})
        names = (topics.get(end.name) or topics.get(end.name.lstrip("/")) for end in it.endpoints)
        ends = (
            end._replace(name=name, fixed=BY_ARGUMENT, own=True)
            if name and end.parameter in own
            else end
            for end, name in zip(it.endpoints, names, strict=True)
        )
        yield it._replace(endpoints=tuple(ends))


def _outside_parameters(it: Run, known: KnownNodes, release: str) -> Iterator[str]:
    """Yield a node's parameters whose relative topics are resolved outside its robot's namespace."""
    if it.fact.known not in known.nodes:
        return
    params = [one for one in known.nodes[it.fact.known].params.values() if one.absolute]
    for name in it.values if params else ():
        plugin = it.values.get(f"{name.rpartition('.')[0]}.plugin")
        below = plugin is not None and is_below_costmap(str(plugin.value))
        fitting = (one for one in params if is_called(one, name))
        if any(below or is_absolute(one, release) for one in fitting):
            yield name


def _is_needed(it: NodeFacts, spec: RobotSpec, member: Member) -> bool:
    """Return whether a node runs: a plugin's, a manager without a plugin, a bridge with topics."""
    if it.plugin and spec.simulator == REAL:
        return False
    if it.name == MANAGER and not it.plugin and spec.simulator != REAL:
        return not any(one.manager for one in member.reading.nodes)
    if it.plugin:
        # On Humble it has the name of Ignition, too.
        loaded = {name.replace("ign_", "gz_", 1) for name in plugin_libraries(member.inventory)}
        return library_key(it.plugin) in loaded
    if it.name != BRIDGE_NODE or spec.related_files.get("bridge"):
        return True
    return spec.simulator != REAL and (it.shared or is_bridged(member.inventory))


def _srdf_nodes(
    spec: RobotSpec, nodes: Iterable[NodeFacts], known: Mapping[str, NodeFacts]
) -> Iterator[NodeFacts]:
    """Yield the node that reads an SRDF, which may run, unless a node set or launch file has it."""
    if spec.srdf and MOVE_GROUP not in {it.kind for it in nodes}:
        file = os.path.basename(spec.srdf)
        yield known[MOVE_GROUP]._replace(
            when=f"its SRDF is {file}", origin=Origin(place=Place(spec.srdf, 1))
        )


def _known_nodes(given: Iterable[Run], file: FleetFile) -> dict[str, NodeFacts]:
    """Return the known nodes; those in the robot's files as their packages declare them."""
    facts = known_nodes(file.nodes, file.distro, file.nodl)
    nodes = dict(facts.library.nodes)
    named = {it.fact.known for it in given} & nodes.keys()
    return nodes | {name: declared(facts, nodes[name]) for name in named}


def nodes_of_sets(spec: RobotSpec, file: FleetFile) -> tuple[NodeFacts, ...]:
    """Return the nodes of a robot's node sets, as their usual files have them."""
    return facts_of(spec.node_sets, file.nodes or None, file.distro, file.nodl)


def _manager_in_plugin(
    node_set: Iterable[NodeFacts],
    own: Iterable[Run],
    member: Member,
    spec: RobotSpec,
    release: str,
) -> Iterator[NodeFacts]:
    """Yield the controller manager of a plugin, as the plugin's node set has it."""
    # If a file sets it, or a node set has controllers and no manager. None for a launch file where
    # the plugin has a namespace of its own: the description's reading has that manager.
    nodes = tuple(node_set)
    made = {it.manager for it in member.reading.nodes} - {""}
    elsewhere = made and not any(it.endswith(f"/{spec.namespace}/{MANAGER}") for it in made)
    if any(it.name == MANAGER for it in nodes) or (spec.launch and elsewhere):
        return
    wide = (it.section for it in member.reading.nodes if it.section.process_wide)
    names = {name for it in wide for name in it.names}
    library = built_in(release)
    if any(it.host == MANAGER for it in nodes) or any(it.fact.known == MANAGER for it in own):
        every = (
            it for name in library.node_sets for it in nodes_of_set(library, name) if it.plugin
        )
        yield from [it for it in every if it.name == MANAGER and it.plugin in names][:1]


def related_file_nodes(
    nodes: Sequence[NodeFacts], node_set: Sequence[NodeFacts]
) -> Iterator[NodeFacts]:
    """Yield the nodes whose related files are rewritten, with the names in their code."""
    bare: Mapping[str, NodeFacts] = {it.name: it for it in node_set}
    # A section for a node in a namespace below the robot's is known to be right if the node runs there.
    mine = (it for it in nodes if it.name in bare or it.shared or it.host or "/" in it.name)
    yield from (bare.get(it.name, it)._replace(shared=it.shared) for it in mine)


def launched_nodes(evidence: RobotEvidence, others: Iterable[NodeFacts]) -> Iterator[NodeFacts]:
    """Yield the other nodes that surely run, with ends under the names in their code."""
    found = {it.name for it in others}
    for it in evidence.nodes:
        if it.name not in found and it.kind in evidence.known and not it.when:
            code = {end.name for end in evidence.known[it.kind].endpoints}
            yield it._replace(endpoints=tuple(end for end in it.endpoints if end.name in code))


RVIZ = "rviz2"
MANAGERS = "nav2_lifecycle_manager"
NOT_MANAGED = declare("MF803", "shared-node-not-managed", NOTE, formats=("fleet",))


def why_for_each(path: str, layout: str) -> str:
    """Return why each robot has a window of its own; empty if one window shows all robots."""
    chosen = find_layout(layout)
    if chosen.tf_per_robot:
        return "each robot has its own tf topic, and one rviz2 reads one"
    with suppress(MultibotError):
        if chosen.namespaced and any(map(is_for_one, shown_in(read_config(yaml_of(path))))):
            return "panels or displays in it work for one robot alone"
    return ""


def apart(
    nodes: Sequence[NodeFacts], file: FleetFile, spec: RobotSpec
) -> tuple[tuple[NodeFacts, ...], tuple[Finding, ...]]:
    """Return the nodes with shared ones marked, and findings about lifecycle managers of these."""
    config = next(iter(spec.related_files.get("rviz", ())), "")
    own_window = why_for_each(config, make_naming(**file.policy).layout.name)
    usual = ((it, it.shared and not (own_window and it.kind == RVIZ)) for it in nodes)
    marked = [it._replace(shared=_runs_once(it.name, once, file)) for it, once in usual]
    shared = {it.name: None for it in marked if it.shared}
    managers = [it for it in marked if it.package == MANAGERS and not it.shared]
    left, notes = {}, []
    for it in managers:
        heads = [end.name.partition("/")[0] for end in it.endpoints]
        ends = zip(it.endpoints, heads, strict=True)
        left[it.name] = it._replace(
            endpoints=tuple(end for end, head in ends if head not in shared)
        )
        for name in (name for name in file.shared_nodes if name in heads):
            message = f"{it.name} of each robot manages {name}, which all robots share"
            hint = f"remove {name} from its node_names, and start {name} with a manager of its own"
            notes.append(NOT_MANAGED.finding(message, hint, file=file.file, line=1))
    return tuple(left.get(it.name, it) for it in marked), tuple(notes)


def _runs_once(name: str, once: bool, file: FleetFile) -> bool:
    return (once or name in file.shared_nodes) and name not in file.own_nodes


def check_shared(file: FleetFile, run: Mapping[str, object]) -> None:
    """Raise InputError for a node of the file's lists that robots do not ``run``."""
    for key, names in (("shared_nodes", file.shared_nodes), ("own_nodes", file.own_nodes)):
        for name in (it for it in names if it not in run):
            near = did_you_mean_one_of(name, tuple(run)) or "name a node of a robot's node set"
            raise InputError(f"{file.file}: {key}: no robot has a node {name!r}; {near}")
