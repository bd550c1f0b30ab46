"""Text for pictures: names of a graph may hold anything, a picture has little room."""

from __future__ import annotations

from unicodedata import east_asian_width


def visible(text: str) -> str:
    """``text`` on one line; what has no shape of its own (controls, marks that turn the direction
    of writing, halves of surrogate pairs) as an escape."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def clipped(text: str, room: int) -> str:
    """``text`` in ``room`` columns at most, its middle left out: names differ at their ends."""
    if len(text) * 2 <= room or columns(text) <= room:
        return text
    back = _fitting(text[::-1], room // 2)[::-1]
    return f"{_fitting(text, room - 1 - columns(back))}…{back}"


def columns(text: str) -> int:
    """How many columns of a fixed-width font it takes; East Asian letters take two."""
    if text.isascii():
        return len(text)
    return sum(2 if east_asian_width(c) in "WF" else 1 for c in text)


def _fitting(text: str, room: int) -> str:
    """The longest beginning of ``text`` that fits."""
    at = 0
    while at < len(text) and room > 0:
        room -= columns(text[at])
        at += room >= 0
    return text[:at]


def counted(number: int, what: str) -> str:
    """``1 robot``, ``2 robots``."""
    return f"{number} {what}{'' if number == 1 else 's'}"
