"""Whose a name is: the robot that a node, topic or frame belongs to, by the plan and its spelling."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.graph.expectation import Expectation

# What may stand between a robot's name and the rest of a segment.
JOINTS = "_-."
NO_SPELLINGS: Mapping[str, str] = {}


class Owners(NamedTuple):
    """The robots as names of one sort hold them: graph names, or frames.

    ``exact`` are the planned names that are one robot's, ``nodes`` those whose names are put before
    private ones. ``robots`` maps what stands for a robot in the names to the robot. ``words`` are
    those of them that are words of the names themselves (a robot ``scan``). ``last`` tells that a
    robot's name stands at the end. ``spellings`` maps robots to what stands for them, where that is
    another word than their name.
    """

    exact: Mapping[str, str]
    nodes: Mapping[str, str]
    robots: Mapping[str, str]
    words: frozenset[str]
    last: bool
    spellings: Mapping[str, str] = NO_SPELLINGS

    def of(self, name: str) -> str:
        """The robot of a name, or an empty string."""
        known = self.exact.get(name)
        if known is not None:
            return known
        above = name.rpartition("/")[0]
        while above:
            if above in self.nodes:
                return self.nodes[above]
            above = above.rpartition("/")[0]
        return self._by_spelling(name)

    def _by_spelling(self, name: str) -> str:
        segments = name.strip("/").split("/")
        if len(segments) > 1:
            place = segments[-1 if self.last else 0]
            found = place if place in self.robots else self._longest(segments)
            if found:
                return self.robots[found]
        found = self._longest(end for segment in segments for end in _ends(segment))
        return self.robots.get(found, "")

    def _longest(self, parts: Iterable[str]) -> str:
        """``arm_left`` rather than ``arm``."""
        found = (part for part in parts if part in self.robots and part not in self.words)
        return max(found, key=len, default="")

    def spelled(self, robot: str) -> str:
        """What stands for the robot in these names."""
        return self.spellings.get(robot, robot)

    def bare(self, name: str, robot: str) -> str:
        """The name without the robot's: ``/robot1/scan`` and ``/scan/robot1`` are ``/scan``."""
        robot = self.spelled(robot)
        if not robot or robot not in name:
            return name
        lead = "/" if name.startswith("/") else ""
        segments = name.strip("/").split("/")
        there = [at for at, segment in enumerate(segments) if segment == robot]
        if there and len(segments) > 1:
            del segments[there[-1 if self.last else 0]]
        else:
            segments = [_without(segment, robot) for segment in segments]
        return lead + "/".join(segments)


def _ends(segment: str) -> Iterator[str]:
    """What stands before and after each joint of a segment."""
    for at, letter in enumerate(segment):
        if letter in JOINTS:
            yield segment[:at]
            yield segment[at + 1 :]


def _without(segment: str, robot: str) -> str:
    after, before = segment.removeprefix(robot), segment.removesuffix(robot)
    if after != segment and after.startswith(tuple(JOINTS)):
        return after.lstrip(JOINTS)
    if before != segment and before.endswith(tuple(JOINTS)):
        return before.rstrip(JOINTS)
    return segment


def one_less(name: str, robot: str) -> Iterator[str]:
    """The name with the robot's taken off one of its ends, as often as that can be done."""
    for joint in ("/", *JOINTS, ""):
        if name.startswith(robot + joint):
            yield name[len(robot + joint) :]
        if name.endswith(joint + robot):
            yield name[: -len(joint + robot)]


def name_owners(plan: Expectation) -> Owners:
    """The owners of graph names."""
    nodes = {node: robot.name for robot in plan.robots for node in robot.nodes}
    planned = ((w.name, nodes[w.node]) for w in plan.endpoints if w.node in nodes)
    robots = {robot.name: robot.name for robot in plan.robots}
    last = _last((name, robot.name) for robot in plan.robots for name in (*robot.nodes, robot.tf))
    draft = Owners(_single((*nodes.items(), *planned)), nodes, robots, frozenset(), last)
    return draft._replace(words=frozenset(robots.keys() & _words(plan, draft)))


def _words(plan: Expectation, draft: Owners) -> set[str]:
    """The words of names and nodes without their own robot's name, as far as they may be robots."""
    nodes = draft.nodes
    likely = draft.robots.keys() & _parts({w.asked for w in plan.endpoints})
    asked = {(w.asked, nodes.get(w.node, "")) for w in plan.endpoints if likely}
    return _parts({draft.bare(name, robot) for name, robot in (*asked, *nodes.items())})


def frame_owners(plan: Expectation) -> Owners:
    """The owners of tf frames."""
    declared = [(frame, robot.name) for robot in plan.robots for frame in robot.frames]
    others = ((frame, robot.name) for robot in plan.robots for frame in robot.other_frames)
    spellings = {robot.name: robot.spelled for robot in plan.robots if robot.spelled}
    robots = {spellings.get(robot.name, robot.name): robot.name for robot in plan.robots}
    last = _last((frame, spellings.get(robot, robot)) for frame, robot in declared)
    exact = _single((*declared, *others))
    draft = Owners(exact, {}, robots, frozenset(), last, spellings)
    # The descriptions are one: the first robot's frames are enough.
    bare = (draft.bare(*pair) for pair in declared if pair[1] == declared[0][1])
    return draft._replace(words=frozenset(robots.keys() & _parts(bare)))


def _single(pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """The names that are one robot's only."""
    found: dict[str, str] = {}
    for name, robot in pairs:
        if found.setdefault(name, robot) != robot:
            found[name] = ""
    return {name: robot for name, robot in found.items() if robot}


def _last(names: Iterable[tuple[str, str]]) -> bool:
    """Whether the robots' names end more of their names than they begin."""
    bare = ((name.strip("/"), robot) for name, robot in names)
    return sum(name.endswith(robot) - name.startswith(robot) for name, robot in bare) > 0


def _parts(names: Iterable[str]) -> set[str]:
    segments = {segment for name in names for segment in name.strip("/").split("/")}
    return segments.union(end for segment in segments for end in _ends(segment))
