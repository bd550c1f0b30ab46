# SPDX-License-Identifier: Apache-2.0
"""A CMakeLists.txt -> its calls, with variables put in and loops unrolled; nothing of it is run."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.producers.sources.files import sources_in, start_of_file

LIST = "CMakeLists.txt"
_CALL = re.compile(r"\b([A-Za-z_]\w*)[ \t\r\n]*\(([^()]*)\)")
_WORD = re.compile(r"\"[^\"]*\"|[^\s\";]+")
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_HERE = ("CMAKE_CURRENT_SOURCE_DIR", "CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR")
_NAMES = ("PROJECT_NAME", "CMAKE_PROJECT_NAME")
MOST_CALLS, DEEPEST = 10_000, 6


class CmakeCall(NamedTuple):
    """A call: its name in small letters, and its words; paths are below the ``folder``."""

    name: str
    words: tuple[str, ...]
    folder: str

    def after(self, word: str) -> str:
        """The word behind this one; empty for none."""
        return self.words[self.words.index(word) + 1] if word in self.words[:-1] else ""


@lru_cache(maxsize=64)
def cmake_calls(folder: str) -> tuple[CmakeCall, ...]:
    """The calls of the CMakeLists.txt of a package, and those of the folders that it adds."""
    own = package_of(os.path.join(folder, LIST))
    known = {**dict.fromkeys(_HERE, folder), **dict.fromkeys(_NAMES, own[0] if own else "")}
    return tuple(_of_file(folder, known, 0))[:MOST_CALLS]


def _of_file(folder: str, known: dict[str, str], depth: int) -> Iterator[CmakeCall]:
    text = "\n".join(it.partition("#")[0] for it in start_of_file(folder, LIST).splitlines())
    calls = [(it[1].lower(), it[2]) for it in _CALL.finditer(text)][:MOST_CALLS]
    at = 0
    while at < len(calls):
        name, raw = calls[at]
        at += 1
        if name == "foreach":
            end = next((it for it in range(at, len(calls)) if calls[it][0] == "endforeach"), at)
            variable, *values = (*_words(raw, known), "")[:-1] or ("",)
            for value in values if values[:1] != ["IN"] else values[2:]:
                inner = {**known, variable: value}
                yield from (CmakeCall(it, _words(one, inner), folder) for it, one in calls[at:end])
            at = end
            continue
        call = CmakeCall(name, _words(raw, known), folder)
        known |= dict(_set_by(call))
        yield call
        if name == "add_subdirectory" and call.words and depth < DEEPEST:
            yield from _of_file(os.path.join(folder, call.words[0]), dict(known), depth + 1)


def _set_by(call: CmakeCall) -> Iterator[tuple[str, str]]:
    """The variables that a call sets."""
    name, words = call.name, call.words
    if name == "set" and words:
        yield words[0], ";".join(words[1:])
    elif name == "project" and words:
        yield "PROJECT_NAME", words[0]
    elif name == "list" and words[:1] == ("APPEND",) and len(words) > 1:
        yield words[1], ";".join((f"${{{words[1]}}}", *words[2:]))
    elif name == "file" and words[:1] in (("GLOB",), ("GLOB_RECURSE",)):
        yield words[1], ";".join(_globbed(call.folder, words[2:]))


def _globbed(folder: str, patterns: tuple[str, ...]) -> Iterator[str]:
    for it in patterns:
        above, _, last = os.path.join(folder, it).rpartition(os.sep)
        inside = (one for one in sources_in(folder) if one.startswith(above.rstrip("*")))
        yield from (one for one in inside if one.endswith(last.lstrip("*")))


def _words(raw: str, known: dict[str, str]) -> tuple[str, ...]:
    text = raw
    for _ in range(DEEPEST if "$" in raw else 0):
        text = _VARIABLE.sub(lambda it: known.get(it[1], it[0]), text)[:MOST_CALLS]
    return tuple(it.strip('"') for it in _WORD.findall(text))
