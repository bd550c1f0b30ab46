# SPDX-License-Identifier: Apache-2.0
"""What launch and launch_ros have, and what their classes take: fixtures/launch_signatures.json.

    python tests/support/launch_signatures.py > fixtures/launch_signatures.json

Needs launch and launch_ros. Without them the stand-in has to have these names and signatures, and the
tests refuse by this table the options that launch_ros would refuse.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from multibot_rewrite.producers.launch.stand_in import contents
from multibot_rewrite.producers.launch.stand_in.names import names as known
from multibot_rewrite.producers.launch.stand_in.values import Kept

CLASSES = {
    "launch_ros.actions": (
        *("Node", "LifecycleNode", "ComposableNodeContainer", "LoadComposableNodes"),
        "SetParameter",
    ),
    "launch_ros.descriptions": ("ComposableNode",),
    "launch_ros.parameter_descriptions": ("ParameterValue",),
}
# What the classes give the classes above them.
_MADE = {"self", "cmd", "process_description", "matcher", "action_matcher", "on_event"}
_MADE |= {"target_action_cls", "target_event_cls"}
# Newer releases have it.
_LATER = {"autostart"}
# Newer classes (launch rolling: actions/for_loop.py, actions/log.py, substitutions/for_loop_var.py,
# path_join_substitution.py, string_join_substitution.py).
NEWER = {
    "launch.actions.ForEach": ["condition", "function", "input_values"],
    "launch.actions.ForLoop": ["condition", "function", "length", "name"],
    "launch.actions.Log": ["condition", "level", "msg"],
    **{f"launch.actions.Log{it}": ["condition", "msg"] for it in ("Debug", "Error", "Warning")},
    "launch.substitutions.ForEachVar": ["default_value", "name"],
    "launch.substitutions.ForLoopIndex": ["default_value", "name"],
    "launch.substitutions.PathSubstitution": ["path"],
    "launch.substitutions.StringJoinSubstitution": ["delimiter", "substitutions"],
}
# Classes that others extend, or that are made for a launch file, and types.
_NONE = {"Condition", "LaunchDescriptionSource", "StateTransition", "Substitution"}
_NONE |= {"SomeEntitiesType", "SomeSubstitutionsType"}


def options(module: str, name: str) -> list[str]:
    """Return what a class may be given; ``**kwargs`` go to the class above."""
    taken: set[str] = set()
    for above in getattr(import_module(module), name).__mro__:
        if "__init__" not in vars(above) or above is object:
            continue
        found = inspect.signature(vars(above)["__init__"]).parameters.values()
        taken |= {it.name for it in found if it.kind is not it.VAR_KEYWORD}
        if not any(it.kind is it.VAR_KEYWORD for it in found):
            break
    return sorted(taken - _MADE)


def stand_in() -> dict[str, list[str]]:
    """Return what the classes of the stand-in take, by full name."""
    return {name: sorted(_taken(it)) for name, it in _classes()}


def _classes() -> Iterator[tuple[str, Any]]:
    for module, names in known().read.items():
        for name in names.split() if module.startswith("launch") else ():
            it = contents()[module][name]
            if inspect.isclass(it) and not issubclass(it, Exception) and name not in _NONE:
                yield f"{module}.{name}", it


def public_names() -> dict[str, list[str]]:
    """Return what each real package offers, by the modules that a launch file imports from."""
    found = {}
    for module in (it for it in known().read if it.partition(".")[0] in ("launch", "launch_ros")):
        real = import_module(module)
        # launch_ros.utilities promises two that it has not.
        own = {it: vars(real).get(it) for it in getattr(real, "__all__", ())}
        found[module] = sorted(it for it in own if own[it] and not inspect.ismodule(own[it]))
    return found


def _taken(kind: Any) -> set[str]:
    if issubclass(kind, Kept):
        return {*kind.names, *kind.others} - _MADE - _LATER
    return {*inspect.signature(kind.__init__).parameters} - _MADE


def table() -> dict[str, Any]:
    """Options by the name of each class of launch_ros; below ``launch`` those that the stand-in has."""
    real = {name: options(module, name) for module, names in CLASSES.items() for name in names}
    names = (name.rpartition(".") for name, _ in _classes() if name not in NEWER)
    made = {".".join((it[0], it[2])): options(it[0], it[2]) for it in names}
    return {**real, "launch": made, "names": public_names()}


if __name__ == "__main__":
    print(json.dumps(table(), indent=1))
