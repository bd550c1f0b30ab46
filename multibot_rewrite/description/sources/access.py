# SPDX-License-Identifier: Apache-2.0
"""What the expansion of a xacro file may use: files below its roots, packages, ROS's variables."""

import os
import stat
from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from typing import NamedTuple

from multibot_rewrite.base.bounded import MAX_BYTES, open_text, read_start
from multibot_rewrite.base.model import UNREADABLE, InputError, MultibotError
from multibot_rewrite.base.outside import outside, real_path, variable
from multibot_rewrite.description.sources.child.frames import FENCES
from multibot_rewrite.description.sources.packages import in_sources, package_folder

# The folder of a package for $(find PACKAGE), empty where it is not known.
Find = Callable[[str], str]
# A xacro file sees the variables of the environment that begin so: ROS's, and no passwords.
VARIABLES = (
    "AMENT_", "CMAKE_PREFIX_PATH", "COLCON_", "GAZEBO_MODEL_PATH", "GAZEBO_PLUGIN_PATH",
    "GAZEBO_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "GZ_SIM_SYSTEM_PLUGIN_PATH", "GZ_VERSION",
    "IGN_GAZEBO_RESOURCE_PATH", "RMW_", "ROS_", "SDF_PATH", "TURTLEBOT",
)  # fmt: skip
# Folders above a file in which its package and its repository are looked for.
HIGHEST = 8
# What a repository has at its top, in copies without ``.git`` too.
_OF_REPOSITORY = (".gitignore", ".github", ".gitmodules", "LICENSE", "README.md")
# Files that one pattern is compared with.
MOST_FILES = 20_000
SECONDS = 60.0


class Reach(NamedTuple):
    """How far expansions may reach: more folders, seconds, fences; with ``trust`` anywhere."""

    roots: tuple[str, ...] = ()
    trust: bool = False
    seconds: float = SECONDS
    fences: tuple[str, ...] = FENCES


BOUNDED, TRUSTED = Reach(), Reach(trust=True)


class NotAllowedError(MultibotError):
    """An access outside the bounds; the text says what and why."""


class Access:
    """What an expansion of ``path`` may use, with packages of ``find`` and of a sourced ROS."""

    def __init__(self, path: str, reach: Reach, find: Find | None) -> None:
        self.path, self.reach, self.find = path, reach, find
        self.beside = {os.path.dirname(it) for it in _real_paths(path)}
        self.roots = [real_path(it) for it in (*_own_folders(path), *reach.roots)]
        self.sourced = [
            os.path.abspath(it)
            for it in (*_ros_prefixes(), *_paths_in_variable("ROS_PACKAGE_PATH"))
        ]

    def readable(self, name: str) -> str:
        """Return the path to open for ``name``; raises NotAllowedError."""
        if self.reach.trust or name == self.path:
            return name
        # A workspace that was sourced is trusted, with the links that colcon makes in it.
        plain, real = os.path.abspath(name), real_path(name)
        if any(_is_below(plain, it) for it in self.sourced):
            return plain
        folder = os.path.dirname(real)
        roots = (*self.roots, folder) if folder in self.beside else self.roots
        root = next((it for it in roots if _is_below(real, it)), None)
        if root is None:
            raise NotAllowedError(f"{name} is outside of the folders that xacro may read")
        if any(it[0] == "." for it in os.path.relpath(real, root).split(os.sep) if it != "."):
            raise NotAllowedError(f"{name} is hidden, and xacro may not read it")
        return real

    def package(self, name: str) -> str:
        """Return the folder for $(find NAME), which may be read from now on; raises LookupError."""
        if os.path.basename(name) != name or name in ("", os.curdir, os.pardir):
            raise LookupError(f"{name!r} is no name of a package")
        folder = (
            (self.find and self.find(name)) or _installed(name) or self._package_in_workspace(name)
        )
        if not folder:
            why = "" if _ros_prefixes() or self.find else ": AMENT_PREFIX_PATH is not set"
            raise LookupError(f"package {name!r} is not found{why}")
        self.roots.append(real_path(folder))
        return folder

    def _package_in_workspace(self, name: str) -> str:
        """Return the folder of a package in the file's repository or workspace."""
        repository = _repository(os.path.dirname(_real_paths(self.path)[0]))
        # A workspace has its repositories side by side in src.
        above = os.path.dirname(repository)
        workspace = above if os.path.basename(above) == "src" else ""
        home = os.path.realpath(os.path.expanduser("~"))
        both = (it for it in (repository, workspace) if it)
        roots = tuple(it for it in both if not _is_below(home, it))
        folder = package_folder(name, _real_paths(self.path)[0], roots)
        return folder if os.path.isfile(os.path.join(folder, "package.xml")) else ""

    def variable(self, name: str) -> str | None:
        """Return a variable of the environment; raises NotAllowedError for a forbidden one."""
        value = variable(name)
        if value is not None and not self.reach.trust and not name.startswith(VARIABLES):
            hint = "is set, but xacro sees ROS's variables alone"
            raise NotAllowedError(f"the environment variable {name!r} {hint}")
        return value

    def matching(self, pattern: str) -> list[str]:
        """Return the sorted files for a pattern with ``*``, ``?`` or ``[``; raises NotAllowedError."""
        found, seen = [os.sep if os.path.isabs(pattern) else ""], 0
        for part in pattern.split(os.sep):
            if not any(it in part for it in "*?["):
                found = [os.path.join(it, part) for it in found]
                continue
            beside = []
            for folder in found:
                self.readable(folder or os.curdir)
                names = [it for it in _listing(folder) if it[0] != "." and fnmatchcase(it, part)]
                beside += [os.path.join(folder, it) for it in names]
                seen += len(names)
                if seen > MOST_FILES:
                    raise NotAllowedError(f"{pattern} names more than {MOST_FILES} files")
            found = beside
        return sorted(it for it in found if self.readable(it) and _is_there(it))

    def read(self, name: str) -> bytes:
        """Return a file's bytes, one more than allowed if larger; as ``readable`` or OSError."""
        # Of a package that is not built its sources count: a build may install files elsewhere.
        path = self.readable(name)
        if not _is_there(path):
            path = self.readable(in_sources(path) or path)
        data = _content(path, self.reach.trust)
        if data is None:
            raise NotAllowedError(f"{name} is no regular file, and xacro may not read it")
        return data


@outside
def check_file(path: str) -> None:
    """Raise InputError for a file that cannot be read, or is too large."""
    try:
        read_start(path, 0)
        size = os.stat(path).st_size
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}", UNREADABLE) from None
    if size > MAX_BYTES:
        limit = f"{MAX_BYTES // 2**20} MB"
        raise InputError(f"{path}: {size / 2**20:.0f} MB is over the limit of {limit}")


@outside
def _content(path: str, trust: bool) -> bytes | None:
    """Return a file's bytes, one more than allowed if larger; None for a device or pipe."""
    if (text := open_text(path)) is not None:
        return text
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC
    with open(path, "rb", opener=lambda it, _: os.open(it, flags)) as file:
        is_regular = stat.S_ISREG(os.fstat(file.fileno()).st_mode)
        return file.read(MAX_BYTES + 1) if is_regular or trust else None


@outside
def _is_there(path: str) -> bool:
    return os.path.lexists(path)


@outside
def _real_paths(path: str) -> tuple[str, str]:
    """Return (path in the real folder, real path) of a file, which may be a link."""
    folder, name = os.path.split(os.path.abspath(path))
    return os.path.join(os.path.realpath(folder), name), os.path.realpath(path)


@outside
def _own_folders(path: str) -> tuple[str, ...]:
    """Return folder, package and repository of a file or link, and a working directory above."""
    # Not the home of a user and what is above it, although they may hold a robot or be a
    # repository.
    home, here = os.path.realpath(os.path.expanduser("~")), os.path.realpath(os.curdir)
    found: list[str] = []
    for file in _real_paths(path):
        folder = os.path.dirname(file)
        marked = _folder_with(folder, "package.xml"), _repository(folder)
        worked_in = here if _is_below(folder, here) else ""
        found += (it for it in (folder, *marked, worked_in) if it and not _is_below(home, it))
    return tuple(found)


def _folder_with(folder: str, mark: str) -> str:
    """Return the nearest folder above that holds ``mark``; empty if there is none."""
    return next((it for it in _upwards(folder) if os.path.lexists(os.path.join(it, mark))), "")


def _repository(folder: str) -> str:
    """Return the repository that a folder is in; empty if there is none."""
    # In a copy without ``.git`` it is the nearest folder above the package with a file that only
    # repositories have, or one called src.
    if known := _folder_with(folder, ".git"):
        return known
    package = _folder_with(folder, "package.xml")
    above = list(_upwards(os.path.dirname(package))) if package else []
    marks = (os.path.join(it, mark) for it in above for mark in _OF_REPOSITORY)
    found = next((os.path.dirname(it) for it in marks if os.path.lexists(it)), "")
    return found or next((it for it in above if os.path.basename(it) == "src"), "")


def _upwards(folder: str) -> Iterator[str]:
    """Yield a folder and those above it."""
    for _ in range(HIGHEST):
        yield folder
        folder = os.path.dirname(folder)


def _is_below(path: str, folder: str) -> bool:
    return path == folder or path.startswith(os.path.join(folder, ""))


def _ros_prefixes() -> list[str]:
    return _paths_in_variable("AMENT_PREFIX_PATH")


def _paths_in_variable(name: str) -> list[str]:
    return [it for it in (variable(name) or "").split(os.pathsep) if it]


@outside
def _installed(name: str) -> str:
    """Return the folder of an installed package, as ament_index_python finds it, or ""."""
    for prefix in _ros_prefixes():
        if os.path.isfile(os.path.join(prefix, "share/ament_index/resource_index/packages", name)):
            return os.path.join(prefix, "share", name)
    return ""


@outside
def _listing(folder: str) -> list[str]:
    """Return the names in a folder; none if it cannot be read."""
    try:
        return os.listdir(folder or os.curdir)
    except OSError:
        return []
