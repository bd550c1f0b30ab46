# SPDX-License-Identifier: Apache-2.0
"""The line of an action in a launch file: kept when it is made."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import lru_cache, wraps
from types import FrameType
from typing import Any

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.entities import LINE, root_of
from multibot_rewrite.system.records import Place

_KEPT = "multibot_place"
# What makes actions for a launch file, and what reads launch files: neither is one.
_READERS = tuple(f"{__package__}.{it}" for it in ("read", "visit"))
_ELEMENTS = ("node", "node_container", "composable_node")
_MAKERS = ("launch", "launch_ros", "launch_xml", "launch_yaml", "multibot_rewrite")


def keep_places() -> None:
    """Note from now on for every action and component the line of the launch file that made it."""
    for kind in (of_launch().Action, of_launch_ros("descriptions").ComposableNode):
        if not hasattr(kind.__init__, "__wrapped__"):
            kind.__init__ = _noting_place(kind.__init__)


def _noting_place(made: Callable[..., None]) -> Callable[..., None]:
    """Return a constructor that notes the line of the launch file that calls it."""

    @wraps(made)
    def keeping(self: Any, *words: Any, **options: Any) -> None:
        # An action for a robot is made again when it runs.
        if getattr(self, _KEPT, None) is None:
            setattr(self, _KEPT, _maker(sys._getframe(1)))
        made(self, *words, **options)

    return keeping


def place_of(action: Any, file: str, what: tuple[str, str] | None = None) -> Place:
    """Return the place of an action in ``file``; if that is not Python, by its package and program."""
    kept = getattr(action, _KEPT, None)
    if isinstance(kept, Place):
        return kept
    real = os.path.realpath(file)
    return Place(real, getattr(action, LINE, 0) or (_lines(real).get(what, 1) if what else 1))


def _maker(frame: FrameType | None) -> Place | None:
    """Return the line of the launch file that made an action; None for a file that a parser reads."""
    while frame is not None:
        module = str(frame.f_globals.get("__name__", ""))
        if module in _READERS:
            return None
        if module.partition(".")[0] not in _MAKERS:
            return Place(_real(frame.f_code.co_filename), frame.f_lineno)
        frame = frame.f_back
    return None


_real = lru_cache(os.path.realpath)


@lru_cache
def _lines(file: str) -> dict[tuple[str, str], int]:
    """Return the first line with each package and program, in a file in XML or YAML."""
    if not os.path.isfile(file):
        return {}
    try:
        every = [*root_of(read_bytes(file), file).every()]
    except (ValueError, TypeError, RuntimeError, SyntaxError, InputError):
        return {}
    found = {}
    for it in (one for one in reversed(every) if one.tag in _ELEMENTS):
        program = it.values.get("plugin") or it.values.get("exec", "")
        found[str(it.values.get("pkg", "")), str(program)] = it.line
    return found
