# SPDX-License-Identifier: Apache-2.0
"""How far a look reached: which machines were seen, and how to look from others. Pure.

"Not seen from here" is "missing" only where a robot would have been seen.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.wording import plural, shorten
from multibot_rewrite.system.environment import machine
from multibot_rewrite.system.records import ZENOH, System

LOCALHOST = "LOCALHOST"
MERGED = "looks-merged"
# The nodes of each machine.
Machines = Mapping[str, Sequence[str]]


def machines(graph: System) -> Machines:
    """The nodes of each machine, by what Fast DDS calls it; a Zenoh router does not say which."""
    found: dict[str, list[str]] = defaultdict(list)
    for node in graph.nodes if graph.environment.rmw != ZENOH else ():
        if host := machine(node.process):
            found[host].append(node.name)
    return dict(found)


def hidden_from_here(graph: System, seen: Machines) -> bool:
    """Whether a robot on another machine may run unseen: nothing but one machine was ``seen``.

    Then multicast may be lost, or the other machine keeps to itself. Under LOCALHOST without peers
    only this machine was asked for, and a discovery server or a router knows all that use it.
    """
    around = graph.environment
    asked_for_all = around.range not in (LOCALHOST, "OFF") or bool(around.static_peers)
    one_look = not any(it.code == MERGED for it in around.caveats)
    return asked_for_all and one_look and not around.discovery_server and len(seen) == 1


def why_not_seen(graph: System, robot: str, seen: Machines) -> str:
    """What is known of where ``robot`` may be, and what to do, in one sentence."""
    around = graph.environment
    if around.rmw == ZENOH:
        router = around.discovery_server
        return f"is it started, in this domain, and connected to the router at {router}?"
    if around.discovery_server:
        return f"is it started, and does it use the discovery server {around.discovery_server}?"
    if hidden_from_here(graph, seen):
        (names,) = seen.values()
        return (
            f"all that is seen runs on one machine ({shorten(names)}). If {robot} is on another,"
            " multicast may be lost, or it is on range LOCALHOST. Set ROS_STATIC_PEERS to its"
            " address, or take a snapshot there and join them (multibot snapshot --from). If all"
            " robots are to be on this machine set ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"
        )
    started = "is the robot started, and with this ROS_DOMAIN_ID?"
    if around.range == LOCALHOST and not around.static_peers:
        return f"{started} Only this machine is looked at: range LOCALHOST, no ROS_STATIC_PEERS"
    return f"{started} {plural(len(seen), 'machine')} are seen" if len(seen) > 1 else started
