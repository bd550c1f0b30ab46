# SPDX-License-Identifier: Apache-2.0
"""Nodes that run with any fleet and are no part of a robot: tools, and what simulators start."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fnmatch import translate
from functools import lru_cache

from multibot_rewrite.base.conventions import is_tool_word, only_looks


def is_tool(node: str, more: tuple[str, ...] = ()) -> bool:
    """Return whether the node with this full name is a tool. ``more`` are patterns in addition to
    the usual ones; without a slash they are of any namespace."""
    word = node.rpartition("/")[2]
    if is_tool_word(word):
        return True
    full, last = _patterns(more)
    return bool(more) and bool(last.fullmatch(word) or full.fullmatch(node))


@lru_cache(maxsize=8)
def _patterns(more: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return patterns of full names, and of last words."""
    sides = ([p for p in more if "/" in p], [p for p in more if "/" not in p])
    full, last = (re.compile("|".join(map(translate, side)) or "(?!)") for side in sides)
    return full, last


def is_viewer(node: str) -> bool:
    """Return whether a node only looks, or passes on what a person asks for."""
    return only_looks(last_word(node))


def is_hidden(node: str) -> bool:
    """Return whether it is a node of the ``ros2`` command, or another that hides itself."""
    return last_word(node).startswith("_")


def is_spawner(node: str) -> bool:
    """Return whether a node loads controllers, and waits for a manager until then."""
    return last_word(node).startswith("spawner_")


def last_word(name: str) -> str:
    """Return the last segment of a name."""
    return name.rpartition("/")[2]


def in_namespaces_above(node: str, name: str) -> Iterator[str]:
    """Yield a name directly in a node's namespace, moved to each of the namespaces above."""
    namespace = node.rpartition("/")[0]
    while namespace and name.startswith(f"{namespace}/"):
        rest = name.removeprefix(namespace)
        namespace = namespace.rpartition("/")[0]
        yield namespace + rest
        name = namespace + rest
