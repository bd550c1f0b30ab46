"""Looking at the live graph: the only module that imports rclpy. Runs in a process of its own.

``python -m multibot_rewrite.graph.ros REQUEST`` writes a snapshot as JSON to standard output. It
ends when its standard input is closed, on SIGTERM and on Ctrl-C, and always leaves the graph
cleanly: what is killed stays in everybody's view for 20 s. rcl may end the process by itself,
hence the process (see ``graph.child``).
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from multibot_rewrite.graph import ask, gather
from multibot_rewrite.graph import environment as surroundings
from multibot_rewrite.graph.request import ENDED, NO_RCLPY, Request, from_text
from multibot_rewrite.graph.snapshot import (
    UNKNOWN_NODE,
    Caveat,
    Environment,
    GraphEndpoint,
    Snapshot,
    to_json,
)
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
)

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.node import Node

# 10 looks a second cost less than a tenth of a core with 100 robots.
POLL_SECONDS = 0.1
# tf comes ten times a second or more; a shared topic of 100 robots took 1.3 s to be heard whole.
TF_SECONDS = (1.5, 3.0)


class _Eye(NamedTuple):
    """An open view of the graph; ``stop`` is set when somebody wants the looking to end."""

    node: Node
    context: Context
    stop: threading.Event
    started: float


def main(arguments: Sequence[str]) -> int:
    """Look as the request in ``arguments`` says; returns the exit code."""
    result = _own_standard_output()
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    threading.Thread(target=_wait_for_end, args=(stop,), daemon=True).start()
    try:
        import rclpy  # noqa: F401
    except (ImportError, OSError) as error:  # OSError: a shared library that does not load
        sys.stderr.write(f"{type(error).__name__}: {error}\n")
        return NO_RCLPY
    snapshot = look(from_text(arguments[0]), stop)
    if snapshot is None:
        return ENDED
    with os.fdopen(result, "wb") as file:
        file.write(to_json(snapshot))
    return 0


def _own_standard_output() -> int:
    """A descriptor nobody else writes to; what libraries print goes to standard error."""
    result = os.dup(1)
    os.dup2(2, 1)
    return result


def _wait_for_end(stop: threading.Event) -> None:
    # Unbuffered, because a thread inside sys.stdin would block the interpreter's end.
    with suppress(OSError):
        while os.read(0, 4096):
            pass
    stop.set()


def look(request: Request, stop: threading.Event) -> Snapshot | None:
    """A snapshot, once the graph is settled; None where ``stop`` was set first."""
    with _opened(stop) as eye:
        why = _settle(eye, request)
        seconds = time.monotonic() - eye.started
        names, endpoints = _taken(eye, request)
        if stop.is_set():
            return None
        heard, caveats = _listen(eye, endpoints)
        groups = gather.processes(endpoints)
        nodes = gather.placed_nodes(names, groups)
        placed = tuple(gather.placed_endpoints(endpoints, groups))
        asked = surroundings.settings(os.environ)
        told = surroundings.view_caveats(nodes, placed, asked, why, request.expected)
        caveats = [*surroundings.setting_caveats(os.environ), *told, *caveats]
        around = _environment(eye, asked, placed, why, seconds, caveats)
        return Snapshot(tuple(nodes), placed, tuple(gather.frames(heard, placed)), around)


def _taken(eye: _Eye, request: Request) -> tuple[list[str], list[GraphEndpoint]]:
    """Names and endpoints, again for a while where they have not found one another."""
    limit = min(request.timeout, time.monotonic() - eye.started + gather.QUIET_SECONDS)
    while True:
        names = ask.names_in(eye.node)
        found = list(ask.by_node(eye.node, names, (*ask.QUESTIONS, *_ACTIONS), _gone()))
        endpoints = ask.endpoints_of(eye.node, names, found, request.topics)
        owners = {end.node for end in endpoints}
        whole = owners.issuperset(names) and f"/{UNKNOWN_NODE}" not in owners
        if whole or time.monotonic() - eye.started >= limit or eye.stop.wait(POLL_SECONDS):
            return names, endpoints


@contextmanager
def _opened(stop: threading.Event) -> Iterator[_Eye]:
    """A hidden node in a context of its own that no command line and no rule reaches."""
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.signals import SignalHandlerOptions

    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = Node(
            f"_multibot_snapshot_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            start_parameter_services=False,
            enable_rosout=False,
        )
        try:
            yield _Eye(node, context, stop, time.monotonic())
        finally:
            node.destroy_node()
    finally:
        context.try_shutdown()


def _settle(eye: _Eye, request: Request) -> str:
    """Wait until the graph is settled; why it is, empty where the looking was stopped."""
    before: object = None
    expected_before: object = None
    changed = gather.Changes(0.0, 0.0)
    while not eye.stop.wait(POLL_SECONDS):
        names = ask.names_in(eye.node)
        ends = sorted(ask.by_node(eye.node, names, ask.QUESTIONS, _gone()))
        expected = [end for end in ends if end.node in request.expected]
        now = time.monotonic() - eye.started
        if (names, ends) != before:
            before, changed = (names, ends), changed._replace(all=now)
        if expected != expected_before:
            expected_before, changed = expected, changed._replace(expected=now)
        seen = {end.node for end in ends}
        why = gather.settled(now, changed, seen, request.expected, request.timeout)
        if why:
            return why
    return ""


def _action_servers(node: Node, name: str, space: str) -> Any:
    from rclpy.action import get_action_server_names_and_types_by_node

    return get_action_server_names_and_types_by_node(node, name, space)


def _action_clients(node: Node, name: str, space: str) -> Any:
    from rclpy.action import get_action_client_names_and_types_by_node

    return get_action_client_names_and_types_by_node(node, name, space)


_ACTIONS: tuple[ask.Question, ...] = (
    (ACTION, SERVES, _action_servers),
    (ACTION, CALLS, _action_clients),
)


def _gone() -> type[Exception]:
    from rclpy.node import NodeNameNonExistentError

    gone: type[Exception] = NodeNameNonExistentError
    return gone


def _listen(
    eye: _Eye, endpoints: Iterable[GraphEndpoint]
) -> tuple[list[gather.Heard], list[Caveat]]:
    """The transforms that are sent now, on every topic of transforms there is."""
    topics = {
        (end.name, end.qos.durability == "TRANSIENT_LOCAL")
        for end in endpoints
        if end.type == gather.TF_TYPE and end.role == PUBLISHES and end.qos
    }
    if not topics:
        return [], []
    message_type, reason = _tf_type()
    if message_type is None:
        names = surroundings.listed(sorted({name for name, _ in topics}))
        text = f"the frames on {names} were not read: {reason}; install tf2_msgs or source ROS 2"
        return [], [Caveat("frames-not-read", False, text)]
    heard: dict[tuple[str, bool], set[gather.Heard]] = {topic: set() for topic in topics}
    with _subscribed(eye, heard, message_type) as spin_once:
        began = time.monotonic()
        while not eye.stop.is_set():
            spin_once()
            passed = time.monotonic() - began
            if passed > TF_SECONDS[1] or (passed > TF_SECONDS[0] and all(heard.values())):
                break
    return [it for edges in heard.values() for it in edges], []


def _tf_type() -> tuple[Any, str]:
    """The message type of tf, or None and why it cannot be had."""
    from rclpy.exceptions import NoTypeSupportImportedException
    from rclpy.type_support import check_for_type_support
    from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

    broken = (ImportError, AttributeError, NoTypeSupportImportedException, UnsupportedTypeSupport)
    try:
        from tf2_msgs.msg import TFMessage

        # Half installed, it fails only where it is used.
        check_for_type_support(TFMessage)
    except broken as error:
        return None, str(error)
    return TFMessage, ""


@contextmanager
def _subscribed(
    eye: _Eye, heard: Mapping[tuple[str, bool], set[gather.Heard]], message_type: Any
) -> Iterator[Any]:
    """Subscriptions that fill ``heard``; gives a function that handles what has come."""
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    for (topic, latched), edges in heard.items():
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        # Best effort reads from reliable senders too, but latched samples come to reliable readers.
        reliability = ReliabilityPolicy.RELIABLE if latched else ReliabilityPolicy.BEST_EFFORT
        qos = QoSProfile(depth=100, durability=durability, reliability=reliability)
        eye.node.create_subscription(message_type, topic, _collector(topic, latched, edges), qos)
    executor = SingleThreadedExecutor(context=eye.context)
    executor.add_node(eye.node)
    try:
        yield lambda: executor.spin_once(timeout_sec=POLL_SECONDS)
    finally:
        executor.shutdown()


def _collector(topic: str, latched: bool, edges: set[gather.Heard]) -> Any:
    def collect(message: Any) -> None:
        for transform in message.transforms:
            parent, child = transform.header.frame_id, transform.child_frame_id
            edges.add(gather.Heard(topic, latched, parent, child))

    return collect


def _environment(
    eye: _Eye,
    asked: surroundings.Settings,
    endpoints: Iterable[GraphEndpoint],
    why: str,
    seconds: float,
    caveats: Iterable[Caveat],
) -> Environment:
    from rclpy.utilities import get_rmw_implementation_identifier

    return Environment(
        eye.context.get_domain_id(),
        asked.range,
        asked.static_peers,
        get_rmw_implementation_identifier(),
        asked.discovery_server,
        asked.super_client,
        surroundings.participants(endpoints),
        why,
        round(seconds, 2),
        tuple(caveats),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
