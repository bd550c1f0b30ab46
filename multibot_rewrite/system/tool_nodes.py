"""Nodes that run beside any fleet and are no part of a robot: tools, and what simulators start."""

from __future__ import annotations

import re
from fnmatch import translate
from functools import lru_cache

from multibot_rewrite.base.conventions import is_tool_word


def is_tool(node: str, more: tuple[str, ...] = ()) -> bool:
    """Is the node with this full name a tool? ``more`` are patterns beside the usual ones; without a
    slash they are of any namespace."""
    word = node.rpartition("/")[2]
    if is_tool_word(word):
        return True
    full, last = _patterns(more)
    return bool(more) and bool(last.fullmatch(word) or full.fullmatch(node))


@lru_cache(maxsize=8)
def _patterns(more: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Of full names, and of last words."""
    sides = ([p for p in more if "/" in p], [p for p in more if "/" not in p])
    full, last = (re.compile("|".join(map(translate, side)) or "(?!)") for side in sides)
    return full, last
