"""Lists of names as part of a sentence."""

from __future__ import annotations

from collections.abc import Iterable

FEW, SEVERAL = 3, 5


def shorten(names: Iterable[str], most: int = FEW) -> str:
    """The first names of a list, each once, and how many more there are."""
    unique = list(dict.fromkeys(names))
    more = f" and {len(unique) - most} more" if len(unique) > most else ""
    return ", ".join(unique[:most]) + more
