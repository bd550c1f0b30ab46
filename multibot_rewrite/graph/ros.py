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

from multibot_rewrite.graph import environment as surroundings
from multibot_rewrite.graph import gather
from multibot_rewrite.graph.request import ENDED, NO_RCLPY, Request, from_text
from multibot_rewrite.graph.snapshot import (
    UNKNOWN_NODE,
    Caveat,
    Environment,
    GraphEndpoint,
    Qos,
    Snapshot,
    to_json,
)
from multibot_rewrite.remap.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.node import Node

# 10 looks a second cost less than a tenth of a core with 100 robots.
POLL_SECONDS = 0.1
# tf comes ten times a second or more; a shared topic of 100 robots took 1.3 s to be heard whole.
TF_SECONDS = (1.5, 3.0)
# rmw's word for no limit: the largest 64 bit number of nanoseconds.
_ENDLESS = 2**63 - 1


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
    except Exception as error:
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
        names = _names(eye.node)
        endpoints = _endpoints(eye.node, names, request)
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
        names = _names(eye.node)
        ends = sorted(_by_node(eye.node, names, _QUESTIONS[:4]))
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


def _names(node: Node) -> list[str]:
    """Full names of all nodes but the looking one, duplicates kept."""
    there = (_full(name, space) for name, space in node.get_node_names_and_namespaces())
    return sorted(name for name in there if name != node.get_fully_qualified_name())


def _full(name: str, namespace: str) -> str:
    if name == UNKNOWN_NODE:
        # Its namespace is a word of that kind, too, without a slash.
        return f"/{name}"
    return f"{namespace.rstrip('/')}/{name}"


def _action_servers(node: Node, name: str, space: str) -> Any:
    from rclpy.action import get_action_server_names_and_types_by_node

    return get_action_server_names_and_types_by_node(node, name, space)


def _action_clients(node: Node, name: str, space: str) -> Any:
    from rclpy.action import get_action_client_names_and_types_by_node

    return get_action_client_names_and_types_by_node(node, name, space)


# The first four are enough to see whether anything changes.
_QUESTIONS: tuple[tuple[str, str, Any], ...] = (
    (TOPIC, PUBLISHES, lambda node, *who: node.get_publisher_names_and_types_by_node(*who)),
    (TOPIC, SUBSCRIBES, lambda node, *who: node.get_subscriber_names_and_types_by_node(*who)),
    (SERVICE, SERVES, lambda node, *who: node.get_service_names_and_types_by_node(*who)),
    (SERVICE, CALLS, lambda node, *who: node.get_client_names_and_types_by_node(*who)),
    (ACTION, SERVES, _action_servers),
    (ACTION, CALLS, _action_clients),
)


def _by_node(
    node: Node, names: Iterable[str], questions: Iterable[tuple[str, str, Any]]
) -> Iterator[GraphEndpoint]:
    """What each node has; of two nodes with one name rcl shows the first."""
    from rclpy.node import NodeNameNonExistentError

    for name in sorted(set(names)):
        space, _, own = name.rpartition("/")
        # It went away between two questions.
        with suppress(NodeNameNonExistentError):
            for kind, role, ask in questions:
                for thing, types in ask(node, own, space or "/"):
                    for type_ in types:
                        yield GraphEndpoint(kind, role, thing, type_, "", name, None, "")


def _endpoints(node: Node, names: list[str], request: Request) -> list[GraphEndpoint]:
    """What all nodes have, with QoS and process where it is worth asking by topic."""
    by_node = list(_by_node(node, names, _QUESTIONS))
    topics = dict(node.get_topic_names_and_types())
    wanted = gather.topics_to_ask(names, by_node, topics, request.topics)
    endpoints = gather.merged(by_node, {topic: _by_topic(node, topic) for topic in wanted})
    known = gather.processes(endpoints)
    homeless = {end.node: end for end in by_node if end.node not in known and end.kind != ACTION}
    return [*endpoints, *_replaced(node, endpoints, homeless)] if homeless else endpoints


def _replaced(
    node: Node, endpoints: list[GraphEndpoint], homeless: Mapping[str, GraphEndpoint]
) -> Iterator[GraphEndpoint]:
    """One endpoint of each node without a known process, again and with its process.

    Takes what it tells anew out of ``endpoints``.
    """
    for name, end in homeless.items():
        told = _by_topic(node, end.name) if end.kind == TOPIC else _by_service(node, end)
        for better in told:
            if better.node == name and better.role == end.role and end in endpoints:
                endpoints.remove(end)
                yield better


def _by_topic(node: Node, topic: str) -> list[GraphEndpoint]:
    own = node.get_fully_qualified_name()
    found = [_told(TOPIC, PUBLISHES, topic, it) for it in node.get_publishers_info_by_topic(topic)]
    found += [
        _told(TOPIC, SUBSCRIBES, topic, it) for it in node.get_subscriptions_info_by_topic(topic)
    ]
    return [end for end in found if end.node != own]


def _by_service(node: Node, end: GraphEndpoint) -> list[GraphEndpoint]:
    """The endpoint behind a service as DDS has it: a server reads requests, a client writes."""
    asking = "publishers" if end.role == CALLS else "subscriptions"
    question = getattr(node, f"get_{asking}_info_by_topic")
    infos = question(f"rq{end.name}Request", no_mangle=True)
    found = (_told(SERVICE, end.role, end.name, info) for info in infos)
    # The type and hash told are those of the request alone.
    return [it._replace(type=end.type, type_hash="") for it in found]


def _told(kind: str, role: str, name: str, info: Any) -> GraphEndpoint:
    hash_ = str(info.topic_type_hash) if info.topic_type_hash.version > 0 else ""
    # The first 12 bytes of a DDS gid are its participant.
    process = bytes(info.endpoint_gid[:12]).hex()
    owner = _full(info.node_name, info.node_namespace)
    qos = _qos(info.qos_profile)
    return GraphEndpoint(kind, role, name, info.topic_type, hash_, owner, qos, process)


def _qos(profile: Any) -> Qos:
    return Qos(
        profile.history.name,
        profile.depth,
        profile.reliability.name,
        profile.durability.name,
        _seconds(profile.deadline),
        _seconds(profile.lifespan),
        profile.liveliness.name,
        _seconds(profile.liveliness_lease_duration),
    )


def _seconds(duration: Any) -> float:
    count = duration.nanoseconds
    return float("inf") if count >= _ENDLESS or count == 0 else count / 1e9


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
    try:
        from rclpy.type_support import check_for_type_support
        from tf2_msgs.msg import TFMessage

        # Half installed, it fails only where it is used.
        check_for_type_support(TFMessage)
    except Exception as error:
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
