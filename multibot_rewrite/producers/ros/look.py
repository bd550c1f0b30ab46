# SPDX-License-Identifier: Apache-2.0
"""A node in the graph, and what it can ask at once: the nodes with their ends."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.producers.ros import assemble, queries, ros
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.system.records import ACTION, CALLS, SERVES, UNKNOWN_NODE, End

# The shortest pause between two polls.
POLL_SECONDS = 0.1
# What a look may take beyond its timeout, for the last queries.
GRACE_SECONDS = 1.0


class GraphSession(NamedTuple):
    """A node that observes the graph; ``stop`` is set when the observation has to end, ``tell`` gets
    what is seen so far: a text, or a snapshot. ``lost``: the datagrams for its domain that this machine
    had lost before."""

    ros: ros.Session
    node: Any
    request: Request
    stop: threading.Event
    started: float
    tell: Callable[[bytes], None]
    lost: int

    def now(self) -> float:
        """Seconds since the observation began."""
        return time.monotonic() - self.started

    def domain(self) -> int:
        """The ROS_DOMAIN_ID that is observed."""
        return int(self.ros.context.get_domain_id())

    def over(self) -> bool:
        """Whether it has to end, also in the midst of queries."""
        return self.stop.is_set() or self.now() >= self.request.timeout + GRACE_SECONDS


def receive(session: GraphSession, seconds: float) -> None:
    """Receive messages for so long, or until the observation has to end."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        session.stop.wait(min(left, POLL_SECONDS))
        ros.receive(session.node)
        if session.stop.is_set():
            return


def overview(session: GraphSession) -> tuple[list[str], list[End]]:
    """The nodes and their endpoints: enough to see whether anything changed."""
    names = queries.node_names(session.node)
    found = queries.endpoints_by_node(
        session.node, names, queries.NODE_QUERIES, ros.node_gone_error()
    )
    return names, sorted(found)


def complete_view(session: GraphSession, cache: queries.TopicCache) -> tuple[list[str], list[End]]:
    """Names and endpoints; repeated for a while if nodes have no endpoints or no name yet."""
    limit = min(session.request.timeout, session.now() + assemble.QUIET_SECONDS)
    while True:
        names, endpoints = view(session, cache)
        owners = {end.node for end in endpoints}
        complete = owners.issuperset(names) and f"/{UNKNOWN_NODE}" not in owners
        if complete or session.now() >= limit or session.stop.wait(POLL_SECONDS):
            return names, endpoints


def own_ends(session: ros.Session) -> list[tuple[str, str, str]]:
    """Node, role and name of each end that the nodes of this process have, as a look gives them."""
    nodes = list(session.executor.get_nodes())
    names = [it.get_fully_qualified_name() for it in nodes]
    found = [
        end
        for node in nodes[:1]
        for end in queries.endpoints_by_node(node, names, _ALL_QUERIES, ros.node_gone_error())
    ]
    return sorted({(it.node, it.role, it.name) for it in found})


def view(session: GraphSession, cache: queries.TopicCache) -> tuple[list[str], list[End]]:
    """Names and endpoints, with QoS and process for the topics that are worth a query."""
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
