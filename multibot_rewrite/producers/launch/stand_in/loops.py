# SPDX-License-Identifier: Apache-2.0
"""Actions that are repeated, of the stand-in for launch.

Source: launch rolling, actions/for_loop.py (since kilted 3.8.0).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from multibot_rewrite.base.bounded import A_VALUE, load_yaml
from multibot_rewrite.producers.launch.stand_in.actions import Action, OpaqueFunction
from multibot_rewrite.producers.launch.stand_in.values import (
    ITERATED,
    LaunchContext,
    Text,
    text_of,
)


class ForEach(Action):
    """What a function makes of each set of values; they are mappings in YAML with ``;`` between."""

    names = ("input_values", "function")
    input_values: Text
    function: Any

    def execute(self, context: LaunchContext) -> list[Any]:
        texts = text_of(context, self.input_values).strip().split(";")
        values = (load_yaml(it.strip(), A_VALUE) for it in texts if it)
        return [made for it in values if it is not None for made in self.function(**it) or ()]


class ForLoop(Action):
    """What a function makes of each number below a length."""

    names = ("length", "function", "name")
    length: Text
    function: Any

    def execute(self, context: LaunchContext) -> list[Any]:
        numbers = range(int(text_of(context, self.length)))
        return [made for i in numbers for made in self.function(i=i) or ()]


def each_of(values: Text, actions: Iterable[Any]) -> ForEach:
    """``<for_each>``: its actions, of which ``$(for-var)`` reads the values."""
    return ForEach(values, lambda **known: _repeated(actions, known))


def loop_of(length: Text, name: str, actions: Iterable[Any]) -> ForLoop:
    """``<for>``: its actions, of which ``$(index)`` reads the number."""
    return ForLoop(length, lambda i: _repeated(actions, {name: i}), name)


def _repeated(actions: Iterable[Any], values: Mapping[str, Any]) -> list[Any]:
    known = {f"{ITERATED}{name}": str(value) for name, value in values.items()}

    def enter(context: LaunchContext) -> None:
        context._push_locals()
        context.extend_locals(known)

    leave = OpaqueFunction(function=lambda context: context._pop_locals())
    return [OpaqueFunction(function=enter), *deepcopy([*actions]), leave]
