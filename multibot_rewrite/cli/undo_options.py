# SPDX-License-Identifier: Apache-2.0
"""Finds options with which a rewrite can be undone, if the given ones do not do it."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator, Sequence
from itertools import product
from math import inf
from typing import Any

from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, PREFIX

_LAYOUTS = tuple(it.name for it in LAYOUTS if it.name != DEFAULT_LAYOUT)
# Option -> what may have been given with it; None and []: nothing.
_TRIED: dict[str, tuple[Any, ...]] = {
    "affix": (None, PREFIX),
    "separator": ([], ["_"], ["/"], ["-"]),
    "layout": (None, *_LAYOUTS),
}


_LINK = lazy_compile(rb"""<link\b[^<>]*?\sname=["']([^"'<>]*)["']""")
Undo = Callable[[argparse.Namespace], bytes]


def with_missing_options(
    error: RewriteRefused, options: argparse.Namespace, undo: Undo, robot: str, data: bytes
) -> RewriteRefused:
    """Return the error with the options as its hint with which ``undo`` of the ``data`` succeeds.

    Links without the robot's name may be shared, if others have it. What ``undo`` gives is
    verified: rewritten with these options it is the file again.
    """
    links = [it.decode("utf-8", "replace") for it in _LINK.findall(data)]
    bare = [it for it in links if robot not in it]
    words = _best_options(options, undo, robot, bare if len(bare) < len(links) else [])[1]
    hint = f"the file was made with {words}: give that, too"
    return (
        RewriteRefused(tuple(it._replace(hint=hint) for it in error.findings)) if words else error
    )


def more_to_undo(stripped: bytes, options: argparse.Namespace, undo: Undo, robot: str) -> str:
    """Return options that take more of the robot's name out of its links; empty for none."""
    tags = re.findall(rb"<link\b[^<>]*>", stripped)
    if not tags or any(robot.encode() not in it for it in tags):
        return ""
    other = argparse.Namespace(**{**vars(options), "affix": None, "separator": [], "layout": None})
    left, words = _best_options(other, undo, robot)
    return words if left < stripped.count(robot.encode()) else ""


def _best_options(
    options: argparse.Namespace, undo: Undo, robot: str, shared: Sequence[str] = ()
) -> tuple[float, str]:
    """Return how often the name is left with the best options, and the fewest such options."""
    best: tuple[float, str] = inf, ""
    for more in _missing_options(options, [*shared]):
        try:
            made = undo(argparse.Namespace(**{**vars(options), **more}))
        except MultibotError:
            continue
        left = made.count(robot.encode())
        best = best if best[0] <= left else (left, _as_command_line(more))
    return best


def _missing_options(options: argparse.Namespace, shared: list[str]) -> Iterator[dict[str, Any]]:
    """Yield combinations of missing options, the smallest ones first."""
    given = vars(options)
    tried = {**_TRIED, "shared": ([], shared)} if shared else _TRIED
    open_ = {name: values for name, values in tried.items() if not given[name]}
    every = (dict(zip(open_, values, strict=True)) for values in product(*open_.values()))
    named = [{name: value for name, value in it.items() if value} for it in every]
    yield from sorted(filter(None, named), key=len)


def _as_command_line(more: dict[str, Any]) -> str:
    return " ".join(
        f"--{name} {','.join(value) if isinstance(value, list) else value}"
        for name, value in more.items()
    )
