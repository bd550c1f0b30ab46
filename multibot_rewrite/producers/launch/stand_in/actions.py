"""Actions, events and launch files of the stand-in for launch.

An action keeps what it is given; what only sets something up does so when it is visited. Source: launch
jazzy, actions/, event_handlers/, launch_description_sources/.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable
from typing import Any

from multibot_rewrite.producers.launch.stand_in.values import Kept, LaunchContext, Text, text_of


class Action(Kept):
    """An action; its condition decides whether it is executed."""

    condition: Any = None
    others: tuple[str, ...] = ("condition",)

    def visit(self, context: LaunchContext) -> Any:
        wanted = self.condition is None or self.condition.evaluate(context)
        return self.execute(context) if wanted else None

    def execute(self, context: LaunchContext) -> Any:
        return None


class OpaqueFunction(Action):
    """A function that makes actions."""

    names = ("function", "args", "kwargs")
    function: Any
    args: Any
    kwargs: Any

    def execute(self, context: LaunchContext) -> Any:
        return self.function(context, *(self.args or ()), **(self.kwargs or {}))


class DeclareLaunchArgument(Action):
    """A launch argument."""

    names = ("name", "default_value", "description", "choices")
    name: str
    default_value: Text
    choices: Any

    def execute(self, context: LaunchContext) -> None:
        given = context.launch_configurations
        if self.name not in given:
            if self.default_value is None:
                raise RuntimeError(f"Required launch argument '{self.name}' was not provided.")
            given[self.name] = text_of(context, self.default_value)
        if self.choices and given[self.name] not in self.choices:
            raise RuntimeError(f"Argument '{self.name}' is none of {', '.join(self.choices)}")


class SetLaunchConfiguration(Action):
    """Sets a launch configuration."""

    names = ("name", "value")
    name: Text
    value: Text

    def execute(self, context: LaunchContext) -> None:
        name = text_of(context, self.name)
        context.launch_configurations[name] = text_of(context, self.value)


class PushLaunchConfigurations(Action):
    """Begins a scope."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Ends a scope."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()


class GroupAction(Action):
    """Actions with launch configurations of their own."""

    names = ("actions", "scoped", "forwarding", "launch_configurations")
    actions: Iterable[Any]
    scoped: Any
    forwarding: Any
    launch_configurations: Any

    def execute(self, context: LaunchContext) -> list[Any]:
        given = self.launch_configurations or {}
        own: list[Any] = [SetLaunchConfiguration(name, value) for name, value in given.items()]
        if self.forwarding is False:
            kept = {name: text_of(context, value) for name, value in given.items()}
            own = [OpaqueFunction(function=lambda it: _only(it, kept))]
        inner = [*own, *self.actions]
        if self.scoped is False:
            return inner
        return [PushLaunchConfigurations(), *inner, PopLaunchConfigurations()]


def _only(context: LaunchContext, kept: dict[str, str]) -> None:
    context.launch_configurations = dict(kept)


class LaunchDescription:
    """What a launch file makes."""

    def __init__(self, initial_entities: Any = None, *, deprecated_reason: Any = None) -> None:
        self.entities = list(initial_entities or ())

    def visit(self, context: LaunchContext) -> list[Any]:
        return self.entities

    def add_action(self, action: Any) -> None:
        self.entities.append(action)


class IncludeLaunchDescription(Action):
    """Another launch file, or a description."""

    names = ("launch_description_source", "launch_arguments")
    launch_description_source: Any
    launch_arguments: Any

    def execute(self, context: LaunchContext) -> list[Any]:
        source = self.launch_description_source
        if not hasattr(source, "get_launch_description"):
            source = AnyLaunchDescriptionSource(source)
        description = source.get_launch_description(context)
        context.extend_locals({"current_launch_file_path": source.location})
        told = [SetLaunchConfiguration(*it) for it in self.launch_arguments or ()]
        return [*told, description]


class AnyLaunchDescriptionSource:
    """A launch file in Python; one in another form needs launch."""

    def __init__(self, launch_file_path: Text) -> None:
        self.location = launch_file_path

    def get_launch_description(self, context: LaunchContext) -> Any:
        self.location = text_of(context, self.location)
        if not self.location.endswith(".py"):
            raise ValueError("a launch file in XML or YAML needs launch itself; source ROS 2")
        spec = importlib.util.spec_from_file_location("launch_file", self.location)
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.generate_launch_description()


class EventHandler(Kept):
    """What happens at an event: actions, or a function that makes some; its last argument."""

    target_action: Any = None
    others: tuple[str, ...] = ("handle_once",)

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        if not (self.target_action is None or hasattr(self.target_action, "execute")):
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


class ExecuteProcess(Action):
    """A command line. What a process is given besides its own."""

    names = ("cmd", "on_exit")
    others: tuple[str, ...] = (
        *("condition", "prefix", "name", "cwd", "env", "additional_env", "output", "output_format"),
        *("shell", "respawn", "respawn_delay", "respawn_max_retries", "emulate_tty", "log_cmd"),
        *("sigterm_timeout", "sigkill_timeout", "cached_output"),
    )


class LogInfo(Action):
    """A line of the log."""

    names = ("msg",)


class EmitEvent(Action):
    """An event."""

    names = ("event",)


class Shutdown(Action):
    """The end."""

    names = ("reason",)
    others = ("event", "condition")


class SetEnvironmentVariable(Action):
    """A variable of the environment, which no node's name depends on."""

    names = ("name", "value")


def matches_action(target_action: Any) -> Any:
    """Is an event that of this action?"""
    return lambda event: event is target_action
