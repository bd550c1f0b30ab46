# SPDX-License-Identifier: Apache-2.0
"""Takes two robots of each sort of a built fleet: faults of its files show there.

Robots are of one sort where the files, the part of the launch file and the part of the plan of one are
those of the other with its own words put in; numbers may differ as their poses do. A fault in one file
makes its robot a sort of its own. What two robots of a sort do to each other, any two of them do.
"""

import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec
from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.outputs.output_file import PLAN, OutputFile
from multibot_rewrite.producers.launch.records import LaunchGraph
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import System

# What two robots do to each other needs two of them.
_OF_EACH = 2
_FUNCTION = re.compile(r"(?m)^def start_(\w+)\(\):\n(?:(?:[ ].*)?\n)*")
# The table of the launch file: what starts each robot.
_TABLE = "\nROBOTS = {\n"
_ROW = re.compile(r"""(?m)^    ['"](\w+)['"]: .*,\n""")
_PLANNED = re.compile(r"(?m)^- name: ([^\s/]\S*)\n(?:  .*\n)+")
_FILE = re.compile(r"""(?:file|text)\(['"]([^'"\n]+)['"]\)""")
_NUMBER = re.compile(r"(?<![\w.])(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)(?![\w.])")
# The read-back looks for an RViz config, and not into it.
_NOT_READ = (".rviz",)


class _Sort(NamedTuple):
    """All texts of a robot with marks in the place of its words, and where it starts."""

    texts: tuple[str, ...]
    pose: Pose


class Sample(NamedTuple):
    """The outputs with two robots of each sort; ``left`` are the words of the others.

    ``alike`` has for each robot that stays those of its sort, its own name first."""

    made: Outputs
    left: frozenset[str] = frozenset()
    alike: Mapping[str, tuple[str, ...]] = {}


def two_of_each(made: Outputs, robots: Sequence[RobotSpec]) -> Sample:
    """Return the sample; all robots if launch file and plan do not have one part for each."""
    words = {word for it in robots for word in it.words}
    cut = ((word, it.start()) for word in words for it in re.finditer("[_/]", word))
    # Names of two robots could be one, such as those of ``arm`` and ``arm_left``.
    is_within = any(word[:at] in words or word[at + 1 :] in words for word, at in cut)
    if len(robots) <= _OF_EACH or is_within:
        return Sample(made)
    files = {it.path: it for it in made.files}
    launch, plan = (files[it].text if it in files else "" for it in (LAUNCH, PLAN))
    parts, plans = _parts_by_name(_FUNCTION, launch), _parts_by_name(_PLANNED, plan)
    rows = _parts_by_name(_ROW, launch.partition(_TABLE)[2])
    sorts: list[_Sort] = []
    of_sort: dict[int, list[RobotSpec]] = defaultdict(list)
    for it in robots:
        row, part = rows.get(it.name, ""), parts.get(it.name, "")
        is_whole = bool(part) == (f"start_{it.name}" in row)
        if not (row and is_whole and it.name in plans):
            return Sample(made)
        own = _sort_of(it, (row, part, plans[it.name]), files)
        at = next((at for at, one in enumerate(sorts) if _are_alike(one, own)), len(sorts))
        sorts += [own] if at == len(sorts) else []
        of_sort[at].append(it)
    left = [it for several in of_sort.values() for it in several[_OF_EACH:]]
    alike: dict[str, tuple[str, ...]] = {}
    for names in ([it.name for it in one] for one in of_sort.values()):
        alike |= {it: tuple(dict.fromkeys((it, *names))) for it in names[:_OF_EACH]}
    return Sample(_without(made, left), frozenset(word for it in left for word in it.words), alike)


def names_one_of(graph: LaunchGraph, words: Collection[str]) -> bool:
    """Return whether one of the words is in what the launch gives to a node."""
    every = "|".join(map(re.escape, sorted(words, reverse=True)))
    found = re.compile(rf"(?<![A-Za-z0-9])(?:{every})(?![A-Za-z0-9])")
    texts = {it.text for _, it in graph.files}
    for node in graph.nodes:
        texts.update((node.name, node.namespace, node.container, *node.arguments))
        texts.update(text for pair in node.remappings for text in pair)
        texts.update(it.text for it in node.parameters)
    return any(map(found.search, texts))


def _parts_by_name(pattern: re.Pattern[str], text: str) -> dict[str, str]:
    return {it[1]: it[0] for it in pattern.finditer(text)}


def _sort_of(it: RobotSpec, parts: Iterable[str], files: Mapping[str, OutputFile]) -> _Sort:
    """Return what tells sorts of robots apart: its files and parts without its own words, its pose."""
    named = {path for part in parts for path in _FILE.findall(part) if path in files}
    own = sorted({*named, *(path for path in files if path.startswith(f"{it.name}/"))})
    texts = (files[path].text for path in own if not path.endswith(_NOT_READ))
    marks: dict[str, str] = {}
    for at, word in enumerate((*it.words, it.model)):
        marks.setdefault(word, f"\0{at}\0")
    longest = sorted(filter(None, marks), key=len, reverse=True)
    words = re.compile("|".join(map(re.escape, longest)))
    every = (*own, *parts, *texts)
    return _Sort(tuple(words.sub(lambda one: marks[one[0]], text) for text in every),
                 it.pose or Pose())  # fmt: skip


def _are_alike(one: _Sort, other: _Sort) -> bool:
    poses = set(zip(one.pose, other.pose, strict=True))
    if len(one.texts) != len(other.texts):
        return False
    pairs = zip(one.texts, other.texts, strict=True)
    return all(ours == theirs or _same_but_pose(poses, ours, theirs) for ours, theirs in pairs)


def _same_but_pose(poses: Collection[tuple[float, float]], one: str, other: str) -> bool:
    """Return whether two texts are equal except for numbers of the poses."""
    ours, theirs = _NUMBER.split(one), _NUMBER.split(other)
    if len(ours) != len(theirs) or ours[::2] != theirs[::2]:
        return False
    pairs = zip(ours[1::2], theirs[1::2], strict=True)
    return all(a == b or (float(a), float(b)) in poses for a, b in pairs)


def _without(made: Outputs, left: Sequence[RobotSpec]) -> Outputs:
    """Return the outputs without some robots."""
    names = {it.name for it in left}
    files = [it for it in made.files if it.path.partition("/")[0] not in names]

    def unless_left_out(one: re.Match[str]) -> str:
        return "" if one[1] in names else one[0]

    for at, it in enumerate(files):
        if it.path == LAUNCH:
            above, table, rows = _FUNCTION.sub(unless_left_out, it.text).partition(_TABLE)
            files[at] = it._replace(
                data=f"{above}{table}{_ROW.sub(unless_left_out, rows)}".encode()
            )
    planned = _plan_without(made.planned, names)
    return made._replace(files=tuple(files), planned=planned) if left else made


def _plan_without(plan: System, robots: Collection[str]) -> System:
    """Return the plan without some robots, and without what only they have."""
    names = {it.name for it in plan.nodes if it.robot in robots}
    gone: dict[str, bool] = defaultdict(lambda: True)
    for it in plan.ends:
        gone[it.name] &= it.node in names
    # A bridge may bring a topic that no planned node has an end of.
    if others := {it.name for it in plan.topics} - gone.keys():
        owner = whose_by_plan(plan).robot
        gone |= {it: owner(it) in robots for it in others}

    def of_other_nodes(records: Iterable[Any]) -> tuple[Any, ...]:
        return tuple(it for it in records if it.node not in names)

    return plan._replace(
        nodes=tuple(it for it in plan.nodes if it.robot not in robots),
        ends=of_other_nodes(plan.ends),
        edges=tuple(it for it in plan.edges if not it.publishers or not names >= {*it.publishers}),
        robots=tuple(it for it in plan.robots if it.name not in robots),
        topics=tuple(it for it in plan.topics if not gone[it.name]),
        parameters=of_other_nodes(plan.parameters),
        controllers=tuple(it for it in plan.controllers if it.manager not in names),
        interfaces=of_other_nodes(plan.interfaces),
        lookups=of_other_nodes(plan.lookups),
        addresses=of_other_nodes(plan.addresses),
    )
