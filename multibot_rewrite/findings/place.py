"""Byte offsets of a text as a person counts: lines and columns."""

from __future__ import annotations


def locate(source: bytes, offset: int) -> tuple[int, int]:
    """Line and column, from 1, of a byte offset; the column counts characters."""
    line_start = source.rfind(b"\n", 0, offset) + 1
    column = len(source[line_start:offset].decode("utf-8", "replace")) + 1
    return source.count(b"\n", 0, offset) + 1, column
