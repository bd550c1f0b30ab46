# SPDX-License-Identifier: Apache-2.0
"""What runs on a robot, by its sources and by what was made of them: one way from nodes to a system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.conventions import OF_EVERY_NODE, is_tool_word
from multibot_rewrite.description.readback.reading import FRAME, read
from multibot_rewrite.description.rewriters.own_defaults import frame_sites
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.sources.job import Job
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.outputs.output_file import (
    OutputFile,
    expanded_name,
    gz_bridge_path,
    line_in_source,
    own_yaml,
    path_for,
)
from multibot_rewrite.fleet.robots.fitting.sensors import bridge_rows_of
from multibot_rewrite.fleet.robots.member import without_simulator
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.planning.of_runs import ends_of, lookups_of, with_names
from multibot_rewrite.planning.planned_system import tf_topic
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.table import plugin_nodes
from multibot_rewrite.planning.transforms import STATE_PUBLISHER, sent_by, tree_joints
from multibot_rewrite.planning.way_checks import is_controller_topic
from multibot_rewrite.planning.ways import merged
from multibot_rewrite.producers.ends import (
    BRIDGE_FILE,
    BRIDGE_NODE,
    NEEDS,
    TF,
    bridge_rows,
    edge,
    edges_off,
    either_way,
    run_alone,
    sensor_frames,
    sensor_on,
    virtual_lookups,
)
from multibot_rewrite.producers.evidence.hardware import Exported, control_system, exported
from multibot_rewrite.producers.evidence.nodes import children_of
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.evidence.semantics import (
    FIXED,
    Semantics,
    planning_system,
    semantics,
)
from multibot_rewrite.producers.launch.spawners import active
from multibot_rewrite.related_files.moveit.file_kind import SIMPLE
from multibot_rewrite.related_files.params.sections import PARAMETERS
from multibot_rewrite.related_files.yaml_text import YamlText
from multibot_rewrite.system.merging import joined
from multibot_rewrite.system.records import (
    MAY,
    NOWHERE,
    PUBLISHES,
    RUNS,
    SUBSCRIBES,
    UNKNOWN_NODES,
    Caveat,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Place,
    Robot,
    System,
    edge_of,
)

_MAY_RUN = "a driver that no file names may run"
DRIVERS = Environment(caveats=(Caveat(UNKNOWN_NODES, True, _MAY_RUN),))


def of_sources(robot: RewrittenRobot, evidence: RobotEvidence, srdf: Job | None = None) -> System:
    """Return the system of a robot's sources, alone, with only the rules of usual launch files."""
    source, given = robot.member.source, evidence.given
    moves = any(it.get("type", FIXED) != FIXED for it in source.root.iter("joint"))
    nodes = []
    for node in evidence.nodes:
        # A robot without movable joints has no joint states to read.
        reads = moves or node.package != STATE_PUBLISHER
        ends = tuple(it for it in node.endpoints if reads or it.role != SUBSCRIBES)
        nodes.append(node._replace(endpoints=ends))
    real = robot.spec.simulator == REAL
    text = without_simulator(source.source, source.file) if real else source.source
    reading = read(text, source.file, robot.member.definitions)
    plain = [_plain_run(robot, it) for it in given]
    sections = {it.node: it for it in plain}
    alone = []
    for run in (run_alone(it, sections.get(it.name)) for it in nodes):
        # One for which a file has parameters is meant to run.
        when = run.fact.when if run.place == NOWHERE else ""
        alone.append(run._replace(fact=run.fact._replace(when=when)))
    runs = [it for it in alone if not it.fact.shared]
    plugins = []
    for it in plugin_nodes(reading, ""):
        # What one with a controller manager would publish, its controllers do.
        kept = tuple(end for end in it.fact.endpoints if not is_controller_topic(it, end))
        plugins.append(with_names(it._replace(fact=it.fact._replace(endpoints=kept))))
    tree = [it for _, it in tree_joints(robot.member.sent.root)]
    children = {it.child for it in tree}
    links = (it.get("name", "") for it in robot.member.sent.root.iterfind("link"))
    root = next((it for it in links if it not in children), "")
    sent = {it.node: [*sent_by(it.fact, "")] for it in plugins}
    sent |= {it.name: [*sent_by(it, root)] for it in nodes}
    # A frame below itself tf2 refuses.
    other = (it for it in evidence.simulated if it.parent != it.child)
    inside = [it for it in other if all(it not in own for own in sent.values())]
    moved = {child for node in nodes for child in children_of(node)}
    moved |= {it.name for it in reading.names if it.kind == FRAME and it.tag == "plugin"}
    edges = [*_transform_edges(robot, tree, sent, runs, inside=inside)]
    edges += (it for it in edges_off(given, evidence.known) if it.child not in moved)
    # What a file asks is told at its place.
    order = {name: at for at, name in enumerate(sections)}
    said = _semantics(srdf.data if srdf else b"", srdf.file if srdf else "", source.root)
    lookups = [
        it
        for run in sorted(alone, key=lambda it: order.get(it.node, len(order)))
        for it in lookups_of(run)
    ]
    lookups += (it for it in virtual_lookups(said) if it.frame not in moved)
    rows = (it.end for it in bridge_rows_of(robot.spec))
    own = _system((*runs, *plugins), rows, edges)._replace(lookups=tuple(lookups))
    exports = (_plain_export(robot, it) for it in exported(source.root, source.file))
    moveit = [own_yaml(robot.spec, it) for it in robot.spec.related_files.get("moveit", ())]
    own = _with_interfaces(own, plain, evidence, exports, moveit, said)
    return beside(own, _system(it for it in alone if it.fact.shared))


def as_written(fleet: Fleet, robot: RewrittenRobot, texts: Sequence[OutputFile]) -> System:
    """Return what runs on a robot by the written files, with places in the sources.

    ``fleet`` has the nodes and transforms of this robot alone."""
    name, topic = robot.spec.namespace, tf_topic(robot.spec.namespace, fleet.naming)
    runs, home = fleet.table.runs, f"/{name}"
    sent = {node: edges for (_, node), edges in fleet.edges.items()}
    inside = () if name in fleet.placed else _simulator_edges(robot)
    edges = _transform_edges(robot, robot.tree, sent, runs, home, topic, inside)
    bridges = [it for it in texts if it.path == gz_bridge_path(robot)]
    made = _system(runs, _bridge_ends(bridges, home), edges)
    # Rules of a plugin are for its whole process: topics of controllers that the table does not have.
    plugins = map(with_names, plugin_nodes(robot.member.reading, name))
    by_process = (it for it in _system(plugins).ends if it.sure != RUNS)
    return made._replace(
        ends=(*made.ends, *by_process),
        robots=(Robot(robot.spec.name),),
        heard=tuple(_heard_frames(fleet, robot, bridges)),
    )


def of_all_robots(runs: Iterable[Run], texts: Iterable[OutputFile]) -> System:
    """Return the system of the nodes for all robots of a fleet, as they are written."""
    return _system(runs, _bridge_ends((it for it in texts if it.path == BRIDGE_FILE), ""))


def with_controllers(
    system: System,
    robot: RewrittenRobot,
    evidence: RobotEvidence,
    texts: Sequence[OutputFile],
    known: KnownNodes,
) -> System:
    """Return the system with the controllers and interfaces by the files that were made for a robot."""
    own = [it for it in texts if it.path.startswith(f"{robot.spec.name}/")]
    given = given_nodes([it.yaml for it in own if PARAMETERS in it.text], known)
    written = read_document(robot.description, robot.member.source.file)
    path = path_for(robot, expanded_name(robot.spec.srdf))
    said = _semantics(robot.srdf, path, written.root)
    exports = exported(written.root, robot.member.source.file)
    moveit = (it.yaml for it in own if SIMPLE in it.text)
    return _with_interfaces(system, given, evidence, exports, moveit, said)


def beside(own: System, shared: System) -> System:
    """Return the system of one robot, with what nodes for all robots give it, not what these need."""
    given = tuple(it for it in shared.ends if it.role not in NEEDS)
    return joined(own, shared._replace(ends=given))


def _system(runs: Iterable[Run], rows: Iterable[End] = (), edges: Iterable[Edge] = ()) -> System:
    """Return the system of running nodes, rows of bridges and transforms."""
    running, bridged = [*runs], [*rows]
    nodes = {}
    for run in merged(running):
        # A person starts a tool, or nobody does.
        sure = MAY if run.fact.when or is_tool_word(run.code_name) else RUNS
        name = run.full_name
        nodes[name] = Node(name, robot=run.robot, known=run.node, sure=sure, place=run.place)
    ends: list[End] = []
    for node, end in ((nodes[run.full_name], end) for run in running for end in ends_of(run)):
        if end.name not in OF_EVERY_NODE:
            # A node with parameters is meant to run: what it needs has to be there.
            needs = end.role in NEEDS and node.place != NOWHERE
            sure = end.sure if end.sure != RUNS else RUNS if needs else node.sure
            place = end.place if end.place != NOWHERE else node.place
            ends += either_way(end._replace(node=node.name, sure=sure, place=place))
    for it in bridged:
        ends += either_way(it)
        nodes.setdefault(it.node, Node(it.node, known=BRIDGE_NODE))
    return System(tuple(nodes.values()), tuple(ends), tuple(edges), DRIVERS)


def _bridge_ends(bridges: Iterable[OutputFile], home: str) -> Iterator[End]:
    """Yield the ends of bridges that run in a namespace."""
    for text in bridges:
        for it, *_ in bridge_rows(text.yaml):
            place = Place(*line_in_source(text, it.place.line)) if text.sources else NOWHERE
            yield it._replace(node=f"{home}/{BRIDGE_NODE}", place=place)


def _transform_edges(
    robot: RewrittenRobot,
    tree: Sequence[Edge],
    sent: Mapping[str, Iterable[Edge]],
    runs: Iterable[Run],
    home: str = "",
    topic: str = TF,
    inside: Iterable[Edge] = (),
) -> Iterator[Edge]:
    """Yield the transforms of a description, of nodes, and bridged from ``inside`` a simulator."""
    nodes = {it.node: it for it in runs}
    described = nodes.get(STATE_PUBLISHER)
    publisher = described.full_name if described else f"{home}/{STATE_PUBLISHER}"
    joints = (joint for joint, _ in tree_joints(robot.member.sent.root))
    for it, joint in zip(tree, joints, strict=True):
        place = Place(robot.spec.description, joint.sourceline or 1)  # type: ignore[arg-type]
        yield edge(it, publisher, place, topic)
    yield from (edge(it, f"{home}/{BRIDGE_NODE}", topic=topic) for it in inside)
    in_tree = {*tree}
    for node, own in sent.items():
        run = nodes.get(node)
        sender, place = (run.full_name, run.place) if run else (f"{home}/{node}", NOWHERE)
        yield from (edge(it, sender, place, topic) for it in own if it not in in_tree)


def _simulator_edges(robot: RewrittenRobot) -> Iterator[Edge]:
    """Yield the transforms of gz-sim's drive and odometry systems, which the bridge brings to tf."""
    for host, section in robot.member.inventory.served:
        sites = frame_sites(host, section, robot.names.naming)
        given = [text_at(host, it.path) for it in sites]
        if len(given) == 2 and all(given):
            yield edge_of(given[0], given[1])


def _heard_frames(
    fleet: Fleet, robot: RewrittenRobot, bridges: Iterable[OutputFile]
) -> Iterator[Heard]:
    """Yield the frames of a robot's bridged sensors whose description names none."""
    # Those that it names are compared with its links.
    if robot.spec.simulator == REAL:
        return
    roots = (fleet.inventories[robot.spec.namespace].document.root, robot.member.source.root)
    release = robot.member.definitions.release
    sensors, sources = ([*sensor_frames(it, robot.spec.model, release)] for it in roots)
    for end, inside, frame in (row for text in bridges for row in bridge_rows(text.yaml)):
        it = sensor_on(inside, sensors)
        if end.role == PUBLISHES and it and not frame and not it.is_named:
            old = sources[sensors.index(it)]
            place = Place(robot.member.source.file, old.line)
            yield Heard(end.name, it.frame, link=old.link, place=place)


def _semantics(data: bytes, file: str, root: _Element) -> Semantics:
    """Return what an SRDF, which may be empty, declares for the description."""
    return semantics(read_document(data, file).root, root, file) if data else Semantics((), ())


def _with_interfaces(
    system: System,
    given: Sequence[Run],
    evidence: RobotEvidence,
    exports: Iterable[Exported],
    moveit: Iterable[YamlText],
    said: Semantics,
) -> System:
    """Return the system with its controllers and interfaces."""
    made = control_system(given, evidence.known, exports, active(evidence.spawned))
    planned = planning_system(moveit, said).interfaces
    return system._replace(controllers=made.controllers, interfaces=(*made.interfaces, *planned))


def _names_by_argument_text(robot: RewrittenRobot) -> Mapping[str, str]:
    """Return names without a xacro argument's value, by the names with that."""
    return {text: name.lstrip("/") for (_, name), text in robot.names.own.items()}


def _plain_export(robot: RewrittenRobot, export: Exported) -> Exported:
    """Return the interface as parameter files call it, if an xacro argument renames its owner."""
    own = _names_by_argument_text(robot)
    # A name may have a slash of its own: robot1/imu.
    whole = (it for it in own if export.name.startswith(f"{it}/"))
    owner = next(whole, export.name.partition("/")[0])
    # The code of a plugin puts the same before names that the description does not declare.
    prefixes = {text.removesuffix(name) for text, name in own.items() if text.endswith(name)}
    found = (it for it in prefixes if it and owner.startswith(it))
    bare = own.get(owner, owner.removeprefix(next(found, "")))
    return export._replace(name=f"{bare}{export.name[len(owner) :]}")


def _plain_run(robot: RewrittenRobot, given: Run) -> Run:
    """Return a node's parameters without what a launch file's argument fills in."""
    own = _names_by_argument_text(robot)
    own = {**{name: own[text] for (_, name), text in robot.names.own.items()}, **own}
    values = {}
    for key, it in given.values.items():
        value = it.value
        if isinstance(value, list):
            value = [own.get(one, one) if isinstance(one, str) else one for one in value]
        elif isinstance(value, str):
            value = own.get(value, value)
        values[key] = it._replace(value=value)
    return given._replace(values=values)
