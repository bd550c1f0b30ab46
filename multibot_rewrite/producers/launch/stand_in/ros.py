# SPDX-License-Identifier: Apache-2.0
"""As much of launch_ros as plain launch files use, for machines without it.

Names and signatures are those of launch_ros jazzy. Source: launch_ros jazzy, actions/node.py,
descriptions/composable_node.py, utilities/evaluate_parameters.py, utilities/namespace_utils.py.
"""

from __future__ import annotations

from collections.abc import Iterable
from types import NoneType
from typing import Any

from multibot_rewrite.producers.launch.stand_in.actions import Action, doing
from multibot_rewrite.producers.launch.stand_in.parameters import flat, value_of
from multibot_rewrite.producers.launch.stand_in.processes import (
    EventHandler,
    ExecuteProcess,
    TimerAction,
)
from multibot_rewrite.producers.launch.stand_in.values import (
    Kept,
    LaunchContext,
    Text,
    kept,
    normalize_to_list_of_substitutions,
    text_of,
)

_LISTED = ("parameters", "remappings", "ros_arguments", "arguments")


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
        own = {f"node_{it}": vars(self)[it] for it in ("executable", "name", "namespace")}
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
        self.__package, self.node_plugin = package, plugin
        self.node_name, self.node_namespace = name, namespace
        self.parameters, self.remappings = [flat(it) for it in parameters or ()], remappings
        self._condition = condition

    @property
    def package(self) -> list[Any]:
        """Read only, as launch_ros's is: a component for a robot has its own."""
        return normalize_to_list_of_substitutions(self.__package)

    def condition(self) -> Any:
        return self._condition


class PushRosNamespace(Action):
    """A namespace for what comes next."""

    names = ("namespace",)

    def execute(self, context: LaunchContext) -> None:
        above = context.launch_configurations.get("ros_namespace")
        full = prefix_namespace(above, text_of(context, self.namespace))
        context.launch_configurations["ros_namespace"] = make_namespace_absolute(full)


class PushROSNamespace(PushRosNamespace):
    """The same."""


class SetParameter(Action):
    """A parameter for all nodes that come next."""

    names = ("name", "value")

    def execute(self, context: LaunchContext) -> None:
        name = text_of(context, self.name)
        _add(context, "global_params", [(name, value_of(context, self.value, name))])


def _add(context: LaunchContext, key: str, more: Iterable[Any]) -> None:
    """Extend the list itself, as launch_ros does: an enclosing scope sees it, too."""
    context.launch_configurations.setdefault(key, []).extend(more)


SetParametersFromFile = doing(
    *("SetParametersFromFile", "filename"),
    lambda context, file: _add(context, "global_params", [file]),
)
SetRemap = doing("SetRemap", "src dst", lambda context, *rule: _add(context, "ros_remaps", [rule]))


SetUseSimTime = kept(Action, "SetUseSimTime", "value")
SetROSLogDir = kept(Action, "SetROSLogDir", "new_log_dir")
LifecycleTransition = kept(Action, "LifecycleTransition", "lifecycle_node_names transition_ids")


ROSTimer = kept(TimerAction, "ROSTimer", "period actions")
RosTimer = ROSTimer


OnStateTransition = kept(
    EventHandler,
    "OnStateTransition",
    "target_lifecycle_node entities",
    "start_state goal_state transition matcher",
)
ChangeState = kept(Kept, "ChangeState", "lifecycle_node_matcher transition_id")
StateTransition = kept(Kept, "StateTransition", "action msg")


class Transition:
    """Those of lifecycle_msgs."""

    TRANSITION_CONFIGURE, TRANSITION_CLEANUP = 1, 2
    TRANSITION_ACTIVATE, TRANSITION_DEACTIVATE = 3, 4


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a relative namespace below the root."""
    return ns if ns is None or ns.startswith("/") else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace below another one, unless it is absolute."""
    if ns is None or not base_ns or ns.startswith("/"):
        found = base_ns if ns is None else ns
    else:
        found = f"{'' if base_ns == '/' else base_ns}/{ns}"
    return found if found in (None, "/") else str(found).rstrip("/")
