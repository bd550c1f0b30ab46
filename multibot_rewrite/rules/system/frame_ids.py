# SPDX-License-Identifier: Apache-2.0
"""Dangers of ``header.frame_id`` and of latched descriptions: another robot's, in no tf, empty."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cache, partial
from typing import NamedTuple

from multibot_rewrite.base.conventions import FRAMES_OF_SENSORS, types_of
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Setting
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.wording import SEVERAL, only, shorten, unique
from multibot_rewrite.rules.declaration import last_place, system_rule
from multibot_rewrite.rules.system.likes import done_elsewhere, nodes_of_each
from multibot_rewrite.rules.system.sharing import is_planned_with
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, Tree, at_work, nodes_of, once, robots_of, sent_on
from multibot_rewrite.system.ownership import SEPARATORS
from multibot_rewrite.system.records import NOWHERE, TOPIC, Description, Edge, Place

# What a robot measures is in its own frames. A pose, a path or a marker may be in another robot's.
_MEASURED = ("sensor_msgs/", words.ODOMETRY, "stereo_msgs/", "radar_msgs/")

# Of no use without a frame.
_PLACED = types_of("placed")


class _Message(NamedTuple):
    """A frame that messages on ``topic`` name; ``robot`` is whose topic it is, else whose senders."""

    topic: str
    type: str
    frame: str
    robot: str
    senders: tuple[str, ...]
    field: str = "frame_id"
    link: str = ""
    place: Place = NOWHERE


@system_rule("MG411", "frame-id-of-another-robot", ERROR)
def frame_id_of_another_robot(seen: Index) -> Iterator[Finding]:
    """Report messages with another robot's frame, by the name of the frame."""
    for (frame, robot, senders), messages in _by_sender(seen).items():
        # A sender of the frame's robot has the wrong topic, not the wrong frame.
        whose = {*map(seen.robot, senders)}
        if _is_of_another(seen, frame, robot, messages) and seen.frame_robot(frame) not in whose:
            topics = [it.topic for it in messages if it.type.startswith((*_MEASURED, words.MAP))]
            owner, own = seen.frame_robot(frame), only(_own_frames(seen, frame, robot))
            cause = f"set the frame of {_one_of(senders)} to {own or f'that of {robot}'}"
            yield frame_id_of_another_robot.finding(
                f"{messages[0].field} of {shorten(topics)} is {frame}, a frame of {owner}; sent by"
                f" {_one_of(senders)}", cause,
                robot=robot, node=senders[0], names=(frame,), settings=_with_frame(messages, own),
            )  # fmt: skip


def _own_frames(seen: Index, frame: str, robot: str) -> list[str]:
    """Return the frames that a robot has in place of another one's."""
    frames = _frames_by_topic(seen)
    sent = {one for it in trees_of(seen, robot) for one in frames[it.topic].get(robot, ())}
    return [it for it in sent if seen.plain_frame(it) == seen.plain_frame(frame)]


def _with_frame(messages: Iterable[_Message], frame: str) -> tuple[Setting, ...]:
    """Return the settings that give messages of one sender each this frame; none without one."""
    own = (it for it in messages if frame and len(it.senders) == 1)
    return tuple(Setting(it.senders[0], it.field, frame, it.topic) for it in own)


def _is_of_another(seen: Index, frame: str, robot: str, messages: Sequence[_Message]) -> bool:
    """Return whether measured messages, or a map, are in a frame of another robot."""
    if not robot or seen.frame_robot(frame) in ("", robot):
        return False
    # A robot without a map's frame of its own may be on another one's map.
    is_map = any(it.type == words.MAP for it in messages) and _own_frames(seen, frame, robot)
    return bool(is_map) or any(it.type.startswith(_MEASURED) for it in messages)


@system_rule("MG412", "frame-id-unknown", ERROR, absence=True)
def frame_id_unknown(seen: Index) -> Iterator[Finding]:
    """Report unknown frames, if any transform was received; other rules report that none was."""
    frames = _frames_by_topic(seen)
    yield from _without_frame(seen)
    yield from _with_slash(seen)
    for (frame, robot, senders), messages in _by_sender(seen).items():
        heard = [frames[it.topic] for it in trees_of(seen, robot) if it.edges]
        there = not heard or any(frame in it.get(seen.frame_robot(frame), ()) for it in heard)
        if there or _is_of_another(seen, frame, robot, messages):
            continue
        own = sorted({it for tree in heard for who in ("", robot) for it in tree.get(who, ())})
        # Those of the robot that have this name beside the robot's, or without it.
        last = frame.rpartition("/")[2]
        meant = sorted(it for it in own if seen.plain_frame(it) in (frame, last) or it == last)
        alike = [*filter(None, [nearest(frame, own, MISTYPED)])]
        likely = meant or alike or _frame_of_kind(messages, own)
        elsewhere = _topics_of_frames(seen).get(frame, ())
        topics, link = shorten([it.topic for it in messages]), messages[0].link
        # Of no use to their readers without a place; filters turn that of an IMU. Next to what a launch
        # file starts there may be what sends the transform.
        placed = [it.topic for it in messages if it.type in (*_PLACED, "sensor_msgs/msg/Imu")]
        needed = seen.is_live and any(_is_read(seen, it) for it in placed)
        yield frame_id_unknown.finding(
            f"{messages[0].field} of {topics} is {frame}, which is in no transform of"
            f" {robot or 'tf'}; sent by {_one_of(senders)}",
            # A sensor in a simulator sends what its description says, else a name that is in no tf.
            (f"write <gz_frame_id>{link}</gz_frame_id> in the sensor" if link else "")
            or (f"set the frame of {_one_of(senders)} to {_one_of(likely)}" if likely else "")
            or _elsewhere_hint(seen, frame, robot, elsewhere)
            or f"send a transform for it, or set the frame of {_one_of(senders)} to one that is in tf",
            level=ERROR if (meant and not link) or elsewhere or needed else WARNING,
            robot=robot, node=senders[0], names=(frame,), **last_place(messages[:1]),
            settings=() if link else _with_frame(messages, only(likely)),
        )  # fmt: skip


@system_rule("MG419", "joints-of-another-robot", ERROR)
def joints_of_another_robot(seen: Index) -> Iterator[Finding]:
    """Report joint states with another robot's joints, by the robots' names in them."""
    whose = cache(partial(_robot_of_joint, seen))
    for it in (one for one in seen.system.heard if one.joints):
        _, senders = sent_on(seen, it.topic)
        robot = seen.robot(it.topic) or only(robots_of(seen, senders))
        others = {name: whose(name) for name in it.joints}
        foreign = [name for name, other in others.items() if other not in ("", robot)]
        if robot and senders and foreign:
            yield joints_of_another_robot.finding(
                f"the joints on {it.topic} are {shorten(foreign, SEVERAL)}, of {others[foreign[0]]};"
                f" sent by {_one_of(senders)}",
                f"give {_one_of(senders)} the joints of {robot}",
                robot=robot, node=senders[0], names=(it.topic,),
            )  # fmt: skip


def _robot_of_joint(seen: Index, joint: str) -> str:
    """Return the robot whose name is in a joint's, as in its frames or in its own messages."""
    if found := seen.frame_robot(joint):
        return found
    named = [
        it
        for it in _robots_by_joint(seen).get(joint, ())
        if any(joint.startswith(f"{it}{m}") or joint.endswith(f"{m}{it}") for m in SEPARATORS)
    ]
    return min(filter(None, named), default="")


@once
def _robots_by_joint(seen: Index) -> Mapping[str, Set[str]]:
    """Return the robots on whose topics each joint is."""
    return sets_by_key(
        (joint, seen.robot(it.topic)) for it in seen.system.heard for joint in it.joints
    )


@once
def _frames_by_topic(seen: Index) -> Mapping[str, Mapping[str, Set[str]]]:
    """Return the frames of each tree by their robot."""
    found: dict[str, dict[str, set[str]]] = {}
    for tree in seen.trees:
        own = found.setdefault(tree.topic, defaultdict(set))
        for it in frames_in(tree.edges):
            own[seen.frame_robot(it)].add(it)
    return found


@once
def _topics_of_frames(seen: Index) -> Mapping[str, Sequence[str]]:
    """Return the topics of each frame."""
    return lists_by_key((it, tree.topic) for tree in seen.trees for it in frames_in(tree.edges))


@once
def _senders_of(seen: Index) -> Mapping[str, str]:
    """Return the node that sends a frame, of the first tree in which only one does."""
    edges = [it for tree in seen.trees for it in tree.edges if len(it.publishers) == 1]
    return {it.child: it.publishers[0] for it in reversed(edges)}


def _without_frame(seen: Index) -> Iterator[Finding]:
    """Yield sensor and odometry messages without a frame: tf2 refuses an empty frame_id."""
    for it in seen.system.heard:
        type_, senders = sent_on(seen, it.topic)
        # Of odometry: its pose is known where all of the message was read.
        field = "child_frame_id" if type_ == words.ODOMETRY and it.pose and not it.child else ""
        field = "frame_id" if not it.frame and type_ in _PLACED else field
        if senders and field:
            yield frame_id_unknown.finding(
                f"{field} of {it.topic} is empty: tf cannot say where it was measured; sent by"
                f" {_one_of(senders)}",
                f"set the frame of {_one_of(senders)}",
                level=WARNING if it.frame else ERROR,
                robot=seen.robot(it.topic) or only(robots_of(seen, senders)),
                node=senders[0], names=(it.topic,),
            )  # fmt: skip


def _with_slash(seen: Index) -> Iterator[Finding]:
    """Report frames with a slash, once a sender: tf2 refuses to look them up (validateFrameId)."""
    found: dict[tuple[str, ...], dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for it in seen.system.heard:
        type_, senders = sent_on(seen, it.topic)
        if senders and type_.startswith(_MEASURED):
            for frame in (it.frame, it.child):
                if frame.startswith("/"):
                    found[senders][it.topic].append(frame)
    for senders, topics in found.items():
        named = shorten(unique(frame for own in topics.values() for frame in own))
        topic = next(iter(topics))
        yield frame_id_unknown.finding(
            f"messages on {shorten(topics)} are in {named}: tf2 refuses to look up a frame with a slash"
            f" in front; sent by {_one_of(senders)}",
            f"leave the slash out of the frames of {_one_of(senders)}",
            level=ERROR if any(_is_read(seen, it) for it in topics) else WARNING,
            robot=seen.robot(topic) or only(robots_of(seen, senders)),
            node=senders[0], names=tuple(topics),
        )  # fmt: skip


def _is_read(seen: Index, topic: str) -> bool:
    """Return whether nodes read it that do more than look."""
    return bool(at_work(seen.ends_at(TOPIC, topic).subscribers))


def _elsewhere_hint(seen: Index, frame: str, robot: str, elsewhere: Sequence[str]) -> str:
    """Return which node of another robot sends it, and which one this robot has, or the other place."""
    there = _senders_of(seen).get(frame, "")
    if there and robot and seen.robot(there):
        mine = nodes_of_each(seen).get(robot, {}).get(seen.plain(there), "")
        remedy = f"see the log of {mine}" if mine else f"start such a node for {robot}"
        return f"{there} sends it on its own tf: {remedy}"
    if elsewhere:
        return f"it is on {shorten(elsewhere)}: who sends it there is to send it here, too"
    return ""


def _frame_of_kind(messages: Sequence[_Message], own: Sequence[str]) -> list[str]:
    """Return the robot's frame that is named like one of such a sensor, if it has just one."""
    called = {word for it in messages for word in FRAMES_OF_SENSORS.get(it.type, ())}
    found = sorted(it for it in own if any(word in it for word in called))
    return found if len(found) == 1 else []


def _by_sender(seen: Index) -> dict[tuple[str, str, tuple[str, ...]], list[_Message]]:
    """Return by frame, robot and senders the messages of nodes other than viewers."""
    found: dict[tuple[str, str, tuple[str, ...]], list[_Message]] = defaultdict(list)
    for it in seen.system.heard:
        type_, senders = sent_on(seen, it.topic)
        for field, written in (("frame_id", it.frame), ("child_frame_id", it.child)):
            frame = written.removeprefix("/")
            if senders and frame:
                robot = seen.robot(it.topic) or only(robots_of(seen, senders))
                told = (robot, senders, field, it.link, it.place)
                found[frame, robot, senders].append(_Message(it.topic, type_, frame, *told))
    return found


def trees_of(seen: Index, robot: str) -> list[Tree]:
    """Return the trees that a robot receives: on its own topic, on a shared one, at its nodes."""
    if not robot:
        return list(seen.trees)
    found = _trees_by_robot(seen)
    return [seen.trees[it] for it in sorted({*found.get("", ()), *found.get(robot, ())})]


@once
def _trees_by_robot(seen: Index) -> Mapping[str, Set[int]]:
    """Return the numbers of the trees on each robot's topic or at its nodes; under "" those of all."""
    return sets_by_key(
        (robot, at)
        for at, it in enumerate(seen.trees)
        for robot in (seen.robot(it.topic), *robots_of(seen, (*it.senders, *it.listeners)))
    )


def frames_in(edges: Iterable[Edge]) -> set[str]:
    """Return the frames of some transforms, without a slash in front."""
    return {it.removeprefix("/") for edge in edges for it in (edge.parent, edge.child)}


def _one_of(names: Sequence[str]) -> str:
    """Return the only name, or ``one of`` several."""
    return only(names) or f"one of {shorten(names, SEVERAL)}"


@system_rule("MG420", "description-does-not-fit", ERROR, absence=True)
def description_does_not_fit(seen: Index) -> Iterator[Finding]:
    """Report the first fault of a description."""
    for it in seen.system.descriptions:
        _, senders = sent_on(seen, it.topic)
        robot = seen.robot(it.topic) or only(robots_of(seen, senders))
        if senders and (fault := _description_fault(seen, it, robot)):
            message, hint, level = fault
            yield description_does_not_fit.finding(
                message, hint, level=level, robot=robot, node=senders[0], names=(it.topic,)
            )


def _description_fault(seen: Index, it: Description, robot: str) -> tuple[str, str, str] | None:
    """Return what is wrong with a description, what to do, and the level; None for nothing."""
    if not it.links:
        readers = nodes_of(at_work(seen.by_name[TOPIC, it.topic].subscribers))
        wait = f"; {shorten(readers, SEVERAL)} has no model" if readers else ""
        message = f"{it.topic} is empty, or no URDF{wait}"
        return message, "see the command that makes it: xacro's log", ERROR
    others = {seen.frame_robot(link) for link in it.links} - {""}
    if robot and others and robot not in others:
        message = f"{it.topic} has the links of {min(others)}: {shorten(it.links, SEVERAL)}"
        return message, f"load the description of {robot}", ERROR
    frames = _sent_frames(seen, robot)
    if len(it.links) > 1 and frames and frames.keys().isdisjoint(it.links):
        links, sent = shorten(it.links, SEVERAL), shorten(sorted({*frames.values()}), SEVERAL)
        message = f"no link of {it.topic} ({links}) is a frame that is sent ({sent})"
        return message, "who sends tf has another description: load one in both", ERROR
    return (_joint_fault(seen, it, robot) or _no_joints(seen, it, robot)) if it.joints else None


def _no_joints(seen: Index, it: Description, robot: str) -> tuple[str, str, str] | None:
    """Return what is wrong where no node of the robot sends joint states, and links are in no tf."""
    own = [one for one in seen.topics if one.type == words.JOINTS and seen.robot(one.name) == robot]
    waiting = [one for one in own if {*sent_on(seen, it.topic)[1]} & {*nodes_of(one.subscribers)}]
    if seen.expected or any(one.publishers for one in own) or not waiting:
        return None
    name = waiting[0].name
    lost = () if done_elsewhere(seen, waiting[0]) else _lost_links(seen, it, robot)
    message = f"no node sends {name}, so no transform leads to {shorten(lost, SEVERAL)}"
    hint = "start joint_state_broadcaster, or the bridge or driver that sends it"
    return (message, hint, ERROR if is_planned_with(seen, name) else WARNING) if lost else None


def _sent_frames(seen: Index, robot: str) -> dict[str, str]:
    """Return the frames that are sent of a robot or of none, by name with and without a prefix."""
    sent = {one for tree in trees_of(seen, robot) for one in frames_in(tree.edges)}
    own = sorted(one for one in sent if seen.frame_robot(one) in ("", robot))
    named = ((one.rpartition("/")[2], seen.plain_frame(one), one) for one in own)
    return {name: names[-1] for names in named for name in names}


def _lost_links(seen: Index, it: Description, robot: str) -> list[str]:
    """Return the first link of each piece of tf that has links, except for the largest piece."""
    edges = [one for tree in trees_of(seen, robot) for one in tree.edges]
    above = {one.child.removeprefix("/"): one.parent.removeprefix("/") for one in edges}
    frames = _sent_frames(seen, robot) if edges else {}
    pieces = lists_by_key((root_of(frames.get(link, link), above), link) for link in it.links)
    each = sorted(pieces.values(), key=len, reverse=True) if frames else []
    return [links[0] for links in each[1:]]


def _joint_fault(seen: Index, it: Description, robot: str) -> tuple[str, str, str] | None:
    """Return what is wrong where joint states in its namespace lack joints of a description.

    They have none of them, or no transform leads to links of those that lack. A link that nobody
    measures is only not shown, but planned with."""
    space = it.topic.rpartition("/")[0]
    heard = (
        one for one in seen.system.heard if one.joints and one.topic.rpartition("/")[0] == space
    )
    for topic, every in lists_by_key((one.topic, one.joints) for one in heard).items():
        type_, senders = sent_on(seen, topic)
        # One with joints of its own alone is healthy among others, so each of them has to be heard.
        if type_ != words.JOINTS or not senders or len(every) < len(senders):
            continue
        named = unique(name for joints in every for name in joints)
        lacking = sorted({*it.joints}.difference(named))
        own, who, sent, missed = (
            shorten(one, SEVERAL) for one in (it.joints, senders, named, lacking)
        )
        if len(lacking) == len({*it.joints}):
            message = f"{it.topic} has the joints {own}, and {who} sends {sent} on {topic}"
            return message, f"give {who} the names that the description has", ERROR
        if lost := _lost_links(seen, it, robot) if lacking else []:
            level = ERROR if is_planned_with(seen, topic) else WARNING
            message = f"{who} sends no state of {missed} on {topic}, so no transform leads to"
            hint = f"see which joints {who} is set to send"
            return f"{message} {shorten(lost, SEVERAL)}", hint, level
    return None
