# SPDX-License-Identifier: Apache-2.0
"""Robots with the same nodes compared with each other: parameters, types, QoS and fixed transforms."""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.grouping import dicts_by_key, lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.likes import (
    alike,
    driver_missing,
    lacks_what_its_likes_have,
    made_of,
    nodes_of_each,
)
from multibot_rewrite.rules.system.matching import qos_words
from multibot_rewrite.system.index import Index, once
from multibot_rewrite.system.records import SIM_TIME, ZENOH, Edge

# What is each robot's own: who and where it is, what it is connected to, which files it reads.
_OWN = lazy_compile(
    r"(^|[._])((?<!frame_)id|ip|ports?|address(es)?|host(name)?|ur[li]|serial|device|dev|names?|namespace"
    r"|prefix|tag|color|seed|domain|poses?|position|datum|button|path|file(name)?|folder|home|start)([._]|$)"
    r"|^(x|y|z|yaw|roll|pitch|theta|qos_overrides\..*)$|description|semantic|plugin_lib"
)
# A description's place of a part, in metres and parts of a quaternion.
_SAME = 1e-3
_TWO = 2


class _Value(NamedTuple):
    """A value of one robot: where, its name, the value, and the same in the words of all robots."""

    node: str
    name: str
    value: str
    plain: str


# What it is of, in the words of all robots -> robot -> its value.
_Values = Mapping[tuple[str, ...], Mapping[str, _Value]]


@system_rule("MG328", "differs-from-its-likes", WARNING)
def differs_from_its_likes(seen: Index) -> Iterator[Finding]:
    """Report what differs in one robot from robots built like it, once for each node and its tf."""
    for likes in alike(nodes_of_each(seen)):
        for values in (_parameter_values(seen), _type_values(seen), _qos_values(seen)):
            yield from _differences(_odd_values(values, likes), len(likes) == _TWO)
        yield from _moved_parts(seen, _odd_values(_part_values(seen), likes))
        yield from _lost_parts(seen, likes)


# What is found of robots held against each other is left to any other finding about it, and what a
# missed driver explains to that.
COMPARED = (lacks_what_its_likes_have.code, differs_from_its_likes.code)
BETWEEN_ROBOTS = (*COMPARED, driver_missing.code)
# A tree in pieces, with other names, or without frames: its parts are not compared.
_BROKEN = ("MG208", "MG406", "MG407")


def unexplained(found: Sequence[Finding]) -> list[Finding]:
    """Return the findings without comparisons of robots that another finding explains."""
    told = {it for one in found if one.code not in BETWEEN_ROBOTS for it in one.names}
    found = [it for it in found if it.code != driver_missing.code or told.isdisjoint(it.names)]
    others = [one for one in found if one.code not in COMPARED]
    about = {it for one in others for it in (one.node, *one.names)} - {""}
    robots = {one.robot for one in others if not one.node and not one.names}
    broken = {one.robot for one in others if one.code in _BROKEN}
    return [
        it
        for it in found
        if it.code not in COMPARED
        or (
            (about.isdisjoint((it.node, *it.names)) and it.robot not in robots)
            and (it.node or it.robot not in broken)
        )
    ]


def _odd_values(values: _Values, likes: Sequence[str]) -> Iterator[tuple[str, _Value, _Value]]:
    """Yield (robot, its value, the others' value) where one differs from all the others."""
    for own in values.values():
        there = {it: own[it] for it in likes if it in own}
        counts = Counter(it.plain for it in there.values())
        if len(counts) != 2 or len(there) < len(likes):
            continue
        (usual, _), (odd, number) = counts.most_common()
        if number == 1:
            robot = next(it for it in reversed(there) if there[it].plain == odd)
            yield robot, there[robot], next(it for it in there.values() if it.plain == usual)


def _differences(odd: Iterator[tuple[str, _Value, _Value]], of_two: bool) -> Iterator[Finding]:
    """Report differences; of two robots for both: either may be the one that is wrong."""
    by_node: dict[tuple[str, str, str], list[tuple[_Value, _Value]]] = defaultdict(list)
    for robot, own, other in odd:
        by_node[robot, own.node, other.node].append((own, other))
    for (robot, node, like), pairs in by_node.items():
        listed = (f"{own.name} {own.value}, not {other.value}" for own, other in pairs)
        names = tuple(own.name for own, _ in pairs)
        beside = sorted({other.name for _, other in pairs}.difference(names))
        at = f" ({shorten(beside, SEVERAL)})" if beside else ""
        yield differs_from_its_likes.finding(
            f"has {shorten([*listed], SEVERAL)} as {like}{at}",
            "make them equal, if the two are to be equal",
            robot=robot, node=node, names=(*names, *beside) if of_two else names,
        )  # fmt: skip


@once
def _parameter_values(seen: Index) -> _Values:
    """Return by plain node and parameter the value of each robot."""
    found: dict[tuple[str, ...], dict[str, _Value]] = defaultdict(dict)
    for it in seen.system.parameters:
        robot = seen.robot(it.node)
        if robot and it.name != SIM_TIME and not _OWN.search(it.name):
            told = _Value(it.node, it.name, it.value, it.value.replace(robot, "*"))
            found[seen.plain(it.node), it.name][robot] = told
    return found


@once
def _type_values(seen: Index) -> _Values:
    """Return types of topics whose nodes agree on one; otherwise that is another finding."""
    found: dict[tuple[str, ...], dict[str, _Value]] = defaultdict(dict)
    for it in seen.topics:
        robot = seen.robot(it.name) if it.type else ""
        ends = (*it.publishers, *it.subscribers) if robot else ()
        if ends and all(end.type == it.type for end in ends):
            found[(seen.plain(it.name),)][robot] = _Value(ends[0].node, it.name, it.type, it.type)
    return found


@once
def _qos_values(seen: Index) -> _Values:
    """Return QoS settings; none with Zenoh, which connects any two."""
    found: dict[tuple[str, ...], dict[str, _Value]] = defaultdict(dict)
    told = seen.system.environment.rmw != ZENOH and any(it.qos for it in seen.system.ends)
    for robot, made in made_of(seen).items() if told else ():
        for key, end in made.ends.items():
            if end.qos:
                words = " ".join(qos_words(end))
                about = (*key, "qos")
                found[about][robot] = _Value(end.node, end.name, words, words)
    return found


def _edges_of(seen: Index) -> Iterator[tuple[str, Edge]]:
    """Yield (robot, transform) for fixed transforms that have one sender each."""
    for tree in seen.trees:
        for it in tree.edges:
            robot = seen.frame_robot(it.child) or seen.robot(it.topic)
            if robot and it.static and not it.several:
                yield robot, it


@once
def _part_values(seen: Index) -> _Values:
    """Return parents and places of parts."""
    found: dict[tuple[str, ...], dict[str, _Value]] = defaultdict(dict)
    for robot, it in _edges_of(seen):
        child, parent = seen.plain_frame(it.child), seen.plain_frame(it.parent)
        # One in another form than the robot's frames has no words in common with the others'.
        if parent != it.parent or not seen.frame_robot(it.parent):
            told = _Value(it.topic, it.child, f"below {it.parent}", parent)
            found[child, "parent"][robot] = told
        if it.transform:
            at = " ".join(f"{number:.3g}" for number in it.transform[:3])
            place = str([round(number / _SAME) for number in it.transform])
            found[child, "place"][robot] = _Value(it.topic, it.child, f"at {at}", place)
    return found


def _moved_parts(seen: Index, odd: Iterator[tuple[str, _Value, _Value]]) -> Iterator[Finding]:
    by_robot = lists_by_key((robot, (own, other)) for robot, own, other in odd)
    for robot, pairs in by_robot.items():
        listed = (f"{own.name} {own.value}, not {other.value}" for own, other in pairs)
        like = seen.robot(pairs[0][1].node) or seen.frame_robot(pairs[0][1].name)
        yield differs_from_its_likes.finding(
            f"{robot} has {shorten([*listed], SEVERAL)} as {like}",
            "has it another description, or an older one?",
            robot=robot, names=unique(it.name for pair in pairs for it in pair),
        )  # fmt: skip


def _lost_parts(seen: Index, likes: Sequence[str]) -> Iterator[Finding]:
    """Report lost parts of a robot that sends some; with none its robot_state_publisher is reported."""
    by_robot = _frames(seen)
    frames = {robot: by_robot[robot] for robot in likes if robot in by_robot}
    counts = Counter(it for own in frames.values() for it in own)
    for robot in likes if len(frames) == len(likes) else ():
        lost = sorted(it for it, number in counts.items() if number == len(likes) - 1)
        lost = [it for it in lost if it not in frames[robot]]
        # Under other names all are lost, which is another finding; of two robots one may have a part
        # more. What is there is to hang on the same frame.
        if len(likes) == _TWO or len(lost) >= len(frames[robot]):
            lost = [it for it in lost if (robot, it) in _frames_with_children(seen)]
        if lost:
            like = next(it for it in likes if it != robot)
            yield differs_from_its_likes.finding(
                f"{robot} has no transform of {shorten(lost, SEVERAL)}, as {like} has",
                "has it another description, or an older one?",
                robot=robot, names=tuple(frames[like][it] for it in lost if it in frames[like]),
            )  # fmt: skip


@once
def _frames_with_children(seen: Index) -> Set[tuple[str, str]]:
    """Return the frames that have something below them, by robot and without its name."""
    every = ((it.parent, it.topic) for tree in seen.trees for it in tree.edges)
    return {(seen.frame_robot(it) or seen.robot(on), seen.plain_frame(it)) for it, on in every}


@once
def _frames(seen: Index) -> Mapping[str, Mapping[str, str]]:
    """Return by robot its frames by their names without the robot's."""
    return dicts_by_key(
        (robot, seen.plain_frame(it.child), it.child) for robot, it in _edges_of(seen)
    )
