# SPDX-License-Identifier: Apache-2.0
"""A node in the graph: the nodes and ends that it asks for, and the tf and headers it receives."""

import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any, NamedTuple

from multibot_rewrite.producers.ros import assemble, queries, ros
from multibot_rewrite.producers.ros.headers import (
    CLOCK_TYPE,
    DescriptionSamples,
    HeaderSamples,
    Receive,
)
from multibot_rewrite.producers.ros.participants import make_room
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.ros.tf_subscriptions import Callback, Mark, TfSubscriptions
from multibot_rewrite.producers.zenoh.cdr import read_tf, read_transform
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    SERVES,
    UNKNOWN_NODE,
    Description,
    End,
    Heard,
)

# The shortest pause between two polls.
POLL_SECONDS = 0.1
# What a look may take beyond its timeout, for the last queries.
GRACE_SECONDS = 1.0
# What two participants see differs for a fraction of this where no packet is lost.
LOSSY_AFTER_SECONDS = 1.0


class GraphSession(NamedTuple):
    """A node that observes the graph, until ``stop`` is set.

    ``tell`` gets what is seen so far, a text or a snapshot; ``lost`` datagrams were lost before."""

    ros: ros.Session
    node: Any
    request: Request
    stop: threading.Event
    started: float
    tell: Callable[[bytes], None]
    lost: int

    def now(self) -> float:
        """Return seconds since the observation began."""
        return time.monotonic() - self.started

    def domain(self) -> int:
        """Return the ROS_DOMAIN_ID that is observed."""
        return int(self.ros.context.get_domain_id())

    def over(self) -> bool:
        """Return whether the observation has to end, also in the midst of queries."""
        return self.stop.is_set() or self.now() >= self.request.timeout + GRACE_SECONDS


class SecondParticipant:
    """Another participant of this process, which loses other packets where a network loses some.

    It joins when another machine is seen first, and is in the graph until ``stack`` is closed.
    ``lossy``: the two have differed for longer than packets take that arrive."""

    def __init__(self, session: GraphSession, stack: ExitStack) -> None:
        self._session, self._stack = session, stack
        self._second: GraphSession | None = None
        self._agreed, self.lossy = 0.0, False

    def missed(self, seen: tuple[list[str], list[End]]) -> tuple[str, ...]:
        """Return the nodes that have not the same ends for both, as the first one has ``seen`` them."""
        self._second = self._second or self._joined()
        if not self._second:
            return ()
        (names, ends), (other_names, other_ends) = seen, overview(self._second)
        nodes = {*names} ^ {*other_names}
        missed = tuple(sorted(nodes | {it.node for it in {*ends} ^ {*other_ends}}))
        if not missed:
            self._agreed = self._session.now()
        self.lossy |= self._session.now() - self._agreed > LOSSY_AFTER_SECONDS
        return missed

    def _joined(self) -> GraphSession | None:
        """Return the second participant's session, open once another machine is seen; None before."""
        node = self._session.node
        found = queries.participants(node)
        if len(queries.on_this_machine(node, found)) == len(found):
            return None
        opened = self._stack.enter_context(ros.opened())
        self._agreed = self._session.now()
        # Under the same name, which is left out of what is seen.
        second = ros.add_node(opened, node.get_name())
        make_room()
        return self._session._replace(ros=opened, node=second)


def receive(session: GraphSession, seconds: float) -> None:
    """Receive messages for so long, or until the observation has to end."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        session.stop.wait(min(left, POLL_SECONDS))
        ros.receive(session.node)
        if session.stop.is_set():
            return


def overview(session: GraphSession) -> tuple[list[str], list[End]]:
    """Return the nodes and their endpoints: enough to see whether anything changed."""
    names = queries.node_names(session.node)
    found = queries.endpoints_by_node(
        session.node, names, queries.NODE_QUERIES, ros.node_gone_error()
    )
    return names, sorted(found)


def complete_view(session: GraphSession, cache: queries.TopicCache) -> tuple[list[str], list[End]]:
    """Return names and endpoints, read again for a while if nodes lack endpoints, or a name."""
    limit = min(session.request.timeout, session.now() + assemble.QUIET_SECONDS)
    while True:
        names, endpoints = view(session, cache)
        owners = {end.node for end in endpoints}
        named = owners.issuperset(names) and f"/{UNKNOWN_NODE}" not in owners
        complete = named and not queries.without_nodes(session.node, endpoints)
        if complete or session.now() >= limit or session.stop.wait(POLL_SECONDS):
            return names, endpoints


def own_ends(session: ros.Session) -> list[tuple[str, str, str]]:
    """Return node, role and name of each end of this process's nodes, as a snapshot has them."""
    nodes = list(session.executor.get_nodes())
    names = [it.get_fully_qualified_name() for it in nodes]
    found = [
        end
        for node in nodes[:1]
        for end in queries.endpoints_by_node(node, names, _ALL_QUERIES, ros.node_gone_error())
    ]
    return sorted({(it.node, it.role, it.name) for it in found})


def view(session: GraphSession, cache: queries.TopicCache) -> tuple[list[str], list[End]]:
    """Return names and endpoints, with QoS and process for the topics that are worth a query."""
    node = session.node
    names = queries.node_names(node)
    found = list(queries.endpoints_by_node(node, names, _ALL_QUERIES, ros.node_gone_error()))
    details = queries.TopicQueries(session.request.expected, cache, session.over)
    return names, queries.with_topic_details(node, names, found, details)


_ALL_QUERIES: tuple[queries.NodeQuery, ...] = (
    *queries.NODE_QUERIES,
    (ACTION, SERVES, ros.action_servers),
    (ACTION, CALLS, ros.action_clients),
)


# tf has 10 Hz or more; a shared topic of 100 robots took 1.3 s to be received completely.
TF_SECONDS = (1.5, 3.0)
# Sensors have 5 Hz or more; what is sent once a minute is not waited for.
HEADER_SECONDS = 1.5


class GraphListeners:
    """What is received while the graph is observed: transforms, headers, descriptions."""

    def __init__(self, session: GraphSession) -> None:
        self._session, self._request = session, session.request
        self.tf = TfSubscriptions(partial(_subscribe, session))
        self.headers, self.descriptions = self._samples()
        self.began = 0.0

    def _samples(self) -> tuple[HeaderSamples, DescriptionSamples]:
        by_header = partial(_subscribe_to_headers, self._session)
        return HeaderSamples(by_header), DescriptionSamples(
            partial(_subscribe_to_last, self._session)
        )

    def listen_again(self, endpoints: Sequence[End]) -> None:
        """Ask for headers and descriptions anew: what sent them may be silent, or another one."""
        for end in (*self.headers.open.values(), *self.descriptions.open.values()):
            end()
        self.headers, self.descriptions = self._samples()
        self.began = self._session.now()
        self.update(endpoints)

    def heard(self) -> tuple[tuple[Heard, ...], tuple[Description, ...]]:
        """Return the headers and descriptions that have come."""
        return self.headers.heard(), self.descriptions.found()

    def update(self, endpoints: Sequence[End]) -> None:
        """Subscribe to the topics that are published now."""
        self.tf.update(endpoints, self._request.substitutes)
        if not self._request.substitutes:
            self.headers.update(endpoints)
            self.descriptions.update(endpoints)

    def silent(self) -> list[str]:
        """Return the topics on which nothing has come."""
        return sorted({*self.tf.silent(), *self.headers.silent()})

    def keep_waiting(self) -> bool:
        """Return whether messages may still come on a topic."""
        return self.tf.keep_waiting(*TF_SECONDS) or self.headers.keep_waiting(HEADER_SECONDS)


def _subscribe(
    session: GraphSession, topic: str, type_: str, latched: bool, callback: Callback
) -> Callable[[], None] | str:
    """Subscribe to a tf topic; return what ends the subscription, or why its type is not usable."""
    class_, reason = ros.raw_message_class(type_)
    if not class_:
        return f"{reason}; install tf2_msgs or source ROS 2"
    read = read_tf if type_ == assemble.TF_TYPES[0] else read_transform

    def received(data: bytes, mark: Mark) -> None:
        message = read(data)
        if message:
            callback(message, mark)

    end = ros.subscribe(session.node, class_, topic, latched, received)
    return end or "they have two types, and the other is read already"


def _subscribe_to_headers(
    session: GraphSession, topic: str, type_: str, latched: bool, callback: Receive
) -> Callable[[], None] | None:
    """Subscribe to the last message only, since there may be large images; None without a header."""
    if type_ != CLOCK_TYPE and not ros.begins_with_header(type_):
        return None
    return _subscribe_to_last(session, topic, type_, latched, callback)


def _subscribe_to_last(
    session: GraphSession, topic: str, type_: str, latched: bool, callback: Receive
) -> Callable[[], None] | None:
    class_, _ = ros.raw_message_class(type_)
    # Of the clock all are wanted: it may go back at any.
    depth = 0 if type_ == CLOCK_TYPE else 1
    return class_ and ros.subscribe(session.node, class_, topic, latched, callback, depth=depth)
