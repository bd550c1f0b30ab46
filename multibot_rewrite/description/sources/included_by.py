# SPDX-License-Identifier: Apache-2.0
"""Which xacro files include which: one that only defines macros is no robot, what includes it is."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.lazy import FILLED_IN, lazy_compile, with_gaps
from multibot_rewrite.base.left_out import source_folders
from multibot_rewrite.base.outside import outside
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import XACRO, has_xacro

# Files that are looked at; of a larger one nothing is read.
MOST_FILES, MOST_BYTES = 20_000, 4_000_000
TESTS = frozenset(("test", "tests"))
_INCLUDED = lazy_compile(rb"""<(?:\w+:)?include\b[^<>]*\bfilename\s*=\s*["']([^"'<]+)["']""")
_FILLED = lazy_compile(FILLED_IN)
_MACRO = lazy_compile(rb"<\w+:macro\b")
_FIND = lazy_compile(r"\$\(find(?:-pkg-share)?\s+([\w.-]+)\)/*")


def whole_robots(file: str) -> list[str]:
    """Return the xacros of its package that include a file and are not included themselves."""
    path = os.path.abspath(file)
    home = (package_of(path) or ("", os.path.dirname(path)))[1]
    above = includers(((it, data_of_file(it)) for it in _xacro_files(home)), composed=True)
    found = [path]
    for it in found:  # grows
        found += sorted(above.get(it, set()) - set(found))
    named = os.path.abspath if os.path.isabs(file) else os.path.relpath
    return [named(it) for it in found[1:] if not above.get(it)]


@outside
def robot_instead(file: str) -> str:
    """Return the hint for a description without a link; ``file`` may be its shown name."""
    path = file.removesuffix(" (expanded)")
    data = data_of_file(path)
    users = whole_robots(path) if has_xacro(data) else []
    what = "it defines macros; " if _MACRO.search(data) else ""
    instead = f"{users[0]}, which includes it" if users else "the file that has the robot"
    return f"{what}give {instead}"


def includers(texts: Iterable[tuple[str, bytes]], *, composed: bool = False) -> dict[str, set[str]]:
    """Return by file those of the other files that include it."""
    # A name that is ``composed``, as ``${arm}_macro.xacro``, may be that of several files.
    paths: list[str] = []
    named: dict[str, list[tuple[str, str]]] = {}
    for path, data in texts:
        paths.append(path)
        for it in _INCLUDED.findall(data) if path.endswith(XACRO) else ():
            file = it.decode("utf-8", "replace")
            named.setdefault(os.path.basename(file), []).append((file, path))
    filled = [it for it in named if composed and "$" in it]
    found: dict[str, set[str]] = {}
    for path in paths:
        own = os.path.basename(path)
        alike = (it for it in filled if re.fullmatch(with_gaps(_FILLED.split(it), "."), own))
        for name in (own, *alike):
            for file, other in named.get(name, ()):
                if _may_include(file, path, other):
                    found.setdefault(path, set()).add(other)
    return found


def parts_among(paths: Iterable[str], above: Mapping[str, Collection[str]]) -> set[str]:
    """Return the files that are included, at any depth, by a file that nothing includes."""
    # A loop of includes has no such file, and expanding it reports it.
    found = {it for it in paths if not above.get(it)}
    tops = set(found)
    while more := {it for it, by in above.items() if not found.isdisjoint(by)} - found:
        found |= more
    return found - tops


def data_of_file(path: str) -> bytes:
    """Return the bytes of a file, none if it is too large or cannot be read."""
    with suppress(OSError, ValueError):
        return read_bytes(path, MOST_BYTES)
    return b""


@outside
def _xacro_files(folder: str) -> list[str]:
    found: list[str] = []
    seen = 0
    for above, folders, names in os.walk(folder):
        folders[:] = (it for it in source_folders(above, folders) if it not in TESTS)
        seen += len(names)
        if seen > MOST_FILES:
            break
        paths = (os.path.join(above, it) for it in names if it.endswith(XACRO))
        found += map(os.path.normpath, paths)
    return found


def _may_include(included: str, path: str, by: str) -> bool:
    """Return whether an include may mean this file; with ``${...}`` the base name counts."""
    if path == by:
        return False
    package = _FIND.match(included)
    rest = included[package.end() :] if package else included
    if "$" in rest or os.path.isabs(rest):
        return True
    if not package:
        return os.path.normpath(os.path.join(os.path.dirname(by), rest)) == path
    own = package_of(path)
    return own is not None and package[1] in (own[0], os.path.basename(own[1]))
