"""What classes of launch and launch_ros take, by the real ones: fixtures/launch_signatures.json.

    python tests/support/launch_signatures.py > fixtures/launch_signatures.json

Needs launch and launch_ros. Without them the stand-in has to have these signatures, and the tests
refuse by this table the options that launch_ros would refuse.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable
from importlib import import_module
from typing import Any

import launch_stand_in

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


def signature(thing: Any) -> list[str]:
    """The names of the parameters, and which are only given by name."""
    made = inspect.signature(thing).parameters.values()
    return [f"{'*' if it.kind is it.KEYWORD_ONLY else ''}{it.name}" for it in made]


def signatures(find: Callable[[str, str], Any]) -> dict[str, list[str]]:
    """What the stand-in has of launch, as ``find`` finds it by module and name."""
    found = {}
    for module, names in launch_stand_in.MODULES.items():
        for name, ours in names.items():
            thing = find(module, name)
            if not inspect.isclass(ours):
                found[f"{module}.{name}"] = ["callable"] if callable(thing) else []
                continue
            # The entities of XML and YAML are made by their own parsers.
            if name != "Entity":
                found[f"{module}.{name}"] = signature(thing.__init__)
            own = [it for it, made in vars(ours).items() if inspect.isfunction(made)]
            methods = [it for it in own if not it.startswith("_")]
            found |= {f"{module}.{name}.{it}": signature(getattr(thing, it)) for it in methods}
    return found


def table() -> dict[str, Any]:
    """Options by the name of each class of launch_ros; below ``launch`` signatures by full name."""
    real = {name: options(module, name) for module, names in CLASSES.items() for name in names}
    launch = signatures(lambda module, name: getattr(import_module(module), name))
    return {**real, "launch": launch}


if __name__ == "__main__":
    print(json.dumps(table(), indent=1))
