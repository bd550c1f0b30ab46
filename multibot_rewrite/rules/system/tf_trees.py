# SPDX-License-Identifier: Apache-2.0
"""The transforms on a tf topic and its tf_static: whose they are, and why planned ones are not sent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.grouping import chain_ends, lists_by_key
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import shorten, unique
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.rules.system.causes import Cause, caused
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Index, Sent, Tree, ends_of, once
from multibot_rewrite.system.records import OFF, PUBLISHES, SUBSCRIBES, TOPIC, Edge, Robot
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
    """Return the robots that publish in a tree; if no publisher is known, those of its topic."""
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


@once
def _sent_by_plain_names(seen: Index) -> Mapping[tuple[str, str, str], Sent]:
    """Return sent transforms by robot of the child, and parent and child without the robot's name."""
    plain = seen.plain_frame
    return {(seen.frame_robot(it.child), plain(it.parent), plain(it.child)): it for it in seen.sent}


def no_odometry(seen: Index, robot: str, odom: str, root: str) -> str:
    """Return the cause of a tree in pieces: nothing is sent below an odometry frame, or elsewhere."""
    if other := sent_elsewhere(seen, robot, odom, root):
        return f"{other.publishers[0]} sends {odom} -> {root} on {other.topic}: bring it to tf, too"
    plain = seen.plain_frame(odom), seen.plain_frame(root)
    for owner in ("", robot):
        if it := _sent_by_plain_names(seen).get((owner, *plain)):
            return f"{it.parent} -> {it.child} is sent: use one name for each frame"
    return f"no node sends {odom} -> {root}: is odometry started, are its frames the same?"


def sent_elsewhere(seen: Index, robot: str, odom: str, root: str) -> Edge | None:
    """Return the transform that a tree lacks where it is on another topic of the robot."""
    sent = (it for it in seen.system.edges if (it.parent, it.child) == (odom, root))
    own = (it for it in sent if it.sure != OFF and it.publishers)
    return next((it for it in own if seen.robot(it.topic) == robot), None)


def loose_odometry(seen: Index) -> Iterator[tuple[str, str]]:
    """Yield (odometry frame with nothing below it, its root)."""
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


@once
def sent_by_robot(plan: Index) -> dict[str, list[Sent]]:
    """Return by robot what its nodes send by the plan."""
    return lists_by_key((plan.robot_of.get(it.node, ""), it) for it in plan.sent)


def state_publisher(plan: Index, robot: Robot) -> str:
    """Return the robot's robot_state_publisher by the plan; empty where it has none."""
    return next((it for it in plan.own[robot.name] if STATE_PUBLISHER in it), "")


def is_described(plan: Index, robot: Robot) -> bool:
    """Return whether the plan has a node that sends the transforms of the robot's description."""
    ends = (end for node in plan.own[robot.name] for end in plan.by_node.get(node, ()))
    told = (it.name for it in ends if (it.kind, it.role) == (TOPIC, PUBLISHES))
    return bool(state_publisher(plan, robot)) or any(it.endswith(words.DESCRIPTION) for it in told)


def where_set(plan: Index, node: str) -> str:
    """Return the place that sets a node's frames: its plugin's or its parameters'; empty for none."""
    planned = plan.node.get(node)
    return str(planned.plugin) or str(planned.place) if planned else ""


def why_not_received(
    plan: Index, seen: Index, robot: Robot, frames: Sequence[str], undescribed: bool
) -> str:
    """Return why planned frames are in no transform; ``undescribed``: none of the description's is."""
    theirs, name = [*foreign_transforms(plan, seen, robot)], robot.name
    publisher = state_publisher(plan, robot) or STATE_PUBLISHER
    described = "no planned node publishes its description: is the node that does it running?"
    if is_described(plan, robot):
        described = f"has {publisher} the description of {name}, or that of another robot?"
    causes = (
        _why_silent(plan, seen, robot, words.JOINTS),
        *(
            f"{publisher} has the description of {other}, whose transforms it sends"
            for other, edge in theirs
            if undescribed and edge.static
        ),
        described if undescribed else "",
        *(
            f"by the plan {it.node} sends {it}: has it the parameters of {name}?"
            for it in sent_by_robot(plan)[robot.name]
            if not {it.parent, it.child}.isdisjoint(frames)
        ),
        *(
            f"{it.child} of {other} is sent on its tf: is a name of it wrong?"
            for other, it in theirs
        ),
        "which node sends it? is its joint in the joint states, is its plugin loaded?",
    )
    return next(filter(None, causes))


def why_disconnected(plan: Index, seen: Index, robot: Robot, roots: Sequence[str]) -> Cause:
    """Return why the frames of a robot are in several pieces, with these roots."""
    home = tree_topic(robot.tf_topic)
    edges = [edge for tree in seen.trees if tree.topic == home for edge in tree.edges]
    there = {(it.parent, it.child) for it in edges}
    unsent = [it for it in sent_by_robot(plan)[robot.name] if it[1:] not in there]
    named = _two_names(plan, robot, roots, edges) or _misspelled(plan, robot, roots, edges)
    if named or unsent:
        return named or _not_sent(plan, seen, robot, unsent[0])
    bridged = _bridge_hint(plan, seen, robot)
    causes = (
        _why_silent(plan, seen, robot, TF, bridged_alone=True),
        _why_silent(plan, seen, robot, words.JOINTS, bridged_alone=True),
        _why_silent(plan, seen, robot, TF),
        "" if bridged else _odometry_hint(seen, robot, roots),
        _why_silent(plan, seen, robot, words.JOINTS),
        bridged,
        "a transform between them is missing: joint states of a moving joint, odometry or localization",
    )
    return Cause(next(filter(None, causes)))


def _two_names(
    plan: Index, robot: Robot, roots: Sequence[str], edges: Sequence[Edge]
) -> Cause | None:
    """Return the cause if a root is in the tree twice, with the robot's name and without; or None."""
    plain = plan.of_frames.without_robot
    names = (*roots, *(edge.child for edge in edges))
    for root in roots:
        bare = plain(root, robot.name)
        other = next((it for it in names if it != root and plain(it, robot.name) == bare), "")
        if other:
            right, wrong = (root, other) if root in robot.frames else (other, root)
            said = f"{wrong} and {right} are one frame with two names"
            sent = (it.node for it in sent_by_robot(plan)[robot.name] if right in it[1:])
            node = next(sent, "") or state_publisher(plan, robot)
            if not node:
                return Cause(f"{said}, the second is the planned one")
            place = where_set(plan, node)
            see = f", see {place}" if place else ""
            return caused(f"{said}: by the plan {node} sends the second, {right}{see}", place)
    return None


def _misspelled(
    plan: Index, robot: Robot, roots: Sequence[str], edges: Sequence[Edge]
) -> Cause | None:
    """Return the cause if a root's name is nearly that of a frame of the robot; or None."""
    frames = (*robot.frames, *robot.other_frames)
    known = {plan.of_frames.without_robot(it, robot.name): it for it in sorted(frames)}
    for edge in (it for it in edges if it.parent in roots and it.parent not in frames):
        plain = plan.of_frames.without_robot(edge.parent, robot.name)
        if near := nearest(plain, known, MISTYPED):
            sent = f"{edge.child} is sent below {edge.parent}, but nothing sends that"
            return Cause(f"{sent}: did you mean {known[near]}?")
    return None


def _not_sent(plan: Index, seen: Index, robot: Robot, planned: Sent) -> Cause:
    """Return the cause why a planned transform is not sent."""
    place = where_set(plan, planned.node)
    see = f" (see {place})" if place else ""
    if planned.node not in seen.nodes:
        return caused(f"{planned.node}, which sends {planned}, does not run{see}", place)

    def plain(parent: str, child: str, whose: str) -> tuple[str, ...]:
        return tuple(plan.of_frames.without_robot(it, whose) for it in (parent, child))

    wanted = plain(planned.parent, planned.child, robot.name)
    alike = (
        it
        for it, e in foreign_transforms(plan, seen, robot)
        if plain(e.parent, e.child, it) == wanted
    )
    whose = next(alike, "")
    which = f"it has the parameters of {whose}" if whose else "has it those of another robot?"
    return caused(
        f"by the plan and its parameters{see} {planned.node} sends {planned}, and does not: {which}",
        place,
    )


def foreign_transforms(plan: Index, seen: Index, robot: Robot) -> Iterator[tuple[str, Edge]]:
    """Yield (robot, transform) of other robots that a node of this one may send."""
    found = _transforms_of_robots(plan, seen).get(tree_topic(robot.tf_topic), ())
    return (it for it in found if it[0] != robot.name)


@once
def _transforms_of_robots(plan: Index, seen: Index) -> Mapping[str, Sequence[tuple[str, Edge]]]:
    """Return by topic the transforms with a robot's name that another robot's node may send."""
    found: dict[str, list[tuple[str, Edge]]] = defaultdict(list)
    for tree in seen.trees:
        is_of_one = len(home_of(plan, tree)) == 1
        for edge in (it for it in tree.edges if is_of_one or it.several):
            if other := plan.frame_robot(edge.child):
                found[tree.topic].append((other, edge))
    return found


def _odometry_hint(seen: Index, robot: Robot, roots: Sequence[str]) -> str:
    """Return a cause if one of two roots is an odometry frame without anything below it."""
    for odom, root in loose_odometry(seen) if len(roots) == 2 else ():
        if root in roots and seen.frame_robot(odom) in ("", robot.name):
            (other,) = {*roots} - {root}
            return no_odometry(seen, robot.name, odom, other)
    return ""


def _bridge_hint(plan: Index, seen: Index, robot: Robot) -> str:
    """Return the hint about odometry of a simulated robot that comes over a bridge; empty without."""
    carried = [it for it in plan.system.topics if it.bridge and it.name == robot.tf_topic]
    ends = ends_of(seen, robot.tf_topic) if carried else ()
    bridges = sorted({it.node for it in ends if it.role == PUBLISHES and "bridge" in it.node})
    if not bridges:
        return ""
    return (
        f"the simulator's odometry comes over {shorten(bridges)}: has its file a row for the tf of"
        f" {robot.name}, and is its plugin loaded? Else joint states of a moving joint are missing"
    )


def _why_silent(
    plan: Index, seen: Index, robot: Robot, type_: str, bridged_alone: bool = False
) -> str:
    """Return why a topic is silent that the robot's nodes read, or a bridge has to publish."""
    silent = min(silent_topics(plan, seen, robot, type_), default="")
    if silent and any(it.bridge and it.name == silent for it in plan.system.topics):
        return f"nothing publishes {silent}, which a ros_gz_bridge has to bridge: is it started?"
    source = "joint_state_publisher, joint_state_broadcaster or the bridge"
    why = f"nothing publishes {silent}: is {source} started for {robot.name}?"
    return why if silent and not bridged_alone else ""


def silent_topics(plan: Index, seen: Index, robot: Robot, type_: str) -> set[str]:
    """Return the topics of a type that a robot needs by the plan and nothing publishes."""
    read = {
        end.name
        for node in plan.own[robot.name]
        for end in plan.by_node.get(node, ())
        if end.role == SUBSCRIBES and end.type == type_
    }
    bridged = {
        it.name
        for it in plan.system.topics
        if PUBLISHES in it.bridge and it.type == type_ and plan.robot(it.name) == robot.name
    }
    return (read | bridged) - seen.published
