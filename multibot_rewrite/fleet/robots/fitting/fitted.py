# SPDX-License-Identifier: Apache-2.0
"""Fits settings of nodes that no file makes to the robot's description and files.

Only one node sends a transform, and usual frames that the robot has not become its own. What the
user's files say stays."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description.rewriters.own_defaults import MODEL, default_of, frame_sites
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec
from multibot_rewrite.fleet.robots.fitting.commands import (
    by_way_of_relays,
    driving,
    of_one_type,
    own_mux,
    through_a_mux,
    to_the_drive,
)
from multibot_rewrite.fleet.robots.fitting.node_topics import controllers, plugins, usual_values
from multibot_rewrite.fleet.robots.fitting.sensors import (
    alone,
    bridge_rows_of,
    bridged_commands,
    by_sensor,
    command_rows,
    hearing_sensors,
    offered_topics,
    with_odometry,
)
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.knowledge.conditions import parse_condition
from multibot_rewrite.knowledge.records import MOVE_GROUP, TWIST_MUX, NodeFacts
from multibot_rewrite.planning.bridged_topics import TF_ELEMENT, TF_TYPE
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.planning.transforms import edges_in, sent_by
from multibot_rewrite.producers.evidence.filling import sent_with
from multibot_rewrite.system.records import NOWHERE, SUBSCRIBES, Edge, edge_of
from multibot_rewrite.system.words import last_word

# The layout in which a description keeps its frames.
_NAMING = make_naming("tf-per-robot")
_TF = "tf"


def sent_by_plugins(member: Member, spec: RobotSpec) -> tuple[Edge, ...]:
    """Return the transforms that plugins of the description send to tf; none of a real robot."""
    if spec.simulator == REAL:
        return ()
    elsewhere = _led_elsewhere(spec)
    found = (edge for topic, edge in _sent_by_systems(member) if topic not in elsewhere)
    return (*found, *(it for node in plugins(member) for it in sent_by(node, "")))


def is_led_elsewhere(member: Member, spec: RobotSpec) -> bool:
    """Return whether a bridge file of the robot has its drive's transform on another topic than tf."""
    elsewhere = _led_elsewhere(spec)
    return bool(elsewhere) and any(topic in elsewhere for topic, _ in _sent_by_systems(member))


def _sent_by_systems(member: Member) -> Iterator[tuple[str, Edge]]:
    """Yield (last name of the topic, transform) for what systems of a simulator send."""
    for host, section in collect(member.source, member.tree).served:
        sites = frame_sites(host, section, _NAMING)
        frames = [text_at(host, it.path) or default_of(host, it.default, _NAMING) for it in sites]
        if len(frames) == 2:
            parent, child = (it.removeprefix(MODEL) for it in frames)
            yield last_word(text_at(host, TF_ELEMENT) or _TF), edge_of(parent, child)


def brings_transforms(spec: RobotSpec) -> bool:
    """Return whether a bridge file of the robot or of its launch files has a row with transforms."""
    return any(it.end.type == TF_TYPE for it in bridge_rows_of(spec))


def _led_elsewhere(spec: RobotSpec) -> set[str]:
    """Return last names of gz topics whose transforms are bridged to another topic than tf."""
    led: dict[str, set[str]] = defaultdict(set)
    for it in bridge_rows_of(spec):
        if it.end.type == TF_TYPE and it.end.role != SUBSCRIBES:
            led[last_word(it.inside)].add(last_word(it.end.name))
    return {inside for inside, names in led.items() if _TF not in names}


def sent_by_controllers(nodes: Iterable[NodeFacts]) -> Iterator[Edge]:
    """Yield the transforms of the controllers that surely run."""
    yield from (it for node in controllers(nodes) for it in sent_by(node, ""))


def without_second_senders(
    nodes: Sequence[NodeFacts], free: Collection[str], sent: Sequence[Edge]
) -> Iterator[NodeFacts]:
    """Yield the nodes; ``free`` ones do not send transforms that another one sends."""
    # Two would take the frame from each other.
    bodies = {*BODY_FRAMES, *(it.child for it in sent)}
    taken = {_placed_body(it, bodies) for it in (*sent, *_edges_in_files(nodes, free))}
    for node in nodes:
        own = {_placed_body(it, bodies) for it in sent_by(node, "")}
        switch = _transform_switch(node) if node.name in free and not own.isdisjoint(taken) else ""
        yield (node._replace(sends=(), usual=(*node.usual, (switch, False))) if switch else node)
        taken |= set() if switch else own


def _edges_in_files(nodes: Iterable[NodeFacts], free: Collection[str]) -> Iterator[Edge]:
    yield from (it for node in nodes if node.name not in free for it in sent_by(node, ""))


def sends_too(
    nodes: Iterable[NodeFacts],
    free: Collection[str],
    sent: Sequence[Edge],
    any_parent: bool = False,
) -> bool:
    """Return whether a node that surely runs and is not ``free`` sends what plugins have ``sent``."""
    bodies = {*BODY_FRAMES, *(it.child for it in sent)}
    sure = (it for it in nodes if not it.when)
    own = {_placed_body(it, bodies, any_parent) for it in _edges_in_files(sure, free)}
    return any(_placed_body(it, bodies, any_parent) in own for it in sent)


def have_two_parents(sent: Iterable[Edge]) -> bool:
    """Return whether a frame has two parents by what plugins have ``sent``: not all is for tf."""
    return any(len(it) > 1 for it in sets_by_key((it.child, it.parent) for it in sent).values())


def _placed_body(edge: Edge, bodies: Collection[str], any_parent: bool = False) -> tuple[str, str]:
    """Return (parent, child) of a transform; the robot's body, and any parent if asked, are ""."""
    return "" if any_parent else edge.parent, "" if edge.child in bodies else edge.child


def _transform_switch(node: NodeFacts) -> str:
    """Return the parameter that, alone, switches all transforms of a node off; empty for none."""
    asked = (one for it in node.sends for terms in parse_condition(it.condition) for one in terms)
    values = usual_values(node)
    for name in dict.fromkeys(it.parameter for it in asked):
        off = {**values, name: Given(False, NOWHERE)}
        if not any(sent_with(node, off)):
            return name
    return ""


ODOM = "odom"
Frames = Mapping[str, str]
NO_FRAMES: Frames = {}


def fitting_frames(member: Member, nodes: Iterable[NodeFacts], sent: Sequence[Edge]) -> Frames:
    """Return the usual frames that the robot lacks, each with its drive's frame or usual link."""
    links = {it.get("name", "") for it in member.source.root.iter("link", "frame")}
    own = next((edge_of(ODOM, it) for it in BODY_FRAMES if it in links), None)
    placed = next((it for it in sent if it.child in BODY_FRAMES or it.parent == ODOM), own)
    if placed is None:
        return NO_FRAMES
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
    """Return by node and parameter the frames that are others than ``before``."""
    old = {(node.name, it.parameter): it.default for node in before for it in node.frames}
    return {
        (node.kind.rpartition("/")[2], it.parameter): it.default
        for node in nodes
        for it in node.frames
        if not it.given and old.get((node.name, it.parameter), it.default) != it.default
    }


def root_link(member: Member) -> str:
    """Return the link that no joint holds, above another usual one of the body; empty for none."""
    children = {it.child for it in edges_in(member.source.root)}
    roots = [
        name
        for it in member.source.root.iterfind("link")
        if (name := it.get("name", "")) not in children
    ]
    return roots[0] if len(roots) == 1 and not children.isdisjoint(BODY_FRAMES) else ""


def with_root(node: NodeFacts, root: str) -> NodeFacts:
    """Return the node with the description's root as the frame that it places."""
    # A link that a joint holds has a parent already.
    placed = {it.child for it in node.sends}
    frames = (
        it._replace(default=root) if it.parameter in placed and it.default in BODY_FRAMES else it
        for it in node.frames
    )
    return node._replace(frames=tuple(frames)) if root else node


RVIZ = "rviz2"


class Described(NamedTuple):
    """What a description has: transforms sent, sensor topics by type, root, bridged commands."""

    sent: tuple[Edge, ...]
    offered: Mapping[str, Sequence[str]]
    root: str
    bridged: Collection[str]


def described(member: Member, spec: RobotSpec) -> Described:
    """Return what the description has, under the names that it has there."""
    sent, offered = sent_by_plugins(member, spec), offered_topics(member, spec)
    return Described(sent, offered, root_link(member), bridged_commands(member, spec))


def free_nodes(own: Iterable[str], given: Iterable[Run]) -> frozenset[str]:
    """Return the nodes without a section in parameter files: the build chooses their values."""
    filed = [f"/{it.node}" for it in given]
    return frozenset(it for it in own if not any(one.endswith(f"/{it}") for one in filed))


def fitted(
    nodes: Sequence[NodeFacts],
    own: Collection[str],
    free: Collection[str],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
    has: Described,
    spec: RobotSpec,
) -> tuple[NodeFacts, ...]:
    """Return all nodes; the topics and frames of ``free`` and ``own`` ones fit those of the others."""
    # ``own`` nodes are started by the build: what no file sets of them is the build's to set, too.
    offered = with_odometry(has.offered, nodes)
    settled = []
    for it in nodes:
        if it.name in free:
            hears = hearing_sensors(by_sensor(it, offered), nodes, offered)
            settled.append(_settled(with_root(_without_unlisted_names(hears, spec), has.root)))
        else:
            settled.append(it._replace(usual=()))
    muxes = own_mux(settled, own)
    settled = [to_the_drive(it) if it.name in muxes else it for it in settled]
    usual = dict(one for it in nodes if it.name in muxes for one in it.usual)
    if muxes:
        led = driving(settled, muxes, has.bridged)
        settled = [*through_a_mux(led, own, usual, known[TWIST_MUX])]
    routed = by_way_of_relays(driving(settled, own, has.bridged), own)
    rows = [it.end.type for it in command_rows(spec) if alone(it.end.name) in has.bridged]
    typed = of_one_type(routed, own, free, given, known, rows)
    return tuple(without_second_senders(typed, free, has.sent))


def _without_unlisted_names(node: NodeFacts, spec: RobotSpec) -> NodeFacts:
    """Return the node without names that come from a list or file that the robot lacks."""
    if node.kind == MOVE_GROUP and spec.related_files.get("moveit"):
        return node
    shows = node.kind == RVIZ and bool(spec.related_files.get("rviz"))
    ends = []
    for it in node.endpoints:
        # It is made at run time, in the namespace of its robot; an absolute one all would share.
        is_made_below = "<" in it.name and not it.name.startswith("/")
        may_come = is_made_below or (shows and it.type != TF_TYPE)
        ends.append(it._replace(when="open: file") if may_come and not it.when else it)
    return node._replace(endpoints=tuple(ends))


def _settled(node: NodeFacts) -> NodeFacts:
    """Return the node as the parameters of its node set make it."""
    if not node.usual:
        return node
    values = usual_values(node)
    frames = tuple(
        it._replace(default=str(values[it.parameter].value), given=True)
        if it.parameter in values
        else it
        for it in node.frames
    )
    with_them = node._replace(frames=frames)
    return with_them._replace(sends=tuple(sent_with(with_them, values)))
