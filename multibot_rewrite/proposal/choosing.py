# SPDX-License-Identifier: Apache-2.0
"""Chooses the robot among descriptions, by launch files and names in related files.

Where nothing says it, the likeliest has rivals."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.sources.expand import once_kept
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.proposal.bringup import processes_of_robot
from multibot_rewrite.proposal.launches import Reading
from multibot_rewrite.proposal.looking import NO_SIMULATOR, Looked
from multibot_rewrite.proposal.owners import names_of_files
from multibot_rewrite.proposal.searching import Found, loaded_by, text_of

# What descriptions of a part alone are called.
_PART = lazy_compile(
    r"gripper|hand|finger|camera|sensor|lidar|tool|effector|mount|wheel|dock|geometr"
)
# What a file manager calls a copy of a file.
_COPY = lazy_compile(r"(?<![ (_-])[ (_-]+copy\b\)?|(?<!\s)\s*\(\d+\)")
_BUILDER = "MoveItConfigsBuilder"
_BUILT = lazy_compile(_BUILDER + r"""\(\s*(?:robot_name\s*=\s*)?["'](\w+)["']""")
_BUILT_PACKAGE = lazy_compile(r"""\bpackage_name\s*=\s*["'](\w+)["']""")
# With a share of its names that is so many times as large, files are for this description.
_MORE = 2


class Candidate(NamedTuple):
    """A description and what speaks for it; ``started`` are processes of its launch file.

    ``named`` is how many of its names related files have; ``of_package``: its package is named
    after it; ``part``: it is called like a part, or another description's package uses its
    package."""

    robot: Looked
    started: int
    of_package: bool
    named: int
    part: bool
    links: frozenset[str]
    moving: frozenset[str]

    @property
    def kind(self) -> tuple[bool, bool, bool]:
        """A sort key: has several links, is no part, has something that moves."""
        return self.robot.links < 2, self.part, not self.moving

    @property
    def share(self) -> float:
        """How many of a hundred of its names are known to its related files."""
        return self.named / max(1, len(self.links) + len(self.moving))


class Chosen(NamedTuple):
    """The likeliest robot first; ``rivals`` may be meant as well, ``alike`` are other files of it."""

    order: list[Candidate]
    rivals: list[Candidate]
    alike: list[Candidate]


def chosen(robots: Sequence[Looked], found: Found) -> Chosen:
    """Return the descriptions, likeliest robot first, those that may be meant, and its other files."""
    said = names_of_files(found)
    used = {
        it.path for it in robots if any(_depends_on(one, it) for one in robots if one.links > 1)
    }
    made = [_candidate(it, said, found) for it in robots]
    # Where each uses the other, or a ring does, nothing is said.
    parts = [it._replace(part=it.part or it.robot.path in used) for it in made]
    order = sorted(parts if len(used) < len(robots) else made, key=_sort_key)
    alike = [it for it in order[1:] if _same_robot(it, order[0])]
    rivals = [it for it in order[1:] if it not in alike and not _is_behind(it, order[0])]
    return Chosen(order, rivals, alike)


def may_be_partners(path: str, found: Found) -> Iterator[str]:
    """Yield files of the other kind, SDF or URDF, that may be of the same robot."""
    # They have similar names, or a launch file loads both.
    launched = [paths for _, paths in loaded(found) if os.path.realpath(path) in paths]
    for other in found.every:
        if is_model(other) != is_model(path) and (
            _stem(other) == _stem(path) or any(os.path.realpath(other) in it for it in launched)
        ):
            yield other


def partner(it: Looked, others: Iterable[Looked]) -> Looked | None:
    """Return the description of the other kind that shares most links, at least half of its own."""
    own = _bare_links(it)
    shared = {id(one): len(own & _bare_links(one)) for one in others}
    fits = [one for one in others if one.tag != it.tag and 2 * shared[id(one)] >= one.links > 0]
    return max(fits, key=lambda one: shared[id(one)], default=None)


def _bare_links(it: Looked) -> set[str]:
    """Return a description's links without what a xacro puts in front for a robot."""
    return {name.rpartition("/")[2] for name in _link_names(it)}


def is_model(path: str) -> bool:
    """Return whether a path is that of an SDF or of its xacro (.model for Gazebo Classic)."""
    return ".sdf" in os.path.basename(path) or path.endswith(".model")


def acts(it: Looked) -> bool:
    """Return whether a model can move or sense. A mere thing has at most a plugin of its own."""
    if it.tag != "sdf" or it.links > 1 or any(_moving_joints(it)):
        return True
    return it.root is not None and next(it.root.iter("sensor"), None) is not None


def _candidate(it: Looked, said: frozenset[str], found: Found) -> Candidate:
    """Return a description with what speaks for it."""
    links, moving = frozenset(_link_names(it)), frozenset(_moving_joints(it))
    return Candidate(
        it,
        processes_with(it.path, found),
        names_its_package(it.path),
        len(said & (links | moving)),
        is_called_like_a_part(it.path),
        links,
        moving,
    )


def _depends_on(it: Looked, other: Looked) -> bool:
    """Return whether the package of a description depends on that of another one."""
    own, used = package_of(it.path), package_of(other.path)
    if own is None or used is None or own == used:
        return False
    manifest = text_of(os.path.join(own[1], "package.xml"))
    return f">{used[0]}<" in manifest or f"find {used[0]})" in text_of(it.path)


def is_called_like_a_part(path: str) -> bool:
    """Return whether the name of a description is that of a part of a robot, such as a gripper."""
    return _PART.search(_stem(path).lower()) is not None


def names_its_package(path: str) -> bool:
    """Return whether a package is named after its description, as acme_tetra after tetra.xacro."""
    words = _package_name(path).lower().split("_")
    inner = (words, words[:-1], words[1:], words[1:-1])
    return _stem(path).lower() in {"_".join(it) for it in inner} - {""}


def _sort_key(it: Candidate) -> tuple[object, ...]:
    """Return a sort key: kind, processes, package, names, no copy, simulator, control, path."""
    robot = it.robot
    is_copy = _COPY.search(os.path.basename(robot.path).lower()) is not None
    more = is_copy, robot.simulator == NO_SIMULATOR, not robot.control, len(robot.path), robot.path
    return *it.kind, -it.started, not it.of_package, -it.named, *more


def _is_behind(it: Candidate, best: Candidate) -> bool:
    """Return whether a candidate is clearly less likely to be the robot than the best one."""
    if it.kind != best.kind or (it.moving < best.moving and not it.started):
        return True
    if it.started < best.started or it.of_package < best.of_package:
        return True
    return best.share > _MORE * it.share


def _same_robot(it: Candidate, best: Candidate) -> bool:
    """Return whether two files are of one robot: other kinds, simulated and real, or a copy."""
    # Other files of one name in two folders are variants.
    if data_of_file(it.robot.path) == data_of_file(best.robot.path):
        return True
    names = {it.robot.name, _stem(it.robot.path)} & {best.robot.name, _stem(best.robot.path)}
    bases = {os.path.basename(each.robot.path) for each in (it, best)}
    within = it.links <= best.links or best.links <= it.links
    return bool(names) and (it.links == best.links or (within and len(bases) > 1))


def processes_with(path: str, found: Found) -> int:
    """Return how many processes the launch file with most of them starts for this description."""
    real = os.path.realpath(path)
    return max((processes_of_robot(it) for it, paths in loaded(found) if real in paths), default=0)


def launched_descriptions(found: Found) -> list[str]:
    """Return the descriptions loaded by the named launch file, or by all that start a robot."""
    each = (paths for it, paths in loaded(found) if found.named or processes_of_robot(it))
    return [*dict.fromkeys(path for paths in each for path in paths.values())]


def loaded(found: Found) -> list[tuple[Reading, Mapping[str, str]]]:
    """Return pairs: each launch file, and the descriptions that it loads, by their real paths."""
    return once_kept(
        ("loaded", found), lambda: [(it, loaded_by(it.graph, found)) for it in found.read]
    )


def is_srdf_launched(path: str, found: Found) -> bool:
    """Return whether a launch file loads an SRDF: by MoveItConfigsBuilder or by its path."""
    folder, base = os.path.split(os.path.abspath(path))
    package, end = _package_name(path), f"{os.path.basename(folder)}/{base}"
    texts = [text_of(it) for it in found.launch]
    return any(package in _built_packages(it) or (package in it and end in it) for it in texts)


def _built_packages(text: str) -> set[str]:
    """Return the packages whose files MoveItConfigsBuilder takes."""
    # Without a name ROBOT_moveit_config (moveit_configs_utils/moveit_configs_builder.py).
    if _BUILDER not in text:
        return set()
    usual = (f"{it}_moveit_config" for it in _BUILT.findall(text))
    return {*_BUILT_PACKAGE.findall(text)} or {*usual}


def _package_name(path: str) -> str:
    package = package_of(path)
    return package[0] if package else ""


def _stem(path: str) -> str:
    """Return the name of a description: its file's name, for a model its folder's."""
    stem = os.path.basename(path).partition(".")[0]
    is_model = _COPY.sub("", stem).strip() == "model"
    return os.path.basename(os.path.dirname(path)) if is_model else stem


def _link_names(it: Looked) -> Iterator[str]:
    for link in it.root.iter("link") if it.root is not None else ():
        yield link.get("name", "")


def _moving_joints(it: Looked) -> Iterator[str]:
    for joint in it.root.iter("joint") if it.root is not None else ():
        if joint.get("type", "fixed") != "fixed" and joint.get("name"):
            yield joint.get("name", "")
