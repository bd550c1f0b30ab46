# SPDX-License-Identifier: Apache-2.0
"""Rules about transforms: one parent for each frame, one tree for each robot, the right tf topic."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence, Set

from multibot_rewrite.base.chains import chain_ends
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import found_by_plan
from multibot_rewrite.rules.pair.causes import Cause, caused, plugin_of, tf_rule
from multibot_rewrite.rules.pair.tf_causes import why_disconnected
from multibot_rewrite.rules.pair.tf_trees import TfTree, tf_trees
from multibot_rewrite.rules.system.tf_pieces import in_pieces, tf_tree_in_pieces
from multibot_rewrite.rules.system.tf_topics import tf_on_two_topics
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import PUBLISHES, Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic


@found_by_plan(tf_tree_in_pieces, nodes=False)
def disconnected_tf_tree(plan: Index, seen: Index) -> Iterator[Finding]:
    """On the robot's own tf topic."""
    for tree in tf_trees(plan, seen):
        # A chain may go through frames that are nobody's, as a relay names them.
        above = {edge.child: edge.parent for edge in tree.edges}
        roots_above = chain_ends(above)
        roots_of: dict[str, set[str]] = defaultdict(set)
        # Of a frame with two parents, which is another finding, one counts.
        for edge in (it for it in tree.edges if above[it.child] == it.parent):
            for robot in _robots_at_home(plan, tree, edge):
                roots_of[robot].add(roots_above.get(edge.parent, edge.parent))
        for robot, found in roots_of.items():
            roots = sorted(found - {""})
            if len(roots) > 1:
                yield _disconnected(plan, seen, plan.declared[robot], roots)


def _robots_at_home(plan: Index, tree: TfTree, edge: Edge) -> Set[str]:
    return {_robot_at_home(plan, tree, frame) for frame in (edge.child, edge.parent)} - {""}


def _robot_at_home(plan: Index, tree: TfTree, frame: str) -> str:
    """The robot whose layout puts this frame on this topic, or an empty string."""
    if len(tree.home) == 1:
        return tree.home[0] if frame in plan.frames_of[tree.home[0]] else ""
    robot = plan.of_frames.exact.get(frame, "")
    return robot if robot and tree_topic(plan.declared[robot].tf_topic) == tree.topic else ""


def _disconnected(plan: Index, seen: Index, robot: Robot, roots: Sequence[str]) -> Finding:
    message = in_pieces(robot.name, tree_topic(robot.tf_topic), roots)
    cause = why_disconnected(plan, seen, robot, roots)
    return tf_tree_in_pieces.finding(
        message, **cause._asdict(), robot=robot.name, names=tuple(roots)
    )


@found_by_plan(tf_on_two_topics, nodes=False)
def wrong_tf_topic(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding for a robot and topic."""
    children = {tree.topic: {edge.child for edge in tree.edges} for tree in tf_trees(plan, seen)}
    # A row of a bridge for another topic than the robot's tf says that this is meant.
    elsewhere = {it.name for it in plan.system.topics if PUBLISHES in it.bridge}
    for tree in (it for it in tf_trees(plan, seen) if it.home or it.topic not in elsewhere):
        misplaced: dict[str, list[Edge]] = defaultdict(list)
        for edge in tree.edges:
            robot = _sending_robot(plan, tree, edge.child)
            if robot and tree_topic(plan.declared[robot].tf_topic) != tree.topic:
                misplaced[robot].append(edge)
        for robot, edges in misplaced.items():
            home = tree_topic(plan.declared[robot].tf_topic)
            # A copy that a relay or another node makes, for RViz for example: the robot is as planned.
            copied = all(edge.child in children.get(home, ()) for edge in edges)
            if not (
                copied
                and not tree.home
                and tree.senders
                and _only_planned(plan, tree, robot, edges)
            ):
                yield _wrong_topic(plan, tree, plan.declared[robot], edges)


def _only_planned(plan: Index, tree: TfTree, robot: str, edges: Iterable[Edge]) -> bool:
    """Do only those nodes of the robot send on a topic that should by the plan?"""
    topics = {edge.topic for edge in edges}
    planned = {
        node for node, kind, role, name in plan.by_key if name in topics and role == PUBLISHES
    }
    return planned.issuperset(tree.senders.get(robot, ()))


def _wrong_topic(plan: Index, tree: TfTree, robot: Robot, edges: Sequence[Edge]) -> Finding:
    frames = tuple(dict.fromkeys(edge.child for edge in edges))
    message = (
        f"frame {frames[0]} of {robot.name} is on {edges[0].topic}, expected on {robot.tf_topic}"
    )
    if len(frames) > 1:
        message += f"; the same for {shorten(frames[1:])}"
    cause = _why_wrong_topic(plan, tree, robot, edges)
    return tf_on_two_topics.finding(message, **cause._asdict(), robot=robot.name, names=frames)


def _sending_robot(plan: Index, tree: TfTree, frame: str) -> str:
    """The robot that sends a frame of its own: by the frame's name, or as the only publisher."""
    robot = plan.of_frames.exact.get(frame, "")
    if robot or len(tree.robots) != 1:
        return robot
    only = tree.robots[0]
    return only if frame in plan.declared[only].frames else ""


def _why_wrong_topic(plan: Index, tree: TfTree, robot: Robot, edges: Iterable[Edge]) -> Cause:
    every = [node for nodes in tree.senders.values() for node in nodes]
    senders = tree.senders.get(robot.name) or every
    who = shorten(senders) or "its publisher"
    places = [place for _, place in (plugin_of(plan, node) for node in senders) if place]
    see = f", see {shorten(places)}" if places else ""
    rule = tf_rule(plan, robot, "tf_static" if all(edge.static for edge in edges) else "tf")
    hint = f"the remap rule {rule} is missing for {who}{see}"
    if robot.tf_topic == "/tf":
        hint = f"the layout has one /tf for all robots: remove the rule /tf:=... from {who}{see}"
    return caused(hint, next(iter(places), ""))
