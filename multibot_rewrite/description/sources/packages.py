# SPDX-License-Identifier: Apache-2.0
"""Where packages and the files in them are: looked up once per process."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import islice

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import outside

DEEPEST = 4
MOST_FOLDERS = 20_000
# Ancestors of a description in which its own package is looked for.
HIGHEST = 6
MANIFEST = "package.xml"
# How a CMakeLists.txt calls its package, and so many letters of it are read.
_PROJECT = ("${PROJECT_NAME}", "${CMAKE_PROJECT_NAME}", "${ament_package_name}")
_LONGEST = 262_144
_NAME = lazy_compile(rb"<name>\s*([^<\s]+)\s*</name>")
# Build results, libraries and similar folders: there are no sources of meshes below them.
_SKIPPED = frozenset(("build", "log", "lib", "lib64", "include", "bin", "node_modules", "cmake"))


@outside
def package_folders(name: str, file: str, roots: tuple[str, ...]) -> tuple[str, ...]:
    """Return every folder that may be the package ``name`` for a description ``file``."""
    sources = os.environ.get("ROS_PACKAGE_PATH", "")
    installed = os.environ.get("AMENT_PREFIX_PATH", "")
    here = os.path.dirname(os.path.abspath(file))
    return _candidate_folders(name, here, (*roots, *_split_paths(sources)), _split_paths(installed))


@outside
def package_folder(name: str, file: str, roots: tuple[str, ...]) -> str:
    """Return the folder of $(find NAME) in ``file``, also in its repository; empty if there is none."""
    known = package_folders(name, file, roots)
    own = _own_package(os.path.dirname(os.path.abspath(file)))
    if known or own is None or ".git" in entries(own[1]):
        return known[0] if known else ""
    beside = packages_below((os.path.dirname(own[1]),)).get(name, ())
    return next((it for it in beside if MANIFEST in entries(it)), "")


@outside
def package_of(file: str) -> tuple[str, str] | None:
    """Return name and folder of the package that a file is in."""
    return _own_package(os.path.dirname(os.path.abspath(file)))


@outside
def is_for_ros_1(file: str) -> bool:
    """Return whether a file is in a package that catkin builds, with nothing of ROS 2."""
    own = _own_package(os.path.dirname(os.path.abspath(file)))
    if own is None:
        return False
    text = _start_of(os.path.join(own[1], MANIFEST), 65536)
    return b"catkin" in text and b"ament" not in text


@lru_cache(maxsize=4096)
def _candidate_folders(
    name: str, here: str, roots: tuple[str, ...], prefixes: tuple[str, ...]
) -> tuple[str, ...]:
    own = _own_package(here)
    found = [own[1]] if own is not None and own[0] == name else []
    shares = (os.path.join(prefix, "share", name) for prefix in prefixes)
    found += packages_below(roots).get(name, ())
    return (*found, *(it for it in shares if MANIFEST in entries(it)))


def _split_paths(paths: str) -> tuple[str, ...]:
    return tuple(it for it in paths.split(os.pathsep) if it)


@lru_cache(maxsize=256)
def _own_package(folder: str) -> tuple[str, str] | None:
    """Return name and folder of the package that a folder is in."""
    for _ in range(HIGHEST):
        # Asked for alone: folders above may be those of all users, or for temporary files.
        if os.path.isfile(os.path.join(folder, MANIFEST)):
            return _package_name(folder), folder
        folder = os.path.dirname(folder)
    return None


@outside
def sources_around(file: str) -> str:
    """Return the repository, workspace's ``src`` or package folder around a file; empty without."""
    own = package_of(file)
    above = [own[1]] if own else []
    for _ in range(HIGHEST if own else 0):
        if ".git" in entries(above[-1]):
            return above[-1]
        above.append(os.path.dirname(above[-1]))
    sources = (it for it in above[1:] if os.path.basename(it) == "src")
    return next(sources, above[1]) if own else ""


@lru_cache(maxsize=64)
def packages_below(roots: tuple[str, ...]) -> Mapping[str, tuple[str, ...]]:
    """Return packages below folders by name; a folder of the name counts if no manifest has it."""
    folders = list(_folders(roots))
    named = lists_by_key((_package_name(it), it) for it, is_package in folders if is_package)
    called = lists_by_key(
        (os.path.basename(it), it) for it, is_package in folders if not is_package
    )
    return {name: tuple(its) for name, its in (called | named).items()}


def _folders(roots: tuple[str, ...]) -> Iterator[tuple[str, bool]]:
    """Yield (folder, whether it is a package) breadth first; nothing below a package."""
    waiting = deque((os.path.abspath(root), 0) for root in roots)
    for _ in range(MOST_FOLDERS):
        if not waiting:
            return
        folder, depth = waiting.popleft()
        inside = _folder_entries(folder)
        is_package = any(it.name == MANIFEST for it in inside)
        yield folder, is_package
        if depth < DEEPEST and not is_package:
            named = (it for it in inside if it.name[0] != "." and it.name not in _SKIPPED)
            below = sorted(it.path for it in named if it.is_dir(follow_symlinks=False))
            waiting += ((it, depth + 1) for it in below)


def _folder_entries(folder: str) -> list[os.DirEntry[str]]:
    try:
        with os.scandir(folder) as found:
            return list(found)
    except OSError:
        return []


@outside
@lru_cache(maxsize=4096)
def entries(folder: str) -> frozenset[str]:
    """Return the names in a folder, as they are written; none if it cannot be read."""
    try:
        return frozenset(os.listdir(folder))
    except (OSError, ValueError):  # a path of a damaged file may hold a null character
        return frozenset()


def _start_of(path: str, most: int) -> bytes:
    """Return the start of a file; empty if it cannot be read, or is a pipe."""
    try:
        with open(path if os.path.isfile(path) else os.devnull, "rb") as file:
            return file.read(most)
    except OSError:
        return b""


def _package_name(folder: str) -> str:
    found = _NAME.search(_start_of(os.path.join(folder, MANIFEST), 8192))
    return found[1].decode("utf-8", "replace") if found else os.path.basename(folder)


@lru_cache(maxsize=1024)
def _by_lower_case(folder: str) -> Mapping[str, str]:
    """Return the names in a folder by lower case; the first of those that differ only in case."""
    return {it.lower(): it for it in sorted(entries(folder), reverse=True)}


@outside
def find_in(folder: str, path: str) -> str:
    """Return the path below a folder as it is on the disk, whatever the case; empty if absent."""
    found: list[str] = []
    here = folder
    for step in os.path.normpath(path).split(os.sep):
        here = os.path.join(here, *found[-1:])
        if step == os.pardir or step in entries(here):
            found.append(step)
            continue
        near = _by_lower_case(here).get(step.lower(), "")
        if not near:
            return ""
        found.append(near)
    return os.path.join(*found)


@outside
def in_sources(path: str) -> str:
    """Return the source file that a build installs as ``path``; empty if none is certain."""
    # By the package's CMakeLists.txt, else its only file that ends so, as
    # ``description/urdf/arm.xacro`` for ``urdf/arm.xacro``.
    folder = os.path.dirname(os.path.abspath(path))
    while not os.path.isdir(folder):
        folder = os.path.dirname(folder)
    package = _own_package(folder)
    if package is None:
        return ""
    below = os.path.relpath(os.path.abspath(path), package[1])
    for source, installed in _installed(package[1]):
        inside = os.path.relpath(below, installed or os.curdir)
        there = os.path.normpath(os.path.join(source, inside))
        if inside.split(os.sep)[0] != os.pardir and os.path.isfile(there):
            return there
    end = os.sep + below
    found = [it for it in _every_file(package[1]) if it.endswith(end)]
    return found[0] if len(found) == 1 else ""


@lru_cache(maxsize=64)
def _installed(folder: str) -> tuple[tuple[str, str], ...]:
    """Return (source, installed path) of what a package's CMakeLists.txt installs."""
    lines = _start_of(os.path.join(folder, "CMakeLists.txt"), _LONGEST).decode("utf-8", "replace")
    text = " ".join(line.partition("#")[0] for line in lines.splitlines())
    calls = (it.partition(")")[0].replace('"', " ").split() for it in text.split("install(")[1:])
    return tuple(pair for words in calls for pair in _of_install(folder, words))


def _of_install(folder: str, words: list[str]) -> Iterator[tuple[str, str]]:
    """Yield (source, target) of one ``install(DIRECTORY a b/ DESTINATION c)``."""
    if words[:1] not in (["DIRECTORY"], ["FILES"]) or words[-1:] == ["DESTINATION"]:
        return
    at = words.index("DESTINATION") if "DESTINATION" in words else 0
    share, _, name = words[at + 1].partition("/") if at else ("", "", "")
    own, _, target = name.partition("/")
    if share != "share" or own not in (os.path.basename(folder), _package_name(folder), *_PROJECT):
        return
    for it in words[1:at]:
        last = "" if it.endswith("/") else os.path.basename(it)
        source = it.removeprefix("${CMAKE_CURRENT_SOURCE_DIR}/")
        yield os.path.normpath(os.path.join(folder, source)), os.path.join(target, last).rstrip("/")


@lru_cache(maxsize=64)
def _every_file(folder: str) -> tuple[str, ...]:
    """Return the files of a package, up to the limit of the search."""
    return tuple(islice(_files_below(folder), MOST_FOLDERS))


def _files_below(folder: str) -> Iterator[str]:
    for above, folders, names in os.walk(folder):
        folders[:] = (it for it in folders if it[0] != "." and it not in _SKIPPED)
        yield from (os.path.join(above, name) for name in names)
