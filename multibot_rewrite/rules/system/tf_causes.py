# SPDX-License-Identifier: Apache-2.0
"""Why planned transforms are not sent: a node that does not run, nothing to send it of, another robot's
description or parameters. A transform itself does not say who sends it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.system.causes import Cause, caused
from multibot_rewrite.rules.system.tf_trees import home_of, loose_odometry, no_odometry
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Index, Sent, ends_of, once
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic


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
    theirs, name = [*foreign(plan, seen, robot)], robot.name
    publisher = state_publisher(plan, robot) or STATE_PUBLISHER
    described = "no planned node publishes its description: is the node that does it running?"
    if is_described(plan, robot):
        described = f"has {publisher} the description of {name}, or that of another robot?"
    causes = (
        _silent(plan, seen, robot, words.JOINTS),
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
    bridged = _bridged(plan, seen, robot)
    causes = (
        _silent(plan, seen, robot, TF, bridged_alone=True),
        _silent(plan, seen, robot, words.JOINTS, bridged_alone=True),
        _silent(plan, seen, robot, TF),
        "" if bridged else _no_odometry(seen, robot, roots),
        _silent(plan, seen, robot, words.JOINTS),
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
    place = where_set(plan, planned.node)
    see = f" (see {place})" if place else ""
    if planned.node not in seen.nodes:
        return caused(f"{planned.node}, which sends {planned}, does not run{see}", place)

    def plain(parent: str, child: str, whose: str) -> tuple[str, ...]:
        return tuple(plan.of_frames.without_robot(it, whose) for it in (parent, child))

    wanted = plain(planned.parent, planned.child, robot.name)
    alike = (it for it, e in foreign(plan, seen, robot) if plain(e.parent, e.child, it) == wanted)
    whose = next(alike, "")
    which = f"it has the parameters of {whose}" if whose else "has it those of another robot?"
    return caused(
        f"by the plan and its parameters{see} {planned.node} sends {planned}, and does not: {which}",
        place,
    )


def foreign(plan: Index, seen: Index, robot: Robot) -> Iterator[tuple[str, Edge]]:
    """Yield transforms of other robots, each with its robot, that a node of this one may send: all
    on a tf topic of its own, otherwise those that several nodes send."""
    found = _named(plan, seen).get(tree_topic(robot.tf_topic), ())
    return (it for it in found if it[0] != robot.name)


@once
def _named(plan: Index, seen: Index) -> Mapping[str, Sequence[tuple[str, Edge]]]:
    """Return by topic the transforms that have a robot's name, each with that robot, on one robot's
    tf topic; on a shared one only those that several nodes send."""
    found: dict[str, list[tuple[str, Edge]]] = defaultdict(list)
    for tree in seen.trees:
        is_of_one = len(home_of(plan, tree)) == 1
        for edge in (it for it in tree.edges if is_of_one or it.several):
            if other := plan.frame_robot(edge.child):
                found[tree.topic].append((other, edge))
    return found


def _no_odometry(seen: Index, robot: Robot, roots: Sequence[str]) -> str:
    """Return a cause if one of two roots is an odometry frame without anything below it."""
    for odom, root in loose_odometry(seen) if len(roots) == 2 else ():
        if root in roots and seen.frame_robot(odom) in ("", robot.name):
            (other,) = {*roots} - {root}
            return no_odometry(seen, robot.name, odom, other)
    return ""


def _bridged(plan: Index, seen: Index, robot: Robot) -> str:
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


def _silent(plan: Index, seen: Index, robot: Robot, type_: str, bridged_alone: bool = False) -> str:
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
