# SPDX-License-Identifier: Apache-2.0
"""Names and values as part of a sentence or a table, or each once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

FEW, SEVERAL, SHOWN = 3, 5, 8
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


def and_then(words: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def unique(names: Iterable[str]) -> tuple[str, ...]:
    """Each name once, in their order."""
    return tuple(dict.fromkeys(names))


def only(names: Sequence[str]) -> str:
    """The one name; empty where there are several, or none."""
    return names[0] if len(names) == 1 else ""


def plural(count: int, word: str) -> str:
    """A number with the word for what is counted."""
    ending = "es" if word.endswith("s") else "s"
    return f"{count} {word}{ending * (count != 1)}"
