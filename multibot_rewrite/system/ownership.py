# SPDX-License-Identifier: Apache-2.0
"""Which robot a node, topic or frame belongs to, by the plan and by how its name is written."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import SENT_FRAMES, USUAL_FRAMES
from multibot_rewrite.system.records import HARDWARE_NODE, System

# What may separate a robot's name from the rest of a segment.
SEPARATORS = "_-."
NO_TAGS: Mapping[str, str] = {}
NO_WORDS: frozenset[str] = frozenset()


class NameOwnership(NamedTuple):
    """How the names of one sort, graph names or frames, show their robot.

    ``exact`` are planned names that belong to one robot, ``nodes`` the planned nodes, whose names
    begin their private names. A robot's tag is its name in these names, a namespace of several levels
    with its slashes: ``robots`` maps tags to robots, ``tags`` robots to tags where the tag is not the
    robot's name. ``ambiguous_words`` are
    tags that occur as an ordinary word as well (a robot ``scan``). ``robot_is_last`` says that the
    tag is at the end of a name; ``levels`` is the largest number of segments of a tag. A tag that is
    only a part of a segment counts if the rest is one of ``plain_names``, or if there are none:
    ``rover_2/lidar`` is a name of ``rover`` only if ``2/lidar`` is one that robots have.
    """

    exact: Mapping[str, str]
    nodes: Mapping[str, str]
    robots: Mapping[str, str]
    ambiguous_words: frozenset[str]
    robot_is_last: bool
    tags: Mapping[str, str] = NO_TAGS
    levels: int = 1
    plain_names: frozenset[str] = NO_WORDS

    def robot(self, name: str) -> str:
        """Return the robot that a name belongs to, or an empty string."""
        known = self.exact.get(name)
        if known is not None:
            return known
        above = name.rpartition("/")[0]
        while above:
            if above in self.nodes:
                return self.nodes[above]
            above = above.rpartition("/")[0]
        at_its_place = self.robot_at_its_place(name)
        if at_its_place:
            return at_its_place
        segments = name.strip("/").split("/")
        if len(segments) > 1 and (found := self._longest(segments)):
            return self.robots[found]
        found = self._longest(end for segment in segments for end in _ends(segment))
        robot = self.robots.get(found, "")
        once = self.without_robot(name, robot)
        # It may have the tag at both ends.
        is_known = not {once, self.without_robot(once, robot)}.isdisjoint(self.plain_names)
        return robot if is_known or not self.plain_names else ""

    def robot_at_its_place(self, name: str) -> str:
        """Return the robot whose (longest) tag is where this plan has tags, or an empty string."""
        segments = name.strip("/").split("/")
        if self.robot_is_last:
            return self.robots.get(segments[-1], "") if len(segments) > 1 else ""
        deepest = min(self.levels, len(segments) - 1)
        ways_in = ("/".join(segments[:count]) for count in range(deepest, 0, -1))
        return next((self.robots[it] for it in ways_in if it in self.robots), "")

    def _longest(self, parts: Iterable[str]) -> str:
        """Return the longest tag among the parts: ``arm_left`` rather than ``arm``."""
        found = (part for part in parts if part in self.robots and part not in self.ambiguous_words)
        return max(found, key=len, default="")

    def tag(self, robot: str) -> str:
        """Return the robot's name as these names have it."""
        return self.tags.get(robot, robot)

    def without_robot(self, name: str, robot: str) -> str:
        """Return the name without the robot's: ``/robot1/scan`` and ``/scan/robot1`` are ``/scan``."""
        tag = self.tags.get(robot, robot)
        if not tag or tag not in name:
            return name
        # Most are called so.
        if name.startswith(f"/{tag}/") and not self.robot_is_last:
            return name[len(tag) + 1 :]
        slash = "/" if name.startswith("/") else ""
        if "/" in tag:
            return slash + f"{name.strip('/')}/".removeprefix(f"{tag}/").rstrip("/")
        segments = name.strip("/").split("/")
        places = [at for at, segment in enumerate(segments) if segment == tag]
        if places and len(segments) > 1:
            del segments[places[-1 if self.robot_is_last else 0]]
        else:
            segments = [_without_tag(it, tag, self.robot_is_last) for it in segments]
        return slash + "/".join(segments)


NOBODYS = NameOwnership({}, {}, {}, frozenset(), False)


class Whose(NamedTuple):
    """The robots of a system, and the robot of a node, topic, service or action, or of a frame.

    It is empty where it is of no robot or of all. ``plain`` and ``plain_frame`` have the name
    without the robot's. ``of_names`` and ``of_frames`` are how a plan has it."""

    robots: tuple[str, ...]
    robot: Callable[[str], str]
    plain: Callable[[str], str]
    frame_robot: Callable[[str], str]
    plain_frame: Callable[[str], str]
    of_names: NameOwnership = NOBODYS
    of_frames: NameOwnership = NOBODYS


# Of a robot alone, which has no name in what it is called.
ALONE = Whose((), lambda _: "", lambda name: name, lambda _: "", lambda frame: frame)


def whose_by_plan(plan: System) -> Whose:
    """Return whose names are by a plan; what it has for all robots is nobody's."""
    names, frames = name_ownership(plan), frame_ownership(plan)
    shared = {*(it.name for it in plan.nodes if not it.robot), *plan.shared_topics}
    # All that is not everybody's is of a robot alone whose name is in no name.
    alone = plan.robots[0].name if is_alone(plan) else ""
    robot = cache(lambda name: "" if name in shared else alone or names.robot(name))
    frame_robot = cache(frames.robot)
    return Whose(
        tuple(sorted(it.name for it in plan.robots)),
        robot,
        cache(lambda name: names.without_robot(name, robot(name))),
        frame_robot,
        cache(lambda frame: frames.without_robot(frame, frame_robot(frame))),
        names,
        frames,
    )


def is_alone(plan: System) -> bool:
    """Return whether a plan is that of one robot, whose name no node or end has."""
    if len(plan.robots) != 1:
        return False
    word = plan.robots[0].space
    names = (*(it.name for it in plan.nodes), *(it.name for it in plan.ends))
    return bool(plan.nodes) and not any(word in name for name in names)


def without_name(plan: System) -> System:
    """Return the plan of a robot without its namespace: its nodes and names are in the root."""
    (robot,) = plan.robots
    space = f"/{robot.space}"

    def bare(name: str) -> str:
        return (name.removeprefix(space) or "/") if f"{name}/".startswith(f"{space}/") else name

    gaps = (
        it._replace(
            message=it.message.replace(f"{space}/", "/"),
            hint=it.hint.replace(f"{space}/", "/"),
            node=bare(it.node),
            names=tuple(map(bare, it.names)),
        )
        for it in plan.gaps
    )
    return renamed(plan, bare)._replace(gaps=tuple(gaps))


def renamed(system: System, new: Callable[[str], str]) -> System:
    """Return the system with its nodes, topics, services and actions under new names."""

    def new_name(name: str) -> str:
        return new(name) if name else name

    def new_names(names: Iterable[str]) -> tuple[str, ...]:
        return tuple(map(new_name, names))

    def with_new_names(records: Iterable[Any], *fields: str) -> tuple[Any, ...]:
        return tuple(
            it._replace(**{field: new_name(getattr(it, field)) for field in fields})
            for it in records
        )

    senders = (it._replace(senders=new_names(it.senders)) for it in system.topics)
    groups = (
        it._replace(sure=it.sure._replace(instead=new_names(it.sure.instead)))
        for it in system.nodes
    )
    edges = (it._replace(publishers=new_names(it.publishers)) for it in system.edges)
    return system._replace(
        nodes=with_new_names(groups, "name", "taker"),
        ends=with_new_names(system.ends, "name", "node"),
        edges=with_new_names(edges, "topic"),
        robots=with_new_names(system.robots, "tf_topic"),
        topics=with_new_names(senders, "name"),
        heard=with_new_names(system.heard, "topic"),
        descriptions=with_new_names(system.descriptions, "topic"),
        parameters=with_new_names(system.parameters, "node"),
        controllers=with_new_names(system.controllers, "manager"),
    )


def _ends(segment: str) -> Iterator[str]:
    """Yield what is before and after each separator of a segment."""
    for at, letter in enumerate(segment):
        if letter in SEPARATORS:
            yield segment[:at]
            yield segment[at + 1 :]


def _without_tag(segment: str, tag: str, is_last: bool) -> str:
    """Return the segment without the tag, which is at its other end only if it is not at this one."""
    before, after = segment.removesuffix(tag), segment.removeprefix(tag)
    ends = {True: (before, before.rstrip(SEPARATORS)), False: (after, after.lstrip(SEPARATORS))}
    found = (
        rest
        for with_separator, rest in (ends[is_last], ends[not is_last])
        if with_separator not in (segment, rest)
    )
    return next(found, segment)


def name_ownership(plan: System) -> NameOwnership:
    """Return the ownership of graph names: nodes, topics, services, actions."""
    nodes = {it.name: it.robot for it in plan.nodes if it.robot}
    planned = [(w.name, nodes[w.node]) for w in plan.ends if w.node in nodes]
    robots = {robot.space: robot.name for robot in plan.robots}
    tags = {robot.name: robot.namespace for robot in plan.robots if robot.namespace}
    tf = ((robot.tf_topic, robot.name) for robot in plan.robots)
    every = {*nodes.items(), *planned, *tf}
    last = _is_last((name, tags.get(robot, robot)) for name, robot in every)
    levels = max((space.count("/") + 1 for space in robots), default=1)
    draft = NameOwnership({}, nodes, robots, frozenset(), last, tags, levels)
    # The topics of which a plan says more, each with the robot whose tag is at its place there, or in
    # the topic that it is below: of /scan/a/points that of /scan/a.
    topics: dict[str, str] = {}
    for name in sorted(it.name for it in plan.topics):
        if robot := topics.get(name.rpartition("/")[0]) or draft.robot_at_its_place(name):
            topics[name] = robot
    draft = draft._replace(exact={**topics, **_of_one_robot((*nodes.items(), *planned))})
    words = _plain_words(plan, draft, topics)
    return draft._replace(ambiguous_words=frozenset(robots.keys() & words))


def _plain_words(plan: System, draft: NameOwnership, topics: Mapping[str, str]) -> set[str]:
    """Return the words in planned names, without the robots' own, that could be a robot's name."""
    nodes = draft.nodes
    likely = draft.robots.keys() & _segments_and_ends({w.code_name for w in plan.ends})
    # A node of all robots may name a robot's topic in its code, as a domain_bridge does.
    in_code = {
        (w.code_name, nodes.get(w.node) or draft.exact.get(w.code_name, ""))
        for w in plan.ends
        if likely
    }
    # A hardware component and its node have one name, with the robot's.
    parts = {(it.name, it.robot) for it in plan.nodes if it.known == HARDWARE_NODE}
    once = {draft.without_robot(*it) for it in (*in_code, *(nodes.items() - parts))}
    # Of what is below a link of its robot, the link has the robot's name, too.
    every = (*topics.items(), *parts)
    twice = {draft.without_robot(draft.without_robot(*it), it[1]) for it in every}
    return _segments_and_ends(once | twice)


def frame_ownership(plan: System) -> NameOwnership:
    """Return the ownership of tf frames."""
    declared = [(frame, robot.name) for robot in plan.robots for frame in robot.frames]
    others = ((frame, robot.name) for robot in plan.robots for frame in robot.other_frames)
    tags = {robot.name: robot.tag for robot in plan.robots if robot.tag}
    robots = {tags.get(robot.name, robot.name): robot.name for robot in plan.robots}
    tagged = [(frame, tags.get(robot, robot)) for frame, robot in declared]
    loose = {tag for frame, tag in tagged if not _is_glued(frame, tag)}
    is_glued = not loose.issuperset(tag for _, tag in tagged)
    # lidar_link of a robot link has no robot's name where others of its frames have none.
    last = _is_last(it for it in tagged if is_glued or it[1] in it[0].split("/"))
    exact = _of_one_robot((*declared, *others))
    # Robots with a tf topic each may have the same frames, whatever these are called.
    common = dict.fromkeys({frame for frame, _ in declared} - exact.keys(), "")
    draft = NameOwnership({**exact, **common}, {}, robots, frozenset(), last, tags)
    plain = frozenset((*(draft.without_robot(*pair) for pair in declared), *common))
    any_rest = is_glued or not plain
    return draft._replace(
        ambiguous_words=frozenset(robots.keys() & _segments_and_ends(plain)),
        plain_names=NO_WORDS if any_rest else plain.union(USUAL_FRAMES, SENT_FRAMES),
    )


def _is_glued(name: str, tag: str) -> bool:
    """Return whether the tag begins or ends a name without being a segment, as in robot1_base_link."""
    at_an_end = name.startswith(tag) or name.endswith(tag)
    return at_an_end and tag not in name.split("/") and _without_tag(name, tag, True) != name


def _of_one_robot(pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the names that belong to one robot only, with the robot."""
    found: dict[str, str] = {}
    of_several = set()
    for name, robot in pairs:
        if found.setdefault(name, robot) != robot:
            of_several.add(name)
    for name in of_several:
        del found[name]
    return found


def _is_last(names: Iterable[tuple[str, str]]) -> bool:
    """Return whether tags are more often at the end of names than at their beginning."""
    more = 0
    for name, tag in names:
        plain = name.strip("/")
        more += plain.endswith(tag) - plain.startswith(tag)
    return more > 0


def _segments_and_ends(names: Iterable[str]) -> set[str]:
    segments = {segment for name in names for segment in name.strip("/").split("/")}
    return segments.union(end for segment in segments for end in _ends(segment))
