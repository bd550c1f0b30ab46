"""The files beside a description -> those that it runs with, and the stacks that they say.

Where several files are for the same thing (parameters of a node, an RViz config), the nearest is taken.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.proposal.looking import CLASSIC, GZ, NO_SIMULATOR, Looked
from multibot_rewrite.fleet.proposal.owners import moveit_of_others, of_others
from multibot_rewrite.fleet.proposal.searching import Found, without
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.evidence.parameter_files import given_nodes

# Of these kinds a robot has one file, of the others any number.
ONE = ("rviz", "bridge")
KINDS = ("params", "rviz", "bridge", "moveit", "behavior_trees")
# A stack, and nodes in a parameter file that say so: all of them, then none of these.
_STACKS = (
    ("nav2", ("amcl", "controller_server"), ()),
    ("nav2_slam", ("slam_toolbox", "controller_server"), ("amcl",)),
    ("navigation", ("controller_server",), ("amcl", "slam_toolbox")),
    ("localization", ("amcl",), ("controller_server",)),
    ("slam_toolbox", ("slam_toolbox",), ("controller_server",)),
    ("robot_localization", ("ekf_node",), ()),
    ("robot_localization", ("ekf_filter_node",), ("ekf_node",)),
    ("teleop", ("teleop_twist_joy_node",), ()),
)
_MANAGER = "controller_manager"
_CONTROL = {
    NO_SIMULATOR: "ros2_control",
    GZ: "gz_ros2_control",
    CLASSIC: "gazebo_ros2_control",
}
_WORD = re.compile(r"[a-z0-9]+")


class Companions(NamedTuple):
    """What goes with a description: files by kind, its SRDF, its stacks each with the reason.

    ``left`` are files of the same kind that were not taken, each with the reason.
    """

    files: Mapping[str, tuple[str, ...]]
    srdf: str
    stacks: Mapping[str, str]
    left: Mapping[str, str]

    @property
    def paths(self) -> Iterator[str]:
        """All files; raises nothing."""
        yield from (path for its in self.files.values() for path in its)
        yield from filter(None, (self.srdf,))


def companions_of(robot: Looked, found: Found, release: str) -> Companions:
    """What goes with a description of these files."""
    left = of_others(robot, found)
    found = without(found, left)
    files = {kind: tuple(_of_kind(kind, robot, found, left)) for kind in KINDS if kind != "params"}
    sections = dict(_sections(_nearest(robot, found.params), release, left))
    idle = _controllers_of_others(robot, sections)
    left |= idle
    sections = {path: names for path, names in sections.items() if path not in idle}
    files["params"] = tuple(sections)
    srdf = _nearest(robot, found.srdf)[:1]
    left |= {it: "another SRDF was taken" for it in found.srdf if it not in srdf}
    others = moveit_of_others(srdf[0], found) if srdf else {}
    left |= others
    files["moveit"] = tuple(it for it in files["moveit"] if srdf and it not in others)
    nodes = {name: path for path, names in sections.items() for name in names}
    chosen = {kind: its for kind, its in files.items() if its}
    return Companions(chosen, "".join(srdf), dict(_stacks(robot, nodes, "".join(srdf))), left)


def _controllers_of_others(robot: Looked, sections: Mapping[str, frozenset[str]]) -> dict[str, str]:
    """The files of controllers of the real robot, whose simulated one is driven by other plugins."""
    if robot.control or robot.simulator == NO_SIMULATOR:
        return {}
    reason = "no plugin of the simulated robot makes a controller manager"
    return {path: reason for path, names in sections.items() if _MANAGER in names}


def _of_kind(kind: str, robot: Looked, found: Found, left: dict[str, str]) -> Iterator[str]:
    """The files of a kind, nearest first; of equal base names, or where one is enough, only one."""
    taken: dict[str, str] = {}
    for path in _nearest(robot, getattr(found, kind)):
        key = kind if kind in ONE else os.path.basename(path)
        if key in taken:
            left[path] = f"{os.path.basename(taken[key])} of another folder was taken"
        else:
            taken[key] = path
            yield path


def _sections(
    paths: Iterable[str], release: str, left: dict[str, str]
) -> Iterator[tuple[str, frozenset[str]]]:
    """Parameter files with the nodes that they are for; one that has a node of an earlier one is left
    out."""
    known = load_known_nodes("", release)
    before: dict[str, str] = {}
    for path in paths:
        try:
            nodes = given_nodes([read_yaml(read_file(path), path)], known)
        except InputError as error:
            left[path] = str(error)
            continue
        names = frozenset(word for it in nodes for word in (it.name, it.known) if word)
        again = sorted(names & before.keys())
        if again:
            left[path] = f"{os.path.basename(before[again[0]])} has parameters of {again[0]}, too"
            continue
        before |= dict.fromkeys(names, path)
        yield path, names


def _nearest(robot: Looked, paths: Sequence[str]) -> list[str]:
    """The files of the description's own package first, then by how like its own their paths are."""
    words, home = set(_WORD.findall(robot.path.lower())), package_of(robot.path)

    def distance(path: str) -> tuple[bool, int, str]:
        return package_of(path) != home, -len(words & set(_WORD.findall(path.lower()))), path

    return sorted(paths, key=distance)


def _stacks(robot: Looked, nodes: Mapping[str, str], srdf: str) -> Iterator[tuple[str, str]]:
    """The stacks that a robot runs, each with what says so."""
    bare = {name.rpartition("/")[2]: path for name, path in nodes.items()}
    for stack, with_, lacking in _STACKS:
        if set(with_) <= bare.keys() and not set(lacking) & bare.keys():
            first = with_[0]
            yield stack, f"{os.path.basename(bare[first])} has parameters of {' and '.join(with_)}"
    if robot.control:
        stack = _CONTROL[robot.simulator]
        where = bare.get(_MANAGER)
        why = f" and {os.path.basename(where)} has controllers" if where else ""
        yield stack, f"the description has <ros2_control>{why}"
    elif robot.simulator == NO_SIMULATOR:
        yield "robot_state", "joint_state_publisher sends the joints until a driver does"
    if srdf:
        yield "moveit", f"there is {os.path.basename(srdf)}"
