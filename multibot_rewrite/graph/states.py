"""What nodes answer when they are asked for their state: life cycle, clock, controllers. Pure.

A graph shows names and types alone; these need a service call to each node (``graph/live/ask.py``).
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from multibot_rewrite.graph.snapshot import Snapshot
from multibot_rewrite.remap.records import SERVES, SERVICE

GET_STATE = "lifecycle_msgs/srv/GetState"
GET_PARAMETERS = "rcl_interfaces/srv/GetParameters"
LIST_CONTROLLERS = "controller_manager_msgs/srv/ListControllers"
ASKED = (GET_STATE, GET_PARAMETERS, LIST_CONTROLLERS)
SIM_TIME = "use_sim_time"


class Question(NamedTuple):
    """A service that is called to ask a node."""

    node: str
    service: str
    type: str


class Controller(NamedTuple):
    """A controller of a controller manager; ``claims`` are command interfaces, while it is active."""

    name: str
    state: str
    claims: tuple[str, ...]


class NodeState(NamedTuple):
    """What one node answered.

    ``lifecycle`` is the label of its state, empty for a node that is not managed. ``sim_time`` is
    whether it uses simulated time, None if it has no answer. ``controllers`` are those that it manages.
    """

    node: str
    lifecycle: str = ""
    sim_time: bool | None = None
    controllers: tuple[Controller, ...] = ()


def questions(graph: Snapshot) -> Iterator[Question]:
    """Whom to ask for what; of two nodes with one name, one would answer for the other."""
    names = [node.name for node in graph.nodes]
    for end in graph.endpoints:
        known = (end.kind, end.role) == (SERVICE, SERVES) and end.type in ASKED
        if known and end.name.startswith(f"{end.node}/") and names.count(end.node) == 1:
            yield Question(end.node, end.name, end.type)


def to_message(states: tuple[NodeState, ...]) -> bytes:
    """The states as JSON, for the process that asked."""
    return json.dumps(states).encode()


def from_message(data: bytes) -> tuple[NodeState, ...]:
    """Read what ``to_message`` wrote."""
    return tuple(_state(*it) for it in json.loads(data))


def _state(node: str, lifecycle: str, sim_time: bool | None, controllers: list[Any]) -> NodeState:
    own = (Controller(name, state, tuple(claims)) for name, state, claims in controllers)
    return NodeState(node, lifecycle, sim_time, tuple(own))
