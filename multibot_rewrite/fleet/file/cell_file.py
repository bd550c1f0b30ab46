# SPDX-License-Identifier: Apache-2.0
"""``cell`` of a fleet file: arms that one move_group plans for.

move_group runs once, and reads the joint states of all arms on one topic: MoveIt's state monitor takes
messages with some of the joints (moveit2 2.12.4 current_state_monitor.cpp, ``jointStateCallback``).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.fleet.file.fleet_data import FleetData, listed

CELL, MOVE_GROUP, JOINT_STATES = "cell", "move_group", "/joint_states"


class Cell(NamedTuple):
    """The joined robot: its name, and its planning groups of several arms with the groups in them.
    ``place`` is where the fleet file asks for it."""

    name: str
    groups: Mapping[str, tuple[str, ...]]
    place: str


def with_cell(read: FleetData) -> FleetData:
    """Return the data with what a cell means for its keys: groups for each arm, one move_group, one
    topic of joint states."""
    if CELL not in read.data:
        return read
    data = dict(read.data)
    for key, usual, more in (
        ("shared_nodes", (), MOVE_GROUP),
        ("shared_topics", SHARED_TOPICS, JOINT_STATES),
    ):
        data[key] = list(dict.fromkeys((*listed(data.get(key, list(usual))), more)))
    data.setdefault("groups", "rename")
    return read._replace(data=data)


def cell_of(read: FleetData, naming: Naming) -> Cell | None:
    """Return the cell of a fleet, None without; raises InputError if its robots cannot be joined."""
    if CELL not in read.data:
        return None
    given = read.data[CELL]
    file, line = read.places[CELL,]
    groups = {name: tuple(it) for name, it in given.get("groups", {}).items()}
    found = Cell(given.get("name", CELL), groups, f"{file}:{line}")
    place, layout = f"{found.place}: cell:", naming.layout
    if layout.at_run_time or not layout.frames:
        what = f"in layout {layout.name} the joints of all arms have the same names in their URDFs"
        raise InputError(f"{place} {what}; take layout frames-per-robot")
    if layout.tf_per_robot:
        what = f"layout {layout.name} has a tf for each arm"
        raise InputError(f"{place} {what}; take layout frames-per-robot")
    for robot in read.data["robots"]:
        name = robot["name"]
        if name == found.name:
            raise InputError(f"{place} a robot is called {name!r}, too; write another name:")
        if not robot.get("srdf", read.data.get("srdf")):
            what = f"robot {name!r} has no srdf, so MoveIt knows no group of it"
            raise InputError(f"{place} {what}; name its SRDF")
    return found
