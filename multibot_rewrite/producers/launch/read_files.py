# SPDX-License-Identifier: Apache-2.0
"""The descriptions that a launch file reads itself: of a text that a node gets, the file is known."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from typing import Any

from multibot_rewrite.producers.launch.records import ParameterText

_ENDINGS = (".urdf", ".sdf", ".xml", ".model")
_LIMIT = 1 << 24


def keep_reads() -> list[str]:
    """From now on every description that is opened in this process is in the list."""
    found: list[str] = []

    def opened(event: str, words: tuple[Any, ...]) -> None:
        if event == "open" and isinstance(words[0], str) and words[0].endswith(_ENDINGS):
            found.append(words[0])

    sys.addaudithook(opened)
    return found


def descriptions_in(paths: Iterable[str]) -> Iterator[tuple[str, ParameterText]]:
    """The text of each of these files."""
    for path in dict.fromkeys(map(os.path.realpath, paths)):
        if os.path.isfile(path) and os.path.getsize(path) < _LIMIT:
            with open(path, encoding="utf-8", errors="replace") as file:
                yield path, ParameterText(path, file.read(), path)
