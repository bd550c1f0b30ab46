# SPDX-License-Identifier: Apache-2.0
"""Packages of launch files: a file in one that is named by both; those that are not installed but
there as sources, as a build installs them, and an empty folder for others.

Source: ament_index_python (a file ``share/ament_index/resource_index/packages/NAME`` below a prefix of
AMENT_PREFIX_PATH stands for a package, its files are in ``share/NAME``).
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.sources.packages import (
    MANIFEST,
    package_folders,
    package_of,
    packages_below,
    sources_around,
)
from multibot_rewrite.producers.launch.install_rules import link_share

_INDEX = os.path.join("share", "ament_index", "resource_index", "packages")
_PYTHON = lazy_compile(r"ament_python_install_package\(\s*(\w+)")
# The folder of links to packages, below that of what is made for a launch file.
SOURCES = "sources"
PREFIXES = "AMENT_PREFIX_PATH"
# The prefix of packages that have an empty folder here.
NOT_INSTALLED = "not_installed"


def link_sources(file: str, roots: Iterable[str], folder: str) -> None:
    """Fill a folder with links to the packages below ``roots``, and to those next to the one of the
    launch ``file``."""
    for name, path in packages_for(file, roots).items():
        link_share(name, path, _shared(name, os.path.join(folder, SOURCES)))
        _has_python(name, path)  # known to the forks that ask for it


def add_sources(file: str, roots: Iterable[str], folder: str) -> None:
    """Make the packages known that ``link_sources`` has linked. What is installed is found first, then
    what is below the roots."""
    for name, path in packages_for(file, roots).items():
        if _has_python(name, path):
            sys.path.append(path)
    _search(os.path.join(folder, SOURCES))


@cache
def _has_python(name: str, folder: str) -> bool:
    """Return whether it has a Python package of its own name, or CMakeLists.txt installs another."""
    if os.path.isfile(os.path.join(folder, name, "__init__.py")):
        return True
    with suppress(OSError, UnicodeDecodeError):
        text = Path(folder, "CMakeLists.txt").read_text("utf-8")
        names = _PYTHON.findall(text)
        return any(os.path.isfile(os.path.join(folder, it, "__init__.py")) for it in names)
    return False


def add_empty(name: str, folder: str) -> None:
    """Make a package known that is nowhere: its share folder is empty, and has NOT_INSTALLED in its
    path."""
    prefix = os.path.join(folder, NOT_INSTALLED)
    os.makedirs(_shared(name, prefix))
    _search(prefix)


def add_file(error: BaseException, folder: str) -> bool:
    """Make the file empty that could not be read of such a package: what is in it is not known. False
    for another error."""
    # launch has its own error around what a launch file raises (jazzy invalid_launch_file_error.py).
    lost: BaseException | None = error
    while lost is not None and not isinstance(lost, FileNotFoundError):
        lost = lost.__cause__
    path = str(lost.filename or "") if lost else ""
    share = os.path.join(folder, NOT_INSTALLED, "share", "")
    if not path.startswith(share):
        return False
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "xb"):
        return True


def _search(prefix: str) -> None:
    paths = os.environ.get(PREFIXES, "").split(os.pathsep)
    os.environ[PREFIXES] = os.pathsep.join(dict.fromkeys(filter(None, (*paths, prefix))))


def _shared(name: str, prefix: str) -> str:
    os.makedirs(os.path.join(prefix, _INDEX), exist_ok=True)
    with open(os.path.join(prefix, _INDEX, name), "wb"):
        pass
    return os.path.join(prefix, "share", name)


def packages_for(file: str, roots: Iterable[str]) -> dict[str, str]:
    """Return the folders of the packages that a launch file finds as sources, by their names."""
    own, around = package_of(file), sources_around(file)
    below = packages_below((*roots, *([around] if around else ())))
    found = {name: os.path.abspath(folders[0]) for name, folders in below.items()}
    found = {it: path for it, path in found.items() if os.path.isfile(f"{path}/{MANIFEST}")}
    return found | dict([own] if own else [])


ROOTS = "source its workspace, or give the folder of its sources with --roots (launch_roots:)"


def file_of_package(package: str, name: str, roots: tuple[str, ...]) -> str:
    """Return the path of a file in a package that is installed or, as sources, below ``roots``.
    Raises UsageError unless the package is found and has exactly one file of that name."""
    # What is installed counts first, as for the includes of a launch.
    folders = package_folders(package, os.sep, ()) or package_folders(package, os.sep, roots)
    if not folders:
        raise UsageError(f"launch {package} {name}: package {package!r} is not found; {ROOTS}")
    found: list[str] = []
    for above, below, files in os.walk(folders[0]):
        below[:] = [it for it in below if not it.startswith(".")]
        found += [os.path.join(above, name)] if name in files else []
    found.sort()
    if len(found) == 1:
        return found[0]
    if found:
        both = " and ".join(os.path.relpath(it, folders[0]) for it in found[:2])
        raise UsageError(f"launch {package} {name}: it has {both}; give the path of one")
    raise UsageError(f"launch {package} {name}: {folders[0]} has no such file; correct the name")
