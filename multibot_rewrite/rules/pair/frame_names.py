# SPDX-License-Identifier: Apache-2.0
"""Rules about the names of tf frames: each robot's own, as the description and the layout have them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import found_by_plan, pair_rule
from multibot_rewrite.rules.pair.causes import Cause, caused
from multibot_rewrite.rules.pair.frame_prefixes import added_prefixes, robot_behind_prefix
from multibot_rewrite.rules.pair.similar_names import similar
from multibot_rewrite.rules.pair.tf_senders import sent_by_robot, state_publisher, where_set
from multibot_rewrite.rules.pair.tf_trees import TfTree, frames_in, tf_trees
from multibot_rewrite.rules.system.transforms import robots_name_twice
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.ownership import SEPARATORS, without_tag_once
from multibot_rewrite.system.records import Edge, Robot


@pair_rule("MG207", "frame-without-robot-name", ERROR, nodes=False, absence=True)
def frame_without_robot_name(plan: Index, seen: Index) -> Iterator[Finding]:
    """Of one robot only; else it is a frame of several robots."""
    for tree in tf_trees(plan, seen):
        own: dict[str, list[str]] = defaultdict(list)
        for frame, robots in _frames_without_robot(plan, tree).items():
            if len(robots) == 1 and frame not in plan.declared[robots[0]].frames:
                own[robots[0]].append(frame)
        for robot, found in own.items():
            message = f"frames {shorten(found)} on {tree.topic} do not have the name of {robot}"
            cause = _why_bare(plan, tree, plan.declared[robot], found)
            yield frame_without_robot_name.finding(
                message, **cause._asdict(), robot=robot, names=tuple(found)
            )


def _why_bare(plan: Index, tree: TfTree, robot: Robot, names: Sequence[str]) -> Cause:
    """The node that sends all of them by the plan, besides the description; else the description."""
    by_name = _by_plain_name(plan, robot)
    expected = {by_name[name] for name in names}
    sent = next((it for it in sent_by_robot(plan, robot) if expected <= {*it[1:]}), None)
    first = f"expected {by_name[names[0]]}"
    if sent:
        place = where_set(plan, sent.node)
        see = f", see {place}" if place else ""
        return caused(f"{first}: by the plan {sent.node} sends {sent}{see}", place)
    senders = shorten(tree.senders.get(robot.name, ())) or "its robot_state_publisher"
    return Cause(f"{first}: load the rewritten description in {senders}")


def _frames_without_robot(plan: Index, tree: TfTree) -> dict[str, list[str]]:
    """The frames of a tree that hold no robot's name, with the robots they may belong to.

    That is a robot that declares the frame so, or with its name while that frame is not there.
    """
    present = set(frames_in(tree))
    unnamed = {name for name in present if not plan.frame_robot(name)}
    unnamed -= {*plan.system.shared_frames}
    found: dict[str, list[str]] = defaultdict(list)
    for robot in (plan.declared[name] for name in tree.robots if unnamed):
        for plain, frame in _by_plain_name(plan, robot).items():
            if plain in unnamed and (plain == frame or frame not in present):
                found[plain].append(robot.name)
    return found


def _has_plain_frames(plan: Index, robot: Robot) -> bool:
    """Whether the layout has the same frames for every robot; one of them may hold its name."""
    ownership = plan.of_frames
    return any(ownership.without_robot(frame, robot.name) == frame for frame in robot.frames)


def _by_plain_name(plan: Index, robot: Robot) -> dict[str, str]:
    """The robot's frames by their name without the robot's."""
    if _has_plain_frames(plan, robot):
        return {frame: frame for frame in robot.frames}
    return {plan.of_frames.without_robot(frame, robot.name): frame for frame in robot.frames}


@pair_rule("MG204", "undeclared-frame", WARNING, nodes=False)
def undeclared_frame(plan: Index, seen: Index) -> Iterator[Finding]:
    """A frame that a driver adds below its sensor's link is none."""
    for tree in tf_trees(plan, seen):
        children = {edge.child: edge for edge in tree.edges}
        for robot, names in _not_in_a_description(plan, tree, children).items():
            prefixed = added_prefixes(plan.declared[robot], names)
            found = [
                name
                for name in names
                if name in children and not _of_a_sensor(plan, robot, name, children)
                if name not in prefixed and not _has_name_twice(plan, plan.declared[robot], name)
            ]
            if found:
                yield _undeclared(plan, plan.declared[robot], found)


def _undeclared(plan: Index, robot: Robot, names: Sequence[str]) -> Finding:
    verb = "is" if len(names) == 1 else "are"
    message = f"{_frames(names).rpartition(' ')[0]} {verb} not in the description of {robot.name}"
    declared = _by_plain_name(plan, robot)
    plain = plan.of_frames.without_robot(names[0], robot.name)
    meant = declared.get(plain) or declared.get(similar(plain, declared), "")
    cause = f"did you mean {meant}? Otherwise" if meant else "a sensor's own frame? Then"
    cause += f" add {'it' if len(names) == 1 else 'them'} to other_frames of the plan"
    return undeclared_frame.finding(message, cause, robot=robot.name, names=tuple(names))


def _of_a_sensor(plan: Index, robot: str, name: str, children: Mapping[str, Edge]) -> bool:
    """Whether a frame is one that a driver adds below its sensor's link.

    Its name begins like the link's: camera_depth_frame is below camera_link.
    """
    above, passed = name, set()
    while above in children and children[above].static and above not in passed:
        passed.add(above)
        above = children[above].parent
        if above in plan.frames_of[robot]:
            return _first_word(plan, above, robot) == _first_word(plan, name, robot)
    return False


def _first_word(plan: Index, frame: str, robot: str) -> str:
    plain = plan.of_frames.without_robot(frame, robot)
    return plain[
        : next((at for at, letter in enumerate(plain) if letter in "/" + SEPARATORS), None)
    ]


@found_by_plan(robots_name_twice, nodes=False)
def robot_name_twice(plan: Index, seen: Index) -> Iterator[Finding]:
    """Parents and children."""
    for tree in tf_trees(plan, seen):
        children = {edge.child: edge for edge in tree.edges}
        found = _not_in_a_description(plan, tree, children)
        for frame, of in _behind_prefixes(plan, tree):
            found[of].append(frame)
        for name, names in found.items():
            robot = plan.declared[name]
            twice = [it for it in names if _has_name_twice(plan, robot, it)]
            if twice:
                yield _doubled(plan, robot, twice)
            prefixed = added_prefixes(robot, names)
            others = [it for it in prefixed if it not in twice]
            if others:
                yield _prefixed(plan, robot, others, prefixed[others[0]])


def _behind_prefixes(plan: Index, tree: TfTree) -> Iterator[tuple[str, str]]:
    """Frames on a shared topic that say no robot and are of one but for a prefix, each with it."""
    ownership = plan.of_frames
    for frame in frames_in(tree) if len(tree.home) != 1 else ():
        if frame not in plan.system.shared_frames and not ownership.robot(frame):
            robot = robot_behind_prefix(ownership, frame)
            if robot:
                yield frame, robot


def _not_in_a_description(
    plan: Index, tree: TfTree, children: Mapping[str, Edge]
) -> dict[str, list[str]]:
    """By robot: the frames of a tree that are its own and not in its description."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in frames_in(tree):
        robot = _robot_without_frame(plan, tree, name, children)
        if robot:
            found[robot].append(name)
    return found


def _prefixed(plan: Index, robot: Robot, names: Sequence[str], prefix: str) -> Finding:
    verb = "is" if len(names) == 1 else "are"
    what = f"{_frames(names).rpartition(' ')[0]} {verb}"
    message = f"{what} planned without {prefix!r} in front"
    sender = state_publisher(plan, robot) or f"the robot_state_publisher of {robot.name}"
    cause = (
        f"frame_prefix of {sender} is {prefix!r}, on top of a rewritten description: set it to ''"
    )
    return robots_name_twice.finding(message, cause, robot=robot.name, names=tuple(names))


def _doubled(plan: Index, robot: Robot, names: Sequence[str]) -> Finding:
    cause = (
        "frame_prefix of robot_state_publisher or tf_frame_prefix_enable of a controller (on by "
    )
    if _has_plain_frames(plan, robot):
        message = f"{_frames(names)} the name of {robot.name}, which this layout does not add"
        cause += "default), or a description rewritten for another layout: set them to '' and false"
    else:
        message = f"{_frames(names)} the name of {robot.name} twice"
        cause += "default), on top of a rewritten description: set them to '' and false"
    return robots_name_twice.finding(message, cause, robot=robot.name, names=tuple(names))


def _frames(names: Sequence[str]) -> str:
    return f"frame {names[0]} has" if len(names) == 1 else f"frames {shorten(names)} have"


def _has_name_twice(plan: Index, robot: Robot, name: str) -> bool:
    ownership = plan.of_frames
    tag = ownership.tag(robot.name)
    if not plan.frames_of[robot.name].isdisjoint(without_tag_once(name, tag)):
        return True
    once = ownership.without_robot(name, robot.name)
    twice = ownership.without_robot(once, robot.name)
    ambiguous = tag in ownership.ambiguous_words
    return twice != once and not ambiguous and twice in _by_plain_name(plan, robot)


def _robot_without_frame(plan: Index, tree: TfTree, name: str, children: Mapping[str, Edge]) -> str:
    """The robot of a frame by name or topic, if the frame is not in the robot's description."""
    if name in plan.system.shared_frames or plan.of_frames.exact.get(name):
        return ""
    robot = plan.frame_robot(name)
    # A moving frame on a robot's own topic may be anything that it detects.
    if not robot and len(tree.home) == 1 and name in children and children[name].static:
        robot = tree.home[0]
    if not robot or not plan.declared[robot].frames or name in plan.frames_of[robot]:
        return ""
    # frame_without_robot_name reports a frame that only lacks the robot's name.
    return "" if name in _by_plain_name(plan, plan.declared[robot]) else robot
