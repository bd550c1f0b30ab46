# SPDX-License-Identifier: Apache-2.0
"""Packages as sources, installed as far as launch files need it: a share folder of links for each.

It shares nothing with the reader of install rules that it judges.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree

_INSTALL = re.compile(r"\binstall\s*\(([^()]*)\)", re.IGNORECASE)
_KINDS = {"DIRECTORY", "FILES", "PROGRAMS"}
_ENDS = {"PATTERN", "FILES_MATCHING", "USE_SOURCE_PERMISSIONS", "OPTIONAL", "EXCLUDE", "RENAME"}


def packages(folder: Path) -> dict[str, Path]:
    """Return the packages below a folder, each with its folder; of one name the uppermost."""
    found: dict[str, Path] = {}
    for file in sorted(folder.rglob("package.xml"), key=lambda it: (len(it.parts), it)):
        try:
            name = (ElementTree.parse(file).findtext("name") or "").strip()
        except ElementTree.ParseError:
            continue
        if name:
            found.setdefault(name, file.parent)
    return found


def linked(source: Path, target: Path) -> None:
    """Make a link to a file."""
    target.symlink_to(source)


def copied(source: Path, target: Path) -> None:
    """Copy a file that is there."""
    if source.is_file():
        shutil.copyfile(source, target)


# How a file gets to its place: source, target.
Way = Callable[[Path, Path], None]


def install(name: str, source: Path, prefix: Path, way: Way = linked) -> None:
    """Make the share folder of a package: what its CMakeLists.txt installs there, and its sources."""
    share = prefix / "share" / name
    share.mkdir(parents=True)
    for path, target in _installed(name, source):
        merge(path, prefix / target, way)
    merge(source, share, way)
    inside = source / name  # of ament_python: folders inside of the module are often installed
    if (source / "setup.py").is_file() and inside.is_dir():
        for it in inside.iterdir():
            if it.is_dir():
                merge(it, share / it.name, way)


def merge(source: Path, target: Path, way: Way = linked) -> None:
    """Put a file, or all files below a folder, where there is none yet."""
    if source.is_dir():
        if source.name in (".git", "__pycache__"):
            return
        target.mkdir(parents=True, exist_ok=True)
        for it in source.iterdir():
            merge(it, target / it.name, way)
    elif not os.path.lexists(target):
        target.parent.mkdir(parents=True, exist_ok=True)
        way(source, target)


def _installed(name: str, source: Path) -> Iterator[tuple[Path, str]]:
    """Return what is installed below share, each with its place in the prefix."""
    file = source / "CMakeLists.txt"
    text = file.read_text(errors="replace") if file.is_file() else ""
    text = re.sub(r"#.*", "", text).replace("${PROJECT_NAME}", name).replace('"', " ")
    for inside in _INSTALL.findall(text):
        words = inside.split()
        if words[:1] and words[0].upper() in _KINDS and "DESTINATION" in words:
            at = words.index("DESTINATION")
            to = words[at + 1] if at + 1 < len(words) else ""
            for word in words[1:at]:
                if word.upper() in _ENDS:
                    break
                path = source / word.rstrip("/")
                if to.startswith("share/") and path.exists():
                    yield path, to if word.endswith("/") else f"{to}/{path.name}"
