"""The fleet with the nodes that hold its robots where they start: they are planned like any other."""

from __future__ import annotations

from multibot_rewrite.fleet import Fleet
from multibot_rewrite.fleets.plan import FleetPlan
from multibot_rewrite.fleets.transforms import NODE, StaticTransform, place
from multibot_rewrite.graph.transforms import Edge
from multibot_rewrite.remap.bridge import TF_TYPE
from multibot_rewrite.remap.records import PUBLISHES, TOPIC, Endpoint, NodeFacts, Table
from multibot_rewrite.remap.table import joined, names_of, node_table

STATIC = "/tf_static"
HOLDER = NodeFacts(NODE, "tf2_ros", (Endpoint(TOPIC, PUBLISHES, STATIC, TF_TYPE),))


def started(plan: FleetPlan) -> Fleet:
    """The planned fleet, and a publisher of a static transform for each robot that needs one."""
    fleet = plan.fleet
    for it in place(plan).transforms:
        edge = Edge(it.parent, it.child, True)
        table = joined(fleet.table, _table(fleet, it), fleet.naming)
        edges = {**fleet.edges, (it.robot, NODE): [edge]}
        fleet = fleet._replace(table=table, edges=edges)
    return fleet


def _table(fleet: Fleet, it: StaticTransform) -> Table:
    node = node_table(it.robot, HOLDER, fleet.naming)
    return Table(fleet.table.layout, (node,), tuple(names_of([(HOLDER, node)])), ())
