# SPDX-License-Identifier: Apache-2.0
"""Snapshots of schema 1, as versions before wrote them: other keys, and the answers of nodes apart."""

from __future__ import annotations

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.parameters import Answer, parameter_text, with_answers
from multibot_rewrite.system.records import (
    SIM_TIME,
    Controller,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Parameter,
    System,
)


class OldController(NamedTuple):
    """As ``Controller``, in the record of its manager."""

    name: str
    state: str
    claims: tuple[str, ...] = ()


class OldParameter(NamedTuple):
    """As ``Parameter``, in the record of its node."""

    name: str
    value: str


class OldState(NamedTuple):
    """What one node answered."""

    node: str
    lifecycle: str = ""
    sim_time: bool | None = None
    controllers: tuple[OldController, ...] = ()
    parameters: tuple[OldParameter, ...] = ()


class OldSnapshot(NamedTuple):
    """The keys of the file."""

    nodes: tuple[Node, ...]
    endpoints: tuple[End, ...]
    frames: tuple[Edge, ...]
    environment: Environment
    heard: tuple[Heard, ...] = ()
    states: tuple[OldState, ...] = ()


def system_of(old: OldSnapshot) -> System:
    """What the file says, in the records of today."""
    seen = System(old.nodes, old.endpoints, old.frames, old.environment, old.heard)
    return with_answers(seen, map(_answer, old.states))


def _answer(old: OldState) -> Answer:
    timed = (
        ()
        if old.sim_time is None
        else (Parameter(old.node, SIM_TIME, parameter_text(old.sim_time)),)
    )
    return Answer(
        old.node,
        old.lifecycle,
        (*timed, *(Parameter(old.node, *it) for it in old.parameters)),
        tuple(Controller(old.node, *it) for it in old.controllers),
    )
