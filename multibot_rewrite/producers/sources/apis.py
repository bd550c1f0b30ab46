# SPDX-License-Identifier: Apache-2.0
"""``calls.txt``: which calls declare an endpoint. One line, one way to declare one."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import NamedTuple

ARGUMENT = "ARGUMENT"
HELPER, OWN = "helper", "own"


class Api(NamedTuple):
    """A call that declares an endpoint; see the head of ``calls.txt``."""

    function: str
    role: str
    name: str
    type: str
    node: str = ""


@cache
def apis() -> Mapping[str, tuple[Api, ...]]:
    """By function."""
    found: dict[str, list[Api]] = {}
    text = files(__package__).joinpath("calls.txt").read_text(encoding="utf-8")
    for line in text.splitlines():
        if line and not line.startswith("#"):
            api = Api(*line.split())
            found.setdefault(api.function, []).append(api)
    return {name: tuple(rows) for name, rows in found.items()}
