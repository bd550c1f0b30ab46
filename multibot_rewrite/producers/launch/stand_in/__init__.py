# SPDX-License-Identifier: Apache-2.0
"""A stand-in for launch and launch_ros where they are not: plain launch files in Python are read.

``standing_in`` lets ``import launch`` find it. Nothing is started.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from types import ModuleType
from typing import Any

from multibot_rewrite.producers.launch.stand_in import (
    actions,
    frontend,
    packages,
    parameters,
    processes,
    ros,
    values,
)
from multibot_rewrite.producers.launch.stand_in.actions import not_read
from multibot_rewrite.producers.launch.stand_in.names import names

_ROOMS = (values, packages, frontend, actions, processes, parameters, ros)
# A name that two modules have for two things.
_OTHERWISE = {("launch_ros.substitutions", "Parameter"): packages.ParameterSubstitution}
_CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def _get_logger(name: str | None = None) -> Any:
    import logging  # slow to import; few launch files say anything

    return logging.getLogger(name)


@cache
def contents() -> Mapping[str, dict[str, Any]]:
    """Return the modules of the stand-in, each with the names that it has."""
    known = {key: it for room in _ROOMS for key, it in vars(room).items()}
    known["get_logger"] = _get_logger
    found = {
        module: {it: _OTHERWISE.get((module, it)) or known[it] for it in words.split()}
        for module, words in names().read.items()
    }
    for module, words in names().not_read.items():
        found.setdefault(module, {}).update({it: not_read(it) for it in words.split()})
    return found


@cache
def inside() -> dict[str, str]:
    """Return the modules inside packages, as ``launch.actions.timer_action``, each with its package."""
    found = {}
    for package, content in contents().items():
        own = names().inside.get(package, "").split()
        for it in (*(_CAMEL.sub("_", name).lower() for name in content), *own):
            found[f"{package}.{it}"] = package
    return found


@contextmanager
def standing_in(**more: Mapping[str, Any]) -> Iterator[None]:
    """Let ``import launch`` find the stand-in inside, and all else what it found before."""
    found: dict[str, Mapping[str, Any]] = {**contents(), **more}
    every = {name: found[package] for name, package in inside().items()} | found
    made = {name: ModuleType(name) for name in every}
    for name, module in made.items():
        vars(module).update(every[name], __path__=[])
    for name, module in made.items():
        package, _, last = name.rpartition(".")
        if package and not hasattr(made[package], last):
            setattr(made[package], last, module)
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


def is_stood_in() -> bool:
    """Return whether ``import launch`` finds the stand-in."""
    return sys.modules.get("launch") is not None and not hasattr(sys.modules["launch"], "__file__")
