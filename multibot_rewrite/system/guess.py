# SPDX-License-Identifier: Apache-2.0
"""A graph without a plan -> the robots that are in it, and whose each of its names is. Pure.

A namespace is a robot's where nodes are in it, and topics that a body has: commands, joints, odometry,
a description, tf. Two or more namespaces with nodes of the same names are robots where these nodes have
such a topic, wherever that is: in each namespace, or one for all. Without namespaces a robot is a word
at the end of such topics (``cmd_vel/robot1``), or one that several trees of frames have
(``robot1/base_link``).
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Set
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.conventions import BODY_FRAMES, OF_A_ROBOT, USUAL_FRAMES
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.system.ownership import SEPARATORS, Whose
from multibot_rewrite.system.records import TOPIC, Edge, System
from multibot_rewrite.system.words import is_tool

# Topics that a whole robot has; a lidar alone has a scan, and a camera sends tf.
_WHOLE = frozenset(("cmd_vel", "odom", "joint_states", "robot_description"))
# Namespaces with topics like a robot's that are only a part of one; two_finger_arm is an arm.
_PART = lazy_compile(
    r"(?!.*(?:arm|bot)_?[0-9]*$).*(cam|costmap|lidar|laser|scan|sensor|imu|gps|realsense|zed|oakd?$|velodyne|ouster|sick|wheel|motor"
    r"|gripper|controller|manager|server|caster|steering|finger|torso).*"
)
_NUMBER = lazy_compile(r"\d+")


class GuessedRobot(NamedTuple):
    """A robot that names show; ``before`` or ``behind`` is its word in frames, such as ``robot1/``.

    Each is empty where there is none. ``only_frames``: no topic or node has a word for it."""

    name: str
    namespace: str
    before: str = ""
    behind: str = ""
    only_frames: bool = False


def _frames_of_parts(edges: Iterable[Edge]) -> set[str]:
    """Return the frames below a robot's base: an arm, a wheel, whatever its own base is called."""
    children = lists_by_key(
        (it.parent.removeprefix("/"), it.child.removeprefix("/")) for it in edges
    )
    todo, found = [*BODY_FRAMES], {*BODY_FRAMES}
    for frame in todo:  # grows
        new = [it for it in children[frame] if it not in found]
        found.update(new)
        todo += new
    return found - {*BODY_FRAMES}


def guess_robots(graph: System) -> tuple[GuessedRobot, ...]:
    """Return the robots of a graph, in the order of their names; empty where none has a name."""
    parts = _frames_of_parts(graph.edges)
    lived_in = [node.name for node in graph.nodes if not is_tool(node.name)]
    namespaces = [it for it in _robot_namespaces(graph, lived_in) if not _is_a_part(it, parts)]
    frames = {it for edge in graph.edges for it in (edge.child, edge.parent)}
    words = [] if namespaces else _last_words(graph)
    if not (namespaces or words):
        namespaces = sorted(_alike_namespaces(graph, lived_in, numbered=True))
    if namespaces:
        return tuple(with_frames(_robots_of_namespaces(namespaces), frames))
    if words:
        return tuple(with_frames((GuessedRobot(it, "") for it in words), frames))
    parents = sets_by_key((it.child, it.parent) for it in graph.edges)
    return tuple(_frame_robots(frames - parts, parents))


def _is_a_part(namespace: str, parts: Collection[str]) -> bool:
    """Return whether a namespace's base frame is below that of a robot without a name."""
    word = namespace.rpartition("/")[2]
    return any(f"{word}{way}{base}" in parts for way in "/_" for base in BODY_FRAMES)


def _robots_of_namespaces(namespaces: Collection[str]) -> Iterator[GuessedRobot]:
    """Yield the robots by their last words, or by the whole namespaces where two end alike."""
    last = [it.rpartition("/")[2] for it in namespaces]
    times = Counter(last)
    for word, space in zip(last, namespaces, strict=True):
        yield GuessedRobot(word if times[word] == 1 else space.strip("/"), space)


def _robot_namespaces(graph: System, lived_in: Collection[str]) -> list[str]:
    """Return the namespaces of robots, in order."""
    nodes = {node.name for node in graph.nodes}
    parts = (end.name.rpartition("/") for end in graph.ends if end.kind == TOPIC)
    shown = ((space, word) for space, _, word in parts if space and word in OF_A_ROBOT)
    # Below a node's own name are its private names.
    found = sets_by_key((space, word) for space, word in shown if space not in nodes)
    bodies = [
        space
        for space, words in found.items()
        if (len(words) > 1 or not words.isdisjoint(("tf", "tf_static")))
        and _may_be_a_robot(space, lived_in)
    ]
    # What is above a robot's namespace is a group of robots.
    bodies += [
        it
        for it in _alike_namespaces(graph, lived_in)
        if not any(body.startswith(f"{it}/") for body in bodies)
    ]
    outer = [it for it in bodies if not any(it.startswith(f"{other}/") for other in bodies)]
    return sorted({*outer, *_numbered_alike(outer, lived_in)})


def _alike_namespaces(graph: System, nodes: Iterable[str], numbered: bool = False) -> Iterator[str]:
    """Yield namespaces next to each other that have nodes of the same names.

    One such node has a topic of a whole robot in each of them; two of any kind do for namespaces
    with numbers."""
    whole = {end.node for end in graph.ends if end.name.rpartition("/")[2] in _WHOLE}
    below: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for node in (it for it in nodes if numbered or it in whole):
        space = node.rpartition("/")[0]
        while space:
            below[space.rpartition("/")[0]][space].add(node.removeprefix(space))
            space = space.rpartition("/")[0]
    for spaces in below.values():
        times = Counter(name for names in spaces.values() for name in names)
        for space, names in spaces.items():
            same = sum(times[name] > 1 for name in names)
            enough = same > 1 and _NUMBER.search(space.rpartition("/")[2]) if numbered else same
            if enough and _may_be_a_robot(space, [f"{space}{it}" for it in names]):
                yield space


def _may_be_a_robot(space: str, nodes: Collection[str]) -> bool:
    part = _PART.fullmatch(space.rpartition("/")[2].lower())
    # A recording has no nodes.
    return not part and (not nodes or any(node.startswith(f"{space}/") for node in nodes))


def _numbered_alike(spaces: Collection[str], nodes: Iterable[str]) -> Iterator[str]:
    """Yield namespaces of nodes that differ from a robot's only in the number: it has just started."""
    patterns = {_NUMBER.sub("#", space) for space in spaces if _NUMBER.search(space)}
    for node in nodes:
        space = node.rpartition("/")[0]
        while space:
            if _NUMBER.search(space) and _NUMBER.sub("#", space) in patterns:
                yield space
            space = space.rpartition("/")[0]


def _last_words(graph: System) -> list[str]:
    """Return words behind topics of a body: ``robot1`` of ``/cmd_vel/robot1`` and ``/odom/robot1``."""
    found: dict[str, set[str]] = defaultdict(set)
    for end in graph.ends:
        *_, before, last = ("", *end.name.split("/"))
        if end.kind == TOPIC and before in OF_A_ROBOT and last not in OF_A_ROBOT:
            found[last].add(before)
    nodes = [node.name for node in graph.nodes]
    return sorted(
        word
        for word, topics in found.items()
        if len(topics) > 1 and any(node.endswith(f"_{word}") for node in nodes)
    )


def _frames_above(frames: Iterable[str], parents: Mapping[str, Set[str]]) -> Set[str]:
    """Return all frames above these."""
    todo, found = [*frames], set[str]()
    for it in todo:  # grows
        new = parents.get(it, set()) - found
        todo += new
        found |= new
    return found


def _frame_robots(frames: Iterable[str], parents: Mapping[str, Set[str]]) -> Iterator[GuessedRobot]:
    """Yield two or more robots whose words are next to usual names of frames, and apart in the tree."""
    ways: dict[tuple[str, bool], dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for frame in frames:
        for separator in ("/", *SEPARATORS):
            for usual in USUAL_FRAMES:
                if frame.endswith(separator + usual):
                    ways[separator, True][frame.removesuffix(separator + usual)].add(frame)
                if frame.startswith(usual + separator):
                    ways[separator, False][frame.removeprefix(usual + separator)].add(frame)
    whole = {way: _not_parts(words, parents) for way, words in ways.items()}
    several = {way: words for way, words in whole.items() if len(words) > 1}
    if several:
        (separator, first), words = max(several.items(), key=lambda it: len(it[1]))
        for word in sorted(words):
            before, behind = (word + separator, "") if first else ("", separator + word)
            yield GuessedRobot(word, "", before, behind, True)


def _not_parts(words: Mapping[str, Collection[str]], parents: Mapping[str, Set[str]]) -> set[str]:
    """Return the words whose frames are below none of another word's."""
    owners = {frame: word for word, frames in words.items() for frame in frames}
    above = {
        word: {owners.get(it, word) for it in _frames_above(frames, parents)}
        for word, frames in words.items()
    }
    return {word for word, found in above.items() if found <= {word}}


def with_frames(robots: Iterable[GuessedRobot], frames: Iterable[str]) -> Iterator[GuessedRobot]:
    """Yield each robot with the way in which most frames have its name."""
    times = Counter(way for frame in frames for way in _affixes(frame))
    for robot in robots:
        word = robot.namespace.rpartition("/")[2] or robot.name
        marks = ("/", *SEPARATORS)
        ways = [way for it in marks for way in ((word + it, ""), ("", it + word))]
        way = max(ways, key=times.__getitem__)
        yield robot._replace(before=way[0], behind=way[1]) if times[way] else robot


def _affixes(frame: str) -> Iterator[tuple[str, str]]:
    """Yield (beginning, "") and ("", end) of a frame at each separator, which both include."""
    for at, it in enumerate(frame):
        if it == "/" or it in SEPARATORS:
            yield frame[: at + 1], ""
            yield "", frame[at:]


def whose_by_guess(robots: Iterable[GuessedRobot]) -> Whose:
    """Return whose each name is, by the robots that were guessed."""
    known = tuple(robots)
    there = [it for it in known if not it.only_frames]
    by_word = {it.namespace or it.name: it for it in there}
    by_word |= {it.name: it for it in there}
    of_name = cache(lambda name: _robot_of_name(name, by_word))
    by_way: dict[tuple[str, str], int] = {}
    for at, it in enumerate(known):
        for way in ((it.before, ""), ("", it.behind)):
            by_way.setdefault(way, at)

    @cache
    def of_frame(frame: str) -> GuessedRobot | None:
        first = min((by_way[way] for way in _affixes(frame) if way in by_way), default=None)
        return None if first is None else known[first]

    def plain_frame(frame: str) -> str:
        robot = of_frame(frame)
        return frame.removeprefix(robot.before).removesuffix(robot.behind) if robot else frame

    def name_of(robot: GuessedRobot | None) -> str:
        return robot.name if robot else ""

    return Whose(
        tuple(sorted(it.name for it in known)),
        cache(lambda name: name_of(of_name(name))),
        cache(lambda name: _plain_name(name, of_name(name))),
        cache(lambda frame: name_of(of_frame(frame))),
        cache(plain_frame),
    )


def _robot_of_name(name: str, robots: Mapping[str, GuessedRobot]) -> GuessedRobot | None:
    """Return a name's robot by namespace, by the last word, or in the root by any word of a name."""
    above = name
    while above:
        if above in robots:
            return robots[above]
        above = above.rpartition("/")[0]
    words = _words_in(name) if name.count("/") == 1 else (name.rpartition("/")[2],)
    return next((robots[word] for word in words if word in robots), None)


def _words_in(name: str) -> Iterator[str]:
    """Yield the last segment of a name, and what is before and after each ``_`` of it."""
    last = name.rpartition("/")[2]
    yield last
    for found in re.finditer("_", last):
        yield last[: found.start()]
        yield last[found.end() :]


def _plain_name(name: str, robot: GuessedRobot | None) -> str:
    """Return a name without the robot's namespace or name."""
    if robot is None:
        return name
    if robot.namespace and name.startswith(f"{robot.namespace}/"):
        return name.removeprefix(robot.namespace)
    bare = name.removesuffix(f"/{robot.name}").removesuffix(f"_{robot.name}")
    return bare.replace(f"/{robot.name}_", "/", 1) or name
