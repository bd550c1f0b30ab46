# SPDX-License-Identifier: Apache-2.0
"""Finds related files of other descriptions, by place and names, and the best parameter file."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import compress
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.lazy import FILLED_IN
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.sources.expand import expand
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.knowledge.parameters import KnownNodes, is_called, load_known_nodes
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.ends import bridge_rows
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.proposal.looking import ANY, Looked, filled_for_any
from multibot_rewrite.proposal.searching import Found, Undecided, home_of, text_of
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.words import last_word

# Descriptions whose names are looked at.
MOST = 60
_NAMED = re.compile(rb"""<(?:link|joint)\b[^<>]*?\bname\s*=\s*["']([^"'<]+)["']""")
_GROUP = re.compile(rb"""<group\b[^<>]*?\bname\s*=\s*["']([^"'<]+)["']""")
_FILLED_IN = re.compile(FILLED_IN)
_KEY = re.compile(rb"^[ \t-]*[\w./][\w./-]*:", re.MULTILINE)
_WORD = re.compile(r"[\w.-]+")
# How many names of a file another description has to have for each that is the robot's own: the files
# of a robot name more than a variant of it has. Nor is a file a rival with so many times as many names
# that the robot has not.
_MORE = 2
_OF_ROBOT = ("frame", "link", "joint")


class _Words(NamedTuple):
    """The words of a file, and those of its values alone."""

    all: frozenset[str]
    values: frozenset[str]


def of_others(robot: Looked, found: Found) -> dict[str, str]:
    """Return the files that belong to another description than the robot's, each with the reason."""
    near = dict(_nearer_to_others(robot.path, found))
    rest = [path for path in _related_files(found) if path not in near]
    return {**near, **dict(_naming_others(robot, found, rest))}


def of_other_robots(robots: Sequence[Looked], found: Found, release: str) -> list[set[str]]:
    """Return for each robot of a fleet the files of the others, by folder, file name or names."""
    known = load_known_nodes("", release)
    owners = {file: _owners_of(file, robots, known) for file in _related_files(found)}
    return [{file for file, its in owners.items() if robot not in its} for robot in robots]


def _owners_of(file: str, robots: Sequence[Looked], known: KnownNodes) -> list[Looked]:
    near = {it: _shared_depth(os.path.dirname(it.path), file) for it in robots}
    nearest = [it for it in robots if near[it] == max(near.values())]
    likely = [it for it in nearest if _is_called_like(file, it)] or nearest
    if not likely[1:] or not file.endswith((".yaml", ".yml")):
        return likely
    lacked = [_lacked_names(it, file, known) for it in likely]
    fits = (not any(less < names for less in lacked) for names in lacked)
    return [*compress(likely, fits)]


def _lacked_names(robot: Looked, file: str, known: KnownNodes) -> set[str]:
    """Return what a parameter or bridge file names and the robot has not."""
    # Of nodes that drive their packages, if no wheel turns.
    root = robot.root if robot.root is not None else etree.Element("robot")
    try:
        document = read_yaml(data_of_file(file), file)
        topics = {it.inside for it in bridge_rows(document)}
        nodes = () if topics else given_nodes([document], known)
    except InputError:
        return set()
    text = etree.tostring(root, encoding="unicode")
    lacked = fitting(robot, file, nodes, known, ()).strange
    lacked |= {it for it in topics if last_word(it) not in text}
    packages = {known.nodes[it.fact.known].package for it in nodes if it.fact.known in known.nodes}
    turns = root.tag == "sdf" or root.find("joint[@type='continuous']") is not None
    drives = ("nav2_", "slam_toolbox")
    return {*lacked, *(it for it in packages if it.startswith(drives) and not turns)}


def _is_called_like(file: str, robot: Looked) -> bool:
    """Return whether a file name begins with the description's name as a separate word."""
    name, front = os.path.basename(file), os.path.basename(robot.path).partition(".")[0]
    return name.startswith(front) and not name[len(front) : len(front) + 1].isalnum()


def _related_files(found: Found) -> Iterator[str]:
    for kind in ("params", "rviz", "bridge", "moveit", "behavior_trees", "srdf"):
        yield from getattr(found, kind)


def _shared_depth(folder: str, file: str) -> int:
    return len(os.path.commonpath((os.path.abspath(folder), os.path.abspath(file))))


def _nearer_to_others(robot: str, found: Found) -> Iterator[tuple[str, str]]:
    """Yield (path, reason) for files of the package that are nearer to another description."""
    # A folder of examples has files of several robots.
    others = {os.path.dirname(it): it for it in reversed(found.every)}
    own, base = os.path.dirname(robot), home_of(robot)
    for file in _related_files(found):
        if _shared_depth(base, file) == len(os.path.abspath(base)):
            at = max(others, key=lambda it: _shared_depth(it, file), default=own)
            if _shared_depth(at, file) > _shared_depth(own, file):
                yield file, f"it is next to {os.path.basename(others[at])}"


def _naming_others(robot: Looked, found: Found, files: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Yield (path, reason) for files that name parts of another description, no nearer to the robot."""
    own = frozenset(_expanded_names(robot)) | _names_in(robot.path)
    names = {it: _names_in(it) for it in found.every[:MOST] if it != robot.path}
    others = {path: its for path, its in names.items() if not its <= own}
    for file in files if others else ():
        words = _words_in(file)
        mine = _known_names(words, own)
        rivals = {path: _known_names(words, its) for path, its in others.items()}
        best = max(rivals, key=lambda it: (len(rivals[it]), it))
        theirs = rivals[best]
        at = _shared_depth(os.path.dirname(best), file)
        if at >= _shared_depth(os.path.dirname(robot.path), file) and (
            len(theirs) > max(1, _MORE * len(mine))
        ):
            named = ", ".join(sorted(theirs - mine)[:3])
            yield file, f"it is for {os.path.basename(best)}, which has {named}"


def _known_names(words: _Words, names: frozenset[str]) -> frozenset[str]:
    """Return the names that a file has; a plain name such as camera counts only as a value."""
    return frozenset(it for it in names & words.all if it in words.values or _is_specific(it))


def _is_specific(name: str) -> bool:
    return "_" in name or any(map(str.isdigit, name))


_SHOWN = re.compile(rb"^[ \t]+([\w./-]+):[ \t]*\n[ \t]+Alpha:", re.MULTILINE)
# Of fewer of a hundred of its names being the robot's, a file is another robot's.
LEAST = 50


def hundredths_known(robot: Looked, path: str) -> int:
    """Return the percentage of links and joints in an SRDF or RViz config that are the robot's."""
    # 100 for a file that names none.
    if path.endswith(".rviz"):
        named = names_shown(path)
    else:
        named, groups = semantic_names(robot, path)
        if not named | groups:  # a file of macros
            return 0
    own = own_names(robot)
    return 100 * len(named & own) // len(named) if named else 100


def own_names(robot: Looked) -> frozenset[str]:
    """Return a robot's links and joints: as they are, without what arguments add, and as written."""
    made = frozenset(_expanded_names(robot))
    return made | _without_prefixes(robot, made) | _names_in(robot.path)


def _without_prefixes(robot: Looked, names: frozenset[str]) -> frozenset[str]:
    """Return names without the prefixes that the robot's arguments add."""
    given = [it.rstrip("_/") for _, it in filled_for_any(robot) if ANY in it]
    fronts = tuple(f"{it}{end}" for it in given for end in "_/")
    front = {name: next((it for it in fronts if name.startswith(it)), "") for name in names}
    return frozenset(name.removeprefix(front[name]) or name for name in names)


def semantic_names(robot: Looked, path: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return the links and joints that an SRDF names, and its groups."""
    # With the robot's arguments if it is a xacro; as written if that cannot be expanded.
    if path.endswith(".xacro"):
        with suppress(InputError):
            names, groups = _expanded_srdf(path, filled_for_any(robot))
            return _without_prefixes(robot, names), _without_prefixes(robot, groups)
    data = data_of_file(path)
    return _names_in(path), frozenset(it.decode("utf-8", "replace") for it in _GROUP.findall(data))


@lru_cache(maxsize=MOST)
def _expanded_srdf(
    path: str, given: tuple[tuple[str, str], ...]
) -> tuple[frozenset[str], frozenset[str]]:
    """Return the links and joints that an expanded SRDF names, and its groups."""
    data = expand(path, dict(given), None, BOUNDED)
    found = (it.decode("utf-8", "replace") for it in _NAMED.findall(data))
    groups = (it.decode("utf-8", "replace") for it in _GROUP.findall(data))
    return frozenset(found) - {*SENT_FRAMES}, frozenset(groups)


def best_folders(robot: Looked, srdf: str, paths: Iterable[str]) -> dict[str, int]:
    """Return by folder how many names of the robot and groups of its SRDF its files have."""
    groups = semantic_names(robot, srdf)[1]
    own = own_names(robot) | groups
    found: dict[str, int] = {}
    for path in paths:
        folder = os.path.dirname(path)
        found[folder] = found.get(folder, 0) + len(_words_in(path).all & own)
    return found


def names_shown(path: str) -> frozenset[str]:
    """Return the links in the trees of an RViz config."""
    found = (it.decode("utf-8", "replace") for it in _SHOWN.findall(data_of_file(path)))
    return frozenset(found) - {*SENT_FRAMES}


def _expanded_names(robot: Looked) -> Iterator[str]:
    for it in robot.root.iter("link", "joint") if robot.root is not None else ():
        yield it.get("name", "")


def _names_in(path: str) -> frozenset[str]:
    """Return the links and joints of a description as they are written, without what xacro fills in."""
    written = (it.decode("utf-8", "replace") for it in _NAMED.findall(data_of_file(path)))
    names = (_FILLED_IN.sub("", it).strip("_/ ") for it in written)
    return frozenset(it for it in names if it) - {*SENT_FRAMES}


def names_of_files(found: Found) -> frozenset[str]:
    """Return the values in related files, and their keys if these are specific names."""
    words = [_words_in(it) for it in _related_files(found)]
    keys = (name for it in words for name in it.all if _is_specific(name))
    return frozenset(keys).union(*(it.values for it in words)) - {*SENT_FRAMES}


def _words_in(path: str) -> _Words:
    """Return all words of a file, and those of its values."""
    data = data_of_file(path)
    texts = data, _KEY.sub(b"", data)
    found = (frozenset(_WORD.findall(it.decode("utf-8", "replace"))) for it in texts)
    return _Words(*found)


def moveit_of_others(robot: Looked, srdf: str, found: Found) -> Mapping[str, str]:
    """Return the reason by path of each MoveIt file for another SRDF, or for groups unknown here."""
    left = {}
    groups = semantic_names(robot, srdf)[1]
    for file in found.moveit:
        is_kinematics = os.path.splitext(os.path.basename(file))[0] == "kinematics"
        if is_kinematics and groups and not _words_in(file).all & groups:
            left[file] = f"it names no group of {os.path.basename(srdf)}"
        best = max(found.srdf, key=lambda it: _shared_depth(os.path.dirname(it), file))
        if _shared_depth(os.path.dirname(best), file) > _shared_depth(os.path.dirname(srdf), file):
            left[file] = f"it is next to {os.path.basename(best)}"
    return left


class Fitting(NamedTuple):
    """A parameter file: the nodes that it is for, and its names that the robot has not."""

    path: str
    nodes: frozenset[str]
    strange: frozenset[str]


def fitting(
    robot: Looked, path: str, nodes: Sequence[Run], known: KnownNodes, bridges: Iterable[str]
) -> Fitting:
    """Return how a file fits a robot: its nodes, and names that the robot has not."""
    # Frames, links and joints must be the description's; topics of several words may be a bridge's.
    own = own_names(robot) | {*SENT_FRAMES}
    text = etree.tostring(robot.root).decode() if robot.root is not None else ""
    said = "\n".join((text, *map(text_of, bridges)))
    found = {
        value
        for kind, value in _named_in_values(nodes, known)
        if (value not in own if kind in _OF_ROBOT else _is_missing_below_namespace(value, said))
    }
    names = frozenset(word for it in nodes for word in (it.node, it.fact.known) if word)
    return Fitting(path, names, frozenset(found))


def not_started(path: str, nodes: Sequence[Run], known: KnownNodes) -> str:
    """Return why another package's file is not the robot's; empty if it may be."""
    # It is an example next to a node's code, or its nodes are unknown.
    own = package_of(path)
    packages = {known.nodes[it.fact.known].package for it in nodes if it.fact.known in known.nodes}
    if own and own[0] in packages:
        return f"it is an example of {own[0]}"
    who = nodes[0].node if nodes else "any node"
    return "" if packages else f"it is for {who}, which no launch file of the robot starts"


def _named_in_values(nodes: Iterable[Run], known: KnownNodes) -> Iterator[tuple[str, str]]:
    """Yield (kind, name) for each name in a value of a known parameter."""
    for node in (it for it in nodes if it.fact.known in known.nodes):
        params = [*known.nodes[node.fact.known].params.values()]
        for name, given in node.values.items():
            kind = next((it.kind for it in params if is_called(it, name) and not it.own), "")
            is_sensor = kind == "topic" and name.endswith(("scan_topic", ".topic"))
            if kind in _OF_ROBOT or is_sensor:
                values = given.value if isinstance(given.value, list | tuple) else (given.value,)
                yield from ((kind, it) for it in values if isinstance(it, str) and "$" not in it)


def _is_missing_below_namespace(topic: str, said: str) -> bool:
    words = topic.strip("/")
    return "/" in words and words not in said


def check_winner(its: Sequence[Fitting], robot: Looked, found: Found) -> None:
    """Raise Undecided if two files for one node have as many names that the robot has not."""
    for at, best in enumerate(its):
        if any(best.nodes & it.nodes for it in its[:at]):
            continue
        rivals = [it for it in its[at + 1 :] if it.nodes & best.nodes and _is_rival(it, best)]
        if best.strange and rivals:
            both = {it.path: _first_names(it.strange) for it in (best, *rivals)}
            node = sorted(best.nodes & rivals[0].nodes)[0]
            what = f"{len(both)} files have parameters of {node}, and names that the robot has not"
            raise Undecided(what, both, found, robot.path)


def _is_rival(it: Fitting, best: Fitting) -> bool:
    return len(it.strange) <= _MORE * len(best.strange)


def _first_names(names: Iterable[str]) -> str:
    every = sorted(names)
    return f"{', '.join(every[:2])} ..." if every[2:] else ", ".join(every)
