# SPDX-License-Identifier: Apache-2.0
"""Programs that a launch file starts, their environment, and what is done when something happens to
them: nothing of it happens here. Names and signatures are those of launch jazzy.
"""

from __future__ import annotations

import os
from typing import Any

from multibot_rewrite.producers.launch.stand_in.actions import Action
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Text,
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
        """The actions that are known before the event."""
        several = self.actions if isinstance(self.actions, list) else [self.actions]
        return "", [it for it in several if not callable(it)]

    def handle(self, event: Any, context: LaunchContext) -> Any:
        return self.actions(event, context) if callable(self.actions) else self.actions


class OnProcessExit(EventHandler):
    """The end of a process."""

    names = ("target_action", "on_exit")


class OnProcessStart(EventHandler):
    """The start of a process."""

    names = ("target_action", "on_start")


class OnProcessIO(EventHandler):
    """Output of a process."""

    names = ("target_action", "on_stdin", "on_stderr", "on_stdout")


class OnExecutionComplete(EventHandler):
    """The end of an action."""

    names = ("target_action", "on_completion")


class OnIncludeLaunchDescription(EventHandler):
    """An include."""

    names = ("entities",)


class OnShutdown(EventHandler):
    """The end of the launch."""

    names = ("on_shutdown",)


class RegisterEventHandler(Action):
    """Waits for an event, which happens at once."""

    names = ("event_handler",)
    event_handler: Any

    def execute(self, context: LaunchContext) -> list[Any]:
        return list(self.event_handler.describe()[1])


class TimerAction(Action):
    """Actions after a time."""

    names = ("period", "actions")
    others = ("cancel_on_shutdown", "condition")


class Executable(Kept):
    """What a process runs."""

    names = ("cmd", "prefix", "name", "cwd", "env", "additional_env", "arguments")


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


class Log(Action):
    """A line of the log, at a level (launch rolling, actions/log.py)."""

    names = ("msg", "level")


class LogInfo(Action):
    """A line of the log."""

    names = ("msg",)


LogDebug = LogWarning = LogError = LogInfo


class EmitEvent(Action):
    """An event."""

    names = ("event",)


class Shutdown(Action):
    """The end."""

    names = ("reason",)
    others = ("event", "condition")


class SetEnvironmentVariable(Action):
    """A variable of the environment."""

    names = ("name", "value")
    name: Text
    value: Text

    def execute(self, context: LaunchContext) -> None:
        context.environment[text_of(context, self.name)] = text_of(context, self.value)


class AppendEnvironmentVariable(Action):
    """More of a variable."""

    names = ("name", "value", "prepend", "separator")
    name: Text
    value: Text
    prepend: Any
    separator: Text

    def execute(self, context: LaunchContext) -> None:
        name, value = text_of(context, self.name), text_of(context, self.value)
        between = os.pathsep if self.separator is None else text_of(context, self.separator)
        known = [context.environment[name]] if name in context.environment else []
        first = typed_truth(text_of(context, str_of(self.prepend or False)))
        context.environment[name] = between.join([value, *known] if first else [*known, value])


class UnsetEnvironmentVariable(Action):
    """A variable is no longer set."""

    names = ("name",)
    name: Text

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(text_of(context, self.name), None)


class UnregisterEventHandler(Action):
    """An event is no longer waited for."""

    names = ("event_handler",)


def matches_action(target_action: Any) -> Any:
    """Is an event that of this action?"""
    return lambda event: event is target_action
