# SPDX-License-Identifier: Apache-2.0
"""Dangers of what nothing sends: an end, a frame or a transform that nodes ask for."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.conventions import SENT_FRAMES, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import last_place, system_rule
from multibot_rewrite.rules.system.frame_ids import frames_in, trees_of
from multibot_rewrite.rules.system.instead import is_needed, meant
from multibot_rewrite.rules.system.likes import nodes_of_each
from multibot_rewrite.rules.system.localized import map_not_joined
from multibot_rewrite.rules.system.names import server_names_miss, topic_names_miss
from multibot_rewrite.rules.system.tf_pieces import is_of_description, tf_tree_in_pieces
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.system.index import TF, Index, ends_of, once
from multibot_rewrite.system.records import (
    ACTION,
    NOWHERE,
    PUBLISHES,
    QUIET,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Lookup,
)

# The server of an action sends its status.
_STATUS = "/_action/status"
_LISTED = 8
_MISSES = (topic_names_miss, server_names_miss)


@system_rule("MG316", "nothing-known-sends", NOTE, absence=True)
def nothing_known_sends(seen: Index) -> Iterator[Finding]:
    """Report all names of a robot as one, without those that others have under another name."""
    left = [it for it in open_ends(seen) if not meant(seen, it)]
    missed = {found.names[0] for it in _MISSES if left and it.check for found in it.check(seen)}
    left = [it for it in left if it.name not in missed]
    by_robot = sets_by_key((seen.robot(it.node), it.name) for it in left)
    for robot, names in by_robot.items():
        # That another robot has it from a node of the same system is not for a driver outside of it.
        elsewhere: dict[str, str] = {}
        for name in sorted(names) if robot else ():
            given = _names_without_robot(seen).get(seen.plain(name), ())
            if other := next((it for it in given if _is_of_like_robot(seen, it, robot)), ""):
                elsewhere[name] = other
        if lacked := tuple(elsewhere):
            others = shorten(elsewhere.values(), _LISTED)
            yield nothing_known_sends.finding(
                f"no node sends {shorten(lacked, _LISTED)}, and one sends {others}",
                "start what sends it for the other robot", level=ERROR, robot=robot, names=lacked,
            )  # fmt: skip
        if rest := tuple(it for it in sorted(names) if it not in elsewhere):
            hint = "unless a driver of the robot does, add a node or node set that does"
            message = f"no known node sends {shorten(rest, _LISTED)}"
            yield nothing_known_sends.finding(message, hint, robot=robot, names=rest)


def _is_of_like_robot(seen: Index, name: str, robot: str) -> bool:
    """Return whether a name is of another robot that is alike except for the name's sender."""
    other, nodes = seen.robot(name), nodes_of_each(seen)
    theirs, own = _frames(seen).get(other, {}), _frames(seen).get(robot, {})
    both = theirs.keys() & own.keys()
    senders = {seen.plain(it.node) for it in ends_of(seen, name) if it.role in (PUBLISHES, SERVES)}
    more = nodes.get(other, {}).keys() - nodes.get(robot, {}).keys()
    is_alike = more <= senders and all(theirs[it] == own[it] for it in both)
    return other not in ("", robot) and is_alike


@once
def _frames(seen: Index) -> Mapping[str, Mapping[str, Set[str]]]:
    """Return the frames that each node of each robot sends, without the robot's name."""
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for it in seen.sent:
        found[seen.robot(it.node)][seen.plain(it.node)].add(seen.plain_frame(it.child))
    return found


@once
def _names_without_robot(seen: Index) -> Mapping[str, Sequence[str]]:
    """Return the names that are sent or served by their name without a robot's, the last one first."""
    return lists_by_key(
        (seen.plain(name), name)
        for (_, name), ends in reversed([*seen.by_name.items()])
        if ends.publishers or ends.servers
    )


def is_for_driver(seen: Index, it: Finding) -> bool:
    """Return whether the driver of a real robot may mend it.

    It may place the link at which the tree is in pieces, which no other node's parameters name, and
    send what a localizer waits for and a usual frame of the robot."""
    if it.code == map_not_joined.code:
        # With another name, a frame below the map is the wrong one.
        return len(it.names) == 1
    if it.code == frame_not_sent.code:
        return seen.plain_frame(it.names[0]) in USUAL_FRAMES
    edges = (one for one in seen.system.edges if not is_of_description(seen, one))
    named = {frame for edge in edges for frame in (edge.parent, edge.child)}
    return it.code == tf_tree_in_pieces.code and not (it.node or named >= {*it.names})


def no_longer_sent(end: End) -> Finding:
    """Return the finding about one end that nothing sends any more."""
    does, gives = ("subscribes to", "publishes") if end.kind == TOPIC else ("calls", "serves")
    message = f"{does} {end.name}, which no node {gives} after the rewrite"
    return nothing_known_sends.finding(
        message,
        "remap one of the two ends to the name of the other",
        level=ERROR,
        node=end.node,
        names=(end.name,),
        **last_place([end]),
    )


def open_ends(seen: Index) -> list[End]:
    """Return the ends that nodes surely need and nothing gives; a served action sends its status."""
    served = {
        f"{it.name}{_STATUS}" for it in seen.by_name.values() if it.kind == ACTION and it.servers
    }
    return [
        end
        for (kind, name), ends in seen.by_name.items()
        if not (ends.publishers or ends.servers or (kind == TOPIC and name in served))
        for end in (*ends.subscribers, *ends.clients)
        if is_needed(end)
    ]


@system_rule("MG413", "frame-not-sent", WARNING, absence=True)
def frame_not_sent(seen: Index) -> Iterator[Finding]:
    """Report each unsent frame once a robot, with its readers; unusual names may be a driver's."""
    readers: dict[tuple[str, str, str], dict[str, Lookup]] = {}
    robots = dict.fromkeys(seen.robot(it.node) for it in seen.system.lookups)
    sent = {name: [it for tree in trees_of(seen, name) for it in tree.edges] for name in robots}
    frames = {name: frozenset(frames_in(edges)) for name, edges in sent.items()}
    for it in seen.system.lookups:
        robot = seen.robot(it.node)
        if it.frame in frames[robot] and not it.parent:
            continue
        readers.setdefault((robot, it.parent, it.frame), {}).setdefault(it.node, it)
    for (robot, *_), nodes in readers.items():
        it, *others = nodes.values()
        found = (
            _virtual_joint_finding(seen, it, sent[robot])
            if it.parent
            else _usual_frame_finding(seen, it, sent[robot])
        )
        if found:
            also = f"; the same for {', '.join(other.node for other in others)}" if others else ""
            yield found._replace(message=f"{found.message}{also}")


def _usual_frame_finding(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    plain = seen.plain_frame(it.frame)
    bare = it.frame.rpartition("/")[2]
    # Without a robot's name before it, it is sent.
    usual = plain in USUAL_FRAMES or (bare in USUAL_FRAMES and bare in frames_in(edges))
    sender = _sent_transform(seen, it.node, edges) if usual else None
    # One that hears no transforms writes the frame into messages, or into what it sends.
    hears = any(end.type == TF and end.role == SUBSCRIBES for end in seen.by_node.get(it.node, ()))
    if sender is None and usual and edges and not seen.in_doubt and hears:
        message = f"reads frame {it.frame}, but no known node sends it"
        return _lookup_finding(seen, it, message, "name the node or node set that sends it", NOTE)
    if sender is None:
        return _unknown_frame_finding(seen, it, edges)
    place = f" ({sender.place})" if sender.place != NOWHERE else ""
    who = next((it for it in sender.publishers if not seen.publishes_description(it)), "a node")
    sends = f"{who} sends {sender.parent} -> {sender.child}{place}"
    hint = f"{sends}; use a frame that is sent, or name the node that does"
    # A map often comes from a node that is started apart.
    level = NOTE if plain == "map" else WARNING
    return _lookup_finding(
        seen, it, f"reads frame {it.frame}, but no known node sends it", hint, level
    )


def _unknown_frame_finding(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    """Return a finding for an unknown frame: misspelled, or not sent in a running system; or None."""
    near = nearest(it.frame, sorted(frames_in(edges)), MISTYPED)
    if not near and (seen.system.environment.settled != QUIET or not edges):
        return None
    hint = f"did you mean {near}?" if near else "send it, or use a frame that is sent"
    return _lookup_finding(seen, it, f"reads frame {it.frame}, but nothing sends it", hint, WARNING)


def _sent_transform(seen: Index, node: str, edges: Sequence[Edge]) -> Edge | None:
    """Return a transform that a node sends by its file, preferably one of the robot of ``node``."""
    # Of all that send on one topic nobody can tell them apart: a description has no odometry.
    own = [
        it
        for it in edges
        if not is_of_description(seen, it)
        or (len(it.publishers) > 1 and seen.plain_frame(it.parent) in SENT_FRAMES)
    ]
    placed = [it for it in own if it.place != NOWHERE]
    found, robot = placed if placed or seen.in_doubt else own, seen.robot(node)
    return min(found, key=lambda it: robot not in map(seen.robot, it.publishers), default=None)


def _virtual_joint_finding(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    above = {edge.child: edge.parent for edge in edges}
    if it.frame in above and it.parent in {*above, *above.values()}:
        return None
    if it.frame in above:
        # What it is looked up from is nowhere.
        root = root_of(it.frame, above)
        message = f"reads {it.parent} -> {it.frame}, and nothing sends {it.parent}"
        hint = f"start what sends {it.parent} -> {root}: localization, or odometry"
        return _lookup_finding(seen, it, f"{message}: the tree begins with {root}", hint, WARNING)
    frames = frames_in(edges)
    if near := "" if it.frame in frames else nearest(it.frame, sorted(frames), MISTYPED):
        message = f"reads {it.parent} -> {it.frame}, and nothing sends {it.frame}"
        return _lookup_finding(seen, it, message, f"did you mean {near}?", WARNING)
    message = (
        f"has the transform {it.parent} -> {it.frame} as its state, but no known node sends it"
    )
    hint = "name the node that sends it, or make the virtual joint fixed"
    return _lookup_finding(seen, it, message, hint, NOTE)


def _lookup_finding(seen: Index, it: Lookup, message: str, hint: str, level: str) -> Finding:
    return frame_not_sent.finding(
        message, hint, level=level,
        robot=seen.robot(it.node), node=it.node, names=(it.frame,), **last_place([it]),
    )  # fmt: skip


# What is missing where the driver of a real robot, which no file names, may send it.
FOR_DRIVERS = (tf_tree_in_pieces.code, map_not_joined.code, frame_not_sent.code)
