# SPDX-License-Identifier: Apache-2.0
"""Folders of sources -> what they say. A folder is called REPOSITORY@VERSION."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.producers.sources.cpp import read_cpp
from multibot_rewrite.producers.sources.python import read_python
from multibot_rewrite.producers.sources.records import Place, Source, joined

READERS = {".cpp": read_cpp, ".cc": read_cpp, ".hpp": read_cpp, ".h": read_cpp, ".py": read_python}
# Not what a robot runs.
SKIPPED = {
    "test",
    "tests",
    "demos",
    "demo",
    "examples",
    "launch",
    "doc",
    "docs",
    "tutorials",
    "benchmark",
}


def read_folder(folder: Path) -> Source:
    """Return what all files of a checkout say; raises UsageError for what is no checkout."""
    if not folder.is_dir() or "@" not in folder.name:
        raise UsageError(f"{folder}: not a folder called REPOSITORY@VERSION")
    repository, _, version = folder.name.partition("@")
    return joined([_read(path, folder, repository, version) for path in _files(folder)])


def _files(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        if path.suffix in READERS and not SKIPPED & set(inside.parts[:-1]):
            yield path


def _read(path: Path, folder: Path, repository: str, version: str) -> Source:
    inside = path.relative_to(folder).as_posix()
    place = Place(repository, version, inside, 0, _package(path, folder))
    return READERS[path.suffix](path.read_text(encoding="utf-8", errors="replace"), place)


def _package(path: Path, folder: Path) -> str:
    """Return the nearest folder above that has a package.xml."""
    for above in path.parents:
        if above == folder or (above / "package.xml").exists():
            return above.name if above != folder else folder.name.partition("@")[0]
    return ""
