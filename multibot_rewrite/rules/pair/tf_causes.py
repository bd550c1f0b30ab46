# SPDX-License-Identifier: Apache-2.0
"""Why a tf tree is in pieces: a name on one side, a node that does not run, the wrong parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.pair.causes import Cause, caused
from multibot_rewrite.rules.pair.name_variants import name_variants
from multibot_rewrite.rules.pair.silent_topics import silent_topics
from multibot_rewrite.rules.pair.tf_senders import (
    foreign,
    sender_of,
    sent_by_robot,
    where_set,
)
from multibot_rewrite.rules.pair.tf_trees import TfTree, tf_trees
from multibot_rewrite.rules.system.tf_pieces import loose_odometry, no_odometry
from multibot_rewrite.system.index import Index, Sent, ends_of
from multibot_rewrite.system.records import PUBLISHES, Edge, Robot
from multibot_rewrite.system.tf_copies import tree_topic

JOINT_STATES, TF = "sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage"
_BRIDGE = "a ros_gz_bridge has to bridge: is it started?"


def why_disconnected(plan: Index, seen: Index, robot: Robot, roots: Sequence[str]) -> Cause:
    """The node that sends a frame under another name, or does not send what it should."""
    edges = [edge for tree in _trees(plan, seen, robot) for edge in tree.edges]
    unsent = [it for it in sent_by_robot(plan, robot) if not _is_sent(it, edges)]
    bridged = _bridged(plan, seen, robot)
    causes = (
        _two_names(plan, robot, roots, edges),
        _misspelled(plan, robot, roots, edges),
        *(_not_sent(plan, seen, robot, it) for it in unsent),
        *(_silent_bridge(plan, seen, robot, type_) for type_ in (TF, JOINT_STATES)),
        _silent(plan, seen, robot, TF),
        None if bridged else _no_odometry(seen, robot, roots),
        _silent(plan, seen, robot, JOINT_STATES),
        bridged,
    )
    general = "a transform between them is missing: joint states of a moving joint, odometry or"
    return next(filter(None, causes), Cause(f"{general} localization"))


def _trees(plan: Index, seen: Index, robot: Robot) -> Iterator[TfTree]:
    return (tree for tree in tf_trees(plan, seen) if tree.topic == tree_topic(robot.tf_topic))


def _is_sent(planned: Sent, edges: Sequence[Edge]) -> bool:
    return any((it.parent, it.child) == planned[1:] for it in edges)


def _two_names(
    plan: Index,
    robot: Robot,
    roots: Sequence[str],
    edges: Sequence[Edge],
) -> Cause | None:
    """A root that is in the tree under another name, with the robot's or without."""
    names = {*roots, *(edge.child for edge in edges)}
    for root in roots:
        plain = plan.of_frames.without_robot(root, robot.name)
        variants = name_variants(plain, root, plan.of_frames.tag(robot.name))
        other = next((name for name in variants if name in names), "")
        if other:
            right, wrong = (root, other) if root in robot.frames else (other, root)
            return _wrongly_named(plan, robot, right, wrong)
    return None


def _misspelled(
    plan: Index, robot: Robot, roots: Sequence[str], edges: Sequence[Edge]
) -> Cause | None:
    """A root that is called nearly as a frame of the robot is, the robot's name apart."""
    frames = (*robot.frames, *robot.other_frames)
    known = {plan.of_frames.without_robot(it, robot.name): it for it in sorted(frames)}
    for edge in (it for it in edges if it.parent in roots and it.parent not in frames):
        plain = plan.of_frames.without_robot(edge.parent, robot.name)
        if near := nearest(plain, known, MISTYPED):
            sent = f"{edge.child} is sent below {edge.parent}, but nothing sends that"
            return Cause(f"{sent}: did you mean {known[near]}?")
    return None


def _wrongly_named(plan: Index, robot: Robot, right: str, wrong: str) -> Cause:
    names = f"{wrong} and {right} are one frame with two names"
    node = sender_of(plan, robot, right)
    if not node:
        return Cause(f"{names}, the second is the planned one")
    place = where_set(plan, node)
    see = f", see {place}" if place else ""
    return caused(f"{names}: by the plan {node} sends the second, {right}{see}", place)


def _not_sent(plan: Index, seen: Index, robot: Robot, planned: Sent) -> Cause:
    place = where_set(plan, planned.node)
    see = f" (see {place})" if place else ""
    if planned.node not in seen.nodes:
        return caused(f"{planned.node}, which sends {planned}, does not run{see}", place)
    whose = next(_whose(plan, seen, robot, planned), "")
    which = f"it has the parameters of {whose}" if whose else "has it those of another robot?"
    return caused(
        f"by the plan and its parameters{see} {planned.node} sends {planned}, and does not: {which}",
        place,
    )


def _whose(plan: Index, seen: Index, robot: Robot, planned: Sent) -> Iterator[str]:
    """The robots of whom this transform is, and is sent for this one."""
    plain = _plain(plan, planned.parent, planned.child, robot.name)
    for other, edge in foreign(plan, seen, robot):
        if _plain(plan, edge.parent, edge.child, other) == plain:
            yield other


def _plain(plan: Index, parent: str, child: str, robot: str) -> tuple[str, ...]:
    return tuple(plan.of_frames.without_robot(it, robot) for it in (parent, child))


def _no_odometry(seen: Index, robot: Robot, roots: Sequence[str]) -> Cause | None:
    """Two roots, of which one is that of an odometry frame that nothing is sent below."""
    for odom, root in loose_odometry(seen) if len(roots) == 2 else ():
        if root in roots and seen.frame_robot(odom) in ("", robot.name):
            (other,) = {*roots} - {root}
            return Cause(no_odometry(seen, robot.name, odom, other))
    return None


def _bridged(plan: Index, seen: Index, robot: Robot) -> Cause | None:
    """The odometry of a simulated robot, which a bridge carries beside the transforms of others."""
    carried = [it for it in plan.system.topics if it.bridge and it.name == robot.tf_topic]
    ends = ends_of(seen, robot.tf_topic) if carried else ()
    bridges = sorted({it.node for it in ends if it.role == PUBLISHES and "bridge" in it.node})
    if not bridges:
        return None
    return Cause(
        f"the simulator's odometry comes over {shorten(bridges)}: has its file a row for the tf of"
        f" {robot.name}, and is its plugin loaded? Else joint states of a moving joint are missing"
    )


def _silent_bridge(plan: Index, seen: Index, robot: Robot, type_: str) -> Cause | None:
    silent = silent_topics(plan, seen, robot, type_)
    topics = {it.name for it in plan.system.topics if it.bridge} & {min(silent, default="")}
    return next((Cause(f"nothing publishes {it}, which {_BRIDGE}") for it in topics), None)


def _silent(plan: Index, seen: Index, robot: Robot, type_: str) -> Cause | None:
    silent = silent_topics(plan, seen, robot, type_)
    source = "joint_state_publisher, joint_state_broadcaster or the bridge"
    why = f"nothing publishes {min(silent, default='')}: is {source} started for {robot.name}?"
    return Cause(why) if silent else None
