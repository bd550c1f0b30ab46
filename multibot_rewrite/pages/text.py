"""Text for pictures: names in a graph may have any character, and pictures have little space."""

from __future__ import annotations

from unicodedata import east_asian_width


def visible(text: str) -> str:
    """``text`` on one line; characters that are not printable are written as escapes."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def clipped(text: str, room: int) -> str:
    """``text`` in at most ``room`` columns; the middle is cut, because names differ at their ends."""
    if len(text) * 2 <= room or columns(text) <= room:
        return text
    back = _fitting(text[::-1], room // 2)[::-1]
    return f"{_fitting(text, room - 1 - columns(back))}…{back}"


def columns(text: str) -> int:
    """The width of ``text`` in a fixed-width font; East Asian letters are two columns wide."""
    if text.isascii():
        return len(text)
    return sum(2 if east_asian_width(c) in "WF" else 1 for c in text)


def _fitting(text: str, room: int) -> str:
    """The longest beginning of ``text`` that fits into ``room`` columns."""
    at = 0
    while at < len(text) and room > 0:
        room -= columns(text[at])
        at += room >= 0
    return text[:at]
