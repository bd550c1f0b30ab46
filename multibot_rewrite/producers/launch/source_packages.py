# SPDX-License-Identifier: Apache-2.0
"""Packages of launch files: installed, there as sources, or an empty folder for a missing one.

Source: ament_index_python (a file ``share/ament_index/resource_index/packages/NAME`` below a prefix of
AMENT_PREFIX_PATH stands for a package, its files are in ``share/NAME``). What a build installs is known
by ``install(DIRECTORY config/ DESTINATION share/x/params)`` in CMakeLists.txt and ``data_files`` in
setup.py; of a package in Python the folders inside of its module are installed with its own."""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from glob import glob
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.description.sources.packages import (
    MANIFEST,
    package_folders,
    package_of,
    packages_below,
    sources_around,
)

_INDEX = os.path.join("share", "ament_index", "resource_index", "packages")
_RULE = lazy_compile(
    r"(?i)install\(\s*(?:DIRECTORY|FILES)\s([^()]*?)\sDESTINATION\s+\"?([^\s)\"]+)"
)
_PROJECT = lazy_compile(r"\$\{(?:PROJECT_NAME|CMAKE_PROJECT_NAME)\}")
_PYTHON = lazy_compile(r"ament_python_install_package\(\s*(\w+)")
# No longer path is one: a setup.py may double a text again and again.
_LONGEST = 4096
# The folder of links to packages, below that of what is made for a launch file.
SOURCES = "sources"
PREFIXES = "AMENT_PREFIX_PATH"
# The prefix of packages that have an empty folder here.
NOT_INSTALLED = "not_installed"


def link_sources(file: str, roots: Iterable[str], folder: str) -> None:
    """Link the packages below ``roots``, and those next to the launch ``file``'s, into a folder."""
    for name, path in packages_for(file, roots).items():
        link_share(name, path, _add_share(name, os.path.join(folder, SOURCES)))
        _has_python(name, path)  # known to the forks that ask for it


def add_sources(file: str, roots: Iterable[str], folder: str) -> None:
    """Make packages known that ``link_sources`` has linked; what is installed comes first."""
    for name, path in packages_for(file, roots).items():
        if _has_python(name, path):
            sys.path.append(path)
    _add_prefix(os.path.join(folder, SOURCES))


@cache
def _has_python(name: str, folder: str) -> bool:
    """Return whether a package has a Python package of its name, or its CMakeLists.txt another."""
    if os.path.isfile(os.path.join(folder, name, "__init__.py")):
        return True
    with suppress(OSError, UnicodeDecodeError):
        text = Path(folder, "CMakeLists.txt").read_text("utf-8")
        names = _PYTHON.findall(text)
        return any(os.path.isfile(os.path.join(folder, it, "__init__.py")) for it in names)
    return False


def add_empty(name: str, folder: str) -> None:
    """Add a package that is not installed: its empty share folder has NOT_INSTALLED in its path."""
    prefix = os.path.join(folder, NOT_INSTALLED)
    os.makedirs(_add_share(name, prefix))
    _add_prefix(prefix)


def add_file(error: BaseException, folder: str) -> bool:
    """Add an empty file of an added package for one that was not found; False for other errors."""
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


def _add_prefix(prefix: str) -> None:
    paths = os.environ.get(PREFIXES, "").split(os.pathsep)
    os.environ[PREFIXES] = os.pathsep.join(dict.fromkeys(filter(None, (*paths, prefix))))


def _add_share(name: str, prefix: str) -> str:
    """Register a package below a prefix, and return its share folder."""
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
    """Return a file of a package, installed or below ``roots``; raises UsageError unless one."""
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


def link_share(name: str, folder: str, share: str) -> None:
    """Make ``share`` the share folder of a package, of links to its sources."""
    elsewhere = [*_by_cmake(name, folder), *_by_setup(name, folder), *_by_module(name, folder)]
    os.symlink(folder, share)
    for path, source in elsewhere:
        _link(share, path.split("/"), source)


def _by_cmake(name: str, folder: str) -> Iterator[tuple[str, str]]:
    """Yield what is installed under another path than it has: that path, and the source."""
    text = ""
    with suppress(OSError, UnicodeDecodeError):
        text = Path(folder, "CMakeLists.txt").read_text("utf-8")
    for words, target in _RULE.findall(text):
        to = _PROJECT.sub(name, target).strip("/")
        if not f"{to}/".startswith(f"share/{name}/"):
            continue
        for word in words.split():
            source = os.path.join(folder, word.rstrip("/"))
            contents = os.listdir(source) if word.endswith("/") and os.path.isdir(source) else [""]
            for one in contents:
                own = os.path.join(source, one) if one else source
                path = os.path.join(to, os.path.basename(own)).removeprefix(f"share/{name}/")
                if os.path.exists(own) and path != os.path.relpath(own, folder):
                    yield path, own


def _by_setup(name: str, folder: str) -> Iterator[tuple[str, str]]:
    """Yield what ``data_files`` of a setup.py install under another path: that path, and the source."""
    with suppress(OSError, ValueError, SyntaxError, RecursionError):
        read = _Setup(folder, {})
        for it in ast.walk(ast.parse(Path(folder, "setup.py").read_text("utf-8"))):
            if isinstance(it, ast.Assign) and isinstance(it.targets[0], ast.Name):
                read.texts[it.targets[0].id] = read.text(it.value)[:_LONGEST]
            elif isinstance(it, ast.Tuple) and len(it.elts) == 2:
                to = read.text(it.elts[0]).strip("/")
                for own in read.files(it.elts[1]) if f"{to}/".startswith(f"share/{name}/") else ():
                    path = f"{to}/{os.path.basename(own)}".removeprefix(f"share/{name}/")
                    if path != os.path.relpath(own, folder):
                        yield path, own


class _Setup(NamedTuple):
    """Expressions of the setup.py in a ``folder``; ``texts`` are its variables, empty if unknown."""

    folder: str
    texts: dict[str, str]

    def text(self, it: ast.AST) -> str:
        """Return the text of an expression, as of ``os.path.join('share', package_name)``."""
        if isinstance(it, ast.Constant):
            return str(it.value)
        if isinstance(it, ast.Name):
            return self.texts.get(it.id, "")
        if isinstance(it, ast.FormattedValue):
            return self.text(it.value)
        if isinstance(it, ast.JoinedStr):
            return "".join(map(self.text, it.values))
        if isinstance(it, ast.BinOp):
            return self.text(it.left) + self.text(it.right)
        return "/".join(map(self.text, it.args)) if isinstance(it, ast.Call) else ""

    def files(self, it: ast.AST) -> list[str]:
        """Return the files that an expression names, as ``glob('launch/*')``, in the folder."""
        if isinstance(it, ast.BinOp):
            return self.files(it.left) + self.files(it.right)
        every = it.elts if isinstance(it, ast.List) else it.args if isinstance(it, ast.Call) else ()
        named = [self.text(one).lstrip("/") for one in every]
        found = (glob(os.path.join(self.folder, one)) for one in named if ".." not in one)
        return sorted(path for paths in found for path in paths if os.path.isfile(path))


def _by_module(name: str, folder: str) -> Iterator[tuple[str, str]]:
    """Yield folders of a Python module that are installed as share folders: name and source."""
    module = os.path.join(folder, name)
    if os.path.isfile(os.path.join(folder, "setup.py")) and os.path.isdir(module):
        for it in os.listdir(module):
            inside = os.path.join(module, it)
            if os.path.isdir(inside) and not os.path.exists(os.path.join(folder, it)):
                yield it, inside


def _link(folder: str, path: list[str], source: str) -> None:
    """Make a link below a folder that may be one itself: then it becomes a folder of links."""
    if os.path.islink(folder):
        real = os.path.realpath(folder)
        os.unlink(folder)
        os.mkdir(folder)
        for it in os.listdir(real):
            os.symlink(os.path.join(real, it), os.path.join(folder, it))
    os.makedirs(folder, exist_ok=True)
    there = os.path.join(folder, path[0])
    if len(path) > 1:
        _link(there, path[1:], source)
    elif not os.path.lexists(there):
        os.symlink(source, there)
    elif os.path.isdir(source) and os.path.isdir(there):
        for it in os.listdir(source):  # two folders that are installed under one name are one
            _link(there, [it], os.path.join(source, it))
