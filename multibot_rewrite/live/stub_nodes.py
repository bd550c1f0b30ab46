# SPDX-License-Identifier: Apache-2.0
"""The stub nodes of a rehearsal: ``python -m multibot_rewrite.live.stub_nodes``, a child.

Its order is a list of stub nodes. Once all are in the graph it sends which types replace others, the
ends that the nodes have, and the frames that they send.
"""

import json
import os
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any, NamedTuple

from multibot_rewrite.base.conventions import CLIENT, LISTENER
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.live.rehearsal import TF, Stub, action_parts, from_order, substitute_type
from multibot_rewrite.planning.of_runs import sibling
from multibot_rewrite.planning.ways import ros_arguments
from multibot_rewrite.producers.ros import ros
from multibot_rewrite.producers.ros.look import own_ends
from multibot_rewrite.producers.ros.request import Send, run_worker
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    Edge,
)

# The rate of robot_state_publisher and of most odometry sources.
PUBLISH_SECONDS = 0.1
STATIC = "tf_static"
Publish = Callable[[], None]


class _Stubs(NamedTuple):
    """What the stub nodes of one process share; ``replaced`` and ``frames`` grow."""

    session: ros.Session
    replaced: dict[str, str]
    frames: set[str]


def main(order: str, stop: threading.Event, send: Send) -> int:
    """Run the stub nodes until ``stop``; returns the exit code."""
    with ros.opened() as session:
        stubs = _Stubs(session, {}, set())
        publishers = [
            publish
            for number, stub in enumerate(from_order(json.loads(order)))
            for publish in _create_node(stubs, stub, number)
        ]
        send(json.dumps((stubs.replaced, own_ends(session), sorted(stubs.frames))).encode())
        while not stop.wait(PUBLISH_SECONDS):
            for publish in publishers:
                publish()
    return 0


def _create_node(stubs: _Stubs, stub: Stub, number: int) -> Iterator[Publish]:
    """Create a node with its endpoints; yields what has to be published again and again."""
    run, edges = stub
    node = ros.add_node(stubs.session, run.code_name, arguments=run.arguments)
    helpers: dict[str, Any] = {}
    for endpoint, _ in run.names:
        # As tf2's listener, or behind its node's name.
        usual = f"{LISTENER}*" if endpoint.name.strip("/") in TF_TOPICS else CLIENT
        called = (endpoint.by or usual) if endpoint.helper else ""
        if called and called not in helpers:
            made = called.replace("*", f"{os.getpid():x}{number:04x}")
            name = made if called.startswith(LISTENER) else node.get_name() + made
            arguments = ros_arguments(run.process_namespace or "/", "", run.process_rules)
            helpers[called] = ros.add_node(stubs.session, name, arguments=arguments)
        name = endpoint.name
        if endpoint.by and name.startswith("~/"):
            # Below the name of the node that makes the helper, as moveit_servo does
            # (src/utils/common.cpp:510): with ~ it would be below the helper's own.
            name = node.get_fully_qualified_name() + name[1:]
        if endpoint.beside:
            name = sibling(node.resolve_topic_name(endpoint.beside), name)
        own = endpoint._replace(name=name)
        yield from _create_endpoint(stubs, helpers.get(called, node), own, edges)


def _create_endpoint(
    stubs: _Stubs, node: Any, endpoint: Endpoint, edges: Iterable[Edge]
) -> Iterator[Publish]:
    """Create one endpoint, with a substitute where its type is not installed."""
    type_ = _installed_class(endpoint.type)
    if type_ is None:
        substitute = substitute_type(endpoint.kind, endpoint.type)
        stubs.replaced.update({endpoint.type: substitute} if endpoint.type else {})
        if endpoint.kind == ACTION:
            for part in action_parts(endpoint):
                yield from _create_endpoint(stubs, node, part, ())
            return
        type_ = _installed_class(substitute)
    if endpoint.kind == TOPIC and endpoint.role == PUBLISHES:
        yield from _create_publisher(stubs, node, type_, endpoint, edges)
    else:
        _CREATORS[endpoint.kind == ACTION, endpoint.role](node, type_, endpoint.name)


@cache
def _installed_class(type_: str) -> Any:
    """Return the class of a message type; None if it is not installed."""
    return ros.message_class(type_)[0] if type_ else None


_CREATORS: dict[tuple[bool, str], Callable[[Any, Any, str], object]] = {
    (False, SUBSCRIBES): ros.subscribe_and_drop,
    (False, SERVES): lambda node, type_, name: node.create_service(type_, name, lambda _, it: it),
    (False, CALLS): lambda node, type_, name: node.create_client(type_, name),
    (True, SERVES): ros.serve_action,
    (True, CALLS): ros.call_action,
}


def _create_publisher(
    stubs: _Stubs, node: Any, type_: Any, endpoint: Endpoint, edges: Iterable[Edge]
) -> Iterator[Publish]:
    """Create a publisher; yields what has to be published again and again."""
    static = endpoint.name.rpartition("/")[2] == STATIC
    publisher = ros.publish(node, type_, endpoint.name, static)
    own = [edge for edge in edges if edge.static == static]
    # One message with all transforms, or one for each where tf's own type is not installed.
    transform = _installed_class("geometry_msgs/msg/TransformStamped")
    made = []
    for edge in own:
        one = transform(child_frame_id=edge.child)
        one.header.frame_id = edge.parent
        made.append(one)
    messages = made if type_ is transform or not made else [type_(transforms=made)]
    if endpoint.type != TF or not messages:
        return
    stubs.frames.update(edge.child for edge in own)
    if static:
        _publish(publisher, messages)
    else:
        yield lambda: _publish(publisher, messages)


def _publish(publisher: Any, messages: Iterable[Any]) -> None:
    """Publish transforms with the time of now."""
    for message in messages:
        for it in getattr(message, "transforms", (message,)):
            stamp = it.header.stamp
            stamp.sec, stamp.nanosec = divmod(time.time_ns(), 10**9)
        publisher.publish(message)


if __name__ == "__main__":
    sys.exit(run_worker(main))
