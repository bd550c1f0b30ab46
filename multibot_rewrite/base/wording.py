"""Names and values as part of a sentence or a table."""

from __future__ import annotations

from collections.abc import Iterable

FEW, SEVERAL = 3, 5
_LONGEST = 60


def shorten(names: Iterable[str], most: int = FEW) -> str:
    """The first names of a list, each once, and how many more there are."""
    unique = list(dict.fromkeys(names))
    more = f" and {len(unique) - most} more" if len(unique) > most else ""
    return ", ".join(unique[:most]) + more


def clip(text: str) -> str:
    """A value on one line and not longer than a line can show."""
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 1]}…"
