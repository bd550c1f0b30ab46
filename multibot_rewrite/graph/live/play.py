"""Playing the nodes of a rehearsal: ``python -m multibot_rewrite.graph.live.play``, a child.

Its order is a list of actors. Once all are on the graph it tells which types stand in for which.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any, NamedTuple

from multibot_rewrite.graph.live import ros
from multibot_rewrite.graph.live.worker import Tell, work
from multibot_rewrite.graph.rehearsal import (
    TF,
    Actor,
    Part,
    action_parts,
    from_order,
    stand_in,
)
from multibot_rewrite.graph.snapshot import LISTENER
from multibot_rewrite.graph.transforms import Edge
from multibot_rewrite.remap.records import ACTION, CALLS, PUBLISHES, SERVES, SUBSCRIBES, TOPIC

# As robot_state_publisher and most sources of odometry have it.
SEND_SECONDS = 0.1
STATIC = "tf_static"
Send = Callable[[], None]


class _Stage(NamedTuple):
    """What the playing of one process shares; ``replaced`` grows."""

    session: ros.Session
    replaced: dict[str, str]


def main(order: str, stop: threading.Event, tell: Tell) -> int:
    """Play until ``stop``; returns the exit code."""
    with ros.opened() as session:
        stage = _Stage(session, {})
        senders = [
            send
            for number, actor in enumerate(from_order(json.loads(order)))
            for send in _enter(stage, actor, number)
        ]
        tell(json.dumps(stage.replaced).encode())
        while not stop.wait(SEND_SECONDS):
            for send in senders:
                send()
    return 0


def _enter(stage: _Stage, actor: Actor, number: int) -> Iterator[Send]:
    """Bring a node up; gives what is to be sent again and again."""
    node = ros.add_node(stage.session, actor.name, arguments=actor.arguments)
    helper: Any = None
    for part in actor.parts:
        if part.helper and helper is None:
            words = [word for word in actor.arguments if not word.startswith("__node:=")]
            helper = ros.add_node(
                stage.session, f"{LISTENER}{os.getpid():x}{number:04x}", arguments=_paired(words)
            )
        yield from _ask(stage, helper if part.helper else node, part, actor.edges)


def _paired(words: Iterable[str]) -> list[str]:
    """Arguments without a ``-r`` that nothing follows any more."""
    kept = list(words)
    return [
        word
        for at, word in enumerate(kept)
        if word != "-r" or (at + 1 < len(kept) and kept[at + 1] != "-r")
    ]


def _ask(stage: _Stage, node: Any, part: Part, edges: Iterable[Edge]) -> Iterator[Send]:
    """Make one endpoint, of a type that stands in where its own is not installed."""
    type_ = _installed(part.type)
    if type_ is None and part.kind == ACTION:
        stage.replaced[part.type] = "its services and topics"
        for piece in action_parts(part):
            yield from _ask(stage, node, piece, ())
        return
    if type_ is None:
        instead = stand_in(part.kind, part.type)
        stage.replaced.update({part.type: instead} if part.type else {})
        type_ = _installed(instead)
    if part.kind == TOPIC and part.role == PUBLISHES:
        yield from _publish(node, type_, part, edges)
    else:
        _MAKERS[part.kind == ACTION, part.role](node, type_, part.name)


@cache
def _installed(word: str) -> Any:
    return ros.type_of(word)[0] if word else None


_MAKERS: dict[tuple[bool, str], Callable[[Any, Any, str], object]] = {
    (False, SUBSCRIBES): ros.listen,
    (False, SERVES): lambda node, type_, name: node.create_service(type_, name, lambda _, it: it),
    (False, CALLS): lambda node, type_, name: node.create_client(type_, name),
    (True, SERVES): ros.serve_action,
    (True, CALLS): ros.call_action,
}


def _publish(node: Any, type_: Any, part: Part, edges: Iterable[Edge]) -> Iterator[Send]:
    static = part.name.rpartition("/")[2] == STATIC
    publisher = ros.publish(node, type_, part.name, static)
    messages = _messages(type_, [it for it in edges if it.static == static])
    if part.type != TF or not messages:
        return
    if static:
        _send(publisher, messages)
    else:
        yield lambda: _send(publisher, messages)


def _send(publisher: Any, messages: Iterable[Any]) -> None:
    for message in messages:
        publisher.publish(message)


def _messages(type_: Any, edges: list[Edge]) -> list[Any]:
    """One message of all transforms, or one each where tf's own type is not installed."""
    transform = _installed("geometry_msgs/msg/TransformStamped")
    made = []
    for edge in edges:
        one = transform(child_frame_id=edge.child)
        one.header.frame_id = edge.parent
        made.append(one)
    if type_ is transform or not made:
        return made
    return [type_(transforms=made)]


if __name__ == "__main__":
    sys.exit(work(main))
