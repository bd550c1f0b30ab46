# SPDX-License-Identifier: Apache-2.0
"""What runs on one robot, before its rewrite (by its sources) and after (by what was made)."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import cast

from lxml.etree import _Element

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.moveit.file_kind import SIMPLE
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.yaml_text import YamlText
from multibot_rewrite.description.readback.reading import FRAME, Reading, read
from multibot_rewrite.description.sources.job import Job
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.checks.written_system import DRIVERS, of_robot
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.outputs.output_file import OutputFile, expanded_name, own_yaml, path_for
from multibot_rewrite.fleet.robots.member import without_simulator
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.ends import (
    bridge_ends,
    either_way,
    plugin_ends,
    source_ends,
    source_run,
)
from multibot_rewrite.producers.evidence.hardware import Exported, exported
from multibot_rewrite.producers.evidence.moveit import planning_system
from multibot_rewrite.producers.evidence.nodes import children_of
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.evidence.semantics import FIXED, Semantics, semantics
from multibot_rewrite.producers.interfaces import control_system
from multibot_rewrite.producers.launch.spawners import active
from multibot_rewrite.producers.transforms import (
    edges_off,
    joint_edges,
    node_edges,
    virtual_lookups,
)
from multibot_rewrite.spelling.of_runs import lookups_of
from multibot_rewrite.spelling.records import GivenNode, Run
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER, tree_joints
from multibot_rewrite.system.parameters import Value
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    Edge,
    End,
    Lookup,
    Node,
    Place,
    System,
)

NONE = Semantics((), ())


class RobotSystem(NamedTuple):
    """What runs on a robot: ``control`` has its controllers and interfaces, ``system`` its nodes, their
    ends, transforms and look-ups."""

    control: System
    system: System


def system_before(
    robot: RewrittenRobot, evidence: RobotEvidence, srdf: Job | None = None
) -> RobotSystem:
    """The system of a robot's sources, if it were alone: nothing is renamed or remapped but what the
    usual launch files remap."""
    source, given = robot.member.source, evidence.given
    moves = any(it.get("type", FIXED) != FIXED for it in source.root.iter("joint"))
    nodes = [_runs(it, moves) for it in evidence.nodes]
    sections = {it.name: it for it in given}
    runs = [source_run(it, sections.get(it.name)) for it in nodes]
    real = robot.spec.simulator == REAL
    text = without_simulator(source.source, source.file) if real else source.source
    reading = read(text, source.file, robot.member.vocabulary)
    sent = {child for node in nodes for child in children_of(node)}
    sent |= {it.name for it in reading.names if it.kind == FRAME and it.tag == "plugin"}
    plain = [_plainly(robot, it) for it in given]
    said = _said(srdf, source.root)
    exports = (_plain(robot, it) for it in exported(source.root, source.file))
    lookups = _lookups(plain, nodes, evidence.known, said, sent)
    simulated = {frame for it in evidence.simulated for frame in (it.parent, it.child)}
    return RobotSystem(
        _control(plain, evidence, exports, _documents(robot, "moveit"), said),
        System(
            nodes=tuple(_nodes_of(nodes, reading)),
            ends=tuple(_ends_of(robot, runs, reading)),
            edges=tuple(_edges_of(robot, runs, evidence, sent)),
            environment=DRIVERS,
            lookups=tuple(it for it in lookups if it.frame not in simulated),
        ),
    )


def _said(srdf: Job | None, root: _Element) -> Semantics:
    """What an SRDF says of the description."""
    if srdf is None:
        return NONE
    return semantics(read_document(srdf.data, srdf.file).root, root, srdf.file)


def _ends_of(robot: RewrittenRobot, runs: Iterable[Run], reading: Reading) -> Iterator[End]:
    """The ends of nodes, plugins and bridges."""
    for run in runs:
        yield from source_ends(run)
    yield from _plugin_ends(reading)
    for it in _documents(robot, "bridge"):
        for row in bridge_ends(it, robot.spec.bridge_namespace_of(it.file)):
            yield from either_way(row)


def _plugin_ends(reading: Reading) -> Iterator[End]:
    """The ends of plugins; what one with a controller manager would publish its controllers do, which
    are known by the files that name them."""
    managers = {it.full_name for it in reading.nodes if it.section.process_wide}
    for end in plugin_ends(reading):
        if end.role != PUBLISHES or end.node not in managers:
            yield end


def _control(
    given: Sequence[GivenNode],
    evidence: RobotEvidence,
    exports: Iterable[Exported],
    moveit: Iterable[YamlText],
    said: Semantics,
) -> System:
    made = control_system(given, evidence.known, exports, active(evidence.spawned))
    planned = planning_system(moveit, said)
    return made._replace(interfaces=(*made.interfaces, *planned.interfaces))


def _lookups(
    given: Sequence[GivenNode],
    nodes: Sequence[NodeFacts],
    known: Mapping[str, NodeFacts],
    said: Semantics,
    sent: Container[str],
) -> Iterator[Lookup]:
    runs = {it.name: it for it in nodes}
    for it in given:
        # A costmap is known as a part of the server that has it.
        if facts := known.get(it.known, runs.get(it.name)):
            yield from lookups_of(Run("", "", "/", it.name, (), facts, values=it.values))
    filed = {it.name for it in given}
    for node in (it for it in nodes if it.name not in filed):
        yield from lookups_of(Run("", "", "/", node.name, (), node))
    yield from (it for it in virtual_lookups(said) if it.frame not in sent)


def _nodes_of(nodes: Iterable[NodeFacts], reading: Reading) -> Iterator[Node]:
    yield from (Node(f"/{it.name}", known=it.name) for it in nodes)
    yield from (Node(it.full_name, known=it.name) for it in reading.nodes)


def _edges_of(
    robot: RewrittenRobot, runs: Sequence[Run], evidence: RobotEvidence, sent: Container[str]
) -> Iterator[Edge]:
    tree = (
        (it, Place(robot.spec.description, cast(int, joint.sourceline or 1)))
        for joint, it in tree_joints(robot.member.source.root)
    )
    yield from joint_edges(tree)
    yield from node_edges(runs, _root(robot))
    off = edges_off(evidence.given, evidence.known)
    yield from (it for it in off if it.child not in sent)


def system_after(
    robot: RewrittenRobot,
    evidence: RobotEvidence,
    texts: Sequence[OutputFile],
    known: KnownNodes,
    whole: System,
) -> RobotSystem:
    """The system of the files that were made for a robot, under its remap rules; ``whole`` is that of
    the fleet."""
    own = [it for it in texts if it.path.startswith(f"{robot.spec.name}/")]
    given = given_nodes([it.yaml for it in own if PARAMETERS in it.text], known)
    written = read_document(robot.description, robot.member.source.file)
    path = path_for(robot, expanded_name(robot.spec.srdf))
    said = (
        semantics(read_document(robot.srdf, path).root, written.root, path) if robot.srdf else NONE
    )
    moveit = [it.yaml for it in own if SIMPLE in it.text]
    exports = exported(written.root, robot.member.source.file)
    control = _control(given, evidence, exports, moveit, said)
    return RobotSystem(control, of_robot(whole, robot.spec.namespace))


def _own(robot: RewrittenRobot) -> Mapping[str, str]:
    """What an argument makes -> the name without it, which may begin with the slash behind it: /imu."""
    return {text: name.lstrip("/") for (_, name), text in robot.names.own.items()}


def _plain(robot: RewrittenRobot, export: Exported) -> Exported:
    """The interface as parameter files call it, where an argument of the xacro renames its owner."""
    own = _own(robot)
    # A name may have a slash of its own: robot1/imu.
    whole = (it for it in own if export.name.startswith(f"{it}/"))
    owner = next(whole, export.name.partition("/")[0])
    # The code of a plugin puts the same before names that the description does not declare.
    prefixes = {text.removesuffix(name) for text, name in own.items() if text.endswith(name)}
    found = (it for it in prefixes if it and owner.startswith(it))
    bare = own.get(owner, owner.removeprefix(next(found, "")))
    return export._replace(name=f"{bare}{export.name[len(owner) :]}")


def _plainly(robot: RewrittenRobot, given: GivenNode) -> GivenNode:
    """The same of what a launch file fills in for a robot that has such an argument, and of what is
    left of a name without it."""
    own = _own(robot)
    own = {**{name: own[text] for (_, name), text in robot.names.own.items()}, **own}
    values = {
        key: it._replace(value=_said_plainly(it.value, own)) for key, it in given.values.items()
    }
    return given._replace(values=values)


def _said_plainly(value: Value, own: Mapping[str, str]) -> Value:
    if isinstance(value, list):
        return [own.get(it, it) if isinstance(it, str) else it for it in value]
    return own.get(value, value) if isinstance(value, str) else value


def _root(robot: RewrittenRobot) -> str:
    """The first link that no joint has as its child."""
    joints = robot.member.source.root.iter("joint")
    children = {end.get("link") for it in joints for end in it.iterfind("child")}
    links = (it.get("name", "") for it in robot.member.source.root.iterfind("link"))
    return next((it for it in links if it not in children), "")


def _documents(robot: RewrittenRobot, kind: str) -> list[YamlText]:
    return [own_yaml(robot.spec, path) for path in robot.spec.companions.get(kind, ())]


def _runs(node: NodeFacts, moves: bool) -> NodeFacts:
    """A robot without movable joints has no joint states to read."""
    if moves or node.package != STATE_PUBLISHER:
        return node
    return node._replace(endpoints=tuple(it for it in node.endpoints if it.role != SUBSCRIBES))
