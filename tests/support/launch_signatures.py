"""The options that classes of launch_ros take, by the real ones: fixtures/launch_signatures.json.

    python tests/support/launch_signatures.py > fixtures/launch_signatures.json

Needs launch and launch_ros. Without them the tests refuse by this table what they would refuse.
"""

from __future__ import annotations

import inspect
import json
from importlib import import_module

CLASSES = {
    "launch_ros.actions": (
        *("Node", "LifecycleNode", "ComposableNodeContainer", "LoadComposableNodes"),
        "SetParameter",
    ),
    "launch_ros.descriptions": ("ComposableNode",),
    "launch_ros.parameter_descriptions": ("ParameterValue",),
}
# What the classes give the classes above them.
_MADE = {"self", "cmd", "process_description"}


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


def table() -> dict[str, list[str]]:
    """By the name of each class."""
    return {name: options(module, name) for module, names in CLASSES.items() for name in names}


if __name__ == "__main__":
    print(json.dumps(table(), indent=1))
