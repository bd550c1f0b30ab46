# SPDX-License-Identifier: Apache-2.0
"""Programs, environment, events and loops of the stand-in for launch; nothing is started.

Names and signatures are those of launch jazzy, of loops those of rolling (actions/for_loop.py,
since kilted 3.8.0)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from multibot_rewrite.base.bounded import A_VALUE, load_yaml
from multibot_rewrite.producers.launch.stand_in.actions import Action, OpaqueFunction, doing
from multibot_rewrite.producers.launch.stand_in.values import (
    ITERATED,
    Kept,
    LaunchContext,
    Text,
    kept,
    str_of,
    text_of,
    typed_truth,
)


class EventHandler(Kept):
    """What happens at an event: actions, or a function that makes some; its last argument."""

    target_action: Any = None
    names: tuple[str, ...] = ("matcher", "entities")
    others: tuple[str, ...] = ("handle_once",)

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        target = self.target_action
        if not (target is None or callable(target) or hasattr(target, "execute")):
            raise TypeError("action_matcher must be an 'ExecuteLocal' instance or a callable")
        self.actions: Any = vars(self)[self.names[-1]] or []

    def describe(self) -> tuple[str, list[Any]]:
        """Return the actions that are known before the event."""
        several = self.actions if isinstance(self.actions, list) else [self.actions]
        return "", [it for it in several if not callable(it)]

    def handle(self, event: Any, context: LaunchContext) -> Any:
        return self.actions(event, context) if callable(self.actions) else self.actions


OnProcessExit = kept(EventHandler, "OnProcessExit", "target_action on_exit")
OnProcessStart = kept(EventHandler, "OnProcessStart", "target_action on_start")
OnProcessIO = kept(EventHandler, "OnProcessIO", "target_action on_stdin on_stderr on_stdout")
OnExecutionComplete = kept(EventHandler, "OnExecutionComplete", "target_action on_completion")
OnIncludeLaunchDescription = kept(EventHandler, "OnIncludeLaunchDescription", "entities")
OnShutdown = kept(EventHandler, "OnShutdown", "on_shutdown")


class RegisterEventHandler(Action):
    """Waits for an event, which happens at once."""

    names = ("event_handler",)

    def execute(self, context: LaunchContext) -> list[Any]:
        return list(self.event_handler.describe()[1])


TimerAction = kept(Action, "TimerAction", "period actions", "cancel_on_shutdown")
Executable = kept(Kept, "Executable", "cmd prefix name cwd env additional_env arguments")


class ExecuteLocal(Action):
    """A process."""

    names: tuple[str, ...] = ("process_description", "on_exit")
    others: tuple[str, ...] = (
        *("condition", "output", "output_format", "shell", "respawn", "respawn_delay"),
        *("respawn_max_retries", "emulate_tty", "log_cmd", "sigterm_timeout", "sigkill_timeout"),
        "cached_output",
    )

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.__on_exit = vars(self)["on_exit"]
        if "process_description" in vars(self):
            self.cmd = vars(vars(self)["process_description"])["cmd"]


class ExecuteProcess(ExecuteLocal):
    """A command line. What a process is given besides its own."""

    names: tuple[str, ...] = ("cmd", "on_exit")
    others: tuple[str, ...] = (
        *ExecuteLocal.others,
        *("prefix", "name", "cwd", "env", "additional_env"),
    )


Log = kept(Action, "Log", "msg level")
LogInfo = kept(Action, "LogInfo", "msg")


LogDebug = LogWarning = LogError = LogInfo


EmitEvent = kept(Action, "EmitEvent", "event")
Shutdown = kept(Action, "Shutdown", "reason", "event")


SetEnvironmentVariable = doing(
    *("SetEnvironmentVariable", "name value"),
    lambda context, name, value: context.environment.update({name: value}),
)
UnsetEnvironmentVariable = doing(
    "UnsetEnvironmentVariable", "name", lambda context, name: context.environment.pop(name, None)
)


class AppendEnvironmentVariable(Action):
    """More of a variable."""

    names = ("name", "value", "prepend", "separator")

    def execute(self, context: LaunchContext) -> None:
        name, value = text_of(context, self.name), text_of(context, self.value)
        between = os.pathsep if self.separator is None else text_of(context, self.separator)
        known = [context.environment[name]] if name in context.environment else []
        first = typed_truth(text_of(context, str_of(self.prepend or False)))
        context.environment[name] = between.join([value, *known] if first else [*known, value])


UnregisterEventHandler = kept(Action, "UnregisterEventHandler", "event_handler")


def matches_action(target_action: Any) -> Any:
    """Return a function that tells whether an event is that of this action."""
    return lambda event: event is target_action


class ForEach(Action):
    """What a function makes of each set of values; they are mappings in YAML with ``;`` between."""

    names = ("input_values", "function")

    def execute(self, context: LaunchContext) -> list[Any]:
        texts = text_of(context, self.input_values).strip().split(";")
        values = (load_yaml(it.strip(), A_VALUE) for it in texts if it)
        return [made for it in values if it is not None for made in self.function(**it) or ()]


class ForLoop(Action):
    """What a function makes of each number below a length."""

    names = ("length", "function", "name")

    def execute(self, context: LaunchContext) -> list[Any]:
        numbers = range(int(text_of(context, self.length)))
        return [made for i in numbers for made in self.function(i=i) or ()]


def each_of(values: Text, actions: Iterable[Any]) -> ForEach:
    """Return ``<for_each>``: its actions, in which ``$(for-var)`` reads the values."""
    return ForEach(values, lambda **known: _repeat_with(actions, known))


def loop_of(length: Text, name: str, actions: Iterable[Any]) -> ForLoop:
    """Return ``<for>``: its actions, in which ``$(index)`` reads the number."""
    return ForLoop(length, lambda i: _repeat_with(actions, {name: i}), name)


def _repeat_with(actions: Iterable[Any], values: Mapping[str, Any]) -> list[Any]:
    known = {f"{ITERATED}{name}": str(value) for name, value in values.items()}

    def enter(context: LaunchContext) -> None:
        context._push_locals()
        context.extend_locals(known)

    leave = OpaqueFunction(function=lambda context: context._pop_locals())
    return [OpaqueFunction(function=enter), *deepcopy([*actions]), leave]
