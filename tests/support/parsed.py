# SPDX-License-Identifier: Apache-2.0
"""The syntax trees of the package, read once for all tests that look at its sources."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import multibot_rewrite

PACKAGE = Path(multibot_rewrite.__file__).parent
# Python from that of Ubuntu 22.04 (Humble) on has to read them.
FIRST = (3, 10)


@cache
def sources() -> dict[str, ast.Module]:
    """Every module of the package by its path below it."""
    return {
        path.relative_to(PACKAGE).as_posix(): parsed(path) for path in sorted(PACKAGE.rglob("*.py"))
    }


def parsed(path: Path) -> ast.Module:
    """Return the tree of a file that the first Python can read."""
    return ast.parse(path.read_text(), str(path), feature_version=FIRST)
