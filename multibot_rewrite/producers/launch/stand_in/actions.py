# SPDX-License-Identifier: Apache-2.0
"""Actions that set up a launch, and launch files, of the stand-in for launch.

An action keeps what it is given; what only sets something up does so when it is visited. Source: launch
jazzy, actions/, launch_description_sources/.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable, Iterable
from functools import cache
from importlib.machinery import SourceFileLoader
from typing import Any

from multibot_rewrite.producers.launch.stand_in.frontend import description_in
from multibot_rewrite.producers.launch.stand_in.values import Kept, LaunchContext, Text, text_of
from multibot_rewrite.producers.launch.unknown_modules import is_unknown

# Launch files within each other; one that includes itself would have no end.
_DEEPEST = 25


class Action(Kept):
    """An action; its condition decides whether it is executed."""

    condition: Any = None
    others: tuple[str, ...] = ("condition",)

    def visit(self, context: LaunchContext) -> Any:
        wanted = self.condition is None or self.condition.evaluate(context)
        return self.execute(context) if wanted else None

    def execute(self, context: LaunchContext) -> Any:
        return None


def expose_action(name: str) -> Any:
    """Return a decorator for files in XML and YAML, which are not read here."""
    return lambda exposed: exposed


expose_substitution = expose_action
SomeEntitiesType_types_tuple = (Action, Iterable)


@cache
def not_read(name: str) -> Any:
    """Return an object that can be imported and not used: its use raises an error with its name."""
    reason = f"{name} is not read: it needs launch itself"

    def refuse(*words: Any, **options: Any) -> Any:
        raise NotImplementedError(reason)

    def take(self: Any, *words: Any, **options: Any) -> None: ...

    if name[0].islower():
        return refuse
    return type(name, (Action,), {"__init__": take, "execute": refuse, "perform": refuse})


def doing(name: str, names: str, do: Callable[..., object]) -> type[Action]:
    """Return a class of actions that call ``do`` with the context and the texts they are given."""

    def execute(it: Any, context: LaunchContext) -> None:
        do(context, *(text_of(context, vars(it)[word]) for word in it.names))

    return type(name, (Action,), {"names": tuple(names.split()), "execute": execute})


SetLaunchConfiguration = doing(
    *("SetLaunchConfiguration", "name value"),
    lambda context, name, value: context.launch_configurations.update({name: value}),
)
UnsetLaunchConfiguration = doing(
    *("UnsetLaunchConfiguration", "name"),
    lambda context, name: context.launch_configurations.pop(name, None),
)


class OpaqueFunction(Action):
    """A function that makes actions."""

    names = ("function", "args", "kwargs")

    def execute(self, context: LaunchContext) -> Any:
        return self.function(context, *(self.args or ()), **(self.kwargs or {}))


class DeclareLaunchArgument(Action):
    """A launch argument."""

    names = ("name", "default_value", "description", "choices")

    @property
    def told(self) -> str:
        """The argument's description as an error has it."""
        text = self.description
        if self.choices is None:
            return "no description given" if text is None else text
        if text is None:
            return f"One of: {self.choices}"
        return f"{text.removesuffix('.')}. Valid choices are: {self.choices}"

    def execute(self, context: LaunchContext) -> None:
        given = context.launch_configurations
        if self.name not in given:
            if self.default_value is None:
                raise RuntimeError(f'Required launch argument "{self.name}" was not provided.')
            given[self.name] = text_of(context, self.default_value)
        if self.choices is not None and given[self.name] not in self.choices:
            told = f'Argument "{self.name}" provided value "{given[self.name]}" is not valid'
            raise RuntimeError(f"{told}. Valid options are: {self.choices}")


class ResetLaunchConfigurations(Action):
    """No launch configuration is set but these."""

    names = ("launch_configurations",)

    def execute(self, context: LaunchContext) -> None:
        given = self.launch_configurations or {}
        kept = {text_of(context, name): text_of(context, it) for name, it in given.items()}
        context.launch_configurations = kept


PushLaunchConfigurations = doing(
    "PushLaunchConfigurations", "", LaunchContext._push_launch_configurations
)
PopLaunchConfigurations = doing(
    "PopLaunchConfigurations", "", LaunchContext._pop_launch_configurations
)
PushEnvironment = doing("PushEnvironment", "", LaunchContext._push_environment)
PopEnvironment = doing("PopEnvironment", "", LaunchContext._pop_environment)
ResetEnvironment = doing("ResetEnvironment", "", LaunchContext._reset_environment)


class GroupAction(Action):
    """Actions with launch configurations and variables of their own."""

    names = ("actions", "scoped", "forwarding", "launch_configurations")

    def get_sub_entities(self) -> list[Any]:
        given = self.launch_configurations or {}
        own: list[Any] = [SetLaunchConfiguration(name, value) for name, value in given.items()]
        if self.scoped is False:
            return [*own, *self.actions]
        if self.forwarding is False:
            own = [ResetEnvironment(), ResetLaunchConfigurations(given)]
        begin = [PushLaunchConfigurations(), PushEnvironment()]
        return [*begin, *own, *self.actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> list[Any]:
        return self.get_sub_entities()


class LaunchDescription:
    """What a launch file makes."""

    def __init__(self, initial_entities: Any = None, *, deprecated_reason: Any = None) -> None:
        self.entities = list(initial_entities or ())

    def visit(self, context: LaunchContext) -> list[Any]:
        return self.entities

    def get_sub_entities(self) -> list[Any]:
        return self.entities

    def get_launch_arguments_with_include_launch_description_actions(self) -> list[Declared]:
        return declared(self.entities)

    def add_action(self, action: Any) -> None:
        self.entities.append(action)

    add_entity = add_action


class IncludeLaunchDescription(Action):
    """Another launch file, or a description."""

    names = ("launch_description_source", "launch_arguments")
    launch_description_source: Any
    launch_arguments: Any

    def __init__(self, *words: Any, **options: Any) -> None:
        super().__init__(*words, **options)
        if not hasattr(self.launch_description_source, "get_launch_description"):
            found = AnyLaunchDescriptionSource(self.launch_description_source)
            self.launch_description_source = found
        if not is_unknown(self.launch_arguments):
            self.launch_arguments = tuple(self.launch_arguments or ())

    def execute(self, context: LaunchContext) -> list[Any]:
        if context.depth > _DEEPEST:
            raise RecursionError
        source = self.launch_description_source
        description = source.get_launch_description(context)
        path = os.path.abspath(source.location)
        folder = {"current_launch_file_directory": os.path.dirname(path)}
        context.extend_locals({"current_launch_file_path": path, **folder})
        given = [text_of(context, name) for name, _ in self.launch_arguments]
        for it, above in description.get_launch_arguments_with_include_launch_description_actions():
            known = [*given, *(name for one in above for name in one.names_without_context())]
            if it.default_value is None and it.name not in known:
                what = f"missing required argument '{it.name}' (description: '{it.told}')"
                said = f"Included launch description {what}, given: [{', '.join(known)}]"
                raise RuntimeError(said)
        told = [SetLaunchConfiguration(*it) for it in self.launch_arguments]
        return [*told, description]

    def get_sub_entities(self) -> list[Any]:
        try:
            return [self.launch_description_source.get_launch_description(LaunchContext())]
        except Exception:
            # Its path is known only when the launch runs.
            return []

    def names_without_context(self) -> list[str]:
        """Return the arguments that it gives, if their names are known before the launch runs."""
        try:
            return [text_of(LaunchContext(), name) for name, _ in self.launch_arguments]
        except Exception:  # as above, of a name
            return []


Declared = tuple[DeclareLaunchArgument, tuple[IncludeLaunchDescription, ...]]


def declared(entities: Iterable[Any]) -> list[Declared]:
    """Return the unconditionally declared arguments, each with the includes that lead to it."""
    found: dict[str, Declared] = {}
    _declare(entities, (), found)
    return [it for it in found.values() if it[0].condition is None]


def _declare(
    entities: Iterable[Any], above: tuple[IncludeLaunchDescription, ...], found: dict[str, Declared]
) -> None:
    for it in entities if len(above) < _DEEPEST else ():
        if isinstance(it, ResetLaunchConfigurations):
            return
        if isinstance(it, DeclareLaunchArgument):
            found.setdefault(it.name, (it, above))
        if hasattr(it, "get_sub_entities") and getattr(it, "condition", None) is None:
            own = (it,) if isinstance(it, IncludeLaunchDescription) else ()
            _declare(it.get_sub_entities(), (*above, *own), found)


class LaunchDescriptionSource:
    """What gives a description: this one, where no file does."""

    def __init__(
        self, launch_description: Any = None, location: Text = "", method: str = ""
    ) -> None:
        self.location = location
        self.description = launch_description

    def get_launch_description(self, context: LaunchContext) -> Any:
        self.location = text_of(context, self.location)
        self.description = self.description or self.read(self.location)
        return self.description

    def read(self, location: str) -> Any:
        raise RuntimeError("called without launch description being set")


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file."""

    def __init__(self, launch_file_path: Text) -> None:
        super().__init__(None, launch_file_path)

    def read(self, location: str) -> Any:
        if not location.endswith(".py"):
            return description_in(location)
        return get_launch_description_from_python_launch_file(location)


PythonLaunchDescriptionSource = AnyLaunchDescriptionSource
XMLLaunchDescriptionSource = AnyLaunchDescriptionSource
YAMLLaunchDescriptionSource = AnyLaunchDescriptionSource


def get_launch_description_from_python_launch_file(path: str) -> Any:
    return load_python_launch_file_as_module(path).generate_launch_description()


def load_python_launch_file_as_module(path: str) -> Any:
    loader = SourceFileLoader("launch_file", path)
    spec = importlib.util.spec_from_loader("launch_file", loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    # Not by the loader, which would write a __pycache__ next to the user's file.
    exec(loader.source_to_code(loader.get_data(path), path), module.__dict__)
    return module
