"""Counts in messages: ``1 robot``, ``2 robots``."""

from __future__ import annotations


def plural(count: int, word: str) -> str:
    """A number with the word for what is counted."""
    return f"{count} {word}{'s' * (count != 1)}"
