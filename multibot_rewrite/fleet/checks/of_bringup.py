# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the launch files of one robot already, as its vendor starts them: a fleet of such
robots has it as well, and is built."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Set
from functools import cache

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched
from multibot_rewrite.rules.check import judge
from multibot_rewrite.rules.launch.judge import as_sure, judge_launch
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import System
from multibot_rewrite.system.tf_copies import tree_topic

_ALREADY = "the robot's own launch files have it for one robot, too"
_SENDS = "sends"
_WITH_A_NAME = 2
# A node with its role.
_Part = tuple[str, str]
# A code, and names without the robot's.
_Key = tuple[str, ...]


def as_the_vendor_has_it(
    plan: FleetPlan, seen: Index, found: Iterable[Finding], known: Knowledge
) -> Iterator[Finding]:
    """Yield the findings about a fleet (``seen``); an error that the launch files of one robot have by
    themselves, between the same nodes, is a warning. What only several robots have stays an error."""
    specs = {it.spec.namespace: it.spec for it in plan.robots if it.spec.launch}
    alone = cache(lambda robot: _errors_of(specs[robot], seen, known))
    for it in found:
        # What names no robot, as the interfaces of its hardware, is asked of all.
        about = (_robots(it, seen) or specs.keys()) if it.level == ERROR else set[str]()
        robots = about & specs.keys()
        if robots and all(_is_in(alone(robot), it, seen, robot) for robot in robots):
            yield _as_known(it)
        else:
            yield it


def as_in_the_vendors_files(plan: FleetPlan, found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings about a fleet; an error in a parameter file that goes with the launch files of
    a robot, which that file has by itself, is a warning."""
    launched_with = {
        os.path.realpath(path): path
        for robot in plan.robots
        for path in (robot.spec.companions.get("params", ()) if robot.spec.launch else ())
    }
    alone = cache(lambda path: _errors_in(path, plan.file.distro))
    for it in found:
        path = launched_with.get(os.path.realpath(it.file)) if it.level == ERROR else None
        yield _as_known(it) if path and (it.code, it.line) in alone(path) else it


def _errors_in(path: str, release: str) -> Set[tuple[str, int]]:
    from multibot_rewrite.lint.check import lint_data
    from multibot_rewrite.rules.settings import Settings

    found = lint_data(path, read_file(path), Settings(distro=release, ros=ROS_2))
    return {(it.code, it.line) for it in found if it.level == ERROR}


def _as_known(it: Finding) -> Finding:
    hint = f"{it.hint}; {_ALREADY}" if it.hint else _ALREADY
    return it._replace(level=WARNING, hint=hint)


def _errors_of(robot: RobotSpec, fleet: Index, known: Knowledge) -> Mapping[_Key, Set[_Part]]:
    """Return what is an error in the launch files of one robot, each with the nodes that have part."""
    started = launched(launch_of(robot.launch, robot.words[0]), known)
    alone = index(started.system, ALONE)
    every = (*judge_launch(started), *(as_sure(it, started, alone) for it in judge(alone)))
    found: dict[_Key, set[_Part]] = defaultdict(set)
    for it in (one for one in every if one.level == ERROR):
        parts = (part for own in _parts(it, started.system).values() for part in own)
        found[_key(it, fleet)].update(_plain(parts, fleet))
    return dict(found)


def _is_in(errors: Mapping[_Key, Set[_Part]], it: Finding, seen: Index, robot: str) -> bool:
    """Is a finding about a fleet one of the errors of this robot alone? Nodes of other robots have no
    part in it, nor nodes that its own launch files do not start."""
    key = _key(it, seen)
    if len(key) < _WITH_A_NAME or key not in errors:
        return False
    for parts in _parts(it, seen.system).values():
        whose = {seen.robot(node) for _, node in parts}
        if robot in whose and not (whose <= {robot, ""} and _plain(parts, seen) <= errors[key]):
            return False
    return True


def _robots(it: Finding, seen: Index) -> set[str]:
    """Return the robots that a finding is about, by its nodes or else by its names."""
    nodes = [node for parts in _parts(it, seen.system).values() for _, node in parts]
    return {it.robot, *map(seen.robot, nodes or (it.node, *it.names))} - {""}


def _key(it: Finding, fleet: Index) -> _Key:
    names = it.names or ((it.node,) if it.node else ())
    plain = (fleet.plain(it) if it.startswith("/") else fleet.plain_frame(it) for it in names)
    return (it.code, *sorted(plain))


def _plain(parts: Iterable[_Part], fleet: Index) -> set[_Part]:
    return {(role, fleet.plain(node)) for role, node in parts}


def _parts(it: Finding, system: System) -> Mapping[str, Set[_Part]]:
    """Return the nodes that have what a finding names: by name, transforms by their tf topic."""
    found: dict[str, set[_Part]] = defaultdict(set)
    for end in (end for end in system.ends if end.name in it.names):
        found[end.name].add((end.role, end.node))
    for edge in (edge for edge in system.edges if edge.child in it.names):
        found[tree_topic(edge.topic)] |= {(_SENDS, node) for node in edge.publishers}
    return found
