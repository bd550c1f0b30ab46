# SPDX-License-Identifier: Apache-2.0
"""One view of nodes in several domains, taken apart: all that a node has is in its domain."""

from __future__ import annotations

from multibot_rewrite.system.domains import seen_by_domain
from multibot_rewrite.system.records import (
    PUBLISHES,
    TOPIC,
    Domain,
    End,
    Node,
    Parameter,
    Robot,
    System,
)

NODES = (Node("/a/n", robot="a"), Node("/b/n", robot="b"))
PLAN = System(NODES, robots=(Robot("a"), Robot("b")), domains=(Domain("a", 11), Domain("b", 12)))


def test_what_a_node_has_is_in_its_domain() -> None:
    more = Node("/b/more")
    nodes = (*NODES, more, Node("/tool"))
    ends = tuple(End(TOPIC, PUBLISHES, f"{it.name}/x", "a/msg/A", node=it.name) for it in nodes)
    parameters = tuple(Parameter(it.name, "use_sim_time", "true") for it in nodes)
    seen = seen_by_domain(PLAN, System(nodes, ends, parameters=parameters))
    own = {11: ["/a/n", "/tool"], 12: ["/b/n", "/b/more"]}
    assert {at: [it.name for it in view.nodes] for at, view in seen.items()} == own
    assert {at: [it.node for it in view.ends] for at, view in seen.items()} == own
    assert {at: [it.node for it in view.parameters] for at, view in seen.items()} == own
