# SPDX-License-Identifier: Apache-2.0
"""With which options a rewrite can be taken back, where those that were given do not do it."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, PREFIX

_LAYOUTS = tuple(it.name for it in LAYOUTS if it.name != DEFAULT_LAYOUT)
# Option -> what may have been given with it; None and []: nothing.
_TRIED: dict[str, tuple[Any, ...]] = {
    "affix": (None, PREFIX),
    "separator": ([], ["_"], ["/"], ["-"]),
    "layout": (None, *_LAYOUTS),
}


def with_missing_options(
    error: RewriteRefused, options: argparse.Namespace, undo: Callable[[argparse.Namespace], object]
) -> RewriteRefused:
    """Return the error with the options that are missing as its hint, if some make ``undo`` succeed.

    What ``undo`` gives is proved: rewritten with these options it is the file again.
    """
    for more in _missing(options):
        try:
            undo(argparse.Namespace(**{**vars(options), **more}))
        except MultibotError:
            continue
        hint = f"the file was made with {_written(more)}: give that, too"
        return RewriteRefused(tuple(it._replace(hint=hint) for it in error.findings))
    return error


def _missing(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Yield combinations of options that were not given, those of fewest options first."""
    given = vars(options)
    open_ = {name: values for name, values in _TRIED.items() if not given[name]}
    every = (dict(zip(open_, values, strict=True)) for values in product(*open_.values()))
    told = [{name: value for name, value in it.items() if value} for it in every]
    yield from sorted(filter(None, told), key=len)


def _written(more: dict[str, Any]) -> str:
    return " ".join(
        f"--{name} {','.join(value) if isinstance(value, list) else value}"
        for name, value in more.items()
    )
