# SPDX-License-Identifier: Apache-2.0
"""Dangers of tf trees: one that is in pieces."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cache

from multibot_rewrite.base.conventions import (
    BODY_FRAMES,
    SENT_FRAMES,
    TF_SWITCHES,
    USUAL_FRAMES,
    switch,
)
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.nearest import MISTYPED, differ_in_numbers, nearest
from multibot_rewrite.base.wording import only, unique
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import to_set
from multibot_rewrite.rules.system.planned_frames import misnamed
from multibot_rewrite.rules.system.tf_trees import (
    above_each,
    loose_odometry,
    no_odometry,
    root_of,
    roots_by_robot,
    sent_elsewhere,
    why_disconnected,
)
from multibot_rewrite.system.index import Index, Tree, robots_of
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import NOWHERE, OFF, Edge
from multibot_rewrite.system.tf_copies import tree_topic
from multibot_rewrite.system.words import START_POSE, last_word

# So many pairs of frames of a robot are compared.
_COMPARED = 20_000


@system_rule("MG406", "tf-tree-in-pieces", ERROR, absence=True)
def tf_tree_in_pieces(seen: Index) -> Iterator[Finding]:
    """Report trees in pieces by the frames of a plan, else by the usual ones (REP 105)."""
    plan, told = seen.expected, set()
    others = misnamed(plan, seen) if plan else ()
    for robot, roots in roots_by_robot(plan, seen) if plan else ():
        # Of frames under other names, or on another topic, that is the finding.
        if plan and robot.name not in others:
            told.add(robot.name)
            message = in_pieces(robot.name, tree_topic(robot.tf_topic), roots)
            cause = why_disconnected(plan, seen, robot, roots)._asdict()
            yield tf_tree_in_pieces.finding(message, **cause, robot=robot.name, names=tuple(roots))
    yield from (it for it in _by_usual_names(seen) if it.robot not in told)


def _by_usual_names(seen: Index) -> Iterator[Finding]:
    """Report trees in pieces by usual names, unless an unknown node may join the pieces."""
    yield from forbidden_transforms(seen)
    if seen.in_doubt:
        for tree in seen.trees:
            yield from _senders_apart(seen, tree)
        return
    yield from _by_frames(seen)


def _by_frames(seen: Index) -> Iterator[Finding]:
    """Report misspelt frames, and odometry that nothing joins with the base."""
    yield from _misspelled(seen)
    for tree in seen.trees:
        yield from _odometry_apart(seen, tree)


def _odometry_apart(seen: Index, tree: Tree) -> Iterator[Finding]:
    """Yield the odometry frames of a tree that are not connected with the base of their robot."""
    above = above_each(tree)
    if len({(edge.child, edge.parent) for edge in tree.edges}) > len(above):
        # A frame with two parents is a finding of its own.
        return
    frames = unique(it for edge in tree.edges for it in (edge.parent, edge.child))
    plain = {it: seen.plain_frame(it) for it in frames}
    bases: dict[str, list[str]] = defaultdict(list)
    for it in (it for it in frames if plain[it] in BODY_FRAMES):
        bases[seen.frame_robot(it)].append(it)
    # What only has fixed frames below it, as those of an autopilot, is no odometry.
    moved = {frame for it in tree.edges for frame in (it.child, "" if it.static else it.parent)}
    for odom in (it for it in frames if plain[it] == "odom" and it in moved):
        robot = seen.frame_robot(odom)
        own = bases[robot]
        roots = {root_of(it, above) for it in own}
        # In a circle there is no root.
        if not own or root_of(odom, above) in {*roots, *above}:
            continue
        found = next(iter(roots))
        robot = robot or only(robots_of(seen, tree.senders))
        message = in_pieces(robot, tree.topic, sorted({root_of(odom, above), found}))
        cause = no_odometry(seen, robot, odom, found)
        yield tf_tree_in_pieces.finding(message, cause, robot=robot, names=(odom, own[0], found))


def _misspelled(seen: Index) -> Iterator[Finding]:
    """Yield misspelt frames: a parent nearly a sent frame, or a leaf nearly a root."""
    for tree in seen.trees:
        children, parents = ({getattr(it, end) for it in tree.edges} for end in ("child", "parent"))
        near_sent, near_root = _near_frames(seen, children), _near_frames(seen, parents - children)
        above = above_each(tree)
        for it in tree.edges:
            usual = seen.plain_frame(it.parent) in (*USUAL_FRAMES, *SENT_FRAMES)
            bare = it.parent not in children and not usual
            near = near_sent(it.parent, it.child) if bare else ""
            if near:
                why = f"{it.child} is sent below {it.parent}, and nothing sends {it.parent}"
                yield _misspelt_frame(seen, tree, it, near, (it.parent, root_of(near, above)), why)
            leaf = it.child not in parents and not is_of_description(seen, it)
            near = near_root(it.child, it.parent) if leaf else ""
            if near:
                why = f"{it.child} is sent below {it.parent}, and has nothing below it"
                yield _misspelt_frame(seen, tree, it, near, (root_of(it.child, above), near), why)


def _near_frames(seen: Index, frames: Collection[str]) -> Callable[[str, str], str]:
    """Return a function for the frame, of the robot's and of nobody's, with nearly a name; or ""."""
    own = sets_by_key((seen.frame_robot(it), it) for it in frames)
    left: dict[str, int] = defaultdict(lambda: _COMPARED)

    @cache
    def nearest_of(frame: str, but: str = "") -> str:
        robot = seen.frame_robot(frame)
        known = (own[robot] | own[""] if robot else {*frames}) - {but}
        left[robot] -= len(known)
        return _near_frame(frame, known) if left[robot] > 0 else ""

    def near_frame(frame: str, but: str) -> str:
        found = nearest_of(frame)
        return nearest_of(frame, but) if found == but else found

    return near_frame


def _near_frame(name: str, others: Collection[str]) -> str:
    """Return the frame with nearly this name; names that differ in numbers alone are two things."""
    near = nearest(name, sorted(others), MISTYPED)
    slip = near and near not in name and name not in near and not differ_in_numbers(name, near)
    return near if slip and nearest(*_differing_words(name, near), MISTYPED) else ""


def _differing_words(name: str, other: str) -> tuple[str, list[str]]:
    """Return (a name, [the other]) without the words that both begin with, and end with."""
    one, two = (re.split(r"[/_]", it) for it in (name, other))
    while one and two and one[0] == two[0]:
        one, two = one[1:], two[1:]
    while one and two and one[-1] == two[-1]:
        one, two = one[:-1], two[:-1]
    return "_".join(one), ["_".join(two)]


def _misspelt_frame(
    seen: Index, tree: Tree, it: Edge, near: str, roots: Sequence[str], why: str
) -> Finding:
    robot = seen.frame_robot(it.child) or only(robots_of(seen, tree.senders))
    message = f"{in_pieces(robot, tree.topic, sorted(roots))}: {why}"
    names = (it.child, it.parent)
    return tf_tree_in_pieces.finding(message, f"did you mean {near}?", robot=robot, names=names)


def in_pieces(robot: str, topic: str, roots: Sequence[str]) -> str:
    """Return the sentence for a tree of several roots."""
    whose = f"the tf tree of {robot}" if robot else "the tf tree"
    return f"{whose} on {topic} has {len(roots)} roots: {', '.join(roots)}"


def forbidden_transforms(seen: Index) -> Iterator[Finding]:
    """Yield transforms that no node sends, because parameters of those that could forbid it."""
    sent = {(tree.topic, edge.child) for tree in seen.trees for edge in tree.edges}
    off: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for it in (it for it in seen.system.edges if it.sure == OFF):
        off[tree_topic(it.topic), it.child].append(it)
    others = [it for tree in seen.trees for it in tree.edges if not is_of_description(seen, it)]
    beside = next((it for it in others if it.place != NOWHERE), None)
    for (topic, child), (first, *more) in off.items():
        if (topic, child) in sent:
            continue
        also = f", and so is {more[0].publishers[0]}" if more else ""
        node = first.publishers[0]
        name = switch(TF_SWITCHES, node)
        told = to_set(name, parameter_text(True), *[node] * bool(name))
        cause = f"let one node send it{': ' * bool(name)}{told.hint}"
        if beside:
            cause += f"; {beside.publishers[0]} ({beside.place}) sends {beside.child}"
        yield tf_tree_in_pieces.finding(
            f"is set not to send {first.parent} -> {child}, which no node sends{also}",
            cause + see_all((*more, first)), level=ERROR if more else WARNING,
            robot=seen.robot(node), node=node, names=(child,), settings=told.settings,
            **last_place([first]),
        )  # fmt: skip


def _senders_apart(seen: Index, tree: Tree) -> Iterator[Finding]:
    """Report nodes whose transforms are in another tree than those of the robot's first node."""
    for robot in unique(seen.robot(node) for it in tree.edges for node in it.publishers[:1]):
        edges = [it for it in tree.edges if {*map(seen.robot, it.publishers)} == {robot}]
        moving = {it.publishers: it for it in edges[::-1] if not is_of_description(seen, it)}
        if not moving:
            continue
        first, *others = [*moving.values()][::-1]
        children = {it.child for it in edges}
        roots = {it.parent for it in edges if is_of_description(seen, it)} - children
        joined = _joined_groups(
            [*((it.parent, it.child) for it in edges), *((first.parent, it) for it in roots)]
        )
        for it in others:
            if joined(it.child) != joined(first.child):
                message = (
                    f"sends {it.parent} -> {it.child}, apart from {first.parent} -> {first.child}"
                )
                cause = "use the same odometry frame in both, or add what joins them"
                yield tf_tree_in_pieces.finding(
                    f"{message} of {first.publishers[0]}", cause + see_all((first, it)), level=WARNING,
                    robot=robot, node=it.publishers[0], names=(it.child,), **last_place([it]),
                )  # fmt: skip


def is_sure(seen: Index, found: Finding, moved: bool) -> bool:
    """Return whether a tree is in pieces for certain: nothing outside the launch file may join it."""
    loose = [it for it in loose_odometry(seen) if {*found.names} & {*it}]
    own = (it for it in seen.nodes if seen.robot(it) == found.robot)
    misspelt = {(it.robot, it.names) for it in _misspelled(seen)}
    is_misspelt = (found.robot, found.names) in misspelt
    if not is_misspelt and any(last_word(seen.plain(it)) == START_POSE for it in own):
        return False
    lacking = [(odom, it) for odom, root in loose for it in found.names if it not in (odom, root)]
    if (loose and not moved) or any(sent_elsewhere(seen, found.robot, *it) for it in lacking):
        return False
    return any(it.robot == found.robot for it in (*forbidden_transforms(seen), *_by_frames(seen)))


def is_of_description(seen: Index, edge: Edge) -> bool:
    """Return whether robot_state_publisher sends a transform."""
    return any(seen.publishes_description(it) for it in edge.publishers)


def _joined_groups(pairs: Iterable[tuple[str, str]]) -> Callable[[str], str]:
    """Return a function for one frame that stands for all that a frame is joined with."""
    above: dict[str, str] = {}

    def root(frame: str) -> str:
        while frame in above:
            frame = above[frame]
        return frame

    for one, other in pairs:
        first, second = root(one), root(other)
        if first != second:
            above[second] = first
    return root
