# SPDX-License-Identifier: Apache-2.0
"""Settings of a robot's nodes that no file of the robot makes: they fit what its description and its
files have.

What the user's files say stays. A node that a stack adds gets the type of commands, the frames and the
transforms with which it works beside them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.rewriters.own_defaults import MODEL, default_of, frame_sites
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec
from multibot_rewrite.fleet.outputs.output_file import own_yaml
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.fleet.robots.mux import COMMANDS, own_mux, through_a_mux, topic_of, topics_of
from multibot_rewrite.knowledge.conditions import chosen_type, parse_condition
from multibot_rewrite.knowledge.records import (
    MANAGER,
    MOVE_GROUP,
    TWIST_MUX,
    Endpoint,
    NodeFacts,
)
from multibot_rewrite.producers.ends import bridge_ends
from multibot_rewrite.producers.evidence.filling import lookup, sent_with
from multibot_rewrite.producers.evidence.records import Given, GivenNode
from multibot_rewrite.spelling.bridged_topics import DIRECTIONS, TF_TYPE, bridged_topics
from multibot_rewrite.spelling.table import plugin_nodes
from multibot_rewrite.spelling.transforms import edges_in, sent_by
from multibot_rewrite.system.records import NOWHERE, PUBLISHES, SUBSCRIBES, Edge, edge_of
from multibot_rewrite.system.words import ODOMETRY, PLAIN, STAMPED

ODOM = "odom"
Frames = Mapping[str, str]
NO_FRAMES: Frames = {}
_BY_FILE = "open: file"
# What a robot has one of, mostly: a reader of it has no other one in mind.
SENSED = (
    *("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/NavSatFix"),
    *("sensor_msgs/msg/PointCloud2", ODOMETRY),
)
RVIZ = "rviz2"
# The layout in which a description keeps its frames.
_NAMING = make_naming("tf-per-robot")


def _driven(member: Member, spec: RobotSpec) -> tuple[Edge, ...]:
    """The transforms that plugins of the description send; none of a real robot."""
    if spec.simulator == REAL:
        return ()
    source = member.source
    found: list[Edge] = []
    for host, section in collect(source, member.tree).served:
        sites = frame_sites(host, section, _NAMING)
        frames = [text_at(host, it.path) or default_of(host, it.default, _NAMING) for it in sites]
        if len(frames) == 2:
            parent, child = (it.removeprefix(MODEL) for it in frames)
            found.append(edge_of(parent, child))
    reading = read(source.source, source.file, member.vocabulary)
    nodes = (node for node, _ in plugin_nodes(reading, ""))
    return (*found, *(it for node in nodes for it in sent_by(node, "")))


def sent_by_controllers(nodes: Iterable[NodeFacts]) -> Iterator[Edge]:
    """The transforms of the controllers that surely run."""
    yield from (it for node in _controllers(nodes) for it in sent_by(node, ""))


def fitting_frames(member: Member, nodes: Iterable[NodeFacts], sent: Sequence[Edge]) -> Frames:
    """Return the usual frames that nothing of the robot has, each with the frame that its drive has in
    that place."""
    placed = next((it for it in sent if it.child in BODY_FRAMES or it.parent == ODOM), None)
    if placed is None:
        return NO_FRAMES
    links = {it.get("name", "") for it in member.source.root.iter("link", "frame")}
    given = {frame.default for it in nodes for frame in it.frames if frame.given}
    has = links | given | {frame for it in sent for frame in it[:2]}
    wanted = {**dict.fromkeys(BODY_FRAMES, placed.child), ODOM: placed.parent}
    return {name: it for name, it in wanted.items() if name not in has}


def with_frames(node: NodeFacts, fits: Frames) -> NodeFacts:
    """Return the node with frames that the robot has, where no file sets them."""
    frames = (
        it if it.given else it._replace(default=fits.get(it.default, it.default))
        for it in node.frames
    )
    return node._replace(frames=tuple(frames)) if fits else node


def changed_frames(
    nodes: Iterable[NodeFacts], before: Iterable[NodeFacts]
) -> Mapping[tuple[str, str], str]:
    """Return the frames of nodes that are others than ``before``, where no file sets them: by the
    node's last name and the parameter."""
    old = {(node.name, it.parameter): it.default for node in before for it in node.frames}
    return {
        (node.kind.rpartition("/")[2], it.parameter): it.default
        for node in nodes
        for it in node.frames
        if not it.given and old.get((node.name, it.parameter), it.default) != it.default
    }


class _Choice(NamedTuple):
    """A node whose commands are stamped or not as a parameter says: its ends that are, as its code has
    them, the type that it has now, whether a file sets the parameter, and whether the build may."""

    node: NodeFacts
    ends: Sequence[Endpoint]
    type: str
    is_set: bool
    is_free: bool


class Described(NamedTuple):
    """What a description has for the nodes of its robot: the transforms that its plugins send, the
    topics of its sensors by type, and its root, where a usual link of the body is below it."""

    sent: tuple[Edge, ...]
    offered: Mapping[str, Sequence[str]]
    root: str


def described(member: Member, spec: RobotSpec) -> Described:
    """Return what the description has, under the names that it has there."""
    return Described(_driven(member, spec), _offered(member, spec), _root(member))


def free_nodes(own: Iterable[str], given: Iterable[GivenNode]) -> frozenset[str]:
    """Return those of the nodes that no parameter file has a section for: what they are set to is the
    build's to choose."""
    filed = [f"/{it.name}" for it in given]
    return frozenset(it for it in own if not any(one.endswith(f"/{it}") for one in filed))


def fitted(
    nodes: Sequence[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[GivenNode],
    known: Mapping[str, NodeFacts],
    has: Described,
    spec: RobotSpec,
) -> tuple[NodeFacts, ...]:
    """Return the nodes, those that are ``free`` with the settings that fit the others. ``own`` are
    those that the build starts: what no file sets of them is the build's to set, too."""
    offered = _with_controllers(has.offered, nodes)
    settled = [
        _settled(_rooted(_as_listed(_hearing(it, nodes, offered), spec), has.root))
        if it.name in free
        else it._replace(usual=())
        for it in nodes
    ]
    muxes = own_mux(settled, own)
    usual = dict(one for it in nodes if it.name in muxes for one in it.usual)
    if muxes:
        settled = [*through_a_mux(_driving(settled, muxes), own, usual, known[TWIST_MUX])]
    settled = [*_driving(settled, own)]
    choices = {it.node.name: it for it in _choices(settled, own, free, given, known)}
    wanted = _wanted(tuple(choices.values()), free, settled, spec)
    typed = [_typed(it, choices.get(it.name), wanted) for it in settled]
    return tuple(_without_second_senders(typed, free, has.sent))


def _offered(member: Member, spec: RobotSpec) -> Mapping[str, Sequence[str]]:
    """The topics of the sensors in the description, by their types, as the robot alone has them."""
    found: dict[str, list[str]] = {}
    if spec.simulator != REAL:
        topics, _ = bridged_topics({"": collect(member.source, member.tree)}, _NAMING)
        for it in topics:
            # One that the description does not name comes where it is read.
            if it.ros_type in SENSED and it.direction == DIRECTIONS["in"] and not it.is_free:
                found.setdefault(it.ros_type, []).append(it.ros.strip("/"))
    return found


def _hearing(
    node: NodeFacts, nodes: Iterable[NodeFacts], offered: Mapping[str, Sequence[str]]
) -> NodeFacts:
    """The node with the robot's only topic of a sensor where it would hear one that nobody sends."""
    sent = topics_of(nodes, PUBLISHES)
    ends = []
    for end in node.endpoints:
        topics = offered.get(end.type, ()) if end.role == SUBSCRIBES and not end.when else ()
        lost = (
            len(topics) == 1 and "<" not in end.name and topic_of(node, end) not in {*topics, *sent}
        )
        # No file says the name that its stack has.
        named = end.named_from or end.name
        ends.append(end._replace(name=named, remapped=topics[0]) if lost else end)
    return node._replace(endpoints=tuple(ends)) if offered else node


def _with_controllers(
    offered: Mapping[str, Sequence[str]], nodes: Iterable[NodeFacts]
) -> Mapping[str, Sequence[str]]:
    """What a robot offers, with the odometry of its controllers."""
    ends = _of_controllers(nodes, PUBLISHES, (ODOMETRY,))
    found = [*offered.get(ODOMETRY, ()), *ends]
    return {**offered, ODOMETRY: found} if ends else offered


def _controllers(nodes: Iterable[NodeFacts]) -> Iterator[NodeFacts]:
    yield from (it for it in nodes if it.host == MANAGER and not it.when)


def _of_controllers(nodes: Iterable[NodeFacts], role: str, types: Collection[str]) -> Sequence[str]:
    """The topics of these types that controllers surely have."""
    ends = ((node, it) for node in _controllers(nodes) for it in node.endpoints)
    return [
        topic_of(*it)
        for it in ends
        if it[1].role == role and it[1].type in types and not it[1].when
    ]


def _driving(nodes: Sequence[NodeFacts], own: Collection[str]) -> Sequence[NodeFacts]:
    """The nodes; commands of ``own`` ones that nothing hears go to the one controller that drives."""
    drives = _of_controllers(nodes, SUBSCRIBES, COMMANDS)
    if len(drives) != 1:
        return nodes
    return [
        _sending(it, topics_of((one for one in nodes if one is not it), SUBSCRIBES), drives[0])
        if it.name in own
        else it
        for it in nodes
    ]


def _sending(node: NodeFacts, heard: Collection[str], drive: str) -> NodeFacts:
    ends = (
        it._replace(remapped=drive)
        if it.role == PUBLISHES and it.type in COMMANDS and topic_of(node, it) not in heard
        else it
        for it in node.endpoints
    )
    return node if node.host else node._replace(endpoints=tuple(ends))


def _root(member: Member) -> str:
    """The link that no joint holds, where another usual one of the body is below it; else empty."""
    children = {it.child for it in edges_in(member.source.root)}
    roots = [
        name
        for it in member.source.root.iterfind("link")
        if (name := it.get("name", "")) not in children
    ]
    return roots[0] if len(roots) == 1 and not children.isdisjoint(BODY_FRAMES) else ""


def _rooted(node: NodeFacts, root: str) -> NodeFacts:
    """The node with the root of the description as the frame that it places: a link that a joint holds
    has a parent already."""
    placed = {it.child for it in node.sends}
    frames = (
        it._replace(default=root) if it.parameter in placed and it.default in BODY_FRAMES else it
        for it in node.frames
    )
    return node._replace(frames=tuple(frames)) if root else node


def _is_made_below(name: str) -> bool:
    """Is it made at run time, in the namespace of its robot? An absolute one all robots would share."""
    return "<" in name and not name.startswith("/")


def _as_listed(node: NodeFacts, spec: RobotSpec) -> NodeFacts:
    """The node without the names that it makes of a list which no file gives it: they may come, if a
    file is added. So may those of the panels and displays that RViz has in its usual file, where the
    robot has another one."""
    if node.kind == MOVE_GROUP and spec.companions.get("moveit"):
        return node
    shows = node.kind == RVIZ and bool(spec.companions.get("rviz"))
    ends = (
        it._replace(when=_BY_FILE)
        if not it.when and (_is_made_below(it.name) or (shows and it.type != TF_TYPE))
        else it
        for it in node.endpoints
    )
    return node._replace(endpoints=tuple(ends))


def _settled(node: NodeFacts) -> NodeFacts:
    """The node as the parameters of its stack make it."""
    if not node.usual:
        return node
    values = _values(node)
    frames = tuple(
        it._replace(default=str(values[it.parameter].value), given=True)
        if it.parameter in values
        else it
        for it in node.frames
    )
    with_them = node._replace(frames=frames)
    return with_them._replace(sends=tuple(sent_with(with_them, values)))


def _values(node: NodeFacts) -> dict[str, Given]:
    return {name: Given(value, NOWHERE) for name, value in node.usual}


def _choices(
    nodes: Iterable[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[GivenNode],
    known: Mapping[str, NodeFacts],
) -> Iterator[_Choice]:
    for node in nodes:
        ends = [*_either(known.get(node.kind, node)), *_either(node)]
        if ends:
            last = f"/{node.name}"
            sections = (it.values for it in given if f"/{it.name}".endswith(last))
            values = next(sections, _values(node))
            chosen = chosen_type(ends[0].types, lookup(node, values)) or ends[0].type
            is_set = not _switches(ends).isdisjoint(values)
            is_free = node.name in free or (node.name in own and not is_set)
            yield _Choice(node, ends, chosen, is_set, is_free)


def _either(node: NodeFacts) -> Iterator[Endpoint]:
    """The ends of a node that are of either type, as a parameter says; not those that are open."""
    both = {PLAIN, STAMPED}
    yield from (
        it for it in node.endpoints if it.types and not it.when and {it.type, *it.also} >= both
    )


def _switches(ends: Iterable[Endpoint]) -> set[str]:
    conditions = (condition for it in ends for condition, _ in it.types)
    return {it.parameter for one in conditions for terms in parse_condition(one) for it in terms}


def _wanted(
    choices: Sequence[_Choice],
    free: Collection[str],
    nodes: Iterable[NodeFacts],
    spec: RobotSpec,
) -> str:
    """The type of the robot's commands: what a file sets, what its bridge or driver takes, what the
    nodes of its files have, and what all nodes have; else the plain one."""
    topics = {topic_of(it.node, end) for it in choices for end in _either(it.node)}
    said = [it.type for it in choices if it.is_set]
    rows = [
        end.type
        for path in spec.companions.get("bridge", ())
        for end in bridge_ends(own_yaml(spec, path))
        if end.role == SUBSCRIBES
    ]
    heard = [
        end.type
        for node in nodes
        for end in node.endpoints
        if end.role == SUBSCRIBES and not (end.when or end.also) and topic_of(node, end) in topics
    ]
    fixed = [it for it in (*said, *rows, *heard) if it in (PLAIN, STAMPED)]
    of_files = [it.type for it in choices if it.node.name not in free]
    usual = {it.type for it in choices}
    return next(iter((*fixed, *of_files, *(usual if len(usual) == 1 else ()))), PLAIN)


def _typed(node: NodeFacts, choice: _Choice | None, wanted: str) -> NodeFacts:
    """The node with ends of the wanted type, and the parameter for it where that is not the default."""
    if choice is None or not choice.is_free:
        return node
    switch = () if choice.type == wanted else _switch(choice, wanted)
    if switch is None:
        return node
    ends = tuple(_of_type(it, wanted) for it in node.endpoints)
    return node._replace(endpoints=ends, usual=(*node.usual, *switch))


def _switch(choice: _Choice, wanted: str) -> tuple[tuple[str, bool]] | None:
    """The parameter that gives all of the node's ends the wanted type; None where there is none."""
    for name in sorted(_switches(choice.ends)):
        for value in (True, False):
            value_of = {name: value}.get
            if all((chosen_type(it.types, value_of) or it.type) == wanted for it in choice.ends):
                return ((name, value),)
    return None


def _of_type(end: Endpoint, wanted: str) -> Endpoint:
    is_command = end.type in COMMANDS and not end.when
    return end._replace(type=wanted, also=(), types=()) if is_command else end


def _without_second_senders(
    nodes: Sequence[NodeFacts], free: Collection[str], sent: Sequence[Edge]
) -> Iterator[NodeFacts]:
    """The nodes, free ones with their transforms off where another one sends them: two would take the
    frame from each other."""
    bodies = {*BODY_FRAMES, *(it.child for it in sent)}
    taken = {_place(it, bodies) for it in (*sent, *_in_files(nodes, free))}
    for node in nodes:
        own = {_place(it, bodies) for it in sent_by(node, "")}
        switch = _switch_of(node) if node.name in free and not own.isdisjoint(taken) else ""
        yield (node._replace(sends=(), usual=(*node.usual, (switch, False))) if switch else node)
        taken |= set() if switch else own


def _in_files(nodes: Iterable[NodeFacts], free: Collection[str]) -> Iterator[Edge]:
    yield from (it for node in nodes if node.name not in free for it in sent_by(node, ""))


def sends_too(nodes: Iterable[NodeFacts], free: Collection[str], sent: Sequence[Edge]) -> bool:
    """Does a node that surely runs and is not ``free`` send a transform that plugins have ``sent``?"""
    bodies = {*BODY_FRAMES, *(it.child for it in sent)}
    sure = (it for it in nodes if not it.when)
    own = {_place(it, bodies) for it in _in_files(sure, free)}
    return any(_place(it, bodies) in own for it in sent)


def _place(edge: Edge, bodies: Collection[str]) -> tuple[str, str]:
    """What a transform places, and where: a robot has one place, whichever of its frames has it."""
    return edge.parent, "" if edge.child in bodies else edge.child


def _switch_of(node: NodeFacts) -> str:
    """The parameter that, alone, switches all transforms of a node off; empty for none."""
    asked = (one for it in node.sends for terms in parse_condition(it.condition) for one in terms)
    values = _values(node)
    for name in dict.fromkeys(it.parameter for it in asked):
        off = {**values, name: Given(False, NOWHERE)}
        if not any(sent_with(node, off)):
            return name
    return ""
