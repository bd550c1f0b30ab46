# SPDX-License-Identifier: Apache-2.0
"""Dangers of what nodes ask of tf by their parameters: a frame, or a transform, that nothing sends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import USUAL_FRAMES
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.rules.declaration import system_rule, where
from multibot_rewrite.rules.system.frame_ids import frames_in, trees_of
from multibot_rewrite.rules.system.tf_pieces import is_of_description, publishes_description
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.system.index import TF, Index
from multibot_rewrite.system.records import NOWHERE, QUIET, SUBSCRIBES, UNKNOWN_NODES, Edge, Lookup

_MAP = "map"
_ODOM = "odom"


@system_rule("MG413", "frame-not-sent", WARNING, absence=True)
def frame_not_sent(seen: Index) -> Iterator[Finding]:
    """Each frame once a robot, with all that read it; other names than the usual ones may be those of a
    driver."""
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
        found = _state(seen, it, sent[robot]) if it.parent else _read(seen, it, sent[robot])
        if found:
            also = f"; the same for {', '.join(other.node for other in others)}" if others else ""
            yield found._replace(message=f"{found.message}{also}")


def _read(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    plain = seen.plain_frame(it.frame)
    bare = it.frame.rpartition("/")[2]
    # Without a robot's name before it, it is sent.
    usual = plain in USUAL_FRAMES or (bare in USUAL_FRAMES and bare in frames_in(edges))
    sender = _sender(seen, it.node, edges) if usual else None
    if sender is None and usual and edges and not _in_doubt(seen) and _listens(seen, it.node):
        message = f"reads frame {it.frame}, but no known node sends it"
        return _finding(seen, it, message, "name the node or stack that sends it", NOTE)
    if sender is None:
        return _unknown(seen, it, edges)
    place = f" ({sender.place})" if sender.place != NOWHERE else ""
    who = next((it for it in sender.publishers if not publishes_description(seen, it)), "a node")
    sends = f"{who} sends {sender.parent} -> {sender.child}{place}"
    hint = f"{sends}; use a frame that is sent, or name the node that does"
    # A map often comes from a node that is started apart.
    level = NOTE if plain == _MAP else WARNING
    return _finding(seen, it, f"reads frame {it.frame}, but no known node sends it", hint, level)


def _unknown(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    """A frame of another name: misspelled, or in no transform of a system that runs."""
    near = nearest(it.frame, sorted(frames_in(edges)), MISTYPED)
    if not near and (seen.system.environment.settled != QUIET or not edges):
        return None
    hint = f"did you mean {near}?" if near else "send it, or use a frame that is sent"
    return _finding(seen, it, f"reads frame {it.frame}, but nothing sends it", hint, WARNING)


def _sender(seen: Index, node: str, edges: Sequence[Edge]) -> Edge | None:
    """A transform that a node sends by its file, of the robot of ``node`` if there is one. Nothing is
    known where only nodes without one send any, and others may run."""
    own = [it for it in edges if not is_of_description(seen, it) or _is_of_a_node(seen, it)]
    placed = [it for it in own if it.place != NOWHERE]
    found, robot = placed if placed or _in_doubt(seen) else own, seen.robot(node)
    return min(found, key=lambda it: robot not in map(seen.robot, it.publishers), default=None)


def _listens(seen: Index, node: str) -> bool:
    """Does it hear transforms? Another one writes the frame into messages, or into what it sends."""
    return any(it.type == TF and it.role == SUBSCRIBES for it in seen.by_node.get(node, ()))


def _in_doubt(seen: Index) -> bool:
    return any(it.code == UNKNOWN_NODES for it in seen.system.environment.caveats)


def _is_of_a_node(seen: Index, edge: Edge) -> bool:
    """Of all that send on one topic nobody can tell them apart: a description has no odometry."""
    return len(edge.publishers) > 1 and seen.plain_frame(edge.parent) in (_MAP, _ODOM)


def _state(seen: Index, it: Lookup, edges: Sequence[Edge]) -> Finding | None:
    above = {edge.child: edge.parent for edge in edges}
    if it.frame in above:
        return _not_joined(seen, it, above)
    frames = frames_in(edges)
    if near := "" if it.frame in frames else nearest(it.frame, sorted(frames), MISTYPED):
        message = f"reads {it.parent} -> {it.frame}, and nothing sends {it.frame}"
        return _finding(seen, it, message, f"did you mean {near}?", WARNING)
    message = (
        f"has the transform {it.parent} -> {it.frame} as its state, but no known node sends it"
    )
    hint = "name the node that sends it, or make the virtual joint fixed"
    return _finding(seen, it, message, hint, NOTE)


def _not_joined(seen: Index, it: Lookup, above: Mapping[str, str]) -> Finding | None:
    """The frame is there, and what it is looked up from is nowhere."""
    if it.parent in {*above, *above.values()}:
        return None
    root = root_of(it.frame, above)
    return _finding(
        seen, it, f"reads {it.parent} -> {it.frame}, and nothing sends {it.parent}: the tree begins"
        f" with {root}", f"start what sends {it.parent} -> {root}: localization, or odometry", WARNING,
    )  # fmt: skip


def _finding(seen: Index, it: Lookup, message: str, hint: str, level: str) -> Finding:
    return frame_not_sent.finding(
        message, hint, level=level,
        robot=seen.robot(it.node), node=it.node, names=(it.frame,), **where([it]),
    )  # fmt: skip
