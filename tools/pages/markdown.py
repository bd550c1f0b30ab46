# SPDX-License-Identifier: Apache-2.0
"""Text of the package as Markdown has it."""

from __future__ import annotations

# In a cell of a table they would end it, or be read as HTML or emphasis.
ESCAPED = str.maketrans({"|": "\\|", "<": "&lt;", "*": "\\*", "_": "\\_"})


def plain(text: str) -> str:
    """Text where ``<tag>`` would be HTML unless it is in backticks."""
    parts = text.split("`")
    parts[::2] = [it.replace("<", "\\<") for it in parts[::2]]
    return "`".join(parts)
