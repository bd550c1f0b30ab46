"""As much of launch_ros as plain launch files use, for machines without it.

Names and signatures are those of launch_ros jazzy. Source: launch_ros jazzy, actions/node.py,
descriptions/composable_node.py, utilities/evaluate_parameters.py, utilities/namespace_utils.py.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import NoneType
from typing import Any

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.producers.launch.stand_in.actions import (
    Action,
    EventHandler,
    ExecuteProcess,
    TimerAction,
)
from multibot_rewrite.producers.launch.stand_in.parse import parse_substitution
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Text,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    str_of,
    text_of,
    typed_truth,
)

_ITEMS = (bool, int, float, str)
_PLAIN = (*_ITEMS, bytes)
_UNIFORM = (
    "Expected a non-empty sequence, with items of uniform type. "
    "Allowed sequence item types are bool, int, float, str."
)
_KINDS = (
    "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], "
    "Sequence[float], Sequence[str]."
)
_OF_NODE = ("executable", "name", "namespace")
_LISTED = ("parameters", "remappings", "ros_arguments", "arguments")


class ParameterValue:
    """A value with its type."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        if isinstance(self.value, list | tuple) and not _is_substituted(self.value):
            return [text_of(context, it) if _is_substituted(it) else it for it in self.value]
        if not _is_substituted(self.value):
            return self.value
        text = text_of(context, self.value)
        if self.value_type in (str, int, float):
            return self.value_type(text)
        if self.value_type is bool:
            return typed_truth(text)
        return load_yaml(text) if text else text


class Parameter:
    """A parameter with its value."""

    def __init__(self, name: Text, value: Any, *, value_type: Any = None) -> None:
        self.name, self.value = name, ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        return text_of(context, self.name), self.value.evaluate(context)


class ParameterFile:
    """A parameter file."""

    def __init__(self, param_file: Any, *, allow_substs: Any = False) -> None:
        is_path = isinstance(param_file, os.PathLike)
        text = [os.fspath(param_file)] if is_path else param_file
        self.__param_file = normalize_to_list_of_substitutions(text)
        self.allow_substs = allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        path = Path(perform_substitutions(context, self.__param_file))
        if not typed_truth(text_of(context, str_of(self.allow_substs))):
            return path
        with tempfile.NamedTemporaryFile("w", prefix="launch_params_", delete=False) as out:
            out.write(text_of(context, parse_substitution(path.read_text(encoding="utf-8"))))
        return Path(out.name)


class Node(ExecuteProcess):
    """A node with its process."""

    names: tuple[str, ...] = (
        *("executable", "package", "name", "namespace", "exec_name", "parameters", "remappings"),
        *("ros_arguments", "arguments", "on_exit"),
    )

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        if not isinstance(vars(self)["parameters"], list | NoneType):
            raise TypeError("Expected 'parameters' given to 'Node' to be a list")
        # By the names that launch_ros keeps them under.
        listed = {it: vars(self)[it] or () for it in _LISTED}
        listed["parameters"] = [flat(it) for it in listed["parameters"]]
        own = {f"node_{it}": vars(self)[it] for it in _OF_NODE}
        own |= {"package": vars(self)["package"], **listed}
        vars(self).update({f"_Node__{key}": it for key, it in own.items()})

    @property
    def node_package(self) -> Any:
        return vars(self)["package"]

    @property
    def node_executable(self) -> Any:
        return vars(self)["executable"]


class LifecycleNode(Node):
    """A node with a life cycle."""

    others = (*Node.others, "autostart")


class ComposableNodeContainer(Node):
    """A container with components."""

    names = (*Node.names, "composable_node_descriptions")

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.__composable_node_descriptions = vars(self)["composable_node_descriptions"]


class LoadComposableNodes(Action):
    """Components for a container that runs."""

    names = ("composable_node_descriptions", "target_container")

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.__composable_node_descriptions = vars(self)["composable_node_descriptions"]
        self.__target_container = vars(self)["target_container"]


class ComposableNode:
    """A component."""

    def __init__(
        self,
        *,
        package: Text,
        plugin: Text,
        name: Text = None,
        namespace: Text = None,
        parameters: Any = None,
        remappings: Any = None,
        extra_arguments: Any = None,
        condition: Any = None,
    ) -> None:
        self.package, self.node_plugin = package, plugin
        self.node_name, self.node_namespace = name, namespace
        self.parameters, self.remappings = [flat(it) for it in parameters or ()], remappings
        self._condition = condition

    def condition(self) -> Any:
        return self._condition


class PushRosNamespace(Action):
    """A namespace for what comes next."""

    names = ("namespace",)
    namespace: Text

    def execute(self, context: LaunchContext) -> None:
        above = context.launch_configurations.get("ros_namespace")
        full = prefix_namespace(above, text_of(context, self.namespace))
        context.launch_configurations["ros_namespace"] = make_namespace_absolute(full)


class PushROSNamespace(PushRosNamespace):
    """The same."""


class SetParameter(Action):
    """A parameter for all nodes that come next."""

    names = ("name", "value")
    name: Text
    value: Any

    def execute(self, context: LaunchContext) -> None:
        name = text_of(context, self.name)
        _add(context, "global_params", [(name, _value(context, self.value, name))])


class SetParametersFromFile(Action):
    """A parameter file for all nodes that come next."""

    names = ("filename",)
    filename: Text

    def execute(self, context: LaunchContext) -> None:
        _add(context, "global_params", [text_of(context, self.filename)])


class SetRemap(Action):
    """A remap rule for all nodes that come next."""

    names = ("src", "dst")
    src: Text
    dst: Text

    def execute(self, context: LaunchContext) -> None:
        rule = (text_of(context, self.src), text_of(context, self.dst))
        _add(context, "ros_remaps", [rule])


def _add(context: LaunchContext, key: str, more: Iterable[Any]) -> None:
    """To the list itself, as launch_ros does: a scope around this one has it, too."""
    context.launch_configurations.setdefault(key, []).extend(more)


class SetUseSimTime(Action):
    """The clock of the node of launch itself."""

    names = ("value",)


class SetROSLogDir(Action):
    """A folder for logs."""

    names = ("new_log_dir",)


class LifecycleTransition(Action):
    """Changes of life cycles."""

    names = ("lifecycle_node_names", "transition_ids")


class ROSTimer(TimerAction):
    """Actions after a time by the clock of ROS."""


RosTimer = ROSTimer


class OnStateTransition(EventHandler):
    """A change of a life cycle."""

    names = ("target_lifecycle_node", "entities")
    others = ("start_state", "goal_state", "transition", "matcher", "handle_once")


class ChangeState(Kept):
    """A transition that is asked for."""

    names = ("lifecycle_node_matcher", "transition_id")


class StateTransition(Kept):
    """A transition that has happened."""

    names = ("action", "msg")


class Transition:
    """Those of lifecycle_msgs."""

    TRANSITION_CONFIGURE, TRANSITION_CLEANUP = 1, 2
    TRANSITION_ACTIVATE, TRANSITION_DEACTIVATE = 3, 4


def make_namespace_absolute(ns: str | None) -> str | None:
    """A relative namespace below the root."""
    return ns if ns is None or ns.startswith("/") else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """A namespace below another one, unless it is absolute."""
    if ns is None or not base_ns or ns.startswith("/"):
        found = base_ns if ns is None else ns
    else:
        found = f"{'' if base_ns == '/' else base_ns}/{ns}"
    return found if found in (None, "/") else str(found).rstrip("/")


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Any, ...]:
    """Files as paths, values by name; raises TypeError for a value that is none."""
    return tuple(_evaluated(context, it) for it in parameters)


def _evaluated(context: LaunchContext, given: Any) -> Any:
    if isinstance(given, Mapping):
        named = flat(given).items()
        return {text_of(context, key): _value(context, it, key) for key, it in named}
    if isinstance(given, Parameter):
        return given
    return (given if isinstance(given, ParameterFile) else ParameterFile(given)).evaluate(context)


def flat(given: Any) -> Any:
    """Parameters with dotted names; files stay as they are."""
    return dict(_flat(given, ())) if isinstance(given, Mapping) else given


def _flat(
    given: Mapping[Any, Any], above: tuple[Any, ...]
) -> Iterator[tuple[tuple[Any, ...], Any]]:
    for key, value in given.items():
        name = (*above, *([key] if isinstance(key, str) or hasattr(key, "perform") else key))
        if isinstance(value, Mapping):
            yield from _flat(value, (*name, "."))
        else:
            yield name, value


def _value(context: LaunchContext, value: Any, name: Text) -> Any:
    if hasattr(value, "evaluate"):
        return value.evaluate(context)
    if _is_substituted(value):
        return _read(text_of(context, value), text_of(context, name))
    if isinstance(value, list | tuple):
        return _listed(context, value, name)
    if not isinstance(value, _PLAIN):
        raise TypeError(f"Unexpected type for parameter value {value!r}")
    return value


def _listed(context: LaunchContext, values: list[Any] | tuple[Any, ...], name: Text) -> list[Any]:
    """Values of one type; those that have none in common are texts."""
    kinds = {type(it) for it in values}
    if kinds == {int, float}:
        return [float(it) for it in values]
    texts = [it if isinstance(it, _PLAIN) else load_yaml(text_of(context, it)) for it in values]
    if not _are_alike(texts):
        raise TypeError(f'{_UNIFORM} Got inconsistent input for "{text_of(context, name)}"')
    return texts


def _are_alike(values: list[Any]) -> bool:
    return bool(values) and len({type(it) for it in values}) == 1 and isinstance(values[0], _ITEMS)


def _is_substituted(value: Any) -> bool:
    """Is it a substitution, or texts with one?"""
    several = value if isinstance(value, list | tuple) else ()
    texts = all(isinstance(it, str) or hasattr(it, "perform") for it in several)
    return hasattr(value, "perform") or (texts and any(hasattr(it, "perform") for it in several))


def _read(text: str, name: str) -> Any:
    """The text of a substitution as YAML has it."""
    wrapped = "try wrapping it in launch_ros.parameter_descriptions.ParameterValue"
    try:
        found = load_yaml(text) if text else ""
    except yaml.YAMLError:
        what = f"Unable to parse the value of parameter {name} as yaml."
        raise TypeError(
            f"{what} If the parameter is meant to be a string, {wrapped}(value, value_type=str)"
        ) from None
    if isinstance(found, list):
        if not _are_alike(found):
            raise TypeError(f'{_UNIFORM} Got inconsistent input for "{name}"')
    elif not isinstance(found, _PLAIN):
        what = f'{_KINDS} Got {type(found)} for "{name}".'
        raise TypeError(
            f"{what} If the parameter is meant to be a string, {wrapped}(value, value_type=str)"
        )
    return found
