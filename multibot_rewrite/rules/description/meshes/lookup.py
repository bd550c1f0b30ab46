# SPDX-License-Identifier: Apache-2.0
"""Files and packages that do not exist; how large the meshes are, and where they end."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, lru_cache
from math import isfinite
from struct import iter_unpack
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.outside import file_state, is_file, kept_bytes
from multibot_rewrite.description.checks.numbers import Vector, vector
from multibot_rewrite.description.checks.poses import minus
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.shapes import Extent
from multibot_rewrite.description.sources.packages import (
    entries,
    find_in,
    package_folders,
    package_of,
)
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.rules.description.meshes.paths import Used, problem, used_files
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import EXPANDED, Subject

_CMAKE = "CMakeLists.txt"
# install(DIRECTORY a b DESTINATION share/${PROJECT_NAME}/below)
_INSTALLED = lazy_compile(
    rb"install\s*\(\s*DIRECTORY\s([^()]*?)\sDESTINATION\s+\"?share/\$\{PROJECT_NAME\}/?([^\s\")]*)",
    0,
)


class MeshFile(NamedTuple):
    """A file that was looked for: folders, path below them, and path on the disk, empty if missing."""

    used: Used
    folders: tuple[str, ...]
    path: str
    found: str


@memoized
def lookups(subject: Subject) -> tuple[MeshFile, ...]:
    """Return each file that can be looked for, once, with the first element that names it."""
    file, roots = subject.document.file.removesuffix(EXPANDED), subject.settings.roots
    first = {it.name: it for it in reversed(used_files(subject)) if it.scheme in ("package", "")}
    asked = (it for it in reversed(first.values()) if "$" not in it.name and "\\" not in it.name)
    folders_of = cache(lambda name, first: _package_folders(name, first, file, roots))
    return tuple(_looked_up(it, *_search_path(it, file, folders_of)) for it in asked)


def _looked_up(it: Used, folders: tuple[str, ...], path: str) -> MeshFile:
    """Return the file that a path below some folders is."""
    if not folders:
        return MeshFile(it, folders, path, "")
    found = [find_in(folder, path) for folder in folders]
    exact = os.path.normpath(path)
    if not any(found) and it.scheme == "package" and any(_installs(at, exact) for at in folders):
        return MeshFile(it, folders, path, exact)
    return MeshFile(it, folders, path, exact if exact in found else next(filter(None, found), ""))


def _installs(folder: str, path: str) -> bool:
    """Return whether the package's CMakeLists.txt installs a file of another folder at this path."""
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


def _search_path(
    it: Used, file: str, folders_of: Callable[[str, str], tuple[str, ...]]
) -> tuple[tuple[str, ...], str]:
    """Return the folders in which a file may be, and its path below them."""
    if it.scheme == "":
        here = os.path.dirname(os.path.abspath(file))
        return (here, os.path.dirname(here)), it.path
    package, _, path = _unquoted_path(it.path).partition("/")
    if not package or not path:
        return (), ""
    path = path.lstrip("/")
    return folders_of(package, path.partition("/")[0].lower()), path


def _unquoted_path(path: str) -> str:
    if "%" not in path:
        return path
    from urllib.parse import unquote  # slow to import, and few names need it

    return unquote(path)


def _package_folders(name: str, first: str, file: str, roots: tuple[str, ...]) -> tuple[str, ...]:
    """Return the folders that may be a package; ``first`` is the first folder of a path below it."""
    found = ((it, entries(it)) for it in package_folders(name, file, roots))
    # A folder without a manifest must at least have that.
    return tuple(
        folder
        for folder, names in found
        if "package.xml" in names or any(name.lower() == first for name in names)
    )


@rule("MB701", "mesh-missing", ERROR)
def mesh_missing(subject: Subject) -> Iterator[Problem]:
    """Report missing files of packages that were found, and missing relative ones."""
    lost = (it for it in lookups(subject) if it.folders and not it.found)
    alike = lists_by_key(
        (_missing_folder(it) or (it.path,), it) for it in lost if not _uri_elsewhere(subject, it)
    )
    for first, *others in alike.values():
        folder = os.path.join(first.folders[0], os.path.dirname(first.path))
        near = nearest(os.path.basename(first.path), sorted(entries(folder)))
        looked = f"correct the path, or add the file; looked in {first.folders[0]}"
        hint = f"did you mean {near!r}?" if near else looked
        more = f", nor do {len(others)} more in its folder" if others else ""
        message = f"{first.used.name!r} does not exist{more}"
        # A whole folder may be made or loaded by the build; who reads a relative path knows from where.
        sure = first.used.scheme and not _missing_folder(first)
        yield problem(first.used, message, hint)._replace(level="" if sure else WARNING)


def _missing_folder(it: MeshFile) -> tuple[str, ...]:
    """Return the folders that were searched and the missing folder; empty if one of them has it."""
    inner = os.path.dirname(it.path)
    there = any(not inner or find_in(folder, inner) for folder in it.folders)
    return () if there else (*it.folders, inner)


@rule("MB713", "mesh-elsewhere", NOTE)
def mesh_elsewhere(subject: Subject) -> Iterator[Problem]:
    """Report relative files that are in the package, but not where the path says."""
    for it in lookups(subject):
        found = _uri_elsewhere(subject, it) if it.folders and not it.found else ""
        if found:
            yield problem(it.used, f"{it.used.name!r} is not there from here", f"use {found}")


def _uri_elsewhere(subject: Subject, it: MeshFile) -> str:
    """Return the package URI of a relative file that exists elsewhere in its package, or empty."""
    file = os.path.abspath(subject.document.file.removesuffix(EXPANDED))
    own = package_of(file) if it.used.scheme == "" else None
    if own is None:
        return ""
    package, root = own
    tail = os.path.normpath(it.path).replace("../", "")
    here = os.path.dirname(file)
    within = here[len(root) :]
    # The folders from its own up to the package's.
    steps = (at for at in range(len(within) - 1, -1, -1) if within[at] == os.sep)
    above = [here, *(here[: len(root) + at] for at in steps)]
    places = [*((folder, tail) for folder in above), (root, f"meshes/{os.path.basename(tail)}")]
    for folder, path in places:
        if found := find_in(folder, path):
            return f"package://{package}/{os.path.relpath(os.path.join(folder, found), root)}"
    return ""


@rule("MB702", "package-not-found", NOTE)
def package_not_found(subject: Subject) -> Iterator[Problem]:
    """Report each missing package once."""
    lost = [it for it in lookups(subject) if it.path and not it.folders]
    for package, it in {it.used.path.partition("/")[0]: it for it in reversed(lost)}.items():
        yield problem(it.used, f"package {package!r} was not found", "give its folder with --roots")


@rule("MB703", "mesh-name-case", ERROR)
def mesh_name_case(subject: Subject) -> Iterator[Problem]:
    """Report paths that differ from the file only in upper and lower case."""
    for it in lookups(subject):
        if it.found and it.found != os.path.normpath(it.path):
            message = f"{it.path!r} is {it.found!r} on the disk"
            yield problem(it.used, message, f"use {it.found!r}")


# Metres: the longest side, and the one after it; a long and thin mesh may be a rail.
LONG, WIDE = 50.0, 10.0
HINT = 'are these millimetres? add scale="0.001 0.001 0.001"'
HINT_OF_UNIT = 'correct <unit meter> in the file, or add scale="0.001 0.001 0.001"'


def box_of(subject: Subject, mesh: _Element, whole: bool = True) -> Extent | None:
    """Return the box around a ``<mesh>`` in its own frame, in metres; as ``mesh_box``."""
    path = _mesh_paths(subject).get((mesh.get("filename") or "").strip(), "")
    box = mesh_box(path, whole) if path else None
    if box is None or "scale" not in mesh.attrib:
        return box
    scale = vector(mesh.get("scale"))
    if scale is None:
        return None
    ends = [(a * s, b * s) for a, b, s in zip(box.low, box.high, scale, strict=True)]
    (a, d), (b, e), (c, f) = map(sorted, ends)
    return Extent((a, b, c), (d, e, f))


@memoized
def _mesh_paths(subject: Subject) -> Mapping[str, str]:
    """Return where the meshes are on the disk, by the name in the description."""
    asked = (
        (it, [os.path.join(above, it.found) for above in it.folders]) for it in lookups(subject)
    )
    found = {it.used.name: next(filter(is_file, at), "") for it, at in asked if it.found}
    direct = (it for it in used_files(subject) if it.scheme == "file" and is_file(it.path))
    return found | {it.name: it.path for it in direct}


@rule("MB714", "mesh-units", WARNING)
def mesh_units(subject: Subject) -> Iterator[Problem]:
    """Report each mesh once; the beginning of a file is enough to tell that it is too large."""
    seen: set[tuple[str, str]] = set()
    for mesh in (it.element for it in used_files(subject) if it.element.tag == "mesh"):
        key = (mesh.get("filename", ""), mesh.get("scale", ""))
        box = None if key in seen else box_of(subject, mesh, whole=False)
        seen.add(key)
        sides = sorted(minus(box.high, box.low)) if box else (0.0,) * 3
        if sides[2] >= LONG and sides[1] >= WIDE:
            message = f"{key[0]!r} is {sides[2]:.3g} m long"
            of_unit = key[0].strip().lower().endswith(COLLADA)
            yield Problem(mesh, message, "filename", HINT_OF_UNIT if of_unit else HINT)


# A larger file is not read as a whole; its beginning tells at least how large it is.
MOST_BYTES, BEGINNING = 4 * 2**20, 64 * 2**10
# A binary STL: 80 bytes of anything, how many triangles, and 50 bytes for each.
_HEAD, _TRIANGLE = 84, 50
_WORD = rb"[ \t]+([-+.\deE]+)"
COLLADA = ".dae"
_CORNER = {
    ".stl": lazy_compile(rb"\bvertex" + _WORD * 3),
    ".obj": lazy_compile(rb"(?m)^[ \t]*v" + _WORD * 3),
}


def mesh_box(path: str, whole: bool = True) -> Extent | None:
    """Return the box around a mesh, or around its start if not ``whole``; None if it is unknown."""
    state, kind = file_state(path), os.path.splitext(path)[1].lower()
    # The scene, which says what is shown and where, is at the end of a Collada file.
    whole = whole or kind == COLLADA
    known = state and (kind == COLLADA or kind in _CORNER)
    return _box(path, state, whole) if known else None


@lru_cache(maxsize=1024)
def _box(path: str, state: tuple[int, ...], whole: bool) -> Extent | None:
    """Return ``mesh_box`` for a file in that state, which the result is kept for."""
    size = state[1]
    if whole and size > MOST_BYTES:
        return None
    try:
        data = kept_bytes(path, MOST_BYTES if whole else BEGINNING)
    except OSError:
        return None
    if path.lower().endswith(COLLADA):
        from multibot_rewrite.description.checks.shapes import (
            collada_box,
        )  # few descriptions are near such a file

        return collada_box(data)
    columns = list(zip(*_corners(path, data, size), strict=True))
    if not columns or not isfinite(sum(map(sum, columns))):
        return None
    (a, b, c), (d, e, f) = ([best(it) for it in columns] for best in (min, max))
    return Extent((a, b, c), (d, e, f))


def _corners(path: str, data: bytes, size: int) -> Iterable[Vector]:
    kind = os.path.splitext(path)[1].lower()
    count = int.from_bytes(data[_HEAD - 4 : _HEAD], "little")
    if kind == ".stl" and size == _HEAD + count * _TRIANGLE:
        whole = (len(data) - _HEAD) // _TRIANGLE * _TRIANGLE
        for it in iter_unpack("<12x9f2x", data[_HEAD : _HEAD + whole]):
            yield from (it[:3], it[3:6], it[6:])
        return
    for found in _CORNER[kind].finditer(data):
        try:
            x, y, z = map(float, found.groups())
        except ValueError:
            return
        yield x, y, z
