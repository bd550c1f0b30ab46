"""As much of launch_ros as plain launch files use, for machines without it.

Names and signatures are those of launch_ros jazzy. Source: launch_ros jazzy, actions/node.py,
descriptions/composable_node.py, utilities/evaluate_parameters.py, utilities/namespace_utils.py.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.producers.launch.stand_in.actions import (
    Action,
    EventHandler,
    ExecuteProcess,
)
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Substitution,
    Text,
    parse_substitution,
    text_of,
    truth_of,
)

_PLAIN = (bool, int, float, str, bytes)
_OF_NODE = ("executable", "name", "namespace")
_LISTED = ("parameters", "remappings", "ros_arguments", "arguments")


class ParameterValue:
    """A value with its type."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        if not _is_text(self.value):
            return self.value
        text = text_of(context, self.value)
        found = text if self.value_type is str else _read(text, "a value")
        if self.value_type in _PLAIN and not isinstance(found, self.value_type):
            return self.value_type(found)
        return found


class ParameterFile:
    """A parameter file."""

    def __init__(self, param_file: Text, *, allow_substs: Any = False) -> None:
        self.__param_file, self.allow_substs = param_file, allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        path = Path(text_of(context, self.__param_file))
        if not truth_of(context, str(self.allow_substs)):
            return path
        with tempfile.NamedTemporaryFile("w", prefix="launch_params_", delete=False) as out:
            out.write(text_of(context, parse_substitution(path.read_text(encoding="utf-8"))))
        return Path(out.name)


class Node(Action):
    """A node with its process."""

    names: tuple[str, ...] = (
        *("executable", "package", "name", "namespace", "exec_name", "parameters", "remappings"),
        *("ros_arguments", "arguments", "on_exit"),
    )
    others: tuple[str, ...] = ExecuteProcess.others

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # By the names that launch_ros keeps them under.
        listed = {it: vars(self)[it] or () for it in _LISTED}
        own = {f"node_{it}": vars(self)[it] for it in _OF_NODE}
        own |= {"package": vars(self)["package"], **listed}
        vars(self).update({f"_Node__{key}": it for key, it in own.items()})


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
        self.parameters, self.remappings = parameters, remappings
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
        own = (text_of(context, self.name), _value(context, self.value, "a value"))
        _add(context, "global_params", own)


class SetRemap(Action):
    """A remap rule for all nodes that come next."""

    names = ("src", "dst")
    src: Text
    dst: Text

    def execute(self, context: LaunchContext) -> None:
        _add(context, "ros_remaps", (text_of(context, self.src), text_of(context, self.dst)))


def _add(context: LaunchContext, key: str, it: Any) -> None:
    context.launch_configurations[key] = [*context.launch_configurations.get(key, ()), it]


class OnStateTransition(EventHandler):
    """A change of a life cycle."""

    names = ("target_lifecycle_node", "entities")
    others = ("start_state", "goal_state", "transition", "handle_once")


class ChangeState(Kept):
    """A transition that is asked for."""

    names = ("lifecycle_node_matcher", "transition_id")


class Transition:
    """Those of lifecycle_msgs."""

    TRANSITION_CONFIGURE, TRANSITION_CLEANUP = 1, 2
    TRANSITION_ACTIVATE, TRANSITION_DEACTIVATE = 3, 4


class PackageNotFoundError(KeyError):
    """A package is not installed."""


class FindPackageShare(Kept, Substitution):
    """The share folder of a package."""

    names = ("package",)
    package: Text

    def perform(self, context: LaunchContext) -> str:
        return get_package_share_directory(text_of(context, self.package))


def get_package_prefix(package_name: str) -> str:
    """The folder that a package is installed in; raises PackageNotFoundError."""
    index = os.path.join("share", "ament_index", "resource_index", "packages", package_name)
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if prefix and os.path.isfile(os.path.join(prefix, index)):
            return prefix
    raise PackageNotFoundError(f"package '{package_name}' not found")


def get_package_share_directory(package_name: str) -> str:
    """The share folder of a package; raises PackageNotFoundError."""
    return os.path.join(get_package_prefix(package_name), "share", package_name)


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
        return dict(_values(context, given, ""))
    if isinstance(given, ParameterFile):
        return given.evaluate(context)
    return Path(text_of(context, given))


def _values(
    context: LaunchContext, given: Mapping[Any, Any], above: str
) -> Iterator[tuple[str, Any]]:
    """The values by dotted name."""
    for key, value in given.items():
        name = f"{above}{text_of(context, key)}"
        if isinstance(value, Mapping):
            yield from _values(context, value, f"{name}.")
        else:
            yield name, _value(context, value, name)


def _value(context: LaunchContext, value: Any, name: str) -> Any:
    if hasattr(value, "evaluate"):
        return value.evaluate(context)
    if isinstance(value, list | tuple) and not any(hasattr(it, "perform") for it in value):
        return [_value(context, it, name) if _is_text(it) else it for it in value]
    return _read(text_of(context, value), name) if _is_text(value) else value


def _is_text(value: Any) -> bool:
    several = isinstance(value, list | tuple) and any(hasattr(it, "perform") for it in value)
    return several or isinstance(value, str) or hasattr(value, "perform")


def _read(text: str, name: str) -> Any:
    """A text as YAML has it."""
    wrapped = (
        "if it is meant to be a string, try wrapping it in ParameterValue(value, value_type=str)"
    )
    try:
        found = load_yaml(text) if text else ""
    except yaml.YAMLError:
        raise TypeError(f"Unable to parse {name} as yaml; {wrapped}") from None
    if not isinstance(found, (*_PLAIN, list)):
        raise TypeError(f"{name} has a value of no type of parameters; {wrapped}")
    return found
