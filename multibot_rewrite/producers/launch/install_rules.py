# SPDX-License-Identifier: Apache-2.0
"""The share folder of a package that exists as sources: as they are, and as a build installs them.

By the install rules of its CMakeLists.txt (``install(DIRECTORY config/ DESTINATION
share/x/params)``); of a package in Python the folders inside of its module are next to those of the
package, too."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_RULE = re.compile(
    r"install\(\s*(?:DIRECTORY|FILES)\s([^()]*?)\sDESTINATION\s+\"?([^\s)\"]+)", re.IGNORECASE
)
_PROJECT = re.compile(r"\$\{(?:PROJECT_NAME|CMAKE_PROJECT_NAME)\}")


def link_share(name: str, folder: str, share: str) -> None:
    """Make ``share`` the share folder of a package, of links to its sources."""
    elsewhere = [*_by_cmake(name, folder), *_by_module(name, folder)]
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


def _by_module(name: str, folder: str) -> Iterator[tuple[str, str]]:
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
