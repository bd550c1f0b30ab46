# SPDX-License-Identifier: Apache-2.0
"""A planned fleet -> what its launch file starts, robot by robot; ``launch_python`` writes it down.

What only runs under a condition that no file answers, and nodes whose program is not known, are left
to the reader: they are named in the file.
"""

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from multibot_rewrite.base.conventions import BY_HAND
from multibot_rewrite.fleet.file.domains import MOVE_GROUP
from multibot_rewrite.fleet.file.fleet_file import BRINGUP
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.own_processes import own_processes, process_for, renamed_word
from multibot_rewrite.fleet.launch.starts import SIMULATOR, RobotStarts
from multibot_rewrite.fleet.outputs import moveit_parameters, spawn
from multibot_rewrite.fleet.outputs.moveit_parameters import parameters_path
from multibot_rewrite.fleet.outputs.output_file import (
    OPTIONS,
    described_path,
    expanded_name,
    gz_bridge_path,
    params_paths,
    path_for,
)
from multibot_rewrite.fleet.outputs.relays import not_bridged, relays
from multibot_rewrite.fleet.robots import start_poses
from multibot_rewrite.fleet.robots.node_names import NodeNames, names_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.knowledge.conditions import UNSENT, readable
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.programs import (
    LIFECYCLE_MANAGER,
    NAV2,
    Program,
    is_unmanaged,
    known_program,
    program_of,
    started_as,
)
from multibot_rewrite.knowledge.records import CARTOGRAPHER, MANAGER, NodeFacts, names_its_process
from multibot_rewrite.planning.domain_bridge import bridge_name, bridge_path
from multibot_rewrite.planning.start import (
    File,
    Parameters,
    Start,
    Text,
    path_of,
    spawner_of,
    start_of,
)
from multibot_rewrite.planning.ways import Started
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.evidence.parameter_files import OWN_TYPE
from multibot_rewrite.producers.launch.bridges import services_in
from multibot_rewrite.producers.launch.handed_on import (
    DESCRIPTION,
    SEMANTIC,
    HandedOn,
    for_robot,
)
from multibot_rewrite.producers.launch.known_node import LUA_FLAGS, STATIC, with_frames
from multibot_rewrite.system.records import COMPONENT, PUBLISHES, SPAWNER
from multibot_rewrite.system.words import START_POSE, last_word

STATE = "robot_state_publisher"
# What launch files themselves set, by robot and node.
Values: TypeAlias = Mapping[tuple[str, str], Mapping[str, Any]]
# Started by hand, or once for all robots.
_BY_HAND = (*BY_HAND, "ros_gz_bridge", START_POSE)
# What helps where a node is not started.
_DESCRIBE = "describe it in a file of nodes, with `{}:` (docs/node-sets.md)"
_NAME = (
    "if it runs, add it to a `node_sets:`, name its launch file under `launch:`, or start it here"
)
_OTHERWISE = "give it another value behind its file under `launch:`, and build again"
_OF_MOVEIT = ("move_group", "servo_node")
# What of MoveIt's parameters has names of joints, links and controllers.
_NAMED = ("robot_description", "moveit_simple_controller_manager", "moveit_ros_control_interface")
_BRIDGE = ("ros_gz_bridge", "parameter_bridge")


def of_robot(
    one: FleetPlan,
    files: Mapping[str, bool],
    bridged: Collection[str],
    values: Values,
    texts: Mapping[str, bytes],
) -> RobotStarts:
    """Return what the one robot of a plan runs.

    ``files`` are the paths that the build writes, each with whether it has launch substitutions;
    ``bridged`` the topics from a simulator; ``values`` what launch files themselves set; ``texts``
    what the build writes."""
    (robot,) = one.robots
    names = names_of(one.fleet.table, robot.spec.namespace)
    facts = {it.name: it for it in one.evidence_of(robot).nodes}
    readers = dict(_readers(one, robot))
    given = _Given(one, robot, names, facts, files, bridged, values, readers, {})
    given = given._replace(left=dict(_not_started(given)))
    # The nodes that are started, and those in their processes.
    started = tuple(
        names.full_name(it)
        for name in given.running
        for it in (name, *(inner for inner in names.inside(name) if inner not in given.left))
    )
    words = (b"*", *(last_word(it).encode() for it in started))
    params = [it for it in params_paths(robot, files) if any(word in texts[it] for word in words)]
    given = given._replace(params=params)
    processes = (_start_of(given, it) for it in given.running if names.started[it].way != COMPONENT)
    relayed = [it.start for it in relays(robot.spec.namespace, one.fleet.naming, one.file)]
    launched = sorted((*processes, *own_processes(one, robot)), key=lambda it: it.number)
    starts = (
        *launched,
        *(it.start for it in start_poses.start_poses(one).transforms),
        *(it for it in relayed if not it.needs),
        *_domain_bridge(robot, files),
        *(it for it in relayed if it.needs),
        *(it._replace(condition=SIMULATOR) for it in _spawn_starts(given)),
    )
    spaces = {it.namespace for it in names.nodes.values() if it.namespace != "/"}
    # What launch files do not start with the arguments that they are given, each with these.
    idle = (
        (it.what, f"{os.path.basename(it.place.file)}:{it.place.line} has {it.why}; {_OTHERWISE}")
        for it in one.evidence_of(robot).idle
    )
    return RobotStarts(
        robot.spec.name,
        os.path.basename(robot.spec.description),
        f"namespace {min(spaces, key=len)}" if spaces else "the root namespace",
        tuple(File(it, files[it]) for it in params),
        starts,
        (*given.left.items(), *idle),
        not_bridged(robot.spec.name) if any(it.needs for it in relayed) else "",
        started,
    )


class _Given(NamedTuple):
    """What is known of a robot; ``left`` are nodes that are not started, with the reason.

    ``readers`` are the nodes that get the parameter files of launch files, ``params`` the parameter
    files with a section for a node that is started."""

    plan: FleetPlan
    robot: RewrittenRobot
    names: NodeNames
    facts: Mapping[str, NodeFacts]
    files: Mapping[str, bool]
    bridged: Collection[str]
    values: Values
    readers: Mapping[str, Collection[str]]
    left: Mapping[str, str]
    params: Sequence[str] = ()

    @property
    def release(self) -> str:
        return self.plan.file.distro

    @property
    def running(self) -> list[str]:
        """The nodes that are started, by their names in the node sets."""
        return [it for it in self.names.started if it not in self.left]


def _not_started(given: _Given) -> Iterator[tuple[str, str]]:
    """Yield (node, reason) for nodes that are not started; empty if something else starts them."""
    naming, file = given.plan.fleet.naming, given.plan.file
    relayed = {it.run.node for it in relays(given.robot.spec.namespace, naming, file)}
    for name in given.names.started:
        it = given.facts.get(name)
        if name in relayed or not {name, it.kind if it else ""}.isdisjoint(_BY_HAND):
            yield name, ""
        elif it is None:
            yield name, f"nothing is known of its program; {_DESCRIBE.format('programs')}"
        elif it.when and not _is_needed(given, it):
            yield name, f"nothing in the fleet file starts it: {readable(it.when)}; {_NAME}"
        elif given.plan.file.params_style == BRINGUP and name != STATE:
            yield name, "parameter files are in the form of nav2_bringup, which starts it"
        elif it.kind == LIFECYCLE_MANAGER and not any(_managed(given, name)):
            yield name, "what it manages runs once for all robots, with a manager of its own"
        elif not given.names.is_controller(name) and _program(given, name) is None:
            is_component = given.names.started[name].way == COMPONENT
            what, key = ("class", "component") if is_component else ("program", "programs")
            yield name, f"the {what} of package {it.package} is not known; {_DESCRIBE.format(key)}"


def _is_needed(given: _Given, it: NodeFacts) -> bool:
    """Return whether a conditional node runs: it is launched, or nobody else sends its topic."""
    evidence = given.plan.evidence_of(given.robot)
    if it.name in evidence.handed_on or it.name in evidence.spawned:
        return True
    topic = it.when.removeprefix(f"{UNSENT}: ")
    if topic == it.when:
        return False
    full = given.names.full_name(it.name)
    ends = given.plan.fleet.table.ends
    sent = [
        (run.full_name == full, name)
        for run, end, name in ends
        if end.role == PUBLISHES and not end.when and end.name.endswith(topic)
    ]
    others = {name for is_mine, name in sent if not is_mine}
    return others.union(given.bridged).isdisjoint(name for is_mine, name in sent if is_mine)


def _start_of(given: _Given, name: str) -> Start:
    """Return what runs a node, with the components in it."""
    it, facts = given.names.started[name], given.facts[name]
    if it.way == SPAWNER:
        return controller(given.plan, it)
    made = _start_of_node(given, name)
    own = given.values.get((given.robot.spec.name, name), {})
    words = made.arguments
    if made.name and names_its_process(facts.kind, given.release):
        # A rule for the one node that its code calls so.
        rule = f"{facts.kind}:__node:={made.name}"
        words = (*words, *(("--ros-args", "-r", rule) if made.name != facts.kind else ()))
        made = made._replace(name="")
    if facts.kind == STATIC:
        words = with_frames([path_of(it) for it in words], own)
    placing = given.plan.evidence_of(given.robot).placing
    if placing is not None and spawn.is_of_vendor(placing) and made.number == placing.number:
        words = tuple(spawn.placed_at(words, given.robot.spec))
    lua = given.robot.spec.related_files.get("lua", ())
    if facts.kind == CARTOGRAPHER and (lua or facts.usual):
        folder, file = os.path.split(path_for(given.robot, *lua[:1] or (OPTIONS,)))
        # In place of the vendor's file.
        flags = {at + more for at, it in enumerate(words) if it in LUA_FLAGS for more in (0, 1)}
        kept = (it for at, it in enumerate(words) if at not in flags)
        words = (*kept, LUA_FLAGS[0], File(folder), LUA_FLAGS[1], file)
    return made._replace(
        arguments=tuple(words),
        components=tuple(
            _start_of_node(given, one)
            for one in given.running
            if (started := given.names.started[one]).way == COMPONENT
            and started.node.fact.container == name
        ),
        brought_up=is_unmanaged(facts, given.release)
        and not any(name in listed for listed in given.names.managed.values()),
    )


def _program(given: _Given, name: str) -> Program | None:
    """Return the program of a node, or the class of a component; None if it is unknown."""
    program = started_as(given.facts[name], given.release)
    if given.names.started[name].way != COMPONENT:
        return program if program and program.executable else None
    if program and program.plugin:
        return program
    own = given.plan.evidence_of(given.robot).handed_on.get(name)
    return Program(own.program[0], "", own.program[1]) if own else None


def _start_of_node(given: _Given, name: str) -> Start:
    """Return the process or component of a node, with its parameters and its launch file's."""
    program = _program(given, name)
    assert program is not None
    made = start_of(given.names.started[name], program, _parameters(given, name))
    return _with_launch_settings(given.plan, given.robot, made, name)


def _with_launch_settings(plan: FleetPlan, robot: RewrittenRobot, it: Start, name: str) -> Start:
    """Return a process with what its launch file gives it; a description in that is the robot's."""
    found = plan.evidence_of(robot).handed_on.get(name)
    if found is None:
        return it
    own: HandedOn = for_robot(found._replace(values={}), robot.spec.name)
    package, program = own.program
    sources = {DESCRIPTION: robot.spec.description, SEMANTIC: robot.spec.srdf}
    texts = {
        key: Text(path_for(robot, expanded_name(sources[key]))) for key in own.texts if sources[key]
    }
    return it._replace(
        name="" if own.is_unnamed and it.name == name.rpartition("/")[2] else it.name,
        parameters=(*it.parameters, *([texts] if texts else [])),
        package=package,
        executable="" if it.plugin else program,
        plugin=program if it.plugin else "",
        arguments=it.arguments if own.kind == STATE else own.arguments,
        environment=own.environment,
        process=own.process,
        number=own.number,
    )


def _parameters(given: _Given, name: str) -> tuple[Parameters, ...]:
    """Return the robot's parameter files for a node, and the values that no file has."""
    robot, facts = given.robot, given.facts[name]
    is_launched = name in given.plan.evidence_of(robot).handed_on
    files = [
        File(it, given.files[it])
        for it in (params_paths(robot, given.files) if is_launched else given.params)
        # Of those that launch files name a launched node has its own.
        if not is_launched or name in given.readers.get(it, (name,))
    ]
    known, made = facts.kind, File(path_for(robot, moveit_parameters.FILE))
    later = files if is_launched and known in _OF_MOVEIT and made.path in given.files else []
    found: list[Parameters] = [] if later else [*files]
    if facts.usual and known != CARTOGRAPHER:
        found.append(dict(facts.usual))
    values = given.values.get((robot.spec.name, name))
    if values and known != STATIC:
        found.append(values)
    if known == MANAGER and (types := dict(_controller_types(given, name))):
        found.append(types)
    if known == start_poses.AMCL and path_for(robot, "start_pose.yaml") in given.files:
        found.append(File(path_for(robot, "start_pose.yaml")))
    if known == STATE:
        found.append(_publisher_parameters(given, name))
    if known in _OF_MOVEIT:
        found.append({"robot_description": Text(_description_path(robot))})
        if made.path in given.files:
            found.append(made)
        elif robot.spec.srdf:
            srdf = Text(path_for(robot, expanded_name(robot.spec.srdf)))
            found.append({moveit_parameters.SEMANTIC: srdf})
        # Of names those of the files count, of all else what the launch file and its files say.
        found += later
        own = without_names(values or {})
        found += [own] if own and made.path in given.files else []
    if known == LIFECYCLE_MANAGER:
        managed = [*filter(None, _managed(given, name))]
        found.append({"autostart": True, "node_names": managed})
    return tuple(found)


def without_names(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return parameters of MoveIt without those that name joints, links and controllers."""
    return {key: it for key, it in values.items() if not key.startswith(_NAMED)}


def _publisher_parameters(given: _Given, name: str) -> Parameters:
    """Return the parameters of a robot_state_publisher: description and the prefix of frames."""
    # Another description of its launch file gets the robot's name in front of its frames.
    robot, naming = given.robot, given.plan.fleet.naming
    handed = given.plan.evidence_of(robot).handed_on.get(name)
    if handed is None or not handed.description:
        prefix = {"frame_prefix": robot.frame_prefix} if robot.frame_prefix else {}
        return {DESCRIPTION: Text(_description_path(robot)), **prefix}
    above = f"{robot.spec.tag}/" if naming.layout.frames else ""
    own = str(handed.values.get("frame_prefix", ""))
    prefix = {"frame_prefix": f"{above}{own}"} if above else {}
    return {DESCRIPTION: Text(described_path(robot, name)), **prefix}


def _readers(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield (file, nodes) for the parameter files of launch files."""
    # Without nodes if it is for a spawner, or for a launch file that is missing.
    evidence = plan.evidence_of(robot)
    words = (
        word
        for it in evidence.processes
        if it.node.process.is_include
        for word in it.node.arguments
    )
    others = {os.path.realpath(it.partition(":=")[2]) for it in words}
    others |= {it.source for one in evidence.spawned.values() for it in one.parameters}
    handed = evidence.handed_on
    for it in robot.spec.related_files.get("params", ()) if handed else ():
        path = os.path.realpath(it)
        nodes = frozenset(node for node, own in handed.items() if path in own.files)
        if nodes or path in others:
            yield path_for(robot, it), nodes


def _controller_types(given: _Given, manager: str) -> Iterator[tuple[str, str]]:
    """Yield a parameter ``NAME.type`` and its value for controllers whose type no file declares."""
    # Without one a controller is not loaded (ros2_control controller_manager.cpp).
    file = given.plan.file
    types = {it: type_ for type_, it in load_known_nodes(file.nodes, file.distro).types.items()}
    declared = {it.node for it in given.plan.evidence_of(given.robot).given if it.program}
    for name, it in given.names.started.items():
        mine = it.way == SPAWNER and it.manager == given.names.name(manager)
        if mine and not {name} & {*given.left, *declared} and given.facts[name].kind in types:
            yield f"{it.node.name}.type", types[given.facts[name].kind]


def _managed(given: _Given, manager: str) -> Iterator[str]:
    """Yield the full names of a lifecycle manager's nodes; empty for one that the robot has not."""
    return (_own_node_name(given, it) for it in given.names.managed.get(manager, ()))


def _own_node_name(given: _Given, node: str) -> str:
    """Return what the robot calls a node of a node set, also by an older name; else empty."""
    if node in given.names.nodes:
        return given.names.name(node)
    alike = (name for name, it in given.facts.items() if it.known == node)
    return next((given.names.name(it) for it in alike if it in given.names.nodes), "")


def _description_path(robot: RewrittenRobot) -> str:
    return path_for(robot, expanded_name(robot.spec.description))


def controller(plan: FleetPlan, it: Started) -> Start:
    """Return the spawner of a controller of the one robot of a plan."""
    (robot,) = plan.robots
    evidence = plan.evidence_of(robot)
    own = next((one for one in evidence.given if one.node == it.node.node), None)
    spawned = evidence.spawned.get(it.node.node)
    sources = {one.source for one in spawned.parameters} if spawned else set[str]()
    files = robot.spec.related_files.get("params", ())
    if own and OWN_TYPE in own.values:
        # Its own section has its type.
        files = tuple(one for one in files if one == own.values[OWN_TYPE].place.file)[:1]
    else:
        files = tuple(one for one in files if os.path.realpath(one) in sources)
    words = [word for one in files for word in ("--param-file", File(path_for(robot, one)))]
    if spawned is None:
        return spawner_of(it, *words)
    if spawned.inactive and "--load-only" not in spawned.words:
        words.append("--inactive")
    made = spawner_of(it, *words)
    how, words_ = spawned.process, (*made.arguments, *spawned.words)
    return made._replace(process=how, number=spawned.number, arguments=words_)


def _spawn_starts(given: _Given) -> Iterator[Start]:
    """Yield what puts the robot into its simulator, and what brings its topics from there."""
    robot = given.robot
    if not is_simulated(robot):
        return
    (it,) = spawn.in_folder(given.plan)
    made, own = spawn.spawner(it, robot.is_classic), given.plan.evidence_of(robot).placing
    if own is not None and not spawn.is_of_vendor(own):
        delay = own.process.delay if not own.process.event else 0.0
        made = made._replace(number=own.number, process=made.process._replace(delay=delay))
    yield from [] if spawn.is_of_vendor(own) else [made]
    path = gz_bridge_path(robot)
    if path in given.files:
        spaces = {it.namespace for it in given.names.nodes.values()}
        namespace = min(spaces, key=len, default="/")
        name = "" if namespace != "/" else f"ros_gz_bridge_{robot.spec.namespace}"
        qos = dict(_qos_rows(given.plan, robot, robot.spec.namespace))
        yield Start(*_BRIDGE, namespace, name, ({"config_file": File(path), **qos},))


def _qos_rows(plan: FleetPlan, robot: RewrittenRobot, space: str) -> Iterator[tuple[str, object]]:
    """Yield settings of launched bridges for the robot's topics; without ``space`` for shared."""
    for key, value in plan.evidence_of(robot).qos.items():
        topic = key.split(".")[1]
        named = renamed_word(topic, "topic", robot.spec.namespace, plan.fleet.naming)
        if space or named == topic:
            yield key.replace(topic, named, 1), value


def _domain_bridge(robot: RewrittenRobot, files: Collection[str]) -> Iterator[Start]:
    """Yield the process that brings topics between the robot's domain and that of all robots."""
    path = bridge_path(robot.spec.name)
    if path in files:
        name = bridge_name(robot.spec.name)
        yield Start("domain_bridge", "domain_bridge", "", name, arguments=(File(path),))


def of_all(
    plan: FleetPlan, files: Mapping[str, bool], simulators: Collection[str], values: Values
) -> tuple[Start, ...]:
    """Return what runs once for all robots: the clock's bridge, and nodes that all of them share."""
    names = names_of(plan.fleet.table, "")
    known = {it.name: it for one in plan.evidence.values() for it in one.nodes}
    # The processes that run once, each once.
    found: list[Start] = []
    for robot in plan.robots:
        for it in (one for one in plan.evidence_of(robot).processes if one.once):
            made, extra = process_for(it.node, robot.spec.name, "", None), it.node.process.is_extra
            made = made._replace(number=-1, process=made.process._replace(after=-1))
            made = made._replace(condition=SIMULATOR if extra else "")
            found += [] if made in found or (extra and not simulators) else [made]
    shared = (*_shared_starts(plan, names, known, values, files), *found)
    if BRIDGE_FILE not in files:
        return shared
    qos = {key: it for robot in plan.robots for key, it in _qos_rows(plan, robot, "")}
    rows, served = ({"config_file": File(BRIDGE_FILE), **qos},), services_in(plan.launched_words)
    bridge = Start(*_BRIDGE, parameters=rows, arguments=tuple(served))
    # It is of no use without the simulator.
    return (bridge._replace(condition=SIMULATOR), *shared) if simulators else (*shared, bridge)


def _shared_starts(
    plan: FleetPlan,
    names: NodeNames,
    known: Mapping[str, NodeFacts],
    values: Values,
    built: Mapping[str, bool],
) -> Iterator[Start]:
    """Yield the shared nodes, from the first robot's files: their sections are alike in all."""
    first, started = plan.robots[0], []
    for name, it in names.started.items():
        facts = known.get(name)
        if facts is None or not {name, facts.kind}.isdisjoint(_BY_HAND):
            continue
        program = program_of(facts, plan.file.distro)
        if program is None:
            continue
        paths = first.spec.related_files.get("params", ())
        files: list[Parameters] = [
            File(it, built.get(it, False)) for it in (path_for(first, one) for one in paths)
        ]
        given = values.get((first.spec.name, name))
        files += [given] if given else []
        if facts.kind in NAV2:
            started.append(it.node.name)
        if plan.file.cell and name == MOVE_GROUP:
            files = [File(parameters_path(plan.file.cell))]
        made = _with_launch_settings(plan, first, start_of(it, program, tuple(files)), name)
        handed = plan.evidence_of(first).handed_on.get(name)
        rules = made.remappings or (handed.rules if handed else ())
        yield made._replace(remappings=rules, number=-1)
    if started:
        manager = known_program(LIFECYCLE_MANAGER, plan.file.distro)
        own = {"autostart": True, "node_names": started}
        yield Start(*manager[:2], "", f"{LIFECYCLE_MANAGER}_shared", (own,))
