# SPDX-License-Identifier: Apache-2.0
"""Adds the files that launch files name: parameter files and the namespaces of bridges.

Clearpath starts the bridge of each sensor in NAMESPACE/sensors (clearpath_generator_gz
launch/sensors.py): relative ROS names of its file are there."""

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from textwrap import indent
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Policy
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.fleet.file.fleet_file import BRINGUP, FleetFile
from multibot_rewrite.fleet.file.robot_spec import REAL, RobotSpec
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.fleet.outputs.output_file import yaml_of
from multibot_rewrite.producers.launch.bridges import files_in, made_files, rows_in_words
from multibot_rewrite.producers.launch.handed_on import for_any, for_robot, handed_on
from multibot_rewrite.producers.launch.of_robot import is_of_robot
from multibot_rewrite.producers.launch.programs import once_for_all
from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.producers.launch.several_robots import without
from multibot_rewrite.related_files.params.sections import raw_sections
from multibot_rewrite.system.records import Place

PARAMS = "params"
# What launch_ros fills in a file with allow_substs.
_SUBSTITUTED = "$(var "
_MAPS, _SERVER = "nav2_map_server", "map_server"
NOT_REWRITTEN = declare("MF824", "launched-parameters-not-rewritten", NOTE, formats=("fleet",))


class _Named(NamedTuple):
    """A file that a launch names, the node's text of it, its place, and the robot in its names."""

    path: str
    text: str
    place: Place
    robot: str


def with_launched_files(file: FleetFile) -> tuple[FleetFile, Mapping[str, Sequence[Finding]]]:
    """Return the fleet with parameter files that only launch files name, and notes by robot."""
    # Robots with the same launch files have those of the first.
    first = {it.launch: it for it in reversed(file.robots) if it.launch}
    named = {launch: tuple(_named_files(spec)) for launch, spec in first.items()}
    found = [_with_files(it, named.get(it.launch, ())) for it in file.robots]
    bridged = {launch: _bridge_rows(spec) for launch, spec in first.items()}
    robots = tuple(_with_bridges(it, *bridged.get(it.launch, ({}, ()))) for it, _ in found)
    return file._replace(robots=robots), {it.name: notes for it, notes in found}


def _named_files(spec: RobotSpec) -> Iterator[_Named]:
    """Yield the parameter files that launch files name and that exist, each once."""
    seen: set[str] = set()
    graph = launch_of(spec.launch, spec.words[0])
    robot = graph.robots[0] if graph.robots else ""
    for given, place in ((it, node.place) for node in graph.nodes for it in _given_to(node)):
        if given.source and given.source not in seen and _sets_parameters(given.source):
            yield _Named(given.source, given.text, place, robot)
        seen.add(given.source)


def _given_to(node: LaunchedNode) -> Iterator[ParameterText]:
    """Yield the parameter files of a node, and those given to a launch file that is missing here."""
    yield from node.parameters
    for word in node.arguments if node.process.is_include else ():
        path = os.path.realpath(word.partition(":=")[2])
        if path.endswith((".yaml", ".yml")) and os.path.isfile(path):
            yield ParameterText(path, yaml_of(path).text, path)


def _bridge_rows(spec: RobotSpec) -> tuple[dict[str, str], tuple[str, ...]]:
    """Return texts of bridge rows for any robot, by the files that have or make them; other files."""
    words = {*spec.words, *(it.strip("/") for one in spec.launch for _, it in one.arguments)}
    found: dict[str, str] = {}
    nodes = launch_of(spec.launch, spec.words[0]).nodes
    for it in sorted(nodes, key=lambda one: one.place):
        program, above = f"{it.package}/{it.executable}", _below(it, words)
        if rows := rows_in_words(program, it.arguments, it.remappings, above):
            text = found.get(it.place.file, "")
            gap = "\n" * max(it.place.line - 1 - text.count("\n"), 0)
            found[it.place.file] = f"{text}{gap}{rows}"
        found |= made_files(it)
    files = dict.fromkeys(file for it in nodes for file in files_in(it))
    return for_any(found, spec.words[0]), tuple(filter(os.path.isfile, files))


def _with_bridges(spec: RobotSpec, found: Mapping[str, str], files: Sequence[str]) -> RobotSpec:
    """Return the robot with what its launch files bridge, and the files that exist of it."""
    own = spec.related_files.get("bridge", ())
    there = {os.path.realpath(it) for it in own}
    own = (*own, *(it for it in files if os.path.realpath(it) not in there), *found)
    if spec.simulator == REAL or own == spec.related_files.get("bridge", ()):
        return spec
    related_files = {**spec.related_files, "bridge": own}
    filled = for_robot(found, spec.words[0]).items()
    return spec._replace(related_files=related_files, filled=(*spec.filled, *filled))


def _sets_parameters(path: str) -> bool:
    try:
        return bool(raw_sections(yaml_of(path)))
    except InputError:
        return False


def _with_files(spec: RobotSpec, named: Sequence[_Named]) -> tuple[RobotSpec, list[Finding]]:
    """Return the robot with the files that it lacked, and notes of those that are left out."""
    own, filled, notes = list(spec.related_files.get(PARAMS, ())), [], []
    written = filter(None, (spec.description, spec.srdf, spec.simulated))
    beside = (path for paths in spec.related_files.values() for path in paths)
    taken = {os.path.basename(it): it for it in (*written, *beside)}
    for it in named:
        there = taken.setdefault(os.path.basename(it.path), it.path)
        whole = yaml_of(it.path).text
        text = without(whole, it.robot) if it.robot else whole
        above = _key_around(it, whole) if it.text != whole else ""
        if above and above not in spec.words:
            text = f"{above}:\n{indent(text, '  ')}"
        where = {"file": it.place.file, "line": it.place.line}
        if os.path.realpath(there) != it.path:
            message = f"the launch gives a node {it.path}; {there} is rewritten in its place"
            hint = "give the launch what is written for the robot, or give one of them another name"
            notes.append(NOT_REWRITTEN.finding(message, hint, **where))
        elif _SUBSTITUTED not in text or _is_filled(it, text, spec):
            own += [] if there in own else [there]
            made = it.text if _SUBSTITUTED in text else text
            filled += [(there, made)] if made != whole else []
        elif there not in own:
            message = f"the launch fills {_SUBSTITUTED}...) in {it.path}; it is not rewritten"
            hint = "write it out for one robot without a prefix, and list that file under params"
            notes.append(NOT_REWRITTEN.finding(message, hint, level=WARNING, **where))
    related_files = {**spec.related_files, PARAMS: tuple(own)} if own else spec.related_files
    return spec._replace(related_files=related_files, filled=(*spec.filled, *filled)), notes


def _key_around(it: _Named, text: str) -> str:
    """Return the key that a launch puts around a file's sections (``root_key``); empty without one."""
    above, own = load_yaml(it.text, it.path), load_yaml(text, it.path)
    key = next(iter(above), "") if isinstance(above, dict) and isinstance(own, dict) else ""
    inside = above[key] if key else None
    return str(key) if isinstance(inside, dict) and own.keys() == inside.keys() else ""


def _is_filled(it: _Named, text: str, spec: RobotSpec) -> bool:
    """Return whether a launch fills a file line by line, all of it and with no word of the robot."""
    same = len(it.text.splitlines()) == len(text.splitlines())
    named = {word for word in spec.words if word in it.text and word not in text}
    return same and not named and _SUBSTITUTED not in it.text


def with_one_map(file: FleetFile) -> FleetFile:
    """Return the fleet with the topics of launched map servers among those of all robots."""
    # Robots with different maps have a server each, as nav2_bringup starts it.
    maps = sets_by_key(row for spec in file.robots for row in _maps(spec))
    apart = {it for it in maps if len(maps[it]) > 1 or file.params_style == BRINGUP}
    own = tuple(dict.fromkeys((*file.own_nodes, *sorted(apart))))
    topics = [topic for it in maps if it not in own for _, topic in maps[it]]
    if not topics:
        return file._replace(own_nodes=own)
    shared = dict.fromkeys((*file.policy.get("shared_topics", SHARED_TOPICS), *topics))
    policy: Policy = {**file.policy, "shared_topics": tuple(shared)}
    return file._replace(own_nodes=own, policy=policy)


def _maps(spec: RobotSpec) -> Iterator[tuple[str, tuple[object, str]]]:
    """Yield (name, (map, topic from the root)) of map servers outside the robot's namespace."""
    words = {*spec.words, *(it.strip("/") for one in spec.launch for _, it in one.arguments)}
    for it in launch_of(spec.launch, spec.words[0]).nodes if spec.launch else ():
        if it.package == _MAPS and once_for_all(it) and not is_of_robot(it.namespace, words):
            name = it.name or _SERVER
            told = handed_on(it, name).values
            topic = str(told.get("topic_name", "map"))
            yield name, (told.get("yaml_filename"), expand(topic, it.namespace, name))


_PACKAGES = ("ros_gz_bridge", "ros_ign_bridge")


def with_bridge_namespaces(file: FleetFile) -> FleetFile:
    """Return the fleet with the namespaces that launch files give to bridges, where it has none."""
    # A file of the launch is the robot's of the same name, as for parameter files.
    # A launch file may be written for one of the robots.
    robots = {word for it in file.robots for word in it.words}
    return file._replace(robots=tuple(_with_namespaces(it, robots) for it in file.robots))


def _with_namespaces(spec: RobotSpec, robots: Collection[str]) -> RobotSpec:
    """Return the robot with the namespaces that launch files give to its bridges."""
    files = spec.related_files.get("bridge", ())
    if spec.bridge_namespace or not (files and spec.launch):
        return spec
    values = (value.strip("/") for it in spec.launch for _, value in it.arguments)
    words = {*robots, *filter(None, values)}
    nodes = (it for it in launch_of(spec.launch, spec.name).nodes if it.package in _PACKAGES)
    told = {
        os.path.basename(name): _below(it, words)
        for it in nodes
        for name in (*files_in(it), *made_files(it))
    }
    found = ((path, told.get(os.path.basename(path), "")) for path in files)
    return spec._replace(bridges_below=tuple((path, below) for path, below in found if below))


def _below(node: LaunchedNode, words: Collection[str]) -> str:
    """Return a launched node's namespace below the robot's."""
    own = node.namespace.strip("/")
    for word in sorted(words, key=len, reverse=True):
        if f"{own}/".startswith(f"{word}/"):
            return own[len(word) + 1 :]
    return own
