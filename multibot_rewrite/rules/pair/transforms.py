"""Rules about transforms: one parent for each frame, one tree for each robot, the right tf topic."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.index import tree_topic
from multibot_rewrite.rules.pair.causes import Cause, caused, plugin_of, tf_rule
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.tf_causes import why_disconnected
from multibot_rewrite.rules.pair.tf_senders import planned_transforms, senders_there
from multibot_rewrite.rules.pair.tf_trees import TfTree
from multibot_rewrite.system.records import PUBLISHES, Edge, Robot


@graph_rule(
    "MG201",
    "two-parents",
    ERROR,
    what="A tf frame has two parents on one tf topic.",
    why="For listeners the frame jumps between two places.",
    fix="Stop one of the two publishers, or rename the frame of one.",
    bad="""\
planned: frames of robot1 on /tf: base_link/robot1
running: transform odom/robot1 -> base_link/robot1 on /tf
running: transform map -> base_link/robot1 on /tf
""",
    good="""\
planned: frames of robot1 on /tf: base_link/robot1
running: transform odom/robot1 -> base_link/robot1 on /tf
running: transform map -> odom/robot1 on /tf
""",
    line=3,
)
def two_parents(view: View) -> Iterator[Finding]:
    """Of any robot, or of none."""
    for tree in view.trees:
        parents: dict[str, set[str]] = defaultdict(set)
        for edge in tree.edges:
            parents[edge.child].add(edge.parent)
        for child, found in parents.items():
            if len(found) > 1:
                both = " and ".join(sorted(found))
                message = f"frame {child} on {tree.topic} has the parents {both}"
                robot = _robot_of_frame(view, tree, child)
                cause = _why_two_parents(view, tree, robot, child)
                yield two_parents.finding(message, cause, robot=robot, names=(child,))


def _why_two_parents(view: View, tree: TfTree, robot: str, child: str) -> str:
    """By the plan one of the two is right; the robot's own nodes are the first that may be wrong."""
    planned = [it for it in planned_transforms(view.plan) if it.child == child]
    found = senders_there(tree, robot, dict.fromkeys(it.node for it in planned))
    # Names of frames may be alike in all robots: the sender is one that is on this topic.
    there = [it for it in planned if it.node in found] or planned[:1]
    sent = {str(it): f"{it.node} sends {it}" for it in reversed(there)}
    by_plan = f"by the plan {' and '.join(reversed(sent.values()))}; " if sent else ""
    cause = f"two nodes send it, or two robots share its name; {by_plan}"
    return f"{cause}publishers of the topic: {shorten(found) or 'none any more'}"


def _senders(tree: TfTree) -> list[str]:
    return [node for nodes in tree.senders.values() for node in nodes]


def _robot_of_frame(view: View, tree: TfTree, frame: str) -> str:
    """The robot of a frame: by the frame's name, or by the topic if that is one robot's."""
    return view.frame_ownership.robot(frame) or (tree.home[0] if len(tree.home) == 1 else "")


@graph_rule(
    "MG203",
    "disconnected-tf-tree",
    ERROR,
    absence=True,
    what="The tf tree of a robot has several roots.",
    why="There is no transform from one part of the robot to the other.",
    fix="Send the transform that is missing: joint states, odometry or localization; or use the"
    " same name for the frame on both sides.",
    bad="""\
planned: frames of robot1 on /tf: base_link/robot1, camera_link/robot1, lens/robot1
running: transform odom/robot1 -> base_link/robot1 on /tf
running: transform camera_link/robot1 -> lens/robot1 on /tf_static
""",
    good="""\
planned: frames of robot1 on /tf: base_link/robot1, camera_link/robot1, lens/robot1
running: transform odom/robot1 -> base_link/robot1 on /tf
running: transform base_link/robot1 -> camera_link/robot1 on /tf_static
running: transform camera_link/robot1 -> lens/robot1 on /tf_static
""",
    line=3,
)
def disconnected_tf_tree(view: View) -> Iterator[Finding]:
    """On the robot's own tf topic."""
    for tree in view.trees:
        # A chain may go through frames that are nobody's, as a relay names them.
        above = {edge.child: edge.parent for edge in tree.edges}
        roots_of: dict[str, set[str]] = defaultdict(set)
        # Of a frame with two parents, which is another finding, one counts.
        for edge in (it for it in tree.edges if above[it.child] == it.parent):
            for robot in _robots_at_home(view, tree, edge):
                roots_of[robot].add(_root(above, edge.parent))
        for robot, found in roots_of.items():
            roots = sorted(found - {""})
            if len(roots) > 1:
                yield _disconnected(view, view.robots[robot], roots)


def _root(above: Mapping[str, str], frame: str) -> str:
    """What a frame hangs from in the end; empty for a circle, which has no root."""
    for _ in above:
        if frame not in above:
            return frame
        frame = above[frame]
    return "" if frame in above else frame


def _robots_at_home(view: View, tree: TfTree, edge: Edge) -> Set[str]:
    return {_robot_at_home(view, tree, frame) for frame in (edge.child, edge.parent)} - {""}


def _robot_at_home(view: View, tree: TfTree, frame: str) -> str:
    """The robot whose layout puts this frame on this topic, or an empty string."""
    if len(tree.home) == 1:
        return tree.home[0] if frame in view.frames_of[tree.home[0]] else ""
    robot = view.frame_ownership.exact.get(frame, "")
    return robot if robot and tree_topic(view.robots[robot].tf_topic) == tree.topic else ""


def _disconnected(view: View, robot: Robot, roots: Sequence[str]) -> Finding:
    message = f"the tf tree of {robot.name} has {len(roots)} roots: {', '.join(roots)}"
    cause = why_disconnected(view, robot, roots)
    return disconnected_tf_tree.finding(
        message, **cause._asdict(), robot=robot.name, names=tuple(roots)
    )


@graph_rule(
    "MG205",
    "wrong-tf-topic",
    ERROR,
    what="A robot's frame is on a tf topic that is not the one of the layout.",
    why="Listeners on the topic of the layout get no transforms.",
    fix="Add or remove the remap rules `/tf:=tf` and `/tf_static:=tf_static` at the nodes of the"
    " hint.",
    bad="""\
planned: frames of robot1 on /robot1/tf: base_link
running: transform odom -> base_link on /tf by /robot1/driver
""",
    good="""\
planned: frames of robot1 on /robot1/tf: base_link
running: transform odom -> base_link on /robot1/tf by /robot1/driver
""",
    line=2,
)
def wrong_tf_topic(view: View) -> Iterator[Finding]:
    """One finding for a robot and topic."""
    children = {tree.topic: {edge.child for edge in tree.edges} for tree in view.trees}
    for tree in view.trees:
        misplaced: dict[str, list[Edge]] = defaultdict(list)
        for edge in tree.edges:
            robot = _sending_robot(view, tree, edge.child)
            if robot and tree_topic(view.robots[robot].tf_topic) != tree.topic:
                misplaced[robot].append(edge)
        for robot, edges in misplaced.items():
            home = tree_topic(view.robots[robot].tf_topic)
            # A copy that a relay or another node makes, for RViz for example: the robot is as planned.
            copied = all(edge.child in children.get(home, ()) for edge in edges)
            if not (copied and tree.senders and _only_planned(view, tree, robot, edges)):
                yield _wrong_topic(view, tree, view.robots[robot], edges)


def _only_planned(view: View, tree: TfTree, robot: str, edges: Iterable[Edge]) -> bool:
    """Do only those nodes of the robot send on a topic that should by the plan?"""
    topics = {edge.topic for edge in edges}
    planned = {
        node for node, kind, role, name in view.planned if name in topics and role == PUBLISHES
    }
    return planned.issuperset(tree.senders.get(robot, ()))


def _wrong_topic(view: View, tree: TfTree, robot: Robot, edges: Sequence[Edge]) -> Finding:
    frames = tuple(dict.fromkeys(edge.child for edge in edges))
    message = (
        f"frame {frames[0]} of {robot.name} is on {edges[0].topic}, expected on {robot.tf_topic}"
    )
    if len(frames) > 1:
        message += f"; so are {len(frames) - 1} more of its frames"
    cause = _why_wrong_topic(view, tree, robot, edges)
    return wrong_tf_topic.finding(message, **cause._asdict(), robot=robot.name, names=frames)


def _sending_robot(view: View, tree: TfTree, frame: str) -> str:
    """The robot that sends a frame of its own: by the frame's name, or as the only publisher."""
    robot = view.frame_ownership.exact.get(frame, "")
    if robot or len(tree.robots) != 1:
        return robot
    only = tree.robots[0]
    return only if frame in view.robots[only].frames else ""


def _why_wrong_topic(view: View, tree: TfTree, robot: Robot, edges: Iterable[Edge]) -> Cause:
    senders = tree.senders.get(robot.name) or tuple(_senders(tree))
    who = shorten(senders) or "its publisher"
    places = [place for _, place in (plugin_of(view, node) for node in senders) if place]
    see = f", see {shorten(places)}" if places else ""
    rule = tf_rule(view, robot, "tf_static" if all(edge.static for edge in edges) else "tf")
    hint = f"the remap rule {rule} is missing for {who}{see}"
    if robot.tf_topic == "/tf":
        hint = f"the layout has one /tf for all robots: remove the rule /tf:=... from {who}{see}"
    return caused(hint, next(iter(places), ""))
