# SPDX-License-Identifier: Apache-2.0
"""Dangers of transforms: two parents, cycles, frames of several robots that collide; who sends one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from multibot_rewrite.base.conventions import (
    SENT_FRAMES,
    TF_SWITCHES,
    USUAL_FRAMES,
    WORLD_FRAMES,
    switch,
)
from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding, Remap
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.wording import SEVERAL, and_then, only, shorten, unique
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import Cause, to_set
from multibot_rewrite.rules.system.planned_frames import with_more_names
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, Tree, robots_of
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import SUBSCRIBES, Edge
from multibot_rewrite.system.tf_copies import static_topic
from multibot_rewrite.system.words import last_word

_STATE_PUBLISHER, _STATIC = "robot_state_publisher", "static_transform_publisher"
# These have a prefix for frames as well, on by default.
_OF_CONTROLLERS = "enable_odom_tf"
# What a node looks at to find the robot in the map.
_SEEN = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"


@system_rule("MG401", "two-parents", ERROR)
def frame_with_two_parents(seen: Index) -> Iterator[Finding]:
    """Yield frames with two parents; the cause names the nodes that may have sent them."""
    for tree in seen.trees:
        edges = lists_by_key((edge.child, edge) for edge in tree.edges)
        above = sets_by_key((edge.child, edge.parent) for edge in tree.edges)
        for child, parents in above.items():
            if len(parents) < 2:
                continue
            both = and_then(sorted(parents))
            message = f"frame {child} has {len(parents)} parents on {tree.topic}: {both}"
            own = edges[child]
            robot = seen.frame_robot(child) or only(robots_of(seen, _senders_of(tree, own)))
            senders = _senders_of(tree, own)
            cause = _senders_text(seen, tree, [(it, child) for it in sorted(parents)], senders)
            cause += see_all(own)
            yield frame_with_two_parents.finding(
                message, cause, robot=robot, names=(child,), **last_place(own)
            )


def _senders_of(tree: Tree, edges: Iterable[Edge]) -> Sequence[str]:
    """Return the nodes that send these transforms, or all senders on the topic if unknown."""
    return unique(node for it in edges for node in it.publishers) or tree.senders


def _senders_text(
    seen: Index, tree: Tree, edges: Sequence[tuple[str, str]], senders: Sequence[str]
) -> str:
    """Return the possible senders of these transforms: known ones first, then the frame's robot."""
    frame = edges[0][1]
    robots = robots_of(seen, senders)
    owner = seen.frame_robot(frame) or seen.robot(tree.topic)
    planned = [(node, it) for it in edges for node in seen.senders.get(it, ())]
    there = [it for it in planned if it[0] in senders] or planned[:1]
    known = [node for node, _ in there]
    nodes = sorted(senders, key=lambda it: (it not in known, seen.robot(it) != owner))
    which = "two of the nodes that send" if nodes[1:] else "the node that sends"
    sent = f"{which} on {tree.topic}: {shorten(nodes, SEVERAL)}" if nodes else ""
    if there:
        by_plan = " and ".join(f"{node} sends {above} -> {it}" for node, (above, it) in there)
        return f"by the plan {by_plan}; {sent}"
    if len(robots) > 1 and not owner:
        return f"{and_then(robots)} need frames of their own, or tf topics of their own; {sent}"
    if len(robots) > 1:
        return f"{sent}; a node of another robot that has the names of {owner}?"
    return sent or "two nodes send parts of it: stop one"


@system_rule("MG402", "robots-frames-collide", ERROR)
def robots_frames_collide(seen: Index) -> Iterator[Finding]:
    """Report robots with the same frames on one topic, also if one robot's frames have no name."""
    for tree in seen.trees:
        who = collide(seen, tree)
        if who:
            bare = _bare_frames(seen, tree)
            message = f"{who} on {tree.topic}: {shorten(bare, SEVERAL)}"
            cause = _how_to_part(seen, tree, robots_of(seen, tree.senders))
            yield robots_frames_collide.finding(
                message, **cause._asdict(), names=(*bare, tree.topic)
            )


def collide(seen: Index, tree: Tree) -> str:
    """Return who sends frames that do not show their robot; empty if nothing collides."""
    senders = [it for it in tree.senders if it not in seen.relays]
    robots, bare = robots_of(seen, senders), set(_bare_frames(seen, tree))
    # Who sends on another robot's topic is a finding of its own.
    if bare and not seen.robot(tree.topic) and _may_collide(seen, tree):
        named = sets_by_key(
            (seen.frame_robot(it.child), seen.plain_frame(it.child)) for it in tree.edges
        )
        nameless = [it for it in robots if len(named.get(it, bare - bare) & bare) < len(bare)]
        of_all = {seen.plain_frame(it) for it in _named_frames(seen, tree)}
        without = {robot for robot in robots if robot not in named}
        who = nameless or robots
        # In a recording nobody is known to have sent them.
        alike = any(it.child in bare and _is_of_several(seen, it) for it in tree.edges)
        if who and (len(without) > 1 or alike or (not without and of_all & bare)):
            send = "sends" if len(who) == 1 else "send"
            return f"{and_then(who)} {send} frames without a robot's name"
    # As where two robots have no namespace.
    several = (it for it in senders if seen.nodes.get(it, 0) > 1)
    if bare and any("robot_state" in last_word(it) for it in several):
        return "two nodes of one name send the same frames"
    return ""


def _may_collide(seen: Index, tree: Tree) -> bool:
    """Return whether two robots may have one frame here, also by nodes with unknown frames."""
    owners: dict[str, set[str]] = defaultdict(set)
    for edge in tree.edges:
        for frame in (edge.child, edge.parent):
            owners[frame].update(robots_of(seen, edge.publishers))
    known = {node for edge in tree.edges for node in edge.publishers}
    plain = [it for it in owners if not seen.frame_robot(it) and it not in WORLD_FRAMES]
    return not known.issuperset(tree.senders) or any(len(owners[it]) != 1 for it in plain)


def _bare_frames(seen: Index, tree: Tree) -> list[str]:
    """Return the frames of a tree without a robot's name, those of several robots first."""
    met = (it.parent for it in tree.edges if _is_of_several(seen, it))
    frames = unique((*met, *(edge.child for edge in tree.edges)))
    return [it for it in frames if not seen.frame_robot(it) and it not in WORLD_FRAMES]


def _is_of_several(seen: Index, edge: Edge) -> bool:
    """Return whether nodes of several robots send a transform below frames of their own."""
    own = edge.parent not in WORLD_FRAMES and not edge.transform
    return own and edge.several and len(robots_of(seen, edge.publishers)) > 1


def _named_frames(seen: Index, tree: Tree) -> Iterator[str]:
    frames = (it for edge in tree.edges for it in (edge.child, edge.parent))
    return (it for it in frames if seen.frame_robot(it))


def _how_to_part(seen: Index, tree: Tree, robots: Sequence[str]) -> Cause:
    """Return how robots' frames on one topic get apart: by names if some have them, else by topics."""
    senders = f"the senders are {shorten(tree.senders, SEVERAL)}"
    named = "put the robot's name into these frames (urdf-postfix; a node's in its parameters)"
    if any(_named_frames(seen, tree)):
        return Cause(f"{named}; {senders}")
    if seen.robot(tree.topic):
        return Cause(f"start the nodes of one of the two in another namespace; {senders}")
    nodes = [it for it in (*tree.senders, *tree.listeners) if it.startswith(f"/{seen.robot(it)}/")]
    remaps = (
        it
        for node in nodes
        for it in tf_remaps([node], tree.topic, f"{node.rpartition('/')[0]}{tree.topic}")
    )
    # One without a namespace may keep the topic.
    whole = bool(nodes) and len(robots) - 1 <= len(robots_of(seen, nodes))
    own = "pass -r /tf:=tf -r /tf_static:=tf_static to every node of a robot"
    own = own if whole else "give each robot a namespace of its own, with tf in it"
    named = "or put its name into its frames (urdf-postfix)"
    return Cause(f"{own}, {named}; {senders}", remaps=tuple(remaps) if whole else ())


def tf_remaps(nodes: Iterable[str], topic: str, home: str) -> tuple[Remap, ...]:
    """Return the rules that move nodes from one tf topic to another, with the static one."""
    pairs = {static_topic(topic): static_topic(home), topic: home}
    return tuple(Remap(node, *pair) for node in nodes for pair in reversed(pairs.items()))


@system_rule("MG403", "tf-cycle", ERROR)
def tf_cycle(seen: Index) -> Iterator[Finding]:
    """Report each circle once."""
    for tree in seen.trees:
        edges = lists_by_key((edge.child, edge) for edge in tree.edges)
        for circle in _circles(sets_by_key((it.child, it.parent) for it in tree.edges)):
            around = [*pairwise((*circle, circle[0]))]
            way = " -> ".join((*circle, circle[0]))
            message = f"the transforms on {tree.topic} go round in a circle: {way}"
            robots = unique(filter(None, (seen.frame_robot(it) for it in circle)))
            robot = only(robots) or only(robots_of(seen, tree.senders))
            yield tf_cycle.finding(
                message,
                _senders_text(seen, tree, around, _senders_of(tree, edges[around[0][1]])),
                robot=robot,
                names=circle,
            )


def _circles(parents: Mapping[str, Iterable[str]]) -> Iterator[tuple[str, ...]]:
    """Yield circles that have no frame in common, each from the parent to the child."""
    left = {child: set(above) & parents.keys() for child, above in parents.items()}
    below = lists_by_key((parent, child) for child, above in left.items() for parent in above)
    _take_away(left, below, [child for child, above in left.items() if not above])
    for start in sorted(left):
        while start in left:
            frame, way = start, dict[str, int]()
            while frame not in way:
                way[frame] = len(way)
                frame = min(left[frame])
            circle = [*way][way[frame] :]
            yield tuple(reversed(circle))
            _take_away(left, below, circle)


def _take_away(
    left: dict[str, set[str]], below: Mapping[str, Iterable[str]], gone: list[str]
) -> None:
    """Remove ``gone`` frames from ``left``, and the frames from which there is no other way."""
    out = {*gone}
    for parent in gone:  # grows
        del left[parent]
        for child in below.get(parent, ()):
            if child not in out:
                left[child].discard(parent)
                if not left[child]:
                    out.add(child)
                    gone.append(child)


@system_rule("MG404", "static-and-moving", ERROR)
def static_and_moving(seen: Index) -> Iterator[Finding]:
    """Yield transforms that are sent as static and as moving; two parents are another finding."""
    for tree in seen.trees:
        above = sets_by_key((edge.child, edge.parent) for edge in tree.edges)
        several = {child for child, parents in above.items() if len(parents) > 1}
        fixed = {it.child: it for it in tree.edges if "tf_static" in it.topic.split("/")}
        for edge in tree.edges:
            other = fixed.get(edge.child)
            if other is None or other.topic == edge.topic or edge.child in several:
                continue
            message = f"{edge.parent} -> {edge.child} is sent on {other.topic} and on {edge.topic}"
            nodes = [it for it in other.publishers if _STATIC in it] or other.publishers
            cause = f"{shorten(nodes)} or {shorten(edge.publishers)}: stop one"
            robot = seen.frame_robot(edge.child) or only(robots_of(seen, tree.senders))
            yield static_and_moving.finding(
                message, cause, robot=robot, names=(edge.child, edge.parent)
            )


@system_rule("MG408", "transform-of-two-senders", ERROR)
def transform_of_two_senders(seen: Index) -> Iterator[Finding]:
    """Report transforms that several nodes send, one finding a robot, unless frames collide."""
    for tree in seen.trees:
        if collide(seen, tree):
            continue
        known = sets_by_key(((it.parent, it.child, it.topic), it.publishers) for it in tree.edges)
        several = {it for it, senders in known.items() if len(senders) > 1}
        edges = (it for it in tree.edges if it.several or (*it[1::-1], it.topic) in several)
        by_robot = lists_by_key((seen.frame_robot(it.child), it) for it in edges)
        for robot, own in by_robot.items():
            listed = shorten(unique(f"{it.parent} -> {it.child}" for it in own))
            message = f"several nodes send {listed} on {tree.topic}"
            senders = _senders_of(tree, own)
            who = robot or only(robots_of(seen, senders))
            nodes = [it for it in senders if seen.robot(it) in ("", who)] or senders
            nodes = who_can_send(seen, nodes, own)
            right = {it for edge in own for it in seen.senders.get(edge[1::-1], ())}
            nodes = sorted(nodes, key=lambda it: it not in right)
            listed_nodes = shorten(nodes, SEVERAL)
            able = [it for it in nodes if switch(TF_SWITCHES, it)]
            name = switch(TF_SWITCHES, able[-1]) if able else ""
            off = to_set(name, parameter_text(False), *able[-1:])
            cause = f"stop one{', or ' * bool(able)}{off.hint}: two of {listed_nodes}"
            others = [it for it in senders if seen.robot(it) not in ("", who)]
            others = [it for it in others if it not in nodes]
            if others:
                cause += f"; or {shorten(others)} with the description or parameters of {who}"
            # Static and of one value: where senders differ none is known.
            is_fixed = all(it.static and it.transform for it in own)
            yield transform_of_two_senders.finding(
                message, cause + see_all(own), level=NOTE if is_fixed else ERROR,
                robot=who, names=unique(it.child for it in own), **last_place(own),
                settings=() if is_fixed else off.settings,
            )  # fmt: skip


@system_rule("MG407", "robots-name-twice", ERROR)
def robots_name_twice(seen: Index) -> Iterator[Finding]:
    """Report all frames of a robot and topic as one. A robot with a plan is checked by it alone."""
    told = set()
    more = with_more_names(seen.expected, seen) if seen.expected else ()
    for message, is_planned, tree, it, names in more:
        told.add(it.name)
        sent = [edge for edge in tree.edges if not {edge.child, edge.parent}.isdisjoint(names)]
        own = [one for one in _senders_of(tree, sent) if seen.robot(one) in ("", it.name)]
        cause = _without_prefix(own if is_planned else ())
        yield robots_name_twice.finding(message, **cause._asdict(), robot=it.name, names=names)
    for tree in seen.trees:
        doubled: dict[str, list[str]] = defaultdict(list)
        for frame in unique(it for edge in tree.edges for it in (edge.child, edge.parent)):
            robot = seen.frame_robot(frame)
            plain = seen.plain_frame(frame)
            # A robot may be called as a frame is.
            once = plain == robot or robot in ("", *USUAL_FRAMES)
            if not once and robot in plain.split("/"):
                doubled[robot].append(frame)
        for robot, frames in doubled.items():
            if robot in told:
                continue
            verb = "has" if len(frames) == 1 else "have"
            message = f"{shorten(frames)} {verb} the name of {robot} twice"
            sent = [it for it in tree.edges if it.child in frames or it.parent in frames]
            cause = _without_prefix(_senders_of(tree, sent))
            yield robots_name_twice.finding(
                message, **cause._asdict(), robot=robot, names=tuple(frames)
            )


def _without_prefix(nodes: Iterable[str]) -> Cause:
    """Return what takes the robot's name away that is put before frames of a rewritten description."""
    described = [it for it in nodes if last_word(it).startswith(_STATE_PUBLISHER)]
    driven = [it for it in nodes if switch(TF_SWITCHES, it) == _OF_CONTROLLERS]
    causes = [
        to_set("frame_prefix", "", *described),
        to_set("tf_frame_prefix_enable", parameter_text(False), *driven),
    ]
    said = (
        " and ".join(filter(None, (it.hint for it in causes)))
        or "see which prefix its senders have"
    )
    settings = (one for it in causes for one in it.settings)
    return Cause(f"the description has the name already: {said}", settings=tuple(settings))


def who_can_send(seen: Index, nodes: Sequence[str], edges: Sequence[Edge]) -> Sequence[str]:
    """Return the nodes that can send one of these transforms; all if fewer than two are left."""
    found = [node for node in nodes if any(_can_send(seen, node, it) for it in edges)]
    if all(seen.plain_frame(it.parent) in WORLD_FRAMES for it in edges):
        ends = (one for it in found for one in seen.by_node.get(it, ()) if one.type in _SEEN)
        seeing = unique(it.node for it in ends if it.role == SUBSCRIBES)
        found = [*seeing] if len(seeing) > 1 else found
    return found if len(found) > 1 else nodes


def _can_send(seen: Index, node: str, edge: Edge) -> bool:
    """Return whether a node can send a transform, by its name and what it reads."""
    above, word = seen.plain_frame(edge.parent), last_word(node)
    if word.startswith(_STATE_PUBLISHER):
        return above not in SENT_FRAMES
    if word.startswith(_STATIC):
        return edge.static
    read = [it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES]
    if any(words.is_start_pose(seen.plain(it.name), it.type) for it in read):
        return above in WORLD_FRAMES
    drives = any(words.moves(it.name, it.type) for it in read)
    return not (drives and above in WORLD_FRAMES)
