# SPDX-License-Identifier: Apache-2.0
"""What is known of the programs that launch files start: ``programs.yaml``."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_own_yaml


class Programs(NamedTuple):
    """Executables whose node is called otherwise than its entry, and those that are no node of a robot.

    ``spawners`` put a description into a simulator, ``simulators`` are packages that only a simulated
    robot needs; ``once`` has patterns of what runs once for all robots, by the reason."""

    names: Mapping[str, str]
    passing: Collection[str]
    spawners: Collection[str]
    simulators: Collection[str]
    once: Mapping[str, Collection[str]]


@cache
def programs() -> Programs:
    """Those of ``programs.yaml``."""
    data = load_own_yaml(__file__, "programs.yaml")
    sets = {it: frozenset(data[it]) for it in ("passing", "spawners", "simulators")}
    return Programs(**{**data, **sets})
