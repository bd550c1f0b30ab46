# SPDX-License-Identifier: Apache-2.0
"""What a built launch file starts: ``python started.py FILE [NAME:=VALUE ...]`` prints it as JSON;
without a word also what it starts for each robot alone.

A stand-in for launch and launch_ros that runs no program, for files as ``multibot build`` writes them:
actions are kept with the words that they were given, conditions and substitutions are evaluated, what
waits for an event comes at once. It knows nothing of the project: it is part of its referee.
"""

from __future__ import annotations

import json
import runpy
import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any

Words = dict[str, Any]


class Context:
    """The launch configurations of a run."""

    def __init__(self, given: dict[str, str]) -> None:
        self.launch_configurations = given


class Kept:
    """An action, a substitution or an event handler, with what it was made of."""

    def __init__(self, *given: Any, **words: Any) -> None:
        self.given, self.words = given, words

    def perform(self, context: Context) -> str:
        return text_of(SUBSTITUTIONS[type(self).__name__](self, context), context)


def text_of(value: Any, context: Context) -> str:
    """Return what a value, a substitution or a list of them comes to."""
    if isinstance(value, Kept):
        return value.perform(context)
    if isinstance(value, (list, tuple)):
        return "".join(text_of(it, context) for it in value)
    return str(value)


def plain(value: Any, context: Context) -> Any:
    """Return a parameter's value: substitutions are evaluated, numbers and lists stay what they are."""
    if isinstance(value, Kept) and type(value).__name__ == "ParameterValue":
        found = plain(value.given[0], context)
        made = value.words.get("value_type")
        return found.lower() in ("true", "1") if made is bool and isinstance(found, str) else found
    if isinstance(value, Kept):
        return value.perform(context)
    if isinstance(value, dict):
        return {text_of(key, context): plain(it, context) for key, it in value.items()}
    return [plain(it, context) for it in value] if isinstance(value, (list, tuple)) else value


SUBSTITUTIONS: dict[str, Any] = {
    "LaunchConfiguration": lambda it, context: context.launch_configurations[it.given[0]],
    "PathJoinSubstitution": lambda it, context: "/".join(
        text_of(part, context) for part in it.given[0]
    ),
    "PythonExpression": lambda it, context: str(eval(text_of(it.given[0], context))),
    "FindPackageShare": lambda it, context: f"share({text_of(it.given[0], context)})",
    "TextSubstitution": lambda it, context: it.words["text"],
}
ACTIONS = ("Node", "LifecycleNode", "ComposableNodeContainer", "ExecuteProcess")
# They start nothing; a namespace is pushed for launch files alone that are not here.
ENVIRONMENT = ("AppendEnvironmentVariable", "SetEnvironmentVariable")
STARTS_NOTHING = (*ENVIRONMENT, "PushRosNamespace")
MODULES = {
    "launch": ("LaunchDescription",),
    "launch.actions": (
        *("DeclareLaunchArgument", "EmitEvent", "ExecuteProcess", "GroupAction", "TimerAction"),
        *("IncludeLaunchDescription", "OpaqueFunction", "RegisterEventHandler"),
        *ENVIRONMENT,
    ),
    "launch.conditions": ("IfCondition", "UnlessCondition"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessStart"),
    "launch.substitutions": (*tuple(SUBSTITUTIONS)[:3], "TextSubstitution"),
    "launch_ros.actions": (*ACTIONS[:3], "LoadComposableNodes", "PushRosNamespace"),
    "launch_ros.descriptions": ("ComposableNode",),
    "launch_ros.event_handlers": ("OnStateTransition",),
    "launch_ros.events.lifecycle": ("ChangeState",),
    "launch_ros.parameter_descriptions": ("ParameterValue",),
    "launch_ros.substitutions": ("FindPackageShare",),
}


def install() -> None:
    """Let a launch file import what stands in."""
    kinds: dict[str, type[Kept]] = {}
    for path, names in MODULES.items():
        for parent in (path.rpartition(".")[0], path):
            sys.modules.setdefault(parent, ModuleType(parent)) if parent else None
        for name in names:
            kinds.setdefault(name, type(name, (Kept,), {}))
            setattr(sys.modules[path], name, kinds[name])
    events, states = ModuleType("launch.events"), ModuleType("lifecycle_msgs.msg")
    events.matches_action = lambda action: action  # type: ignore[attr-defined]
    states.Transition = type(  # type: ignore[attr-defined]
        "Transition", (), {"TRANSITION_ACTIVATE": 3, "TRANSITION_CONFIGURE": 1}
    )
    sys.modules |= {"launch.events": events, "lifecycle_msgs": ModuleType("lifecycle_msgs")}
    sys.modules["lifecycle_msgs.msg"] = states


def holds(action: Kept, context: Context) -> bool:
    """Whether an action's condition is met."""
    condition = action.words.get("condition")
    if condition is None:
        return True
    said = text_of(condition.given[0], context).lower() in ("true", "1")
    return said == (type(condition).__name__ == "IfCondition")


def visit(action: Any, context: Context) -> Iterator[Words]:
    """Yield what an action starts."""
    kind = type(action).__name__
    if not isinstance(action, Kept) or kind in STARTS_NOTHING or not holds(action, context):
        return
    if kind == "DeclareLaunchArgument":
        default = text_of(action.words.get("default_value", ""), context)
        context.launch_configurations.setdefault(action.given[0], default)
    elif kind in ("LaunchDescription", "GroupAction"):
        yield from each(action.given[0], context)
    elif kind == "TimerAction":
        yield from each(action.words["actions"], context)
    elif kind == "OpaqueFunction":
        yield from each(action.words["function"](context), context)
    elif kind == "RegisterEventHandler":
        words = action.given[0].words
        for key in ("on_exit", "on_start", "entities"):
            yield from each(words.get(key) or (), context)
    elif kind == "EmitEvent":
        event = action.words["event"].words
        node = event["lifecycle_node_matcher"]
        state = {"change": event["transition_id"]}
        yield {**state, "node": text_of(node.words["name"], context), **namespace(node, context)}
    elif kind == "IncludeLaunchDescription":
        given = action.words.get("launch_arguments", ())
        arguments = {text_of(key, context): text_of(it, context) for key, it in given}
        yield {"include": text_of(action.given[0], context), "arguments": arguments}
    else:
        yield from started(action, kind, context)


def each(actions: Any, context: Context) -> Iterator[Words]:
    for action in actions if isinstance(actions, (list, tuple)) else (actions,):
        yield from visit(action, context)


def namespace(node: Kept, context: Context) -> Words:
    return {"namespace": text_of(node.words.get("namespace", ""), context)}


def started(action: Kept, kind: str, context: Context) -> Iterator[Words]:
    """Yield a program, or the components that are loaded into one."""
    if kind == "ExecuteProcess":
        yield {"command": [text_of(it, context) for it in action.words["cmd"]]}
    elif kind in ACTIONS:
        yield node_of(action, context)
    elif kind != "LoadComposableNodes":
        raise ValueError(f"the stand-in does not know {kind}")
    for part in action.words.get("composable_node_descriptions", ()):
        if holds(part, context):
            yield {**node_of(part, context), "component": True}


def node_of(node: Kept, context: Context) -> Words:
    """Return the words of a node or component."""
    words = node.words
    executable = words.get("executable", words.get("plugin", ""))
    return {
        "package": text_of(words.get("package", ""), context),
        "executable": text_of(executable, context),
        "name": text_of(words.get("name", ""), context),
        **namespace(node, context),
        "parameters": [
            plain(it, context) if isinstance(it, dict) else {"": text_of(it, context)}
            for it in words.get("parameters", ())
        ],
        "rules": [[text_of(side, context) for side in it] for it in words.get("remappings", ())],
        "arguments": [text_of(it, context) for it in words.get("arguments", ())],
    }


def starts_of(file: str, given: dict[str, str]) -> tuple[list[str], list[Words]]:
    """Return the robots of a launch file, and what it starts with these arguments."""
    made = runpy.run_path(file)
    return list(made["ROBOTS"]), list(visit(made["generate_launch_description"](), Context(given)))


def main(file: str, *given: str) -> None:
    install()
    robots, starts = starts_of(file, dict(it.split(":=", 1) for it in given))
    own = {} if given else {it: starts_of(file, {"robots": it})[1] for it in robots}
    print(json.dumps({"robots": robots, "starts": starts, "own": own}))


if __name__ == "__main__":
    main(*sys.argv[1:])
