# SPDX-License-Identifier: Apache-2.0
"""Paths that a launch file names, as they are when the launch has been read: what it makes is gone."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable

LIMIT = 1 << 24


def is_made(path: str) -> bool:
    """Is it a file of the launch itself?"""
    return os.path.realpath(path).startswith(os.path.realpath(tempfile.gettempdir()) + os.sep)


def lasting(words: Iterable[str]) -> list[str]:
    """Words with paths that are there when the launch is over: the folder with links to sources is gone
    then. Of a file that the launch makes its text is kept (``-string``)."""
    kept = list(words)
    for at, word in enumerate(kept):
        if at and kept[at - 1] == "-file" and is_made(word) and os.path.isfile(word):
            kept[at - 1 : at + 1] = "-string", read_text(word)
        elif word.startswith(tempfile.gettempdir() + os.sep) and not is_made(word):
            kept[at] = os.path.realpath(word)
    return kept


def read_text(path: str) -> str:
    """The text of a file, up to a limit."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read(LIMIT)


def kept_file(path: str) -> str:
    """The real path of a file that is there when the launch is over, else nothing."""
    return os.path.realpath(path) if os.path.isfile(path) and not is_made(path) else ""


def lasting_folders(text: str) -> str:
    """A list of folders, as they are when the launch is over: in the place of one with links to the
    sources of packages the folders of these, each once."""
    found: dict[str, None] = {}
    for it in lasting(text.split(os.pathsep)):
        links = [one.path for one in os.scandir(it)] if is_made(it) and os.path.isdir(it) else []
        found |= dict.fromkeys(os.path.dirname(os.path.realpath(one)) for one in links)
        found |= {} if links else {it: None}
    return os.pathsep.join(found)
