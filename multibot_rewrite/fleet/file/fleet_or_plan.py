"""Is a file a fleet file or a plan? By itself: a check of a plan needs nothing else of a fleet."""

from __future__ import annotations

import re

# What follows ``robots:``, empty lines and comments aside.
_ROBOTS = re.compile(rb"^robots:[ \t]*(?:#[^\n]*)?(?:\s*#[^\n]*\n)*\s*(\S)", re.MULTILINE)
_INCLUDE = re.compile(rb"^include:", re.MULTILINE)


def is_fleet(data: bytes) -> bool:
    """Is this a fleet file? Its robots are a list, or in files that it includes; in a plan they are
    keys."""
    found = _ROBOTS.search(data)
    return found[1][:1] in (b"-", b"[") if found else bool(_INCLUDE.search(data))
