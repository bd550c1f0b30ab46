# SPDX-License-Identifier: Apache-2.0
"""Reads ``domains``, ``crossing``, ``free_fleet`` (ROS domains) and ``cell`` of a fleet file.

One move_group plans for the arms of a cell, and reads the joint states of all arms on one topic:
MoveIt's state monitor takes messages with some of the joints (moveit2 2.12.4
current_state_monitor.cpp, ``jointStateCallback``)."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.nearest import did_you_mean
from multibot_rewrite.fleet.file.fleet_data import FleetData, listed
from multibot_rewrite.system.domains import USUAL_DOMAIN
from multibot_rewrite.system.records import Domain

DOMAINS, CROSSING, FREE_FLEET, SHARED = "domains", "crossing", "free_fleet", "shared_nodes"


class FreeFleet(NamedTuple):
    """What free_fleet gets: Zenoh's router, the map's name, the waypoint of a robot's charger."""

    router: str
    map: str
    charger: str


class Apart(NamedTuple):
    """The domains of robots and of what they share, with the place; empty for a single domain.

    ``crossing`` are topics of each robot that go to the shared domain."""

    domains: tuple[Domain, ...] = ()
    crossing: tuple[str, ...] = ()
    free_fleet: FreeFleet | None = None
    place: tuple[str, int] = ("", 1)

    @property
    def numbers(self) -> dict[str, int]:
        """The domain by robot, with "" for all robots; empty for a fleet of one domain."""
        return {it.robot: it.number for it in self.domains}


TOGETHER = Apart()


def apart_of(read: FleetData, robots: Collection[str]) -> Apart:
    """Return the domains of a fleet file, by robot; raises InputError with its line."""
    data = read.data
    for key in (it for it in (CROSSING, FREE_FLEET) if it in data and DOMAINS not in data):
        file, line = read.places.get((key,), (read.file, 1))
        hint = f"write {DOMAINS} as well, with the domain of each robot"
        raise InputError(f"{file}:{line}: {key}: {hint}")
    if DOMAINS not in data:
        return TOGETHER
    given, adapter = data[DOMAINS], data.get(FREE_FLEET)
    file, line = read.places.get((DOMAINS,), (read.file, 1))
    lacking = [it for it in robots if it not in given]
    unknown = [it for it in given if it != SHARED and it not in robots]
    if lacking:
        near = next(filter(None, (did_you_mean(lacking[0], [it]) for it in unknown)), "")
        what = f"{lacking[0]} has none; give it one{f' ({near})' if near else ''}"
        raise InputError(f"{file}:{line}: {DOMAINS}: {what}")
    if "domain" in data.get("zenoh", {}):
        what = "zenoh has a domain as well; leave out that of zenoh"
        raise InputError(f"{file}:{line}: {DOMAINS}: {what}")
    if adapter is not None:
        charger = adapter.get("charger", "{robot}_charger")
        adapter = FreeFleet(adapter["router"], adapter["map"], charger)
    numbers = {name: given[name] for name in robots}
    numbers[""] = given.get(SHARED, USUAL_DOMAIN)
    return Apart(
        tuple(Domain(*it) for it in numbers.items()),
        tuple(listed(data.get(CROSSING, []))),
        adapter,
        read.places[DOMAINS,],
    )


CELL, MOVE_GROUP, JOINT_STATES = "cell", "move_group", "/joint_states"


class Cell(NamedTuple):
    """The joined robot: its name, and planning groups of several arms with the groups in them."""

    name: str
    groups: Mapping[str, tuple[str, ...]]
    place: str


def with_cell(read: FleetData) -> FleetData:
    """Return the data with what a cell means: groups per arm, one move_group, one topic of states."""
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
