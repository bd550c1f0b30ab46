# SPDX-License-Identifier: Apache-2.0
"""Files and packages that do not exist."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cache

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.sources.packages import (
    entries,
    find_in,
    package_folders,
    package_of,
)
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.rules.description.meshes.shared import Used, problem, used_files
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import EXPANDED, Subject

_CMAKE = "CMakeLists.txt"
# install(DIRECTORY a b DESTINATION share/${PROJECT_NAME}/below)
_INSTALLED = lazy_compile(
    rb"install\s*\(\s*DIRECTORY\s([^()]*?)\sDESTINATION\s+\"?share/\$\{PROJECT_NAME\}/?([^\s\")]*)",
    0,
)


class MeshFile(NamedTuple):
    """A file that was looked for: the folders it may be below, its path there, and the path as it
    is on the disk, empty where it does not exist."""

    used: Used
    folders: tuple[str, ...]
    path: str
    found: str


@memoized
def lookups(subject: Subject) -> tuple[MeshFile, ...]:
    """Each file that can be looked for once, by the first element that names it."""
    file, roots = subject.document.file.removesuffix(EXPANDED), subject.settings.roots
    first = {it.name: it for it in reversed(used_files(subject)) if it.scheme in ("package", "")}
    asked = (it for it in reversed(first.values()) if "$" not in it.name and "\\" not in it.name)
    folders_of = cache(lambda name, first: _packages(name, first, file, roots))
    return tuple(_looked_up(it, *_where(it, file, folders_of)) for it in asked)


def _looked_up(it: Used, folders: tuple[str, ...], path: str) -> MeshFile:
    if not folders:
        return MeshFile(it, folders, path, "")
    found = [find_in(folder, path) for folder in folders]
    exact = os.path.normpath(path)
    if not any(found) and it.scheme == "package" and any(_installs(at, exact) for at in folders):
        return MeshFile(it, folders, path, exact)
    return MeshFile(it, folders, path, exact if exact in found else next(filter(None, found), ""))


def _installs(folder: str, path: str) -> bool:
    """Does CMake put a file of another folder of the package there?"""
    if _CMAKE not in entries(folder):
        return False
    for words, below in _INSTALLED.findall(read_file(os.path.join(folder, _CMAKE))):
        for word in words.decode("utf-8", "replace").split():
            inner = "" if word.endswith("/") else os.path.basename(word)
            start = os.path.join(below.decode("utf-8", "replace"), inner)
            rest = os.path.relpath(path, start or ".")
            if not rest.startswith("..") and find_in(folder, os.path.join(word, rest)):
                return True
    return False


def _where(
    it: Used, file: str, folders_of: Callable[[str, str], tuple[str, ...]]
) -> tuple[tuple[str, ...], str]:
    """The folders in which a file may be, and its path below them."""
    if it.scheme == "":
        here = os.path.dirname(os.path.abspath(file))
        return (here, os.path.dirname(here)), it.path
    package, _, path = _unquoted(it.path).partition("/")
    if not package or not path:
        return (), ""
    path = path.lstrip("/")
    return folders_of(package, path.partition("/")[0].lower()), path


def _unquoted(path: str) -> str:
    if "%" not in path:
        return path
    from urllib.parse import unquote  # slow to import, and few names need it

    return unquote(path)


def _packages(name: str, first: str, file: str, roots: tuple[str, ...]) -> tuple[str, ...]:
    """The folders that may be a package; ``first`` is the first folder of a path below it."""
    # A folder without a manifest must at least have that.
    found = package_folders(name, file, roots)
    return tuple(it for it in found if _may_be_the_package(entries(it), first))


def _may_be_the_package(names: frozenset[str], first: str) -> bool:
    return "package.xml" in names or any(name.lower() == first for name in names)


@rule("MB701", "mesh-missing", ERROR)
def mesh_missing(subject: Subject) -> Iterator[Problem]:
    """Files of packages that were found, and relative ones."""
    lost: dict[tuple[str, ...], list[MeshFile]] = {}
    for it in lookups(subject):
        if it.folders and not it.found and not _elsewhere(subject, it):
            lost.setdefault(_missing_folder(it) or (it.path,), []).append(it)
    for first, *others in lost.values():
        near = _nearest(first)
        looked = f"correct the path, or add the file; looked in {first.folders[0]}"
        hint = f"did you mean {near!r}?" if near else looked
        more = f", nor do {len(others)} more in its folder" if others else ""
        message = f"{first.used.name!r} does not exist{more}"
        # A whole folder may be made or loaded by the build; who reads a relative path knows from where.
        sure = first.used.scheme and not _missing_folder(first)
        yield problem(first.used, message, hint)._replace(level="" if sure else WARNING)


def _missing_folder(it: MeshFile) -> tuple[str, ...]:
    """The folder that a file should be in, wherever it was looked for; empty if one of them exists."""
    inner = os.path.dirname(it.path)
    there = any(not inner or find_in(folder, inner) for folder in it.folders)
    return () if there else (*it.folders, inner)


@rule("MB713", "mesh-elsewhere", NOTE)
def mesh_elsewhere(subject: Subject) -> Iterator[Problem]:
    """Relative files that are in the package, but not where the path says."""
    for it in lookups(subject):
        found = _elsewhere(subject, it) if it.folders and not it.found else ""
        if found:
            yield problem(it.used, f"{it.used.name!r} is not there from here", f"use {found}")


def _elsewhere(subject: Subject, it: MeshFile) -> str:
    """A relative file in the description's package, below a folder above it or in meshes."""
    file = os.path.abspath(subject.document.file.removesuffix(EXPANDED))
    own = package_of(file) if it.used.scheme == "" else None
    if own is None:
        return ""
    package, root = own
    tail = os.path.normpath(it.path).replace("../", "")
    here = os.path.dirname(file)
    above = [here[: len(here) - len(rest)] for rest in _ends(here[len(root) :])]
    places = [*((folder, tail) for folder in above), (root, f"meshes/{os.path.basename(tail)}")]
    for folder, path in places:
        found = find_in(folder, path)
        if found:
            return f"package://{package}/{os.path.relpath(os.path.join(folder, found), root)}"
    return ""


def _ends(path: str) -> list[str]:
    """The ends of a path that start with a slash, the shortest first, and with it the empty one."""
    return ["", *(path[at:] for at in range(len(path) - 1, -1, -1) if path[at] == os.sep)]


def _nearest(it: MeshFile) -> str:
    from multibot_rewrite.base.nearest import nearest

    folder = os.path.join(it.folders[0], os.path.dirname(it.path))
    return nearest(os.path.basename(it.path), sorted(entries(folder)))


@rule("MB702", "package-not-found", NOTE)
def package_not_found(subject: Subject) -> Iterator[Problem]:
    """Once for each package."""
    lost = [it for it in lookups(subject) if it.path and not it.folders]
    for package, it in {_package(it): it for it in reversed(lost)}.items():
        yield problem(it.used, f"package {package!r} was not found", "give its folder with --roots")


def _package(it: MeshFile) -> str:
    return it.used.path.partition("/")[0]


@rule("MB703", "mesh-name-case", ERROR)
def mesh_name_case(subject: Subject) -> Iterator[Problem]:
    """Paths that differ from the file only in upper and lower case."""
    for it in lookups(subject):
        if it.found and it.found != os.path.normpath(it.path):
            message = f"{it.path!r} is {it.found!r} on the disk"
            yield problem(it.used, message, f"use {it.found!r}")
