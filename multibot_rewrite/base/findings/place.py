"""Byte offsets of a text as a person counts: lines and columns."""

from __future__ import annotations

from functools import lru_cache

# What is counted once: a file may have thousands of findings, and be one line.
_BLOCK = 4096
# In UTF-8 a character is one byte that is none of these.
_FOLLOWING = bytes(range(0x80, 0xC0))


def locate(source: bytes, offset: int) -> tuple[int, int]:
    """Line and column, from 1, of a byte offset; the column counts characters."""
    block = offset // _BLOCK
    return _behind(*_blocks(source)[block], source[block * _BLOCK : offset])


@lru_cache(maxsize=4)
def _blocks(source: bytes) -> list[tuple[int, int]]:
    """Line and column of the start of each block."""
    here = 1, 1
    found = [here]
    for at in range(0, len(source), _BLOCK):
        here = _behind(*here, source[at : at + _BLOCK])
        found.append(here)
    return found


def _behind(line: int, column: int, text: bytes) -> tuple[int, int]:
    """Line and column behind a text that starts at these."""
    lines = text.count(b"\n")
    if not lines:
        return line, column + _characters(text)
    return line + lines, _characters(text[text.rfind(b"\n") + 1 :]) + 1


def _characters(text: bytes) -> int:
    return len(text) if text.isascii() else len(text.translate(None, _FOLLOWING))
