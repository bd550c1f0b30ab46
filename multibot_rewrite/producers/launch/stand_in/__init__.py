"""A stand-in for launch and launch_ros where they are not: plain launch files in Python are read.

``standing_in`` lets ``import launch`` find it. Nothing is started.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from multibot_rewrite.producers.launch.stand_in import actions, ros, values

_OF_LAUNCH: Mapping[str, tuple[str, ...]] = {
    "launch": ("Action", "LaunchContext", "LaunchDescription", "Substitution"),
    "launch.actions": (
        *("DeclareLaunchArgument", "EmitEvent", "ExecuteProcess", "GroupAction"),
        *("IncludeLaunchDescription", "LogInfo", "OpaqueFunction", "RegisterEventHandler"),
        *("SetEnvironmentVariable", "SetLaunchConfiguration", "Shutdown", "TimerAction"),
    ),
    "launch.conditions": ("IfCondition", "UnlessCondition"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessIO", "OnProcessStart", "OnShutdown"),
    "launch.events": ("matches_action",),
    "launch.frontend": (),
    "launch.frontend.parse_substitution": ("parse_substitution",),
    "launch.launch_description_sources": ("AnyLaunchDescriptionSource",),
    "launch.substitution": ("Substitution",),
    "launch.substitutions": (
        *("Command", "EnvironmentVariable", "EqualsSubstitution", "FindExecutable"),
        *("LaunchConfiguration", "NotSubstitution", "PathJoinSubstitution", "PythonExpression"),
        *("TextSubstitution", "ThisLaunchFile", "ThisLaunchFileDir"),
    ),
    "launch.utilities": ("normalize_to_list_of_substitutions", "perform_substitutions"),
}
_OF_ROS: Mapping[str, tuple[str, ...]] = {
    "launch_ros": (),
    "launch_ros.actions": (
        *("ComposableNodeContainer", "LifecycleNode", "LoadComposableNodes", "Node"),
        *("PushROSNamespace", "PushRosNamespace", "SetParameter", "SetRemap"),
    ),
    "launch_ros.descriptions": ("ComposableNode", "ParameterFile", "ParameterValue"),
    "launch_ros.event_handlers": ("OnStateTransition",),
    "launch_ros.events": (),
    "launch_ros.events.lifecycle": ("ChangeState",),
    "launch_ros.parameter_descriptions": ("ParameterFile", "ParameterValue"),
    "launch_ros.substitutions": ("FindPackageShare",),
    "launch_ros.utilities": ("evaluate_parameters", "make_namespace_absolute", "prefix_namespace"),
    "lifecycle_msgs": (),
    "lifecycle_msgs.msg": ("Transition",),
    "ament_index_python": (
        "PackageNotFoundError",
        "get_package_prefix",
        "get_package_share_directory",
    ),
    "ament_index_python.packages": (
        *("PackageNotFoundError", "get_package_prefix", "get_package_share_directory"),
    ),
}


def contents() -> dict[str, dict[str, Any]]:
    """The modules, each with what it has."""
    known = {**vars(values), **vars(actions)}
    found = {name: {it: known[it] for it in own} for name, own in _OF_LAUNCH.items()}
    sources = found["launch.launch_description_sources"]
    sources["PythonLaunchDescriptionSource"] = sources["AnyLaunchDescriptionSource"]
    found["launch.logging"] = {"get_logger": logging.getLogger}
    return found | {name: {it: vars(ros)[it] for it in own} for name, own in _OF_ROS.items()}


@contextmanager
def standing_in(**more: Mapping[str, Any]) -> Iterator[None]:
    """``import launch`` finds the stand-in inside, and all else what it found before."""
    made = {name: _module(name, it) for name, it in {**contents(), **more}.items()}
    roots = {name.partition(".")[0] for name in made}
    before = {name: it for name, it in sys.modules.items() if name.partition(".")[0] in roots}
    for name in before:
        del sys.modules[name]
    sys.modules.update(made)
    try:
        yield
    finally:
        for name in [it for it in sys.modules if it.partition(".")[0] in roots]:
            del sys.modules[name]
        sys.modules.update(before)


def _module(name: str, content: Mapping[str, Any]) -> ModuleType:
    module = ModuleType(name)
    vars(module).update(content, __path__=[])
    return module
