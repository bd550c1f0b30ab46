# SPDX-License-Identifier: Apache-2.0
"""The tf trees of a snapshot: the transforms on a tf topic and its tf_static, and their senders."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.chains import chain_ends
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.records import Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic


class TfTree(NamedTuple):
    """The transforms of a tf topic and its tf_static; ``topic`` is the tf topic.

    ``senders`` are all nodes that publish there, by their robot, "" for none; a transform does not
    say which of them sent it. ``home`` are the robots whose tf topic this is by the layout,
    ``robots`` those that publish here, or ``home`` where no publisher is known.
    """

    topic: str
    edges: tuple[Edge, ...]
    senders: Mapping[str, tuple[str, ...]]
    home: tuple[str, ...]
    robots: tuple[str, ...]


@once
def tf_trees(plan: Index, seen: Index) -> Sequence[TfTree]:
    """Those with transforms."""
    home: dict[str, list[str]] = defaultdict(list)
    for robot in plan.system.robots:
        home[tree_topic(robot.tf_topic)].append(robot.name)
    there = (it for it in seen.trees if it.edges)
    return [_tree(plan, it, tuple(home.get(it.topic, ()))) for it in there]


def _tree(plan: Index, tree: Tree, home: tuple[str, ...]) -> TfTree:
    senders: dict[str, tuple[str, ...]] = defaultdict(tuple)
    for node in sorted(tree.senders):
        senders[plan.robot(node)] += (node,)
    robots = tuple(filter(None, senders)) if senders else home
    return TfTree(tree.topic, tree.edges, senders, home, robots)


def roots_by_robot(plan: Index, seen: Index) -> Iterator[tuple[Robot, Sequence[str]]]:
    """The robots whose planned frames have several roots on the tf topic of the robot, with these."""
    for tree in tf_trees(plan, seen):
        # A chain may go through frames that are nobody's, as a relay names them.
        above = {edge.child: edge.parent for edge in tree.edges}
        roots_above = chain_ends(above)
        roots_of: dict[str, set[str]] = defaultdict(set)
        # A frame with two parents is a finding of its own.
        is_one_each = all(above[it.child] == it.parent for it in tree.edges)
        for edge in tree.edges if is_one_each else ():
            for robot in _robots_at_home(plan, tree, edge):
                roots_of[robot].add(roots_above.get(edge.parent, edge.parent))
        for robot, found in roots_of.items():
            roots = sorted(found - {""})
            if len(roots) > 1:
                yield plan.declared[robot], roots


def _robots_at_home(plan: Index, tree: TfTree, edge: Edge) -> Set[str]:
    return {_robot_at_home(plan, tree, frame) for frame in (edge.child, edge.parent)} - {""}


def _robot_at_home(plan: Index, tree: TfTree, frame: str) -> str:
    """The robot whose layout puts this frame on this topic, or an empty string."""
    if len(tree.home) == 1:
        return tree.home[0] if frame in plan.frames_of[tree.home[0]] else ""
    robot = plan.of_frames.exact.get(frame, "")
    return robot if robot and tree_topic(plan.declared[robot].tf_topic) == tree.topic else ""


def frames_in(tree: TfTree) -> Iterator[str]:
    """Every frame of a tree, each once."""
    return iter(dict.fromkeys(name for edge in tree.edges for name in (edge.child, edge.parent)))


def no_odometry(odom: str, root: str) -> str:
    """The cause of a tree in pieces: nothing is sent below an odometry frame."""
    return f"no node sends {odom} -> {root}: is odometry started, are its frames the same?"


def loose_odometry(seen: Index) -> Iterator[tuple[str, str]]:
    """The odometry frames that nothing is sent below, each with the root that it hangs from."""
    for tree in seen.trees:
        above, parents = above_each(tree), {it.parent for it in tree.edges}
        loose = (it for it in above if it not in parents and seen.plain_frame(it) == "odom")
        yield from ((it, root_of(it, above)) for it in loose)


def root_of(frame: str, above: Mapping[str, str]) -> str:
    """The frame above all that are above it; in a circle any of them."""
    for _ in above:
        if frame not in above:
            return frame
        frame = above[frame]
    return frame


def above_each(tree: Tree) -> dict[str, str]:
    """By frame: its parent in a tree."""
    return {it.child: it.parent for it in tree.edges}
