"""What runs on one robot, before its rewrite (by its sources) and after (by what was made)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.closure.frames import Sender
from multibot_rewrite.closure.topics import End
from multibot_rewrite.companions.bridge_entry import BOTH, ROS
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.yaml_text import YamlText, items, line_of, pairs, read_yaml
from multibot_rewrite.evidence.hardware import Exported, exported
from multibot_rewrite.evidence.nodes import children_of
from multibot_rewrite.evidence.parameter_files import given_nodes
from multibot_rewrite.evidence.records import GivenNode, Place
from multibot_rewrite.fleets.bridge_file import below
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_file import REAL
from multibot_rewrite.fleets.member import without_simulator
from multibot_rewrite.fleets.output_file import yaml_of
from multibot_rewrite.fleets.output_values import OutputText
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.robot_nodes import RobotEvidence
from multibot_rewrite.graph.transforms import STATE_PUBLISHER, sent_by
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.readback.nodes import ReadNode
from multibot_rewrite.readback.reading import FRAME, read
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.remap.records import EndpointName
from multibot_rewrite.rosnames import expand
from multibot_rewrite.steps.document import read_document
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC

FIXED, MOVEIT = "fixed", "moveit_simple_controller_manager"
BRIDGE_FILE, BRIDGE_NODE = "bridge.yaml", "ros_gz_bridge"
ROLES = {"GZ_TO_ROS": (PUBLISHES,), "ROS_TO_GZ": (SUBSCRIBES,), "BIDIRECTIONAL": ("",)}


class System(NamedTuple):
    """What runs on a robot: what its files set for nodes, the interfaces of its hardware, the ends of
    its topics and services, those of nodes for all robots, the frames that anything sends, its
    MoveIt files, and the nodes that send transforms."""

    given: tuple[GivenNode, ...]
    exports: tuple[Exported, ...]
    ends: tuple[End, ...]
    shared: tuple[End, ...]
    sent: frozenset[str]
    moveit: tuple[YamlText, ...]
    senders: tuple[Sender, ...] = ()


def system_before(robot: RewrittenRobot, evidence: RobotEvidence) -> System:
    """The system of a robot's sources, if it were alone: nothing is renamed or remapped but what the
    usual launch files remap."""
    source, given, bridges = robot.member.source, evidence.given, _documents(robot, "bridge")
    moves = any(it.get("type", FIXED) != FIXED for it in source.root.iter("joint"))
    nodes = [_runs(it, moves) for it in evidence.nodes]
    real = robot.spec.simulator == REAL
    text = without_simulator(source.source, source.file) if real else source.source
    reading = read(text, source.file, robot.member.vocabulary)
    shared = [end for node in nodes if node.shared for end in _ends_of(node, given)]
    ends = [
        *(end for node in nodes if not node.shared for end in _ends_of(node, given)),
        *(end for node in reading.nodes for end in _plugin_ends(node)),
        *(
            end
            for it in bridges
            for end in bridge_ends(it, robot.spec.bridge_namespace_of(it.file))
        ),
    ]
    sent = {child for node in nodes for child in children_of(node)}
    sent |= {it.name for it in reading.names if it.kind == FRAME and it.tag == "plugin"}
    return System(
        tuple(_plainly(robot, it) for it in given),
        tuple(_plain(robot, it) for it in exported(source.root, source.file)),
        tuple(ends),
        tuple(shared),
        frozenset(sent),
        tuple(_documents(robot, "moveit")),
        tuple(_sender(it, given, _root(robot)) for it in nodes if it.sends),
    )


def system_after(
    robot: RewrittenRobot, fleet: Fleet, texts: Sequence[OutputText], known: KnownNodes
) -> System:
    """The system of the files that were made for a robot, under its remap rules."""
    own = [it for it in texts if it.path.startswith(f"{robot.spec.name}/")]
    params = [_read(it) for it in own if PARAMETERS in it.text]
    bridges = [
        _read(it) for it in texts if it.path in (BRIDGE_FILE, f"{robot.spec.name}/{BRIDGE_FILE}")
    ]
    file = robot.member.source.file
    written = read_document(robot.description, file)
    owners = {f"{it.namespace.rstrip('/')}/{it.name}": it.node for it in fleet.table.nodes}
    ends = [end for it in bridges for end in bridge_ends(it)]
    ends += [_planned(it, owners) for it in fleet.table.names if it.robot == robot.spec.namespace]
    # Rules of a plugin are for its whole process: topics of controllers that the table does not have.
    of_plugins = (end for node in robot.member.reading.nodes for end in _plugin_ends(node))
    ends += [it for it in of_plugins if not it.role]
    return System(
        tuple(given_nodes(params, known)),
        tuple(exported(written.root, file)),
        tuple(ends),
        tuple(_planned(it, owners) for it in fleet.table.names if not it.robot),
        frozenset(it.child for it in robot.tree),
        tuple(_read(it) for it in own if MOVEIT in it.text),
        tuple(_senders(fleet, robot)),
    )


def _senders(fleet: Fleet, robot: RewrittenRobot) -> Iterator[Sender]:
    for (owner, node), edges in fleet.edges.items():
        if owner == robot.spec.namespace and node != STATE_PUBLISHER:
            yield Sender(f"/{node}", tuple(edges), None)


def _planned(it: EndpointName, owners: Mapping[str, str]) -> End:
    end = it.endpoint
    own = (end.kind, end.role, it.name, end.type, end.name, owners.get(it.node, it.node))
    return End(it.node, *own, None, not end.when, end.also)


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
    """The same of what a launch file fills in for a robot that has such an argument."""
    own = _own(robot)
    values = {
        key: it._replace(value=own.get(it.value, it.value)) if isinstance(it.value, str) else it
        for key, it in given.values.items()
    }
    return given._replace(values=values)


def _sender(node: NodeFacts, given: Iterable[GivenNode], root: str) -> Sender:
    place = next((it.place for it in given if it.name == node.name), None)
    return Sender(f"/{node.name}", tuple(sent_by(node, root)), place)


def _root(robot: RewrittenRobot) -> str:
    """The first link that no joint has as its child."""
    joints = robot.member.source.root.iter("joint")
    children = {end.get("link") for it in joints for end in it.iterfind("child")}
    links = (it.get("name", "") for it in robot.member.source.root.iterfind("link"))
    return next((it for it in links if it not in children), "")


def _documents(robot: RewrittenRobot, kind: str) -> list[YamlText]:
    return [yaml_of(path) for path in robot.spec.companions.get(kind, ())]


def _read(text: OutputText) -> YamlText:
    return read_yaml(text.text.encode(), text.path)


def _runs(node: NodeFacts, moves: bool) -> NodeFacts:
    """A robot without movable joints has no joint states to read."""
    if moves or node.package != STATE_PUBLISHER:
        return node
    return node._replace(endpoints=tuple(it for it in node.endpoints if it.role != SUBSCRIBES))


def _ends_of(node: NodeFacts, given: Iterable[GivenNode]) -> Iterator[End]:
    """The ends of a node by the names of its code, or what the usual launch files make of them."""
    above, _, name = f"/{node.name}".rpartition("/")
    section = next((it for it in given if it.name == node.name), None)
    values = section.values if section else {}
    for it in (it for it in node.endpoints if "<" not in it.name):
        full = expand(it.remapped or it.name, above or "/", name)
        place = values[it.parameter].place if it.parameter in values else None
        # A node with parameters is meant to run.
        sure = not it.when and (section is not None or not node.when)
        own = (it.kind, it.role, full, it.type, it.name, node.name)
        at = section.place if section else None
        yield End(f"/{node.name}", *own, place, sure, it.also, at)


def _plugin_ends(node: ReadNode) -> Iterator[End]:
    for it in node.endpoints:
        own = (it.kind, it.role, it.full, it.type, it.name, str(node.number))
        yield End(node.full_name, *own, None, not it.off)


def bridge_ends(document: YamlText, above: str = "") -> Iterator[End]:
    """The ROS ends of the rows of a ros_gz_bridge file that runs in the namespace ``above``."""
    for row in items(document.root):
        values = {key.value: value for key, value in pairs(row)}
        name = values.get(ROS) or values.get(BOTH)
        if name is None:
            continue
        words = {key: str(value.value) for key, value in values.items()}
        place = Place(document.file, line_of(name))
        full = f"/{below(str(name.value), above).lstrip('/')}"
        for role in ROLES.get(words.get("direction", "BIDIRECTIONAL"), ("",)):
            type_ = words.get("ros_type_name", "")
            yield End(f"/{BRIDGE_NODE}", TOPIC, role, full, type_, full, BRIDGE_NODE, place)
