# SPDX-License-Identifier: Apache-2.0
"""The transforms on a tf topic and its tf_static: whose they are by a plan, and where they begin."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.grouping import chain_ends, lists_by_key
from multibot_rewrite.base.wording import unique
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.records import OFF, PUBLISHES, Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic


@once
def homes(plan: Index) -> Mapping[str, Sequence[str]]:
    """Return by tf topic the robots that use it by the layout."""
    return lists_by_key((tree_topic(robot.tf_topic), robot.name) for robot in plan.system.robots)


def home_of(plan: Index, tree: Tree) -> Sequence[str]:
    """Return the robots whose tf topic this is by the layout."""
    return homes(plan).get(tree.topic, ())


@once
def taken_elsewhere(plan: Index) -> Set[str]:
    """Return the topics of bridge rows except robots' tf topics: they were chosen on purpose."""
    rows = {it.name for it in plan.system.topics if PUBLISHES in it.bridge}
    return rows - homes(plan).keys()


def robots_on(plan: Index, tree: Tree) -> Sequence[str]:
    """Return the robots that publish in a tree, or its topic's robots without a known publisher."""
    if not tree.senders:
        return home_of(plan, tree)
    return unique(filter(None, map(plan.robot, sorted(tree.senders))))


def roots_by_robot(plan: Index, seen: Index) -> Iterator[tuple[Robot, Sequence[str]]]:
    """Yield the robots whose planned frames have several roots on their tf topic, with the roots."""
    for tree in seen.trees:
        # A chain may go through frames that are nobody's, as a relay names them.
        above = {edge.child: edge.parent for edge in tree.edges}
        roots_above = chain_ends(above)
        roots_of: dict[str, set[str]] = defaultdict(set)
        # A frame with two parents is a finding of its own.
        is_one_each = all(above[it.child] == it.parent for it in tree.edges)
        for edge in tree.edges if is_one_each else ():
            for frame in (edge.child, edge.parent):
                robot = _robot_at_home(plan, tree, frame)
                roots_of[robot].add(roots_above.get(edge.parent, edge.parent))
        # What is planned to hang from a frame of all, and is a root.
        for it in plan.system.edges if is_one_each else ():
            hangs = it.static and it.parent in plan.system.shared_frames
            if hangs and it.child in roots_of[_robot_at_home(plan, tree, it.child)]:
                roots_of[_robot_at_home(plan, tree, it.child)].add(it.parent)
        for robot, found in roots_of.items():
            roots = sorted(found - {""})
            if robot and len(roots) > 1:
                yield plan.declared[robot], roots


def _robot_at_home(plan: Index, tree: Tree, frame: str) -> str:
    """Return the robot whose layout puts this frame on this topic, or an empty string."""
    home = home_of(plan, tree)
    if len(home) == 1:
        return home[0] if frame in plan.frames_of[home[0]] else ""
    robot = plan.of_frames.exact.get(frame, "")
    return robot if robot and tree_topic(plan.declared[robot].tf_topic) == tree.topic else ""


def frames_in(tree: Tree) -> Iterator[str]:
    """Yield every frame of a tree, each once."""
    return iter(dict.fromkeys(name for edge in tree.edges for name in (edge.child, edge.parent)))


@once
def by_child(seen: Index) -> Mapping[str, Mapping[str, Edge]]:
    """Return transforms by tf topic and child."""
    return {tree.topic: {edge.child: edge for edge in tree.edges} for tree in seen.trees}


@once
def frames_by_topic(seen: Index) -> Mapping[str, Set[str]]:
    """Return every frame by tf topic."""
    return {tree.topic: {*frames_in(tree)} for tree in seen.trees}


def no_odometry(seen: Index, robot: str, odom: str, root: str) -> str:
    """Return the cause of a tree in pieces: nothing is sent below an odometry frame, or elsewhere."""
    if other := sent_elsewhere(seen, robot, odom, root):
        return f"{other.publishers[0]} sends {odom} -> {root} on {other.topic}: bring it to tf, too"
    return f"no node sends {odom} -> {root}: is odometry started, are its frames the same?"


def sent_elsewhere(seen: Index, robot: str, odom: str, root: str) -> Edge | None:
    """Return the transform that a tree lacks where it is on another topic of the robot."""
    sent = (it for it in seen.system.edges if (it.parent, it.child) == (odom, root))
    own = (it for it in sent if it.sure != OFF and it.publishers)
    return next((it for it in own if seen.robot(it.topic) == robot), None)


def loose_odometry(seen: Index) -> Iterator[tuple[str, str]]:
    """Yield the odometry frames with nothing below them, each with its root."""
    for tree in seen.trees:
        above, parents = above_each(tree), {it.parent for it in tree.edges}
        loose = (it for it in above if it not in parents and seen.plain_frame(it) == "odom")
        yield from ((it, root_of(it, above)) for it in loose)


def root_of(frame: str, above: Mapping[str, str]) -> str:
    """Return the topmost frame above a frame; in a cycle any of it."""
    for _ in above:
        if frame not in above:
            return frame
        frame = above[frame]
    return frame


def above_each(tree: Tree) -> dict[str, str]:
    """Return by frame its parent in a tree."""
    return {it.child: it.parent for it in tree.edges}
