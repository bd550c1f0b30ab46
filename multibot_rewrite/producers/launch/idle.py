# SPDX-License-Identifier: Apache-2.0
"""What a launch file does not start on a condition, and the arguments that decide it."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from multibot_rewrite.planning.start import Switch, values_in
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


# The other value of a launch argument that is on or off, and a value that no condition names.
_OTHER = {"true": "false", "false": "true", "True": "False", "False": "True"}
_NO_VALUE = "no_value_of_it"
# A value that is compared with, in the text of a condition.
_WORD = re.compile(r"[\w./-]+")


def switches_of(action: Any, seen: Visit) -> tuple[Switch, ...]:
    """Return the arguments that each turn an action off, or the only one that turns it on; or none."""
    watched = _Watched(seen.context)
    with suppress(Exception):
        is_on = is_wanted(action, watched)
        asked = {**watched.launch_configurations.asked}
        found = tuple(_switch(name, action, watched) for name in asked)
        return found if is_on or len(found) == 1 else ()
    return ()


def _switch(name: str, action: Any, watched: _Watched) -> Switch:
    """Return the values of an argument that start an action; raises ValueError if all or none do."""
    known, default = watched.launch_configurations, str(watched.launch_configurations[name])
    values = {default, *([_OTHER[default]] if default in _OTHER else (_NO_VALUE, *watched.words))}
    on: set[str] = set()
    for known[name] in values:
        on |= {known[name]} if is_wanted(action, watched) else set()
    known[name] = default
    listed = sorted(values - on if _NO_VALUE in on else on)
    if not listed or on == values or not all(map(_WORD.fullmatch, listed)):
        raise ValueError(name)
    if default in _OTHER:
        return Switch(name, default, name if listed[0].lower() == "true" else f"!{name}")
    return Switch(name, default, f"{name}{'!=' if _NO_VALUE in on else '='}{'|'.join(listed)}")


def value_for(it: Switch) -> str:
    """Return the value that turns on what is off; empty where there is not just one."""
    if it.default in _OTHER:
        return _OTHER[it.default]
    values = values_in(it.word)
    return values[0] if len(values) == 1 and "!" not in it.word else ""


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
    """A context that notes which launch configurations are asked for, and ``words`` of texts."""

    def __init__(self, context: Any) -> None:
        self.context = context
        self.launch_configurations = _Asked(context.launch_configurations)
        self.words: set[str] = set()

    def perform_substitution(self, substitution: Any) -> Any:
        """Return the value of a substitution, and note the words in its texts."""
        made = substitution.perform(self)
        self.words.update(_WORD.findall(str(made)))
        return made

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
