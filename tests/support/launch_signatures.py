"""What classes of launch and launch_ros take, by the real ones: fixtures/launch_signatures.json.

    python tests/support/launch_signatures.py > fixtures/launch_signatures.json

Needs launch and launch_ros. Without them the stand-in has to have these signatures, and the tests
refuse by this table the options that launch_ros would refuse.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from multibot_rewrite.producers.launch.stand_in import contents
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


def options(module: str, name: str) -> list[str]:
    """What a class may be given; ``**kwargs`` go to the class above."""
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
    """What the classes of the stand-in take, by full name."""
    return {name: sorted(_taken(it)) for name, it in _classes()}


def _classes() -> Iterator[tuple[str, Any]]:
    for module, content in contents().items():
        for name, it in content.items():
            if module.startswith("launch") and inspect.isclass(it) and name != "Substitution":
                yield f"{module}.{name}", it


def _taken(kind: Any) -> set[str]:
    if issubclass(kind, Kept):
        return {*kind.names, *kind.others} - _MADE - _LATER
    return {*inspect.signature(kind.__init__).parameters} - _MADE


def table() -> dict[str, Any]:
    """Options by the name of each class of launch_ros; below ``launch`` those that the stand-in has."""
    real = {name: options(module, name) for module, names in CLASSES.items() for name in names}
    names = (name.rpartition(".") for name, _ in _classes())
    return {**real, "launch": {".".join((it[0], it[2])): options(it[0], it[2]) for it in names}}


if __name__ == "__main__":
    print(json.dumps(table(), indent=1))
