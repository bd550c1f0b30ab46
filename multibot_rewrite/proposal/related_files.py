# SPDX-License-Identifier: Apache-2.0
"""Chooses the related files that a description runs with, and the node sets in them.

Where several files are for the same thing (parameters of a node, an RViz config), the nearest is taken.
"""

import os
import re
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.producers.launch.known_node import lua_file
from multibot_rewrite.proposal.choosing import is_srdf_launched, loaded
from multibot_rewrite.proposal.launches import Bringup
from multibot_rewrite.proposal.looking import CLASSIC, GZ, NO_SIMULATOR, Looked
from multibot_rewrite.proposal.owners import (
    LEAST,
    Fitting,
    best_folders,
    check_winner,
    fitting,
    hundredths_known,
    moveit_of_others,
    names_shown,
    not_started,
    of_others,
)
from multibot_rewrite.proposal.searching import Found, known_names, text_of, without
from multibot_rewrite.related_files.yaml_text import read_yaml

# Of these kinds a robot has one file, of the others any number.
ONE = ("rviz", "bridge")
KINDS = ("params", "rviz", "bridge", "moveit", "behavior_trees")
_MANAGER = "controller_manager"
_CONTROL = {NO_SIMULATOR: "ros2_control", GZ: "gz_ros2_control", CLASSIC: "gazebo_ros2_control"}
_WORD = re.compile(r"[a-z0-9]+")
_MOVEIT, _UTILITIES = "move_group", "moveit_configs_utils"
# What of these makes a move_group.
_MAKE_MOVEIT = ("generate_demo_launch", "generate_move_group_launch")
# Kinds of which a node names the file that it reads.
_NAMED = ("rviz", "bridge", "behavior_trees")


class RelatedFiles(NamedTuple):
    """What goes with a description: files by kind, its SRDF, its node sets each with the reason.

    ``left`` are files of the same kind that were not taken, each with the reason.
    """

    files: Mapping[str, tuple[str, ...]]
    srdf: str
    node_sets: Mapping[str, str]
    left: Mapping[str, str]

    @property
    def paths(self) -> Iterator[str]:
        """All files; raises nothing."""
        yield from (path for its in self.files.values() for path in its)
        yield from filter(None, (self.srdf,))


def related_files_of(robot: Looked, found: Found, release: str) -> RelatedFiles:
    """Return the related files of a description, among those found."""
    left = of_others(robot, found)
    every = without(found, left)
    left |= _with_others_names(robot, every)
    found = without(every, left)
    kinds = (it for it in KINDS if it not in ("params", "moveit"))
    launching = (it.file for it, paths in loaded(found) if os.path.realpath(robot.path) in paths)
    own = {package_of(it) for it in (robot.path, *launching)}
    strange = _of_other_packages(found, own)
    left |= strange
    found = without(found, strange)
    files = {
        kind: tuple(_files_of_kind(kind, robot, getattr(found, kind), left, packages=own))
        for kind in kinds
    }
    sections = dict(_nodes_by_file(_fitting_files(robot, found, release, left), left))
    idle = _controllers_of_others(robot, sections)
    left |= idle
    if robot.simulator == NO_SIMULATOR:
        left |= dict.fromkeys(found.bridge, "the description has nothing for a simulator")
    files |= {"bridge": tuple(it for it in files["bridge"] if it not in left)}
    sections = {path: names for path, names in sections.items() if path not in idle}
    files["params"] = tuple(sections)
    srdf = _best_srdf(robot, found)
    left |= {it: "another SRDF was taken" for it in found.srdf if it != srdf}
    files["moveit"] = moveit_files(robot, srdf, every, left)
    nodes = {name: path for path, names in sections.items() for name in names}
    chosen = {kind: its for kind, its in files.items() if its}
    return RelatedFiles(chosen, srdf, dict(_node_sets(robot, nodes, srdf)), left)


def srdf_of(robot: Looked, found: Found) -> str:
    """Return the SRDF with most of the robot's names; empty for none."""
    named = without(found, {**of_others(robot, found), **_with_others_names(robot, found)})
    return _best_srdf(robot, named)


def _best_srdf(robot: Looked, found: Found) -> str:
    """Return the SRDF that launch files load, or the one with most of the robot's names."""
    near = _best_known(robot, found.srdf)
    return max(near, key=lambda it: is_srdf_launched(it, found), default="")


def _controllers_of_others(robot: Looked, sections: Mapping[str, frozenset[str]]) -> dict[str, str]:
    """Return controller files that nothing in the description needs, with the reason."""
    if robot.control:
        return {}
    reason = "no plugin of the simulated robot makes a controller manager"
    if robot.simulator == NO_SIMULATOR:
        reason = "the description has no <ros2_control>"
    return {path: reason for path, names in sections.items() if _MANAGER in names}


def moveit_files(robot: Looked, srdf: str, found: Found, left: dict[str, str]) -> tuple[str, ...]:
    """Return MoveIt's files of the best folder first; those ``left`` out get a reason there."""
    if not srdf:
        return ()
    left |= moveit_of_others(robot, srdf, found)
    every = tuple(it for it in found.moveit if it not in left)
    known = best_folders(robot, srdf, every)
    near = _files_of_kind("moveit", robot, every, left, lambda it: -known[os.path.dirname(it)])
    return tuple(near)


def _files_of_kind(
    kind: str,
    robot: Looked,
    every: Sequence[str],
    left: dict[str, str],
    rank: Callable[[str], int] = lambda _: 0,
    packages: Container[object] = (),
) -> Iterator[str]:
    """Yield the files of a kind, nearest first, one of equal base names or one in all."""
    # An RViz config of the robot's ``packages`` goes before others.
    taken: dict[str, str] = {}
    near = _nearest_first(robot, every)
    if kind == "rviz":
        near = sorted(_best_known(robot, every), key=lambda it: package_of(it) not in packages)
    for path in sorted(near, key=rank):
        key = kind if kind in ONE else os.path.basename(path)
        if key in taken:
            left[path] = f"{os.path.basename(taken[key])} of another folder was taken"
        else:
            taken[key] = path
            yield path


def _fitting_files(
    robot: Looked, found: Found, release: str, left: dict[str, str]
) -> Iterator[Fitting]:
    """Yield the readable parameter files, the likeliest first; raises Undecided."""
    # Named ones come first, then those with fewest names that the robot lacks, then the nearest.
    known = load_known_nodes("", release)
    loaded = {*_loaded_files(robot)}
    asked = {*filter(lambda it: it in found.meant or os.path.abspath(it) in loaded, found.params)}
    read = []
    for path in _nearest_first(robot, found.params):
        try:
            nodes = given_nodes([read_yaml(read_file(path), path)], known)
        except InputError as error:
            left[path] = str(error)
            continue
        apart = path not in asked and package_of(path) != package_of(robot.path)
        if apart and (why := not_started(path, nodes, known)):
            left[path] = why
            continue
        read.append(fitting(robot, path, nodes, known, found.bridge))
    meant = {it.path for it in read if it.path in asked}
    own = {path for path, before in found.follows if before == robot.path}
    order = sorted(read, key=lambda it: (it.path not in meant, it.path not in own, len(it.strange)))
    settled = {node for it in order if it.path in meant for node in it.nodes}
    check_winner([it for it in order if not it.nodes & settled], robot, found)
    yield from order


def _nodes_by_file(
    read: Iterable[Fitting], left: dict[str, str]
) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield parameter files and their nodes, without files that repeat a node of an earlier one."""
    before: dict[str, str] = {}
    for path, names, *_ in read:
        if again := sorted(names & before.keys()):
            left[path] = f"{os.path.basename(before[again[0]])} has parameters of {again[0]}, too"
            continue
        before |= dict.fromkeys(names, path)
        yield path, names


def _with_others_names(robot: Looked, found: Found) -> dict[str, str]:
    """Return SRDFs and RViz configs of which most names are not the robot's."""
    known = {it: hundredths_known(robot, it) for it in (*found.srdf, *found.rviz)}
    reason = "of its links and joints {} in a hundred are the robot's"
    return {it: reason.format(share) for it, share in known.items() if share < LEAST}


def _of_other_packages(found: Found, own: Collection[tuple[str, str] | None]) -> dict[str, str]:
    """Return RViz configs of packages that neither have nor launch the robot, nor show a link."""
    own = {*own, None}
    apart = (it for it in found.rviz if package_of(it) not in own and it not in found.meant)
    reason = "it is of a package that does not launch the robot"
    return {it: reason for it in apart if not names_shown(it)}


def _best_known(robot: Looked, paths: Sequence[str]) -> list[str]:
    """Return the paths sorted: those with most of the robot's names first, then the nearest."""
    return sorted(_nearest_first(robot, paths), key=lambda it: -hundredths_known(robot, it))


def _nearest_first(robot: Looked, paths: Sequence[str]) -> list[str]:
    """Return the paths: first those the description loads, then its package's, then similar."""
    words, home = set(_WORD.findall(robot.path.lower())), package_of(robot.path)
    loaded = set(_loaded_files(robot))

    def distance(path: str) -> tuple[bool, bool, int, int, str]:
        """Return the sort key of a path: loaded, in the package, alike in name."""
        like = len(words & set(_WORD.findall(path.lower())))
        first = os.path.abspath(path) not in loaded
        more = len(set(_WORD.findall(path.lower())) - words)
        return first, package_of(path) != home, -like, more, path

    return sorted(paths, key=distance)


def _loaded_files(robot: Looked) -> Iterator[str]:
    """Yield the parameter files that plugins of the description load."""
    for it in robot.root.iter("parameters") if robot.root is not None else ():
        yield os.path.abspath((it.text or "").strip())


def _node_sets(robot: Looked, nodes: Mapping[str, str], srdf: str) -> Iterator[tuple[str, str]]:
    """Yield (node set, reason) for each node set that a robot runs."""
    bare = {name.rpartition("/")[2]: path for name, path in nodes.items()}
    for node_set, with_, lacking in known_names()["node_sets"]:
        if set(with_) <= bare.keys() and not set(lacking) & bare.keys():
            first = with_[0]
            yield (
                node_set,
                f"{os.path.basename(bare[first])} has parameters of {' and '.join(with_)}",
            )
    if robot.control:
        node_set = _CONTROL[robot.simulator]
        where = bare.get(_MANAGER)
        why = f" and {os.path.basename(where)} has controllers" if where else ""
        yield node_set, f"the description has <ros2_control>{why}"
    elif robot.simulator == NO_SIMULATOR:
        yield "robot_state", "joint_state_publisher sends the joints until a driver does"
    if srdf:
        yield "moveit", f"there is {os.path.basename(srdf)}"


def related_files_launched(
    robot: Looked, bringup: Bringup, found: Found, release: str, asked: Mapping[str, str]
) -> RelatedFiles:
    """Return the files that a robot's launch file gives nodes, and those of ``asked`` node sets."""
    # Without the parameter files that a build finds there itself.
    graph = bringup.graph
    # The words and texts that nodes get, in which the files that they read are named.
    words = "\n".join((*(word for it in graph.nodes for word in it.arguments), *graph.texts))

    def is_read(path: str) -> bool:
        """Return whether the launch file gives this file to a node, or the user named it."""
        return path in found.meant or os.path.realpath(path) in words

    files = {kind: [*filter(is_read, getattr(found, kind))] for kind in _NAMED}
    files["rviz"] = [*{os.path.basename(it): it for it in reversed(files["rviz"])}.values()][::-1]
    files["lua"] = [*filter(os.path.isfile, (lua_file(it.arguments) for it in graph.nodes))]
    lost = [it for it in graph.includes if not os.path.isabs(it.file)]
    handed = "\n".join(value for it in lost for _, value in it.arguments)
    params = [it for it in found.params if it in found.meant or os.path.realpath(it) in handed]
    params += (
        _files_of_sets(related_files_of(robot, found, release), asked, release) if asked else []
    )
    starts = any(it.executable == _MOVEIT for it in graph.nodes)
    # A launch file may start a move_group by a package that is not here.
    texts = (text_of(it) for it in (bringup.order.file, *(one.file for one in graph.includes)))
    makes = any(word in text for text in texts for word in _MAKE_MOVEIT)
    srdf = ""
    if starts or makes:
        read = {it.file for it in graph.read}
        own = tuple(it for it in found.srdf if os.path.realpath(it) in read) or found.srdf
        srdf = srdf_of(robot, found._replace(srdf=own))
        files["moveit"] = [*moveit_files(robot, srdf, found, {})]
    why = f"{bringup.name} starts it by {_UTILITIES}, which is not installed here"
    node_sets = {"moveit": why} if srdf and not starts else {}
    files["params"] = [*dict.fromkeys(params)]
    kept = {kind: tuple(its) for kind, its in files.items() if its}
    return RelatedFiles(kept, srdf, {**node_sets, **asked}, {})


def _files_of_sets(guessed: RelatedFiles, node_sets: Mapping[str, str], release: str) -> list[str]:
    """Return the parameter files that have a node of the node sets."""
    nodes = {os.path.basename(it.name) for one in node_sets for it in load_node_set(one, release)}
    every = guessed.files.get("params", ())
    return [it for it in every if any(f"{name}:" in text_of(it) for name in nodes)]
