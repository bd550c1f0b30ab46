# SPDX-License-Identifier: Apache-2.0
"""What nodes answer when they are asked for their state, and the values of parameters as texts."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.records import Controller, Node, Parameter, System

# The value of a parameter, as rcl has it.
Scalar = bool | int | float | str
Value = Scalar | list[Scalar]
# Stands for all names of parameters, where only a run tells them.
ANY_NAME = "*"


def parameter_text(value: object) -> str:
    """A value as JSON: ``true``, ``1``, ``1.0``, ``"base_link"``."""
    return json.dumps(value, ensure_ascii=False)


def parameter_value(text: str) -> object:
    """What a ``parameter_text`` was made of; the text itself where a file has something else there."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text


class Answer(NamedTuple):
    """What one node answered: the label of its life cycle, empty for a node that is not managed, the
    parameters that it was asked for and has, the controllers that it manages."""

    node: str
    lifecycle: str = ""
    parameters: tuple[Parameter, ...] = ()
    controllers: tuple[Controller, ...] = ()


def with_answers(system: System, answers: Iterable[Answer]) -> System:
    """The system with what nodes said."""
    said = tuple(answers)
    states = {it.node: it.lifecycle for it in said if it.lifecycle}
    return system._replace(
        nodes=tuple(_in_state(it, states) for it in system.nodes) if states else system.nodes,
        parameters=(*system.parameters, *(own for it in said for own in it.parameters)),
        controllers=(*system.controllers, *(own for it in said for own in it.controllers)),
    )


def _in_state(node: Node, states: Mapping[str, str]) -> Node:
    return node._replace(lifecycle=states[node.name]) if node.name in states else node
