# SPDX-License-Identifier: Apache-2.0
"""The files of a program: where it starts, and what it imports or includes, as far as that is here."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.sources.cpp import read_cpp
from multibot_rewrite.producers.sources.python import read_python
from multibot_rewrite.producers.sources.records import Place, Source, joined

READERS = {
    **dict.fromkeys((".cpp", ".cc", ".cxx", ".hpp", ".h", ".hh", ".hxx"), read_cpp),
    ".py": read_python,
}
NOT_RUN = ("test", "tests", "build")
MOST_FILES, MOST_LETTERS = 200, 1_000_000
Packages = Mapping[str, str]


class Read(NamedTuple):
    """What the files of a program say, and which they are."""

    source: Source
    files: tuple[str, ...]


def read_program(files: Sequence[str], packages: Packages) -> Read:
    """Return what files declare, with all that they import or include of these packages."""
    found: dict[str, Source] = {}
    waiting = [*files]
    while waiting and len(found) < MOST_FILES:
        path = os.path.realpath(waiting.pop(0))
        if path not in found:
            found[path] = _read(path)
            follow = _included if path.endswith(tuple(READERS)[:-1]) else _imported
            waiting += (it for one in found[path].imports for it in follow(path, one, packages))
    faults = [(Place("", "", it, 1), "is one file too many to be read") for it in waiting[:1]]
    left = Source(faults=tuple(faults) if len(found) >= MOST_FILES else ())
    return Read(joined([*found.values(), left]), tuple(found))


def _read(path: str) -> Source:
    place = Place("", "", path)
    try:
        data = read_file(path)
        changed = os.stat(path).st_mtime_ns
    except (InputError, OSError):
        return Source(faults=((place, "cannot be read"),))
    if len(data) > MOST_LETTERS:
        return Source(faults=((place, f"has more than {MOST_LETTERS} letters"),))
    return _parsed(path, data, changed)


@lru_cache(maxsize=512)
def _parsed(path: str, data: bytes, changed: int) -> Source:
    """Return a file's source, parsed once, however many programs have it."""
    place = Place("", "", path)
    text = data.decode("utf-8", "replace")
    reader = READERS.get(os.path.splitext(path)[1], read_python)
    found = reader(text, place)
    if "\ufffd" in text:
        found = found._replace(faults=(*found.faults, (place, "is not UTF-8")))
    return found


def _imported(path: str, module: str, packages: Packages) -> Iterator[str]:
    """Yield the file of a module: next to the one that imports it, or of a package that is found."""
    bare = module.lstrip(".")
    level = len(module) - len(bare)
    steps = bare.split(".") if bare else []
    folder = os.path.dirname(path)
    for _ in range(level - 1):
        folder = os.path.dirname(folder)
    roots = [folder]
    if not level and steps and steps[0] in packages:
        roots += [packages[steps[0]], os.path.join(packages[steps[0]], "src")]
    for root in roots:
        yield from module_files(root, steps)


def module_files(root: str, steps: Sequence[str]) -> Iterator[str]:
    """Yield the file of a Python module below a folder, if it exists."""
    base = os.path.join(root, *steps)
    both = (f"{base}.py", os.path.join(base, "__init__.py")) if steps else ()
    yield from (it for it in both if os.path.isfile(it))


def _included(path: str, name: str, packages: Packages) -> Iterator[str]:
    """Yield a header that is included, and the unit of the same name in its package."""
    head = name.partition("/")[0]
    own = _package_of(path, packages)
    near = [packages[head]] if head in packages else []
    folders = [os.path.dirname(path)]
    for it in dict.fromkeys((*near, *([own] if own else []))):
        folders += [os.path.join(it, "include"), os.path.join(it, "src"), it]
        folders.append(os.path.join(it, "include", os.path.basename(it)))
    for it in folders:
        header = os.path.normpath(os.path.join(it, name))
        if os.path.isfile(header) and header.endswith(tuple(READERS)):
            yield header
            package = _package_of(header, packages)
            stem = os.path.splitext(os.path.basename(header))[0]
            units = {f"{stem}{end}" for end in (".cpp", ".cc", ".cxx")}
            every = sources_in(package) if package else ()
            yield from (one for one in every if os.path.basename(one) in units)
            return


def _package_of(path: str, packages: Packages) -> str:
    folders = (it for it in packages.values() if path.startswith(f"{os.path.realpath(it)}{os.sep}"))
    return next(folders, "")


def start_of_file(*path: str) -> str:
    """Return the text of a file, as far as it is read; empty for what is none."""
    file = os.path.join(*path)
    try:
        with open(file if os.path.isfile(file) else os.devnull, "rb") as opened:
            return opened.read(MOST_LETTERS).decode("utf-8", "replace")
    except OSError:
        return ""


@lru_cache(maxsize=64)
def sources_in(folder: str) -> tuple[str, ...]:
    """Return the files of a package that can be read, except its tests."""
    found: list[str] = []
    for above, folders, names in os.walk(folder):
        folders[:] = sorted(it for it in folders if it[0] != "." and it not in NOT_RUN)
        found += (os.path.join(above, it) for it in sorted(names) if it.endswith(tuple(READERS)))
        if len(found) > MOST_FILES * 10:
            break
    return tuple(found)
