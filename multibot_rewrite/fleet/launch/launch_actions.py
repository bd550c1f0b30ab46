# SPDX-License-Identifier: Apache-2.0
"""A planned fleet -> what its launch file starts, robot by robot; ``launch_python`` writes it down.

What only runs under a condition that no file answers, and nodes whose program is not known, are left
to the reader: they are named in the file.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.checks.lacking import CARTOGRAPHER
from multibot_rewrite.fleet.file.cell_file import MOVE_GROUP
from multibot_rewrite.fleet.file.fleet_file import BRINGUP
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.starts import Component, File, RobotStarts, Start, Text
from multibot_rewrite.fleet.outputs import moveit_parameters, spawn
from multibot_rewrite.fleet.outputs.cell_outputs import parameters_path
from multibot_rewrite.fleet.outputs.output_file import (
    expanded_name,
    gz_bridge_path,
    params_paths,
    path_for,
)
from multibot_rewrite.fleet.outputs.relays import not_bridged, relays
from multibot_rewrite.fleet.outputs.rviz_outputs import RvizOutput
from multibot_rewrite.fleet.robots import start_poses
from multibot_rewrite.fleet.robots.node_names import NodeNames, names_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.knowledge.conditions import UNSENT, said
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.programs import (
    LIFECYCLE_MANAGER,
    NAV2,
    Program,
    is_unmanaged,
    known_program,
    program_of,
)
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.evidence.parameter_files import OWN_TYPE
from multibot_rewrite.spelling.domain_bridge import bridge_name, bridge_path
from multibot_rewrite.spelling.ways import COMPONENT, SPAWN, SPAWNER, Started, spawner_arguments
from multibot_rewrite.system.records import PUBLISHES

STATE = "robot_state_publisher"
# Started by hand, or once for all robots.
_BY_HAND = ("teleop_twist_keyboard", "rviz2", "ros_gz_bridge", start_poses.NODE)
# What helps where a node is not started.
_DESCRIBE = "describe it in a file of nodes, with `programs:` (docs/stacks.md)"
_NAME = "if it runs, add it to a `stack:`, name its launch file under `launch:`, or start it here"
_BRIDGE = Program("ros_gz_bridge", "parameter_bridge")
_DOMAIN_BRIDGE = Program("domain_bridge", "domain_bridge")


def of_robot(one: FleetPlan, files: Collection[str], bridged: Collection[str]) -> RobotStarts:
    """What the one robot of a plan runs; ``files`` are the paths that the build writes, ``bridged`` the
    topics that bridges bring from a simulator."""
    (robot,) = one.robots
    names = names_of(one.fleet.table, robot.spec.namespace)
    facts = {it.name: it for it in one.evidence_of(robot).nodes}
    given = _Given(one, robot, names, facts, files, bridged)
    left = dict(_left(given))
    simulated = is_simulated(robot)
    starts = [it for name in names.started if name not in left for it in _started(given, name)]
    bridge = gz_bridge_path(robot)
    spawned = []
    if simulated:
        spawned = [_spawner(given)]
        spawned += [_bridge(names, robot, bridge)] if bridge in files else []
    placed = start_poses.start_poses(one).transforms
    starts += [it.start for it in placed]
    copied, bridged_tf = _relays(given)
    starts += [*copied, *_domain_bridge(robot, files)]
    params = params_paths(robot, files)
    told = robot.spec.name, os.path.basename(robot.spec.description), _where(names), params
    found = tuple(starts), tuple(spawned), tuple(left.items())
    nodes = tuple(_nodes(names, left))
    otherwise = not_bridged(robot.spec.name) if bridged_tf else ""
    return RobotStarts(*told, *found, bridged_tf, otherwise, nodes=nodes)


class _Given(NamedTuple):
    plan: FleetPlan
    robot: RewrittenRobot
    names: NodeNames
    facts: Mapping[str, NodeFacts]
    files: Collection[str]
    bridged: Collection[str]

    @property
    def release(self) -> str:
        return self.plan.file.distro


def _nodes(names: NodeNames, left: Collection[str]) -> Iterator[str]:
    """The nodes that are started, and those in their processes."""
    for name in (it for it in names.started if it not in left):
        yield names.full_name(name)
        yield from (names.full_name(it) for it in names.inside(name) if it not in left)


def _where(names: NodeNames) -> str:
    spaces = {it.namespace for it in names.nodes.values() if it.namespace != "/"}
    return f"namespace {min(spaces, key=len)}" if spaces else "the root namespace"


def _left(given: _Given) -> Iterator[tuple[str, str]]:
    """The nodes that are not started, each with the reason; it is empty for those that are started by
    something else."""
    naming, file = given.plan.fleet.naming, given.plan.file
    relayed = {it.run.node for it in relays(given.robot.spec.namespace, naming, file)}
    for name in given.names.started:
        it = given.facts.get(name)
        if name in _BY_HAND or name in relayed:
            yield name, ""
        elif it is None:
            yield name, f"nothing is known of its program; {_DESCRIBE}"
        elif it.when and not _is_needed(given, it):
            yield name, f"nothing in the fleet file starts it: {said(it.when)}; {_NAME}"
        elif given.plan.file.params_style == BRINGUP and name != STATE:
            yield name, "parameter files are in the form of nav2_bringup, which starts it"
        elif not given.names.is_controller(name) and program_of(it, given.release) is None:
            yield name, f"the program of package {it.package} is not known; {_DESCRIBE}"


def _is_needed(given: _Given, it: NodeFacts) -> bool:
    """A node under a condition: what nobody else sends is needed."""
    topic = it.when.removeprefix(f"{UNSENT}: ")
    if topic == it.when:
        return False
    full = given.names.full_name(it.name)
    ends = given.plan.fleet.table.ends
    sent = [(run.full_name == full, name) for run, end, name in ends if _sends(end, topic)]
    others = {name for is_mine, name in sent if not is_mine}
    return others.union(given.bridged).isdisjoint(name for is_mine, name in sent if is_mine)


def _sends(end: Endpoint, topic: str) -> bool:
    return end.role == PUBLISHES and not end.when and end.name.endswith(topic)


def _started(given: _Given, name: str) -> Iterator[Start]:
    it, facts = given.names.started[name], given.facts[name]
    if it.way == SPAWNER:
        yield controller(given.plan, it)
    elif it.way != COMPONENT:
        program = program_of(facts, given.release)
        assert program is not None
        yield Start(
            program.package,
            program.executable,
            it.node.namespace,
            it.node.name,
            _parameters(given, name),
            it.rules,
            (*program.words, *_options(given, facts)),
            tuple(_components(given, name)),
            is_unmanaged(facts, given.release) and not _is_listed(given, name),
        )


def _options(given: _Given, facts: NodeFacts) -> Iterator[str | File]:
    """Return the words that name the robot's first Lua file to Cartographer."""
    files = given.robot.spec.companions.get("lua", ())
    if facts.kind == CARTOGRAPHER and files:
        folder, _, name = path_for(given.robot, files[0]).rpartition("/")
        yield from ("-configuration_directory", File(folder), "-configuration_basename", name)


def _is_listed(given: _Given, name: str) -> bool:
    """Does a lifecycle manager bring it up?"""
    return any(name in listed for listed in given.names.managed.values())


def _components(given: _Given, container: str) -> Iterator[Component]:
    left = dict(_left(given))
    mine = ((name, it) for name, it in given.names.started.items() if name not in left)
    for name, it in mine:
        if it.way == COMPONENT and it.node.fact.container == container and name in given.facts:
            program = program_of(given.facts[name], given.release)
            if program is not None and program.plugin:
                yield Component(
                    program.package,
                    program.plugin,
                    it.node.namespace,
                    it.node.name,
                    _parameters(given, name),
                    it.rules,
                )


def _parameters(given: _Given, name: str) -> tuple[File | Mapping[str, Any], ...]:
    """Its robot's parameter files, and what no file says of it."""
    robot, facts = given.robot, given.facts[name]
    found: list[File | Mapping[str, Any]] = [File(it) for it in params_paths(robot, given.files)]
    known = facts.kind
    if facts.usual:
        found.append(dict(facts.usual))
    if known == MANAGER and (types := dict(_types(given, name))):
        found.append(types)
    if known == start_poses.AMCL and path_for(robot, "start_pose.yaml") in given.files:
        found.append(File(path_for(robot, "start_pose.yaml")))
    if known == STATE:
        prefix = {"frame_prefix": robot.frame_prefix} if robot.frame_prefix else {}
        found.append({"robot_description": Text(_description(robot)), **prefix})
    if known in ("move_group", "servo_node"):
        found.append({"robot_description": Text(_description(robot))})
        made = File(path_for(robot, moveit_parameters.FILE))
        if made.path in given.files:
            found.append(made)
        elif robot.spec.srdf:
            srdf = Text(path_for(robot, expanded_name(robot.spec.srdf)))
            found.append({moveit_parameters.SEMANTIC: srdf})
    if known == LIFECYCLE_MANAGER:
        managed = (_called(given, it) for it in given.names.managed.get(name, ()))
        found.append({"autostart": True, "node_names": list(filter(None, managed))})
    return tuple(found)


def _types(given: _Given, manager: str) -> Iterator[tuple[str, str]]:
    """The types of the controllers that no file of the robot declares: without one a controller is not
    loaded (ros2_control controller_manager.cpp)."""
    file, left = given.plan.file, dict(_left(given))
    types = {it: type_ for type_, it in load_known_nodes(file.nodes, file.distro).types.items()}
    declared = {it.name for it in given.plan.evidence_of(given.robot).given if it.type}
    for name, it in given.names.started.items():
        mine = it.way == SPAWNER and it.manager == given.names.name(manager)
        if mine and not {name} & {*left, *declared} and given.facts[name].kind in types:
            yield f"{it.node.name}.type", types[given.facts[name].kind]


def _called(given: _Given, node: str) -> str:
    """What a node of a stack is called: its robot's parameter file may have it under an older name."""
    if node in given.names.nodes:
        return given.names.name(node)
    alike = (name for name, it in given.facts.items() if it.known == node)
    return next((given.names.name(it) for it in alike if it in given.names.nodes), "")


def _description(robot: RewrittenRobot) -> str:
    return path_for(robot, expanded_name(robot.spec.description))


def controller(plan: FleetPlan, it: Started) -> Start:
    """Return the spawner of a controller of the one robot of a plan."""
    words = (*spawner_arguments(it), *_as_declared(plan, it.node.node))
    return Start(*SPAWN, it.node.namespace, arguments=words)


def _as_declared(plan: FleetPlan, controller: str) -> Iterator[str | File]:
    """The file of a controller whose own section has its type, and if a launch file leaves it
    inactive."""
    (robot,) = plan.robots
    evidence = plan.evidence_of(robot)
    own = next((it for it in evidence.given if it.name == controller), None)
    params = robot.spec.companions.get("params", ())
    if own and OWN_TYPE in own.values and own.values[OWN_TYPE].place.file in params:
        yield from ("--param-file", File(path_for(robot, own.values[OWN_TYPE].place.file)))
    if controller in evidence.spawned and evidence.spawned[controller].inactive:
        yield "--inactive"


def _spawner(given: _Given) -> Start:
    """What puts the robot into its simulator."""
    (it,) = spawn.in_folder(given.plan)
    start = spawn.spawner(it, spawn.is_classic(given.robot))
    words = (File(it.file) if it.file and word == it.file else word for word in start.arguments)
    return start._replace(arguments=tuple(words))


def _bridge(names: NodeNames, robot: RewrittenRobot, path: str) -> Start:
    spaces = {it.namespace for it in names.nodes.values()}
    namespace = min(spaces, key=len, default="/")
    name = "" if namespace != "/" else f"ros_gz_bridge_{robot.spec.namespace}"
    found: tuple[File | Mapping[str, Any], ...] = ({"config_file": File(path)},)
    return Start(*_BRIDGE[:2], namespace, name, found)


def _relays(given: _Given) -> tuple[tuple[Start, ...], tuple[Start, ...]]:
    """What brings its tf to ``/tf``, if the fleet file says so; and what does it with the bridge, which
    may not be installed."""
    naming, file = given.plan.fleet.naming, given.plan.file
    made = relays(given.robot.spec.namespace, naming, file)
    starts = tuple(it.start for it in made)
    return (starts, ()) if naming.layout.frames else ((), starts)


def _domain_bridge(robot: RewrittenRobot, files: Collection[str]) -> Iterator[Start]:
    """What brings topics between its domain and that of all robots."""
    path = bridge_path(robot.spec.namespace)
    if path in files:
        name = bridge_name(robot.spec.namespace)
        yield Start(*_DOMAIN_BRIDGE[:2], "", name, arguments=(File(path),))


def of_all(plan: FleetPlan, files: Collection[str]) -> tuple[Start, ...]:
    """What runs once for all robots: the bridge of the clock, and nodes that all of them share."""
    names = names_of(plan.fleet.table, "")
    known = {it.name: it for one in plan.evidence.values() for it in one.nodes}
    starts = [*_shared(plan, names, known)]
    if BRIDGE_FILE in files:
        starts.append(Start(*_BRIDGE[:2], "", "", ({"config_file": File(BRIDGE_FILE)},)))
    return tuple(starts)


def _shared(plan: FleetPlan, names: NodeNames, known: Mapping[str, NodeFacts]) -> Iterator[Start]:
    """The shared nodes have their sections in the files of every robot, and they are alike."""
    first, started = plan.robots[0], []
    for name, it in names.started.items():
        facts = known.get(name)
        program = program_of(facts, plan.file.distro) if facts and name not in _BY_HAND else None
        if facts is None or program is None or name == "ros_gz_bridge":
            continue
        files = [File(path_for(first, one)) for one in first.spec.companions.get("params", ())]
        if facts.kind in NAV2:
            started.append(it.node.name)
        if plan.file.cell and name == MOVE_GROUP:
            files = [File(parameters_path(plan.file.cell))]
        yield Start(*program[:2], it.node.namespace, it.node.name, tuple(files), it.rules)
    if started:
        manager = known_program(LIFECYCLE_MANAGER, plan.file.distro)
        values = {"autostart": True, "node_names": started}
        yield Start(*manager[:2], "", f"{LIFECYCLE_MANAGER}_shared", (values,))


def windows(configs: Sequence[RvizOutput], files: Collection[str]) -> Iterator[tuple[str, Start]]:
    """The windows of RViz, each with the one robot that it shows, or "" for all.

    MoveIt's displays read the parameters of their process.
    """
    for it in configs:
        for window in it.windows:
            given = f"{window.robot}/{moveit_parameters.FILE}"
            yield (
                window.robot,
                Start(
                    "rviz2",
                    "rviz2",
                    window.namespace,
                    "",
                    (File(given),) if given in files else (),
                    tuple(window.remaps),
                    ("-d", File(it.path(window))),
                ),
            )
