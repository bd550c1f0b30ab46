# SPDX-License-Identifier: Apache-2.0
"""Packages that are there as sources, for launch files that look for them.

Source: ament_index_python (a file ``share/ament_index/resource_index/packages/NAME`` below a prefix of
AMENT_PREFIX_PATH stands for a package, its files are in ``share/NAME``).
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator

_MANIFEST, _INDEX = (
    "package.xml",
    os.path.join("share", "ament_index", "resource_index", "packages"),
)
_PATH = "AMENT_PREFIX_PATH"
_DEPTH = 6


def add_sources(roots: Iterable[str], folder: str) -> None:
    """Make the packages below ``roots`` known; ``folder`` gets links to them.

    What is installed is found first.
    """
    prefix = os.path.join(folder, "sources")
    os.makedirs(os.path.join(prefix, _INDEX))
    for name, path in dict(_packages(roots)).items():
        with open(os.path.join(prefix, _INDEX, name), "wb"):
            pass
        os.symlink(path, os.path.join(prefix, "share", name))
        if os.path.isfile(os.path.join(path, name, "__init__.py")):
            sys.path.append(path)
    os.environ[_PATH] = os.pathsep.join(filter(None, (os.environ.get(_PATH, ""), prefix)))


def _packages(roots: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Name and folder of every package; the first of a name comes last."""
    found = [it for root in roots for it in _below(os.path.abspath(root), 0)]
    yield from reversed(found)


def _below(folder: str, depth: int) -> Iterator[tuple[str, str]]:
    names = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    if _MANIFEST in names:
        name = _name(os.path.join(folder, _MANIFEST))
        yield from [(name, folder)] if name else []
        return
    for name in names if depth < _DEPTH else []:
        path = os.path.join(folder, name)
        if not name.startswith(".") and not os.path.islink(path):
            yield from _below(path, depth + 1)


def _name(path: str) -> str:
    import xml.etree.ElementTree as ET  # the stand-in, with which a build is read back, has no packages

    try:
        return (ET.parse(path).findtext("name") or "").strip()
    except (ET.ParseError, OSError):
        return ""
