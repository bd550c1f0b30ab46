# SPDX-License-Identifier: Apache-2.0
"""Which nodes of a graph are asked for their state, what they answer, and parameters as texts. Pure."""

import json
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.system.records import (
    SERVES,
    SERVICE,
    SILENT,
    SIM_TIME,
    Caveat,
    Controller,
    Parameter,
    System,
)

# The value of a parameter, as rcl has it.
Scalar = bool | int | float | str
Value = Scalar | list[Scalar]
# Stands for all names of parameters, where only a run tells them.
ANY_NAME = "*"


def parameter_text(value: object) -> str:
    """Return a value as JSON: ``true``, ``1``, ``1.0``, ``"base_link"``."""
    return json.dumps(value, ensure_ascii=False)


def parameter_value(text: str) -> object:
    """Return the value of a ``parameter_text``; the text itself if it is not JSON."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text


class Answer(NamedTuple):
    """What one node answered: its lifecycle state (empty for none), parameters and controllers."""

    node: str
    lifecycle: str = ""
    parameters: tuple[Parameter, ...] = ()
    controllers: tuple[Controller, ...] = ()


def with_answers(
    system: System, answers: Iterable[Answer], asked: "Iterable[Question]" = ()
) -> System:
    """Return the system with the nodes' answers; names ``asked`` nodes that did not answer."""
    said = tuple(answers)
    silent = {it.node for it in asked if it.type == GET_PARAMETERS} - {it.node for it in said}
    states = {it.node: it.lifecycle for it in said if it.lifecycle}
    caveats = system.environment.caveats
    if silent:
        text = (
            f"{shorten(sorted(silent), SEVERAL)} did not answer --state within {ANSWER_SECONDS:g} s,"
            " so what such a node does is not known; does it hang?"
        )
        caveats = (*caveats, Caveat(SILENT, True, text))
    return system._replace(
        environment=system.environment._replace(caveats=caveats),
        nodes=tuple(
            it._replace(lifecycle=states.get(it.name, it.lifecycle)) for it in system.nodes
        ),
        parameters=(*system.parameters, *(own for it in said for own in it.parameters)),
        controllers=(*system.controllers, *(own for it in said for own in it.controllers)),
    )


GET_STATE = "lifecycle_msgs/srv/GetState"
GET_PARAMETERS = "rcl_interfaces/srv/GetParameters"
LIST_CONTROLLERS = "controller_manager_msgs/srv/ListControllers"
LIST_PARAMETERS = "rcl_interfaces/srv/ListParameters"
ASKED = (GET_STATE, GET_PARAMETERS, LIST_PARAMETERS, LIST_CONTROLLERS)
# How long all nodes together have for their answers.
ANSWER_SECONDS = 5.0
NO_MORE: Mapping[str, Collection[str]] = {}


class Question(NamedTuple):
    """A service that is called to ask a node, and for which parameters."""

    node: str
    service: str
    type: str
    parameters: tuple[str, ...] = ()


def questions(
    graph: System, parameters: Mapping[str, Collection[str]] = NO_MORE
) -> Iterator[Question]:
    """Yield the questions for nodes, but none for two of one name: one answers for the other.

    ``parameters`` are those that are wanted of a node in addition to ``use_sim_time``, whatever it
    lists."""
    times = Counter(node.name for node in graph.nodes)
    for end in graph.ends:
        known = (end.kind, end.role) == (SERVICE, SERVES) and end.type in ASKED
        if known and end.name.startswith(f"{end.node}/") and times[end.node] == 1:
            wanted = {SIM_TIME, *parameters.get(end.node, ())} if end.type == GET_PARAMETERS else ()
            yield Question(end.node, end.name, end.type, tuple(sorted(wanted)))
