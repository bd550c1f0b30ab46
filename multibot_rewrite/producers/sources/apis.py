# SPDX-License-Identifier: Apache-2.0
"""Which calls of a package declare an endpoint (``calls.txt``), and which do not (``harmless.txt``)."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.grouping import lists_by_key

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
    """Return the calls that declare endpoints, by function."""
    lines = own_text(__file__, "calls.txt").splitlines()
    every = (Api(*line.split()) for line in lines if line and not line.startswith("#"))
    found = lists_by_key((it.function, it) for it in every)
    return {name: tuple(rows) for name, rows in found.items()}


@cache
def harmless() -> frozenset[str]:
    """Return the functions that use nothing of a node that others see."""
    return frozenset(own_text(__file__, "harmless.txt").partition("\n")[2].split())
