"""The tf trees of a graph as rows: a frame, how deep it hangs, and what is wrong with it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.expectation import WantedRobot
from multibot_rewrite.graph.pictures.marks import CLASH, MISSING, OK, Marks
from multibot_rewrite.graph.rules.comparison import View
from multibot_rewrite.graph.rules.trees import tree_of
from multibot_rewrite.graph.snapshot import Frame

# What is written beside a frame.
WORDS = {
    "MG201": "two parents",
    "MG202": "sent by several robots",
    "MG203": "one of several roots",
    "MG204": "not in the description",
    "MG205": "wrong topic",
    "MG206": "robot's name twice",
    "MG207": "lacks the robot's name",
}


class Row(NamedTuple):
    """A frame; ``parent`` is the index of its parent's row, -1 for none. ``words`` say what is wrong.

    ``again`` tells that its children are shown where it stands first.
    """

    frame: str
    parent: int
    depth: int
    robot: str
    state: str
    words: tuple[str, ...]
    static: bool
    again: bool


class Outline(NamedTuple):
    """One tree of ``topic`` and its tf_static; without ``heard`` the frames of ``robot`` that are
    declared and were not heard."""

    topic: str
    robot: str
    heard: bool
    rows: tuple[Row, ...]


def make_outlines(view: View, marks: Marks) -> tuple[Outline, ...]:
    """Each topic's trees side by side, in the order of the robots; then what was not heard there."""
    if not view.trees:
        return ()
    order = {robot: at for at, robot in enumerate(view.robots)}
    edges = {tree.topic: tree.edges for tree in view.trees}
    found: list[Outline] = []
    for topic in dict.fromkeys((*(tree_of(r.tf) for r in view.plan.robots), *sorted(edges))):
        home = [robot for robot in view.plan.robots if tree_of(robot.tf) == topic]
        forest = _forest(view, topic, edges.get(topic, ()), home)
        there = [Outline(topic, _robot(rows), True, rows) for rows in _trees(forest, marks)]
        found += sorted(there, key=lambda one: order.get(one.robot, len(order)))
        found += _unheard(forest, home)
    return tuple(found)


def _robot(rows: Sequence[Row]) -> str:
    """Whose a tree is: the first robot's in it."""
    return next((row.robot for row in rows if row.robot), "")


class _Forest(NamedTuple):
    """All that hangs on one topic; ``static`` tells of each (parent, child)."""

    topic: str
    static: Mapping[tuple[str, str], bool]
    children: Mapping[str, Sequence[str]]
    robots: Mapping[str, str]


def _forest(view: View, topic: str, edges: Sequence[Frame], home: Sequence[WantedRobot]) -> _Forest:
    static = {(edge.parent, edge.child): edge.static for edge in edges}
    children: dict[str, list[str]] = defaultdict(list)
    for parent, child in sorted(static):
        children[parent].append(child)
    only = home[0].name if len(home) == 1 else ""
    frames = sorted({frame for edge in static for frame in edge})
    robots = {frame: view.frame_owners.of(frame) or only for frame in frames}
    return _Forest(topic, static, children, robots)


def _trees(forest: _Forest, marks: Marks) -> Iterator[tuple[Row, ...]]:
    """From each root; below one that is no robot's, each robot's part by itself."""
    below = {child for _, child in forest.static}
    seen: set[str] = set()
    # After the roots: what is left hangs in a ring.
    for root in (*sorted(set(forest.children) - below), *sorted(forest.children)):
        if root in seen:
            continue
        parts: dict[str, list[str]] = defaultdict(list)
        for child in forest.children[root]:
            parts[forest.robots[child] if not forest.robots[root] else ""].append(child)
        for part in parts.values():
            seen.discard(root)
            yield tuple(_rows(forest, marks, root, part, seen))


def _rows(
    forest: _Forest, marks: Marks, root: str, first: Sequence[str], seen: set[str]
) -> Iterator[Row]:
    """Depth first from ``root`` through these children of it, with a stack of our own: a tree may
    be deeper than Python's."""
    waiting = [(root, "", -1, 0)]
    at = 0
    while waiting:
        frame, parent, above, depth = waiting.pop()
        codes = marks.frames.get((forest.topic, frame), ())
        yield Row(
            frame,
            above,
            depth,
            forest.robots[frame],
            CLASH if codes else OK,
            tuple(WORDS.get(code, code) for code in codes),
            forest.static.get((parent, frame), False),
            again=frame in seen,
        )
        if frame not in seen:
            seen.add(frame)
            below = forest.children.get(frame, ()) if depth else first
            waiting += [(child, frame, at, depth + 1) for child in reversed(below)]
        at += 1


def _unheard(forest: _Forest, home: Iterable[WantedRobot]) -> Iterator[Outline]:
    for robot in home:
        absent = [frame for frame in robot.frames if frame not in forest.robots]
        rows = (Row(frame, -1, 0, robot.name, MISSING, (), False, False) for frame in absent)
        if absent:
            yield Outline(forest.topic, robot.name, False, tuple(rows))
