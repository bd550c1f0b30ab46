"""The frames of a robot: who sends its odometry, and do they make one tree?"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.evidence.filling import filled, lookup
from multibot_rewrite.evidence.records import GivenNode
from multibot_rewrite.graph.transforms import Edge
from multibot_rewrite.knowledge.conditions import AND, holds, parse_condition
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.system.conventions import USUAL_FRAMES
from multibot_rewrite.system.records import Place

FRAME, TREE, READ = "frame", "tree", "read frame"


class Sender(NamedTuple):
    """A node and the transforms that it sends; ``place`` is where a file says so."""

    node: str
    edges: tuple[Edge, ...]
    place: Place | None


def tree_gaps(description: Iterable[Edge], senders: Sequence[Sender]) -> Iterator[Gap]:
    """Nodes whose transforms are in another tree than those of the first node.

    If no node sends the root of the description, a driver that is not known may: that joins the two.
    """
    whole, joints = _Trees(), list(description)
    sent = [edge for it in senders for edge in it.edges]
    for edge in (*joints, *sent):
        whole.join(edge.parent, edge.child)
    children = {edge.child for edge in (*joints, *sent)}
    for root in {edge.parent for edge in joints} - children if sent else ():
        whole.join(sent[0].parent, root)
    moving = [it for it in senders if it.edges]
    for it in moving[1:]:
        first, own = moving[0].edges[0], it.edges[0]
        if whole.root(own.child) != whole.root(first.child):
            name = f"{own.parent} -> {own.child}"
            other = f"{first.parent} -> {first.child}"
            yield Gap(TREE, name, it.node, (TREE, it.node), it.place, other, moving[0].place)


def unsent_gaps(
    description: Iterable[Edge],
    senders: Sequence[Sender],
    given: Sequence[GivenNode],
    known: Mapping[str, NodeFacts],
) -> Iterator[Gap]:
    """Usual frames that nodes read by their files, while others send transforms without them: the first
    reader of each. ``near`` is a transform that is sent.

    Nothing is said where no file has a node that sends any: a driver that nobody names may.
    """
    sent = [edge for it in senders for edge in it.edges]
    there = {frame for edge in (*description, *sent) for frame in edge[:2]}
    by_file = next((it for it in senders if it.edges and it.place), None)
    for node in given if by_file else ():
        for parameter, frame, place in _read_frames(node, known.get(node.known)):
            if frame in USUAL_FRAMES and frame not in there and by_file:
                there.add(frame)
                first = by_file.edges[0]
                near = f"{by_file.node} sends {first.parent} -> {first.child}"
                key = (READ, node.known, parameter)
                yield Gap(READ, frame, node.name, key, place, near, by_file.place)


def _read_frames(given: GivenNode, node: NodeFacts | None) -> Iterator[tuple[str, str, Place]]:
    """Parameters of frames that a node does not send itself, with what a file sets them to."""
    own = {name for it in node.sends for name in it[:2]} if node else set()
    for it in node.frames if node else ():
        found = given.values.get(it.parameter)
        if found and it.parameter not in own and isinstance(found.value, str):
            yield it.parameter, found.value.lstrip("/"), found.place


class _Trees:
    """Frames that are joined: each leads to one frame that stands for its tree."""

    def __init__(self) -> None:
        self._above: dict[str, str] = {}

    def root(self, frame: str) -> str:
        while frame in self._above:
            frame = self._above[frame]
        return frame

    def join(self, one: str, other: str) -> None:
        first, second = self.root(one), self.root(other)
        if first != second:
            self._above[second] = first


def frame_gaps(
    given: Sequence[GivenNode], known: Mapping[str, NodeFacts], sent: Iterable[str]
) -> Iterator[Gap]:
    """Frames that nodes of a robot could send, and none does. ``sent`` are those that are sent;
    ``near`` is a second node that could."""
    off: dict[str, list[tuple[GivenNode, str, Place]]] = {}
    for it in given:
        for child, parameter, switch in _switched_off(it, known.get(it.known)):
            off.setdefault(child, []).append((it, parameter, switch))
    for child in sorted(off.keys() - set(sent)):
        (first, parameter, place), *others = off[child]
        key = (FRAME, first.known, parameter)
        near, where = (others[0][0].name, others[0][2]) if others else ("", None)
        yield Gap(FRAME, child, first.name, key, place, near, where)


def _switched_off(given: GivenNode, node: NodeFacts | None) -> Iterator[tuple[str, str, Place]]:
    """Frames that a node would send, with the parameter of each and where it is switched off."""
    if node is None or not node.sends:
        return
    runs = filled(node, given)
    frames = {frame.parameter: frame.default for frame in runs.frames}
    for send in node.sends if not runs.sends else ():
        switch = _switch(send.condition, runs, given)
        if switch:
            yield frames[send.child], send.child, switch


def _switch(condition: str, runs: NodeFacts, given: GivenNode) -> Place | None:
    """Where the parameter is that alone switches it off."""
    value_of = lookup(runs, given.values)
    off = [it for it in condition.split(AND) if not holds(it, value_of)]
    parts = parse_condition(off[0]) if len(off) == 1 else ()
    found = (given.values[it.parameter] for it in parts if it.parameter in given.values)
    return next((it.place for it in found), None)
