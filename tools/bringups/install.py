# SPDX-License-Identifier: Apache-2.0
"""Packages as sources, installed as far as launch files need it: a share folder of links for each.

It shares nothing with the reader of install rules that it judges.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
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


def install(name: str, source: Path, prefix: Path) -> None:
    """Make the share folder of a package: what its CMakeLists.txt installs there, and its sources."""
    share = prefix / "share" / name
    share.mkdir(parents=True)
    for path, target in _installed(name, source):
        merge(path, prefix / target)
    merge(source, share)
    inside = source / name  # of ament_python: folders inside of the module are often installed
    if (source / "setup.py").is_file() and inside.is_dir():
        for it in inside.iterdir():
            if it.is_dir():
                merge(it, share / it.name)


def merge(source: Path, target: Path) -> None:
    """Link a file, or all files below a folder, where there is none yet."""
    if source.is_dir():
        if source.name in (".git", "__pycache__"):
            return
        target.mkdir(parents=True, exist_ok=True)
        for it in source.iterdir():
            merge(it, target / it.name)
    elif not os.path.lexists(target):
        target.parent.mkdir(parents=True, exist_ok=True)
        target.symlink_to(source)


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
