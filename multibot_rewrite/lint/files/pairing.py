# SPDX-License-Identifier: Apache-2.0
"""Which URDF an SRDF belongs to: the one it names among the linted files, else one near it."""

import os
from collections.abc import Iterator, Sequence
from contextlib import redirect_stderr
from functools import partial
from glob import escape
from io import StringIO
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import is_file
from multibot_rewrite.description.checks.links_and_joints import Robot, read_robot
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.packages import package_folder
from multibot_rewrite.description.sources.read import XACRO, is_xacro, read_file
from multibot_rewrite.description.steps.collect import NOTHING, Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.files.named import SRDF_MARK, files_like, robot_name
from multibot_rewrite.related_files.named_file import is_related_file
from multibot_rewrite.rules.settings import Settings, matches

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.access import Reach

# Where a package of MoveIt has its URDF, from the folder of its SRDF.
NEAR = (".", "../urdf", "../config", "../robots", "../../*_description/urdf")
ENDINGS = ("*.urdf", "*.xacro")
# How many files are looked into, and how many descriptions are read.
MOST, TRIED = 200, 6
# How many of an SRDF's names its URDF may lack: one in PART, or SLIPS where there are few.
PART, SLIPS = 4, 2


class Pair(NamedTuple):
    """The robot of an SRDF's URDF with what it declares, without the SRDF's names in ``misses``."""

    robot: Robot | None
    declared: Declared
    misses: int = 0


NO_PAIR = Pair(None, NOTHING)


def named_urdfs(paths: Sequence[str], included: frozenset[str]) -> tuple[tuple[str, str], ...]:
    """Return the robot names of the descriptions, if an SRDF or another related file is among them."""
    others = [
        it for it in paths if SRDF_MARK not in os.path.basename(it) and not is_related_file(it)
    ]
    if len(others) == len(paths):
        return ()
    whole = (it for it in others if it not in included or not it.endswith(".xacro"))
    named = ((robot_name(path), path) for path in whole if is_file(path))
    return tuple((name, path) for name, path in named if name)


def find_pair(path: str, srdf: Inventory, settings: Settings) -> Pair:
    """Return the description with most of an SRDF's names, unless it lacks more than a few."""
    if settings.urdf:
        return _pair_with(settings.urdf, srdf, settings)
    name = srdf.document.root.get("name", "").strip()
    best = NO_PAIR
    for candidate in _candidates(path, name, settings)[:TRIED]:
        try:
            found = _pair_with(candidate, srdf, settings)
        except InputError:  # reported when it is linted itself
            continue
        if best is NO_PAIR or found.misses < best.misses:
            best = found
        if not found.misses:
            break
    names = len(_used_names(srdf))
    fits = best.misses * PART <= names or (best.misses <= SLIPS and best.misses < names)
    return best if fits else NO_PAIR


def _candidates(path: str, name: str, settings: Settings) -> list[str]:
    """Return files with that robot's name, the nearest first, else with the file name of the SRDF."""
    folder = os.path.dirname(os.path.abspath(path))
    named = [urdf for robot, urdf in settings.urdfs if robot == name]
    if named:
        return sorted(
            named, key=lambda it: (os.path.relpath(os.path.abspath(it), folder).count(os.sep), it)
        )
    files = list(islice(_files_near(folder), MOST))
    same = [it for it in files if robot_name(it) == name]
    return same or [it for it in files if _stem(it) == _stem(path)]


def _files_near(folder: str) -> Iterator[str]:
    """Yield the descriptions near a folder that are no SRDFs."""
    for place in NEAR:
        for ending in ENDINGS:
            found = files_like(os.path.normpath(f"{escape(folder)}/{place}/{ending}"))
            yield from (it for it in found if SRDF_MARK not in os.path.basename(it))


def _stem(path: str) -> str:
    return os.path.basename(path).partition(".")[0]


def _pair_with(path: str, srdf: Inventory, settings: Settings) -> Pair:
    """Return the robot of a URDF, with the number of the SRDF's names that it lacks."""
    data, name = described(path, settings)
    tree = builtin_tree(settings.definitions, settings.distro, settings.ros)
    inventory = collect(read_document(data, name), tree)
    declared = inventory.declared
    known = declared["link"].keys() | declared["joint"].keys()
    misses = sum(it not in known for it in _used_names(srdf))
    return Pair(read_robot(inventory.document.root), declared, misses)


def described(path: str, settings: Settings) -> tuple[bytes, str]:
    """Return the URDF with its default arguments, or the first that the settings have for the file."""
    if not is_xacro(path):
        return read_file(path), path
    from multibot_rewrite.description.sources.expand import expand

    sets = [dict(it.arguments) for it in settings.arguments if matches(path, it.pattern)]
    find = partial(package_folder, file=path, roots=settings.readable)
    name, reach = f"{path} (expanded)", reach_of(settings)
    # xacro prints its warnings when a person runs it.
    with redirect_stderr(StringIO()):
        try:
            return expand(path, {}, find, reach), name
        except InputError:
            # An expanded text may have a rest of xacro in it, and is read all the same.
            if not sets and not path.endswith(XACRO):
                return read_file(path), path
            if not sets:
                raise
            return expand(path, sets[0], find, reach), name


def reach_of(settings: Settings) -> "Reach":
    """Return the limits for the xacro files of a lint, with the time limit of a file."""
    from multibot_rewrite.description.sources.access import Reach

    return Reach(settings.readable, settings.trust, settings.seconds)


def _used_names(srdf: Inventory) -> set[str]:
    """Return the links and joints an SRDF uses, without those it declares."""
    uses = (it for it in srdf.claims if it.site.role == "uses" and it.site.whole_value_kind)
    return {it.value.strip() for it in uses} - srdf.declared["joint"].keys()
