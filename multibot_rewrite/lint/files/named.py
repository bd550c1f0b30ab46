# SPDX-License-Identifier: Apache-2.0
"""The names of related files of a description, and the robots in them: loaded for kept results, too."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice

from multibot_rewrite.base.bounded import read_start
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import outside
from multibot_rewrite.description.sources.packages import entries

_NAME = lazy_compile(rb"<robot\b[^<>]*?\sname\s*=\s*[\"']([^\"'$<]+)[\"']")
# What the name of an SRDF has in it.
SRDF_MARK = ".srdf"
# The root element is in the first bytes: the whole file need not be read.
HEAD = 4096
# A package's folders, how deep, and how many files of it are looked at.
_SKIPPED = frozenset(("meshes", "mesh", "test", "tests", "build", "install", "log", "worlds"))
_DEEP, _MOST = 3, 60


@outside
def robot_name(path: str) -> str:
    """Return the name on the root element as it is written; empty if the first bytes lack it."""
    try:
        found = _NAME.search(read_start(path, HEAD))
    except (OSError, ValueError):
        return ""
    return found[1].decode("utf-8", "replace").strip() if found else ""


@outside
def files_like(pattern: str) -> tuple[str, ...]:
    """Return the files that a pattern names, in order."""
    from glob import glob  # few descriptions come to this

    return tuple(sorted(glob(pattern)))


def descriptions_below(folder: str) -> list[str]:
    """Return the URDF and xacro files of a package, the first ones of many."""
    return list(islice(_files_below(folder, _DEEP), _MOST))


def _files_below(folder: str, deep: int) -> Iterator[str]:
    inner = []
    for name in sorted(entries(folder)):
        if name.endswith((".urdf", ".xacro")):
            yield os.path.join(folder, name)
        elif "." not in name and name not in _SKIPPED:
            inner.append(os.path.join(folder, name))
    for it in inner if deep else ():
        yield from _files_below(it, deep - 1)
