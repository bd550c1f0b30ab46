# SPDX-License-Identifier: Apache-2.0
"""Which nodes of a graph are asked for what of their state. Pure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.records import SERVES, SERVICE, System

GET_STATE = "lifecycle_msgs/srv/GetState"
GET_PARAMETERS = "rcl_interfaces/srv/GetParameters"
LIST_CONTROLLERS = "controller_manager_msgs/srv/ListControllers"
LIST_PARAMETERS = "rcl_interfaces/srv/ListParameters"
ASKED = (GET_STATE, GET_PARAMETERS, LIST_PARAMETERS, LIST_CONTROLLERS)
SIM_TIME = "use_sim_time"
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
    """Whom to ask for what; of two nodes with one name, one would answer for the other.

    ``parameters`` are those that are wanted of a node besides ``use_sim_time``, whatever it lists.
    """
    times = Counter(node.name for node in graph.nodes)
    for end in graph.ends:
        known = (end.kind, end.role) == (SERVICE, SERVES) and end.type in ASKED
        if known and end.name.startswith(f"{end.node}/") and times[end.node] == 1:
            wanted = {SIM_TIME, *parameters.get(end.node, ())} if end.type == GET_PARAMETERS else ()
            yield Question(end.node, end.name, end.type, tuple(sorted(wanted)))
