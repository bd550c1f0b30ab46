# SPDX-License-Identifier: Apache-2.0
"""What a launch file does not start on a condition, and the arguments that decide it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from multibot_rewrite.producers.launch.describe import Visit, is_wanted, text
from multibot_rewrite.producers.launch.includes import path_of
from multibot_rewrite.producers.launch.records import IdleAction


def wants(action: Any, seen: Visit) -> bool:
    """Return whether an action's condition holds, as far as conditions count; a false one is kept."""
    if seen.every:
        return True
    watched = _Watched(seen.context)
    if is_wanted(action, watched):
        return True
    asked = tuple(watched.launch_configurations.asked.items())
    seen.idle.append(IdleAction(seen.place, called(action, seen.context), asked))
    return False


# The other value of a launch argument that is on or off.
_OTHER = {"true": "false", "false": "true", "True": "False", "False": "True"}


def turned_on_by(action: Any, seen: Visit) -> tuple[str, str]:
    """Return the launch argument that is on or off and whose other value alone starts an action that
    does not start, with that value; empty for another condition."""
    watched = _Watched(seen.context)
    known = watched.launch_configurations
    with suppress(Exception):
        if not is_wanted(action, watched):
            ((name, value),) = known.asked.items()
            known[name] = _OTHER[value]
            if is_wanted(action, watched):
                return name, known[name]
    return "", ""


def switches_of(action: Any, seen: Visit) -> tuple[tuple[str, str], ...]:
    """Return the launch arguments of a condition that holds, each with its value, if every one is on or
    off and turns it off with the other value; else none."""
    watched = _Watched(seen.context)
    known = watched.launch_configurations
    with suppress(Exception):
        asked = tuple(known.asked.items()) if is_wanted(action, watched) else ()
        for name, value in asked:
            known[name] = _OTHER[value]
            if is_wanted(action, watched):
                return ()
            known[name] = value
        return asked
    return ()


class _Asked(dict[str, Any]):
    """Launch configurations that note which of them are asked for."""

    def __init__(self, known: Mapping[str, Any]) -> None:
        super().__init__(known)
        self.asked: dict[str, str] = {}

    def __getitem__(self, name: str) -> Any:
        value = super().__getitem__(name)
        self.asked[name] = str(value)
        return value

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a variable, or its default."""
        with suppress(KeyError):
            return self[name]
        return default


class _Watched:
    """A context of which it is known which launch configurations were asked for."""

    def __init__(self, context: Any) -> None:
        self.context = context
        self.launch_configurations = _Asked(context.launch_configurations)

    def perform_substitution(self, substitution: Any) -> Any:
        """Return what a substitution is here."""
        return substitution.perform(self)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.context, name)


def called(action: Any, context: Any) -> str:
    """Return what an action starts, for people: a node by its package and program."""
    inside = getattr(action, "_GroupAction__actions", None) or getattr(action, "actions", None)
    if isinstance(inside, list | tuple):
        return ", ".join(dict.fromkeys(called(it, context) for it in inside))
    if hasattr(action, "launch_description_source"):
        return os.path.basename(path_of(action, context)) or type(action).__name__
    program = [getattr(action, f"node_{it}", None) for it in ("package", "executable")]
    with suppress(Exception):
        if all(program):
            return " ".join(text(it, context) for it in program)
        return os.path.basename(text(action.cmd[0], context))
    return type(action).__name__
