"""As much of launch as ``multibot_rewrite.launch`` uses, for machines without it.

Names and signatures are those of launch jazzy; ``test_launch`` compares them where launch is. It runs
no process, and its XML frontend knows attributes and children, no type but bool.
"""

from __future__ import annotations

import logging
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import ModuleType
from typing import Any

import pytest


class Substitution:
    def perform(self, context: LaunchContext) -> str:
        raise NotImplementedError  # as launch's own: each kind of substitution has its perform


class TextSubstitution(Substitution):
    def __init__(self, *, text: str) -> None:
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text


class LaunchConfiguration(Substitution):
    def __init__(self, variable_name: Any, *, default: Any = None) -> None:
        self.variable_name = variable_name

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(
            context, normalize_to_list_of_substitutions(self.variable_name)
        )
        return context.launch_configurations[name]


class LaunchContext:
    def __init__(self, *, argv: Any = None, noninteractive: bool = False) -> None:
        self.launch_configurations: dict[str, str] = {}
        self.handlers: list[OnShutdown] = []
        self._globals: dict[str, Any] = {}

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        self._globals.update(extensions)

    def get_locals_as_dict(self) -> dict[str, Any]:
        return dict(self._globals)

    def register_event_handler(self, event_handler: OnShutdown, append: bool = False) -> None:
        self.handlers.append(event_handler)

    def perform_substitution(self, substitution: Substitution) -> str:
        return substitution.perform(self)


class OnShutdown:
    def __init__(self, *, on_shutdown: Callable[..., Any], **kwargs: Any) -> None:
        self.on_shutdown = on_shutdown

    def handle(self, event: Any, context: LaunchContext) -> Any:
        return self.on_shutdown(event, context)


class OnProcessExit:
    def __init__(self, *, target_action: Any = None, on_exit: Any = None, **kwargs: Any) -> None:
        if not (target_action is None or hasattr(target_action, "execute")):
            raise TypeError("action_matcher must be an 'ExecuteLocal' instance or a callable")
        self.on_exit = on_exit


class IfCondition:
    def __init__(self, predicate_expression: Any) -> None:
        self.predicate_expression = predicate_expression

    def evaluate(self, context: LaunchContext) -> bool:
        words = normalize_to_list_of_substitutions(self.predicate_expression)
        return perform_substitutions(context, words).lower() in ("true", "1")


class Action:
    def __init__(self, *, condition: Any = None) -> None:
        self.condition = condition

    @staticmethod
    def parse(entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        told = entity.get_attr("if", optional=True)
        return Action, {"condition": IfCondition(parser.parse_substitution(told))} if told else {}

    def visit(self, context: LaunchContext) -> Any:
        if self.condition is None or self.condition.evaluate(context):
            return self.execute(context)
        return None

    def execute(self, context: LaunchContext) -> Any:
        return None


class OpaqueFunction(Action):
    def __init__(
        self, *, function: Any, args: Any = None, kwargs: Any = None, **left_over_kwargs: Any
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.function = function

    def execute(self, context: LaunchContext) -> Any:
        return self.function(context)


class RegisterEventHandler(Action):
    """The event happens at once."""

    def __init__(self, event_handler: OnProcessExit, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.handler = event_handler

    def execute(self, context: LaunchContext) -> list[Any]:
        return [*self.handler.on_exit]


class SetLaunchConfiguration(Action):
    def __init__(self, name: Any, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = name, value

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations[self.name] = self.value


class Restore(Action):
    def __init__(self, before: dict[str, str]) -> None:
        super().__init__()
        self.before = before

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations = self.before


class DeclareLaunchArgument(Action):
    def __init__(
        self,
        name: str,
        *,
        default_value: Any = None,
        description: Any = None,
        choices: Any = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name, self.default_value = name, default_value

    def execute(self, context: LaunchContext) -> None:
        if self.default_value is not None:
            context.launch_configurations.setdefault(self.name, self.default_value)


class LaunchDescription:
    def __init__(self, initial_entities: Any = None, *, deprecated_reason: Any = None) -> None:
        self.entities = list(initial_entities or ())

    def visit(self, context: LaunchContext) -> list[Any]:
        return self.entities


class GroupAction(Action):
    def __init__(
        self,
        actions: Iterable[Any],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Any = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.actions = actions

    def execute(self, context: LaunchContext) -> list[Any]:
        return [*self.actions, Restore(dict(context.launch_configurations))]


def normalize_to_list_of_substitutions(subs: Any) -> list[Substitution]:
    if isinstance(subs, str):
        return [TextSubstitution(text=subs)]
    if isinstance(subs, Substitution):
        return [subs]
    return [TextSubstitution(text=it) if isinstance(it, str) else it for it in subs]


def perform_substitutions(context: LaunchContext, subs: list[Substitution]) -> str:
    return "".join(context.perform_substitution(it) for it in subs)


class ParameterValue:
    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type


ACTIONS: dict[str, Any] = {}
SUBSTITUTIONS: dict[str, Any] = {
    "var": lambda data: (LaunchConfiguration, {"variable_name": data[0]})
}


def expose_action(name: str) -> Any:
    return lambda exposed: ACTIONS.setdefault(name, exposed)


def expose_substitution(name: str) -> Any:
    return lambda exposed: SUBSTITUTIONS.setdefault(name, exposed)


class Entity:
    """An XML element that knows what was read of it."""

    def __init__(self, xml_element: ET.Element) -> None:
        self.element = xml_element
        self.read: set[str] = set()
        self.children_read = False

    @property
    def type_name(self) -> str:
        return self.element.tag

    @property
    def children(self) -> list[Entity]:
        self.children_read = True
        return [Entity(it) for it in self.element]

    def get_attr(
        self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True
    ) -> Any:
        self.read.add(name)
        if name not in self.element.attrib:
            if optional:
                return None
            raise AttributeError(f"Attribute '{name}' not found in Entity '{self.type_name}'")
        text = self.element.attrib[name]
        return text.lower() == "true" if data_type is bool else text

    def assert_entity_completely_parsed(self) -> None:
        left = set(self.element.attrib) - self.read
        if left or (len(self.element) and not self.children_read):
            raise ValueError(f"Unexpected attribute(s) found in `{self.type_name}`: {left}")


class Parser:
    def parse_substitution(self, value: str) -> list[Substitution]:
        return list(_parsed(value))

    def parse_action(self, entity: Entity) -> Any:
        made, kwargs = ACTIONS[entity.type_name](entity, self)
        entity.assert_entity_completely_parsed()
        return made(**kwargs)


def _parsed(text: str) -> Iterator[Substitution]:
    """``$(name word word)`` with one more inside each word; no quotes."""
    inner = r"(?:[^()$]|\$\([^()]*\))*"
    for found in re.finditer(rf"\$\(({inner})\)|((?:[^$]|\$(?!\())+)", text):
        if found[2]:
            yield TextSubstitution(text=found[2])
            continue
        name, *words = re.findall(r"(?:[^ $]|\$\([^()]*\))+", found[1])
        made, kwargs = SUBSTITUTIONS[name]([list(_parsed(word)) for word in words])
        yield made(**kwargs)


MODULES: Mapping[str, Mapping[str, Any]] = {
    "launch": {
        "Action": Action,
        "LaunchContext": LaunchContext,
        "LaunchDescription": LaunchDescription,
        "Substitution": Substitution,
    },
    "launch.actions": {
        "DeclareLaunchArgument": DeclareLaunchArgument,
        "GroupAction": GroupAction,
        "OpaqueFunction": OpaqueFunction,
        "RegisterEventHandler": RegisterEventHandler,
        "SetLaunchConfiguration": SetLaunchConfiguration,
    },
    "launch.conditions": {"IfCondition": IfCondition},
    "launch.event_handlers": {"OnProcessExit": OnProcessExit, "OnShutdown": OnShutdown},
    "launch.frontend": {
        "Entity": Entity,
        "Parser": Parser,
        "expose_action": expose_action,
        "expose_substitution": expose_substitution,
    },
    "launch.logging": {"get_logger": logging.getLogger},
    "launch.substitutions": {
        "LaunchConfiguration": LaunchConfiguration,
        "TextSubstitution": TextSubstitution,
    },
    "launch.utilities": {
        "normalize_to_list_of_substitutions": normalize_to_list_of_substitutions,
        "perform_substitutions": perform_substitutions,
    },
}

# launch_ros's, whose other modules the tests have.
MODULES_OF_ROS: Mapping[str, Mapping[str, Any]] = {
    "launch_ros": {},
    "launch_ros.parameter_descriptions": {"ParameterValue": ParameterValue},
}


def install(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``import launch`` find this."""
    for name, content in {**MODULES, **MODULES_OF_ROS}.items():
        module = ModuleType(name)
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, name, module)
