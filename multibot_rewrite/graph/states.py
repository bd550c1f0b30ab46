"""What nodes answer when they are asked for their state: life cycle, parameters, controllers. Pure.

A graph shows names and types alone; these need a service call to each node (``graph/live/ask.py``).
"""

from __future__ import annotations

import json

from multibot_rewrite.record import NamedTuple


class Controller(NamedTuple):
    """A controller of a controller manager; ``claims`` are command interfaces, while it is active."""

    name: str
    state: str
    claims: tuple[str, ...] = ()


class Parameter(NamedTuple):
    """A parameter of a node; ``value`` is what ``parameter_text`` makes of it."""

    name: str
    value: str


class NodeState(NamedTuple):
    """What one node answered.

    ``lifecycle`` is the label of its state, empty for a node that is not managed. ``sim_time`` is
    whether it uses simulated time, None if it has no answer. ``controllers`` are those that it manages,
    ``parameters`` the others that it was asked for and has.
    """

    node: str
    lifecycle: str = ""
    sim_time: bool | None = None
    controllers: tuple[Controller, ...] = ()
    parameters: tuple[Parameter, ...] = ()


def parameter_text(value: object) -> str:
    """A value as JSON, by which two are compared: ``true``, ``1``, ``1.0``, ``"base_link"``."""
    return json.dumps(value, ensure_ascii=False)


def parameter_value(text: str) -> object:
    """What a ``parameter_text`` was made of; the text itself where a file has something else there."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text
