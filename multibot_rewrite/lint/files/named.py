# SPDX-License-Identifier: Apache-2.0
"""What files beside a description are called, and the robots in them: loaded for kept results, too."""

from __future__ import annotations

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import outside

_NAME = lazy_compile(rb"<robot\b[^>]*?\sname\s*=\s*[\"']([^\"'$]+)[\"']")
# What the name of an SRDF has in it.
SRDF_MARK = ".srdf"
# The root element is in the first bytes: the whole file need not be read.
HEAD = 4096


@outside
def robot_name(path: str) -> str:
    """The name on the root element as it is written; empty if the first bytes do not have it."""
    try:
        with open(path, "rb") as file:
            found = _NAME.search(file.read(HEAD))
    except (OSError, ValueError):
        return ""
    return found[1].decode("utf-8", "replace").strip() if found else ""


@outside
def files_like(pattern: str) -> tuple[str, ...]:
    """The files that a pattern names, in order."""
    from glob import glob  # few descriptions come to this

    return tuple(sorted(glob(pattern)))
