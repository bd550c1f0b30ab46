"""Rules about tf: one parent for each frame, one tree for each robot, names and topics by layout."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.graph.expectation import PlannedRobot
from multibot_rewrite.graph.rules.causes import plugin_of
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.ownership import SEPARATORS, without_tag_once
from multibot_rewrite.graph.rules.similar_names import similar
from multibot_rewrite.graph.rules.tf_trees import TfTree, frames_in, tree_topic
from multibot_rewrite.graph.snapshot import GraphFrame
from multibot_rewrite.graph.wording import shorten
from multibot_rewrite.model import ERROR, WARNING


def two_parents(view: View) -> Iterator[GraphFinding]:
    """A tf frame with two parents on one topic: listeners see it jump."""
    for tree in view.trees:
        parents: dict[str, set[str]] = defaultdict(set)
        for edge in tree.edges:
            parents[edge.child].add(edge.parent)
        for child, found in parents.items():
            if len(found) > 1:
                both = " and ".join(sorted(found))
                message = f"frame {child} on {tree.topic} has the parents {both}"
                cause = "two nodes send it, or two robots share its name; publishers of the topic: "
                cause += shorten(_senders(tree)) or "none any more"
                robot = _robot_of_frame(view, tree, child)
                yield GraphFinding("MG201", ERROR, robot, "", message, cause, (child,))


def _senders(tree: TfTree) -> list[str]:
    return [node for nodes in tree.senders.values() for node in nodes]


def _robot_of_frame(view: View, tree: TfTree, frame: str) -> str:
    """The robot of a frame: by the frame's name, or by the topic if that is one robot's."""
    return view.frame_ownership.robot(frame) or (tree.home[0] if len(tree.home) == 1 else "")


def colliding_frames(view: View) -> Iterator[GraphFinding]:
    """One frame name that two robots send on one topic: neither tree can be used."""
    for tree in view.trees:
        unnamed = _frames_without_robot(view, tree)
        shared = {frame: robots for frame, robots in unnamed.items() if len(robots) > 1}
        robots = sorted({robot for found in shared.values() for robot in found})
        if robots:
            message = f"frames {shorten(shared)} on {tree.topic} are sent by {_and(robots)}"
            cause = _why_colliding(view, tree, robots)
            yield GraphFinding("MG202", ERROR, "", "", message, cause, tuple(shared))


def _and(robots: Iterable[str]) -> str:
    return shorten(robots).replace(", ", " and ", 1)


def _why_colliding(view: View, tree: TfTree, robots: Sequence[str]) -> str:
    senders = shorten(node for robot in robots for node in tree.senders.get(robot, ()))
    first = view.robots[robots[0]]
    if _has_plain_frames(view, first):
        rules = f"{_tf_rule(first, 'tf')} and {_tf_rule(first, 'tf_static')}"
        return (
            "frames without a robot's name need a tf topic for each robot: pass the rules"
            f" {rules} to {senders}"
        )
    return f"the descriptions are not rewritten: load each robot's own description in {senders}"


def _has_plain_frames(view: View, robot: PlannedRobot) -> bool:
    """Whether the layout has the same frames for every robot; one of them may hold its name."""
    ownership = view.frame_ownership
    return any(ownership.without_robot(frame, robot.name) == frame for frame in robot.frames)


def _frames_without_robot(view: View, tree: TfTree) -> dict[str, list[str]]:
    """The frames of a tree that hold no robot's name, with the robots they may belong to.

    That is a robot that declares the frame so, or with its name while that frame is not there.
    """
    present = set(frames_in(tree))
    unnamed = {name for name in present if not view.frame_ownership.robot(name)}
    unnamed -= {*view.plan.shared_frames}
    found: dict[str, list[str]] = defaultdict(list)
    for robot in (view.robots[name] for name in tree.robots if unnamed):
        for plain, frame in _by_plain_name(view, robot).items():
            if plain in unnamed and (plain == frame or frame not in present):
                found[plain].append(robot.name)
    return found


def frames_without_robot_name(view: View) -> Iterator[GraphFinding]:
    """A frame without the robot's name, although the layout adds it."""
    for tree in view.trees:
        own: dict[str, list[str]] = defaultdict(list)
        for frame, robots in _frames_without_robot(view, tree).items():
            if len(robots) == 1 and frame not in view.robots[robots[0]].frames:
                own[robots[0]].append(frame)
        for robot, found in own.items():
            expected = _by_plain_name(view, view.robots[robot])[found[0]]
            message = f"frames {shorten(found)} on {tree.topic} do not have the name of {robot}"
            cause = f"expected {expected}: load the rewritten description in "
            cause += shorten(tree.senders.get(robot, ())) or "its robot_state_publisher"
            yield GraphFinding("MG207", ERROR, robot, "", message, cause, tuple(found))


def wrong_tf_topics(view: View) -> Iterator[GraphFinding]:
    """A robot's frames on a tf topic that is not the one of its layout."""
    children = {tree.topic: {edge.child for edge in tree.edges} for tree in view.trees}
    for tree in view.trees:
        misplaced: dict[str, list[GraphFrame]] = defaultdict(list)
        for edge in tree.edges:
            robot = _sending_robot(view, tree, edge.child)
            if robot and tree_topic(view.robots[robot].tf) != tree.topic:
                misplaced[robot].append(edge)
        for robot, edges in misplaced.items():
            home = tree_topic(view.robots[robot].tf)
            # A copy that another node makes, for RViz for example: the robot itself is as planned.
            copied = all(edge.child in children.get(home, ()) for edge in edges)
            if not (copied and tree.senders and robot not in tree.senders):
                yield _wrong_topic(view, tree, view.robots[robot], edges)


def _wrong_topic(
    view: View, tree: TfTree, robot: PlannedRobot, edges: Sequence[GraphFrame]
) -> GraphFinding:
    frames = tuple(dict.fromkeys(edge.child for edge in edges))
    message = f"frame {frames[0]} of {robot.name} is on {edges[0].topic}, expected on {robot.tf}"
    if len(frames) > 1:
        message += f"; so are {len(frames) - 1} more of its frames"
    cause = _why_wrong_topic(view, tree, robot, edges)
    return GraphFinding("MG205", ERROR, robot.name, "", message, cause, frames)


def _sending_robot(view: View, tree: TfTree, frame: str) -> str:
    """The robot that sends a frame of its own: by the frame's name, or as the only publisher."""
    robot = view.frame_ownership.exact.get(frame, "")
    if robot or len(tree.robots) != 1:
        return robot
    only = tree.robots[0]
    return only if frame in view.robots[only].frames else ""


def _why_wrong_topic(
    view: View, tree: TfTree, robot: PlannedRobot, edges: Iterable[GraphFrame]
) -> str:
    senders = tree.senders.get(robot.name) or tuple(_senders(tree))
    who = shorten(senders) or "its publisher"
    places = [place for _, place in (plugin_of(view, node) for node in senders) if place]
    see = f", see {shorten(places)}" if places else ""
    if robot.tf == "/tf":
        return f"the layout has one /tf for all robots: remove the rule /tf:=... from {who}{see}"
    rule = _tf_rule(robot, "tf_static" if all(edge.static for edge in edges) else "tf")
    return f"the remap rule {rule} is missing for {who}{see}"


def _tf_rule(robot: PlannedRobot, topic: str) -> str:
    """The remap rule for a tf topic; its target is relative in the robot's own namespace."""
    namespaced = any(node.startswith(f"/{robot.name}/") for node in robot.nodes)
    place = robot.tf.removeprefix(f"/{robot.name}/") if namespaced else robot.tf
    return f"/{topic}:={'/'.join(topic if it == 'tf' else it for it in place.split('/'))}"


def disconnected_trees(view: View) -> Iterator[GraphFinding]:
    """A robot's frames that are not one connected tree on its tf topic."""
    for tree in view.trees:
        parent_of: dict[str, dict[str, str]] = defaultdict(dict)
        children = {edge.child for edge in tree.edges}
        for edge in tree.edges:
            for robot in {_robot_at_home(view, tree, it) for it in (edge.child, edge.parent)} - {
                ""
            }:
                parent_of[robot][edge.child] = edge.parent
        for robot, parents in parent_of.items():
            roots = sorted({parent for parent in parents.values() if parent not in parents})
            if len(roots) > 1:
                yield _disconnected(view, children, view.robots[robot], roots)


def _disconnected(
    view: View, children: Set[str], robot: PlannedRobot, roots: Sequence[str]
) -> GraphFinding:
    message = f"the tf tree of {robot.name} has {len(roots)} roots: {', '.join(roots)}"
    cause = (
        "a transform between them is missing: no joint_states for a moving joint, no odometry, "
        "no localization, or a frame has another name on one side"
    )
    ownership = view.frame_ownership
    for root in roots:
        plain = ownership.without_robot(root, robot.name)
        variants = _name_variants(plain, root, ownership.tag(robot.name))
        # Under one of these names the root is in the tree.
        other = next((name for name in variants if name in children), "")
        if other:
            cause = f"{other} and {root} are one frame with two names: see the other findings"
    return GraphFinding("MG203", ERROR, robot.name, "", message, cause, tuple(roots))


def _name_variants(plain: str, frame: str, tag: str) -> Iterator[str]:
    """Wrong names of a frame: without the robot's name, and with the name added once more."""
    if plain != frame:
        yield plain
    for separator in ("/", *SEPARATORS):
        yield f"{tag}{separator}{frame}"
        yield f"{frame}{separator}{tag}"


def _robot_at_home(view: View, tree: TfTree, frame: str) -> str:
    """The robot whose layout puts this frame on this topic, or an empty string."""
    if len(tree.home) == 1:
        return tree.home[0] if frame in view.frames_of[tree.home[0]] else ""
    robot = view.frame_ownership.exact.get(frame, "")
    return robot if robot and tree_topic(view.robots[robot].tf) == tree.topic else ""


def _by_plain_name(view: View, robot: PlannedRobot) -> dict[str, str]:
    """The robot's frames by their name without the robot's."""
    if _has_plain_frames(view, robot):
        return {frame: frame for frame in robot.frames}
    return {view.frame_ownership.without_robot(frame, robot.name): frame for frame in robot.frames}


def undeclared_frames(view: View) -> Iterator[GraphFinding]:
    """Frames with a robot's name that are not in its description, or that have the name twice."""
    for tree in view.trees:
        children = {edge.child: edge for edge in tree.edges}
        doubled: dict[str, list[str]] = defaultdict(list)
        unknown: dict[str, list[str]] = defaultdict(list)
        for name in frames_in(tree):
            robot = _robot_without_frame(view, tree, name, children)
            if not robot:
                continue
            if _has_name_twice(view, view.robots[robot], name):
                doubled[robot].append(name)
            elif name in children and not _of_a_sensor(view, robot, name, children):
                unknown[robot].append(name)
        yield from (_doubled(view, view.robots[it], names) for it, names in doubled.items())
        yield from (_undeclared(view, view.robots[it], names) for it, names in unknown.items())


def _robot_without_frame(
    view: View, tree: TfTree, name: str, children: Mapping[str, GraphFrame]
) -> str:
    """The robot of a frame by name or topic, if the frame is not in the robot's description."""
    if name in view.plan.shared_frames or view.frame_ownership.exact.get(name):
        return ""
    robot = view.frame_ownership.robot(name)
    # A moving frame on a robot's own topic may be anything that it detects.
    if not robot and len(tree.home) == 1 and name in children and children[name].static:
        robot = tree.home[0]
    if not robot or not view.robots[robot].frames or name in view.frames_of[robot]:
        return ""
    # frames_without_robot_name reports a frame that only lacks the robot's name.
    return "" if name in _by_plain_name(view, view.robots[robot]) else robot


def _has_name_twice(view: View, robot: PlannedRobot, name: str) -> bool:
    ownership = view.frame_ownership
    tag = ownership.tag(robot.name)
    if not view.frames_of[robot.name].isdisjoint(without_tag_once(name, tag)):
        return True
    once = ownership.without_robot(name, robot.name)
    twice = ownership.without_robot(once, robot.name)
    ambiguous = tag in ownership.ambiguous_words
    return twice != once and not ambiguous and twice in _by_plain_name(view, robot)


def _doubled(view: View, robot: PlannedRobot, names: Sequence[str]) -> GraphFinding:
    cause = (
        "frame_prefix of robot_state_publisher or tf_frame_prefix_enable of a controller (on by "
    )
    if _has_plain_frames(view, robot):
        message = f"{_frames(names)} the name of {robot.name}, which this layout does not add"
        cause += "default), or a description rewritten for another layout: set them to '' and false"
    else:
        message = f"{_frames(names)} the name of {robot.name} twice"
        cause += "default), on top of a rewritten description: set them to '' and false"
    return GraphFinding("MG206", ERROR, robot.name, "", message, cause, tuple(names))


def _frames(names: Sequence[str]) -> str:
    return f"frame {names[0]} has" if len(names) == 1 else f"frames {shorten(names)} have"


def _of_a_sensor(view: View, robot: str, name: str, children: Mapping[str, GraphFrame]) -> bool:
    """Whether a frame is one that a driver adds below its sensor's link.

    Its name begins like the link's: camera_depth_frame is below camera_link.
    """
    above, passed = name, set()
    while above in children and children[above].static and above not in passed:
        passed.add(above)
        above = children[above].parent
        if above in view.frames_of[robot]:
            return _first_word(view, above, robot) == _first_word(view, name, robot)
    return False


def _first_word(view: View, frame: str, robot: str) -> str:
    plain = view.frame_ownership.without_robot(frame, robot)
    return plain[
        : next((at for at, letter in enumerate(plain) if letter in "/" + SEPARATORS), None)
    ]


def _undeclared(view: View, robot: PlannedRobot, names: Sequence[str]) -> GraphFinding:
    verb = "is" if len(names) == 1 else "are"
    message = f"{_frames(names).rpartition(' ')[0]} {verb} not in the description of {robot.name}"
    declared = _by_plain_name(view, robot)
    plain = view.frame_ownership.without_robot(names[0], robot.name)
    meant = declared.get(plain) or declared.get(similar(plain, declared), "")
    cause = f"did you mean {meant}? Otherwise" if meant else "a sensor's own frame? Then"
    cause += f" add {'it' if len(names) == 1 else 'them'} to other_frames of the plan"
    return GraphFinding("MG204", WARNING, robot.name, "", message, cause, tuple(names))
