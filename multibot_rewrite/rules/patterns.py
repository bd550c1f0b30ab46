# SPDX-License-Identifier: Apache-2.0
"""Patterns of a configuration, relative to its folder, as patterns of whole paths."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

from multibot_rewrite.base.model import UsageError


def anchored(pattern: str, folder: str, where: str) -> tuple[str, ...]:
    """A pattern as one or two of whole paths; without a slash it is a name in whatever folder."""
    _check_pattern(pattern, where)
    if os.path.isabs(pattern):
        return (pattern,)
    pattern = pattern.removeprefix("./")
    tail = pattern.removeprefix("**/")
    anywhere = tail != pattern or "/" not in tail.rstrip("/")
    from glob import escape  # most configurations have no pattern

    top = escape(folder).rstrip("/")
    if not anywhere or tail.startswith("*"):
        return (f"{top}/{tail}",)
    return f"{top}/{tail}", f"{top}/*/{tail}"


def _check_pattern(pattern: str, where: str) -> None:
    if not pattern:
        raise UsageError(f"{where}: a pattern is empty")
    if pattern.startswith("!"):
        raise UsageError(f"{where}: {pattern!r}: a pattern cannot take files back in with '!'")
    if "}" in pattern.partition("{")[2]:
        raise UsageError(f"{where}: {pattern!r}: write one pattern each instead of {{a,b}}")
    if not all(it[1] for it in re.finditer(r"\[!?\]?[^\]]*(\]?)", pattern)):
        raise UsageError(f"{where}: {pattern!r}: a bracket is not closed")
    if ".." in pattern.split("/"):
        raise UsageError(f"{where}: {pattern!r} leads out of the folder, write the whole path")


def with_folders(patterns: Iterable[str]) -> Iterator[str]:
    """A pattern that matches a folder is for everything in it."""
    for it in patterns:
        yield from (it, f"{it}/*") if not it.endswith("/") else (f"{it}*",)
