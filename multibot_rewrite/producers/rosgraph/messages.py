# SPDX-License-Identifier: Apache-2.0
"""The messages of rosgraph_msgs that describe a graph, and what their numbers mean.

They are those of ros2/rcl_interfaces, rosgraph_msgs/msg: since 1.2.3 in Humble, 2.3.2 in Kilted and
2.4.4 in Rolling. A graph is a list of nodes with their endpoints, without transforms and processes.
"""

from __future__ import annotations

from multibot_rewrite.base.record import NamedTuple

# The numbers of QoSProfile.msg, and of rmw types.h, are places in these lists.
HISTORY = ("SYSTEM_DEFAULT", "KEEP_LAST", "KEEP_ALL", "UNKNOWN")
RELIABILITY = ("SYSTEM_DEFAULT", "RELIABLE", "BEST_EFFORT", "UNKNOWN", "BEST_AVAILABLE")
DURABILITY = ("SYSTEM_DEFAULT", "TRANSIENT_LOCAL", "VOLATILE", "UNKNOWN", "BEST_AVAILABLE")
LIVELINESS = (
    *("SYSTEM_DEFAULT", "AUTOMATIC", "MANUAL_BY_NODE"),
    *("MANUAL_BY_TOPIC", "UNKNOWN", "BEST_AVAILABLE"),
)
UNKNOWN = "UNKNOWN"
SEND_GOAL = "_SendGoal"


class Hash(NamedTuple):
    """TypeHash.msg."""

    version: int
    value: tuple[int, ...]


class InterfaceType(NamedTuple):
    """InterfaceType.msg."""

    name: str
    hash: Hash


class Duration(NamedTuple):
    """builtin_interfaces/Duration."""

    sec: int
    nanosec: int


class QosProfile(NamedTuple):
    """QoSProfile.msg."""

    depth: int
    deadline: Duration
    lifespan: Duration
    history: int
    reliability: int
    durability: int
    liveliness: int
    liveliness_lease_duration: Duration


class Topic(NamedTuple):
    """Topic.msg."""

    name: str
    type: InterfaceType
    qos: QosProfile


class Service(NamedTuple):
    """Service.msg."""

    name: str
    request_type: InterfaceType
    request_qos: QosProfile
    response_type: InterfaceType
    response_qos: QosProfile


class Action(NamedTuple):
    """Action.msg."""

    name: str
    send_goal: Service
    get_result: Service
    cancel_goal: Service
    feedback: Topic
    status: Topic


class Node(NamedTuple):
    """Node.msg without its parameters."""

    name: str
    publishers: tuple[Topic, ...]
    subscriptions: tuple[Topic, ...]
    service_clients: tuple[Service, ...]
    service_servers: tuple[Service, ...]
    action_clients: tuple[Action, ...]
    action_servers: tuple[Action, ...]


class Graph(NamedTuple):
    """Graph.msg."""

    nodes: tuple[Node, ...]
