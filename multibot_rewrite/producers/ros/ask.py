# SPDX-License-Identifier: Apache-2.0
"""Asking nodes for their states: ``python -m multibot_rewrite.producers.ros.ask``, a child process.

All services are called at once, and all answers are waited for together, so that the time is bounded
whatever hangs.
"""

from __future__ import annotations

import json
import os
import re
import sys
import threading
import time
from collections.abc import Iterable
from typing import Any

from multibot_rewrite.producers.ros import ros
from multibot_rewrite.producers.ros.request import Send, run_worker
from multibot_rewrite.system.parameters import (
    GET_PARAMETERS,
    GET_STATE,
    LIST_PARAMETERS,
    Answer,
    Question,
    parameter_text,
)
from multibot_rewrite.system.record_values import plain_value
from multibot_rewrite.system.records import Controller, Parameter

POLL_SECONDS = 0.05
# Of one node, and how long a text may be: a description is in the graph.
MOST, LONGEST = 500, 2000
_UNASKED = re.compile(r"^qos_overrides\.|passw|token|secret|credential|(^|[._])key($|[._])")
# rcl_interfaces/msg/ParameterType -> the field of ParameterValue; bytes are left out.
_FIELDS = {
    1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value",
    6: "bool_array_value", 7: "integer_array_value", 8: "double_array_value", 9: "string_array_value",
}  # fmt: skip


def main(order: str, stop: threading.Event, send: Send) -> int:
    """Ask as ``order`` says, ``[seconds, questions]``; returns the exit code."""
    seconds, given = json.loads(order)
    asked = [Question(node, name, type_, tuple(own)) for node, name, type_, own in given]
    with ros.opened() as session:
        node = ros.add_node(session, f"_multibot_ask_{os.getpid()}")
        found = ask_nodes(session, node, asked, float(seconds), stop)
    send(json.dumps(plain_value(found)).encode())
    return 0


def ask_nodes(
    session: ros.Session,
    node: Any,
    asked: Iterable[Question],
    seconds: float,
    stop: threading.Event,
) -> tuple[Answer, ...]:
    """Return the answers that come within ``seconds``, or until ``stop``, by the names of nodes."""
    clients: dict[str, Any] = {}
    try:
        found = _ask(session, node, asked, clients, time.monotonic() + seconds, stop)
    finally:
        for client in clients.values():
            node.destroy_client(client)
    return tuple(found[it] for it in sorted(found))


def _ask(
    session: ros.Session,
    node: Any,
    asked: Iterable[Question],
    clients: dict[str, Any],
    end: float,
    stop: threading.Event,
) -> dict[str, Answer]:
    """Return the answers that come in time, by node; the clients made are added to ``clients``."""
    waiting = [it for it in asked if _client(node, it, clients)]
    sent: dict[Question, Any] = {}
    found: dict[str, Answer] = {}
    while (waiting or sent) and time.monotonic() < end and not stop.is_set():
        ready = [it for it in waiting if clients[it.service].service_is_ready()]
        sent |= {it: clients[it.service].call_async(_request(it)) for it in ready}
        waiting = [it for it in waiting if it not in sent]
        ros.spin(session, POLL_SECONDS)
        for it in [it for it, answer in sent.items() if answer.done()]:
            before = found.get(it.node, Answer(it.node))
            answer = sent.pop(it).result()
            found[it.node] = _with_answer(before, it, answer)
            more = listed(it, answer) if it.type == LIST_PARAMETERS else halves(it, answer)
            waiting += [one for one in more if _client(node, one, clients)]
    return found


def listed(asked: Question, answer: Any) -> list[Question]:
    """Return the question for a node's listed parameters, without QoS and private ones, or nothing."""
    names = sorted(it for it in map(str, answer.result.names) if not _UNASKED.search(it))
    service = asked.service.removesuffix("list_parameters") + "get_parameters"
    own = asked._replace(service=service, type=GET_PARAMETERS, parameters=tuple(names[:MOST]))
    return [own] if names else []


def halves(asked: Question, answer: Any) -> list[Question]:
    """Return smaller requests: if one parameter is missing, a node of rclcpp returns none."""
    names = asked.parameters
    if len(names) < 2 or len(answer.values) == len(names):
        return []
    middle = len(names) // 2
    return [asked._replace(parameters=it) for it in (names[:middle], names[middle:])]


def _client(node: Any, asked: Question, clients: dict[str, Any]) -> bool:
    """Make a client for the question, and return whether its type is installed."""
    class_, _ = ros.message_class(asked.type)
    if class_ and asked.service not in clients:
        clients[asked.service] = node.create_client(class_, asked.service)
    return bool(class_)


def _request(asked: Question) -> Any:
    class_, _ = ros.message_class(asked.type)
    if asked.type == GET_PARAMETERS:
        return class_.Request(names=list(asked.parameters))
    if asked.type == LIST_PARAMETERS:
        return class_.Request(prefixes=[], depth=0)
    return class_.Request()


def _with_answer(state: Answer, asked: Question, answer: Any) -> Answer:
    """Return a node's state with the answer to a question."""
    if asked.type == GET_STATE:
        return state._replace(lifecycle=str(answer.current_state.label))
    if asked.type == GET_PARAMETERS:
        texts = zip(asked.parameters, map(_plain_text, answer.values), strict=False)
        said = (Parameter(asked.node, name, text) for name, text in texts if text is not None)
        return state._replace(parameters=tuple(sorted({*state.parameters, *said})))
    if asked.type == LIST_PARAMETERS:
        return state
    own = (
        Controller(asked.node, str(it.name), str(it.state), tuple(map(str, it.claimed_interfaces)))
        for it in answer.controller
    )
    return state._replace(controllers=tuple(own))


def _plain_text(value: Any) -> str | None:
    """Return the value as the records have it; None for a parameter that is not set."""
    field = _FIELDS.get(value.type)
    if field is None:
        return None
    found = getattr(value, field)
    text = parameter_text(list(found) if field.endswith("_array_value") else found)
    return text if len(text) <= LONGEST else None


if __name__ == "__main__":
    sys.exit(run_worker(main))
