# SPDX-License-Identifier: Apache-2.0
"""Faults that one robot's launch files have already: a fleet has them too, and is built."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Set
from functools import cache
from typing import NamedTuple

import yaml
from lxml import etree

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.checks.described import as_known
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.producers.launch.records import LaunchGraph, ParameterText
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import NO_TREE, launched
from multibot_rewrite.producers.launch.spawners import NO_MANAGER
from multibot_rewrite.rules.check import judge
from multibot_rewrite.rules.launch.judge import as_sure, judge_launch
from multibot_rewrite.rules.launch.started import no_type
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import System
from multibot_rewrite.system.tf_copies import tree_topic

_ALREADY = "launch files have it"
_SECOND = re.compile(r"_\d+$")
# A node with its role.
_Part = tuple[str, str]


class _Error(NamedTuple):
    """What is wrong: the code, the names without the robot's, and the nodes that have part."""

    code: str
    names: Set[str]
    parts: Set[_Part] = frozenset()


def as_the_vendor_has_it(
    plan: FleetPlan, seen: Index, found: Iterable[Finding], known: Knowledge
) -> Iterator[Finding]:
    """Yield the findings about a fleet; errors of one robot's launch files are warnings."""
    specs = {it.spec.name: it for it in plan.robots if it.spec.launch}
    alone = cache(lambda robot: _errors_of(specs[robot], seen, known))
    for it in found:
        # What names no robot, as the interfaces of its hardware, is asked of all.
        about = (_robots_of(it, seen) or specs.keys()) if it.level == ERROR else set[str]()
        robots = about & specs.keys()
        own = (
            _is_of_one_name(it, seen, specs[robot])
            or _is_error_of_robot(alone(robot), it, seen, robot)
            for robot in robots
        )
        if robots and all(own):
            yield as_known(it, _ALREADY)
        else:
            yield it


def as_in_the_vendors_files(plan: FleetPlan, found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings; errors of a launch's parameter file by itself are warnings."""
    launched_with = {
        os.path.realpath(path): path
        for robot in plan.robots
        for path in (robot.spec.related_files.get("params", ()) if robot.spec.launch else ())
    }
    alone = cache(lambda path: _errors_in(path, plan.file.distro))
    for it in found:
        path = launched_with.get(os.path.realpath(it.file)) if it.level == ERROR else None
        yield as_known(it, _ALREADY) if path and (it.code, it.line) in alone(path) else it


def _errors_in(path: str, release: str) -> Set[tuple[str, int]]:
    """Return code and line of each error in a parameter file by itself."""
    from multibot_rewrite.lint.check import lint_data
    from multibot_rewrite.rules.settings import Settings

    found = lint_data(path, read_file(path), Settings(distro=release, ros=ROS_2))
    return {(it.code, it.line) for it in found if it.level == ERROR}


def _errors_of(robot: RewrittenRobot, fleet: Index, known: Knowledge) -> list[_Error]:
    """Return the errors in the launch files of one robot."""
    # A publisher without a readable description gets the one of the fleet file.
    graph = launch_of(robot.spec.launch, robot.spec.words[0])
    started = launched(graph, known)
    if any(it.code == NO_TREE for it in started.system.environment.caveats):
        text = etree.tostring(robot.member.source.root, encoding="unicode")
        started = launched(_with_description(graph, text), known)
    alone = index(started.system, ALONE)
    every = (*judge_launch(started), *(as_sure(it, started, alone) for it in judge(alone)))
    found = []
    for it in (it for it in every if it.level == ERROR):
        parts = (part for own in _nodes_by_name(it, started.system).values() for part in own)
        found.append(_plain_error(it, fleet)._replace(parts=_plain_parts(parts, fleet)))
    return found


def _with_description(graph: LaunchGraph, text: str) -> LaunchGraph:
    values = {"/**": {"ros__parameters": {"robot_description": text}}}
    given = ParameterText("", yaml.safe_dump(values))
    nodes = (
        it._replace(parameters=(*it.parameters, given)) if it.executable == STATE_PUBLISHER else it
        for it in graph.nodes
    )
    return graph._replace(nodes=tuple(nodes))


def _is_error_of_robot(errors: Iterable[_Error], it: Finding, seen: Index, robot: str) -> bool:
    """Return whether a finding about a fleet is an error of this robot alone."""
    # Nodes of other robots, or outside its launch files, have no part in it.
    own = _plain_error(it, seen)
    # Where nothing starts a manager, nothing is wrong with its controllers.
    codes = (own.code, NO_MANAGER.code) if own.code == no_type.code else (own.code,)
    alike = [one for one in errors if one.code in codes and own.names <= one.names]
    known = {part for one in alike for part in one.parts}
    if not (own.names and alike):
        return False
    for parts in _nodes_by_name(it, seen.system).values():
        whose = {seen.robot(node) for _, node in parts}
        if robot in whose and not (whose <= {robot, ""} and _plain_parts(parts, seen) <= known):
            return False
    return True


def _is_of_one_name(it: Finding, seen: Index, robot: RewrittenRobot) -> bool:
    """Return whether launch files of a robot start the nodes of a finding under one name."""
    # In a fleet the second one has a number behind its name.
    nodes = [node for parts in _nodes_by_name(it, seen.system).values() for _, node in parts]
    names = {_SECOND.sub("", node.rpartition("/")[2]) for node in nodes}
    if len(names) != 1 or {seen.robot(node) for node in nodes} != {robot.spec.name}:
        return False
    started = launch_of(robot.spec.launch, robot.spec.words[0]).nodes
    return [node.name or node.executable for node in started].count(*names) > 1


def _robots_of(it: Finding, seen: Index) -> set[str]:
    """Return the robots that a finding is about, by its nodes or else by its names."""
    nodes = [node for parts in _nodes_by_name(it, seen.system).values() for _, node in parts]
    return {it.robot, *map(seen.robot, nodes or (it.node, *it.names))} - {""}


def _plain_error(it: Finding, fleet: Index) -> _Error:
    """Return code and names of an error, the names without the robot's."""
    # What is said of words begins with their node.
    names = it.names or (it.node or it.message,)
    plain = (fleet.plain(it) if it.startswith("/") else fleet.plain_frame(it) for it in names)
    return _Error(it.code, {*plain})


def _plain_parts(parts: Iterable[_Part], fleet: Index) -> set[_Part]:
    """Return pairs of role and node, the nodes without the robot's name."""
    return {(role, fleet.plain(node)) for role, node in parts}


def _nodes_by_name(it: Finding, system: System) -> Mapping[str, Set[_Part]]:
    """Return by each name of a finding (role, node) of what has it; of a frame its senders."""
    ends = ((end.name, (end.role, end.node)) for end in system.ends if end.name in it.names)
    edges = (edge for edge in system.edges if edge.child in it.names)
    sent = ((tree_topic(edge.topic), ("sends", node)) for edge in edges for node in edge.publishers)
    return sets_by_key((*ends, *sent))
