# SPDX-License-Identifier: Apache-2.0
"""The tf trees of a graph as rows: a frame, its depth, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.pages.states import CLASH, MISSING, OK, States
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.tf_copies import tree_topic


class FrameRow(NamedTuple):
    """A frame; ``parent`` is the index of its parent's row, -1 for none. ``faults`` are in words.

    The children of a ``repeated`` frame are shown only where the frame is first.
    """

    frame: str
    parent: int
    depth: int
    robot: str
    state: str
    faults: tuple[str, ...]
    static: bool
    repeated: bool


class FrameTree(NamedTuple):
    """One tree on ``topic`` and its tf_static.

    Without ``received`` it has the frames of ``robot`` that are declared and were not received.
    """

    topic: str
    robot: str
    received: bool
    rows: tuple[FrameRow, ...]


def make_frame_trees(plan: Index, seen: Index, states: States) -> tuple[FrameTree, ...]:
    """Return the trees on each topic in the order of the robots, then the frames missing there."""
    edges = {tree.topic: tree.edges for tree in seen.trees if tree.edges}
    if not (edges or states.frames):
        return ()
    order = {robot: at for at, robot in enumerate(plan.declared)}
    found: list[FrameTree] = []
    home_topics = (tree_topic(robot.tf_topic) for robot in plan.system.robots)
    for topic in dict.fromkeys((*home_topics, *sorted(edges))):
        home = [robot for robot in plan.system.robots if tree_topic(robot.tf_topic) == topic]
        static = {(edge.parent, edge.child): edge.static for edge in edges.get(topic, ())}
        only = home[0].name if len(home) == 1 else ""
        frames = sorted({frame for edge in static for frame in edge})
        robot_of = {frame: plan.frame_robot(frame) or only for frame in frames}
        forest = _Forest(topic, static, lists_by_key(sorted(static)), robot_of)
        trees = []
        for rows in _trees(forest, states):
            first = next((row.robot for row in rows if row.robot), "")
            trees.append(FrameTree(topic, first, True, rows))
        found += sorted(trees, key=lambda tree: order.get(tree.robot, len(order)))
        for robot in home:
            missing = [frame for frame in robot.frames if frame not in forest.robots]
            faults = (_in_words(states.frames.get((topic, frame), ())) for frame in missing)
            lost = tuple(
                FrameRow(frame, -1, 0, robot.name, MISSING, words, False, False)
                for frame, words in zip(missing, faults, strict=True)
            )
            found += [FrameTree(topic, robot.name, False, lost)] if lost else []
    return tuple(found)


class _Forest(NamedTuple):
    """All transforms on one topic; ``static`` by (parent, child)."""

    topic: str
    static: Mapping[tuple[str, str], bool]
    children: Mapping[str, Sequence[str]]
    robots: Mapping[str, str]


def _trees(forest: _Forest, states: States) -> Iterator[tuple[FrameRow, ...]]:
    """Yield one tree from each root; from a root of no robot one for each robot."""
    below = {child for _, child in forest.static}
    seen: set[str] = set()
    # After the roots only frames in a loop are left.
    for root in (*sorted(set(forest.children) - below), *sorted(forest.children)):
        if root in seen:
            continue
        shared = not forest.robots[root]
        parts = lists_by_key(
            (forest.robots[it] if shared else "", it) for it in forest.children[root]
        )
        for part in parts.values():
            seen.discard(root)
            yield tuple(_rows(forest, states, root, part, seen))


def _rows(
    forest: _Forest, states: States, root: str, first: Sequence[str], seen: set[str]
) -> Iterator[FrameRow]:
    """Yield rows depth first from ``root`` through the children ``first``, without recursion."""
    waiting = [(root, "", -1, 0)]
    at = 0
    while waiting:
        frame, parent, parent_row, depth = waiting.pop()
        codes = states.frames.get((forest.topic, frame), ())
        yield FrameRow(
            frame,
            parent_row,
            depth,
            forest.robots[frame],
            CLASH if codes else OK,
            _in_words(codes),
            forest.static.get((parent, frame), False),
            repeated=frame in seen,
        )
        if frame not in seen:
            seen.add(frame)
            below = forest.children.get(frame, ()) if depth else first
            waiting += [(child, frame, at, depth + 1) for child in reversed(below)]
        at += 1


def _in_words(codes: Iterable[str]) -> tuple[str, ...]:
    return tuple(RULES[code].name.replace("-", " ") for code in codes)
