# SPDX-License-Identifier: Apache-2.0
"""The nodes of Nav2 that its launch file starts, and the programs of them.

Source: as ``knowledge.programs``; lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER as MANAGER
from multibot_rewrite.knowledge.programs import (
    NAV2,
    Program,
    container_of,
    is_unmanaged,
    known_program,
)
from multibot_rewrite.knowledge.stacks import built_in

__all__ = ["MANAGER", "Program", "container_of", "program", "unmanaged", "with_program"]

CONTAINER, MAP_SERVER, SHARED_MANAGER = "nav2_container", "map_server", "lifecycle_manager_shared"
STATE = "robot_state_publisher"
TRANSITIONS: Mapping[str, int] = MappingProxyType({"configure": 1, "activate": 3})
_INFO = "costmap_filter_info_server"
_KINDS: Mapping[str, str] = MappingProxyType(
    {
        "keepout_filter_mask_server": MAP_SERVER,
        "speed_filter_mask_server": MAP_SERVER,
        f"keepout_{_INFO}": _INFO,
        f"speed_{_INFO}": _INFO,
    }
)


def kind_of(name: str) -> str:
    """The name in ``NAV2`` of a node of a stack."""
    if name.startswith(MANAGER):
        return MANAGER
    return _KINDS.get(name, name)


def program(name: str, release: str) -> Program:
    """The program of a node that ``with_program`` gives."""
    return known_program(kind_of(name), release)


def unmanaged(name: str, release: str) -> bool:
    """Has a node of ``with_program`` a life cycle that no lifecycle manager of Nav2 takes care of?"""
    return is_unmanaged(built_in(release).nodes[kind_of(name)], release)


def with_program(names: Iterable[str]) -> list[str]:
    """Those of the nodes that are Nav2's or slam_toolbox, managers last, so that what they manage is
    there."""
    known = (it for it in names if kind_of(it) in NAV2)
    return sorted(known, key=lambda it: NAV2.index(kind_of(it)))
