"""Asking nodes for their states: ``python -m multibot_rewrite.graph.live.ask``, a child process.

All services are called at once, and all answers are waited for together, so that the time is bounded
whatever hangs.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Iterable
from typing import Any

from multibot_rewrite.graph.live import ros
from multibot_rewrite.graph.live.worker import Send, run_worker
from multibot_rewrite.graph.states import (
    GET_PARAMETERS,
    GET_STATE,
    SIM_TIME,
    Controller,
    NodeState,
    Question,
    to_message,
)

POLL_SECONDS = 0.05
# rcl's ParameterType for bool.
_BOOL = 1


def main(order: str, stop: threading.Event, send: Send) -> int:
    """Ask as ``order`` says, ``[seconds, questions]``; returns the exit code."""
    seconds, asked = json.loads(order)
    with ros.opened() as session:
        node = ros.add_node(session, f"_multibot_ask_{os.getpid()}")
        found = _ask(session, node, [Question(*it) for it in asked], float(seconds), stop)
    send(to_message(tuple(found.values())))
    return 0


def _ask(
    session: ros.Session,
    node: Any,
    asked: Iterable[Question],
    seconds: float,
    stop: threading.Event,
) -> dict[str, NodeState]:
    end = time.monotonic() + seconds
    waiting = {it: client for it in asked if (client := _client(node, it))}
    sent: dict[Question, Any] = {}
    found: dict[str, NodeState] = {}
    while (waiting or sent) and time.monotonic() < end and not stop.is_set():
        ready = [it for it, client in waiting.items() if client.service_is_ready()]
        for it in ready:
            sent[it] = waiting.pop(it).call_async(_request(it))
        ros.spin(session, POLL_SECONDS)
        for it in [it for it, answer in sent.items() if answer.done()]:
            before = found.get(it.node, NodeState(it.node))
            found[it.node] = _with_answer(before, it, sent.pop(it).result())
    return found


def _client(node: Any, asked: Question) -> Any:
    """A client for the question; None where its type is not installed."""
    class_, _ = ros.message_class(asked.type)
    return node.create_client(class_, asked.service) if class_ else None


def _request(asked: Question) -> Any:
    class_, _ = ros.message_class(asked.type)
    return class_.Request(names=[SIM_TIME]) if asked.type == GET_PARAMETERS else class_.Request()


def _with_answer(state: NodeState, asked: Question, answer: Any) -> NodeState:
    if asked.type == GET_STATE:
        return state._replace(lifecycle=str(answer.current_state.label))
    if asked.type == GET_PARAMETERS:
        known = [bool(it.bool_value) for it in answer.values if it.type == _BOOL]
        return state._replace(sim_time=known[0] if known else None)
    own = (
        Controller(str(it.name), str(it.state), tuple(map(str, it.claimed_interfaces)))
        for it in answer.controller
    )
    return state._replace(controllers=tuple(own))


if __name__ == "__main__":
    sys.exit(run_worker(main))
