"""The fleet with the nodes that publish start poses: they are planned like any other node."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.robot_groups import said_once
from multibot_rewrite.fleet.robots.start_poses import NODE, start_poses
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.spelling.bridged_topics import TF_TYPE
from multibot_rewrite.spelling.records import EndpointName, NodeTable
from multibot_rewrite.spelling.table import joined, names_of, node_table
from multibot_rewrite.spelling.transforms import Edge
from multibot_rewrite.system.records import PUBLISHES, TOPIC

STATIC = "/tf_static"
POSE_NODE = NodeFacts(NODE, "tf2_ros", (Endpoint(TOPIC, PUBLISHES, STATIC, TF_TYPE),))


def with_start_pose_nodes(plan: FleetPlan) -> Fleet:
    """The planned fleet with a static transform publisher for each robot that needs one; why a pose
    is not published is among the problems of its table."""
    poses = [start_poses(one) for one in split_per_robot(plan)]
    held = [it for one in poses for it in one.transforms]
    problems = tuple(said_once(plan, (it for one in poses for it in one.findings)))
    table = plan.fleet.table
    fleet = plan.fleet._replace(table=table._replace(problems=(*table.problems, *problems)))
    if not held:
        return fleet
    tables = [node_table(it.robot, POSE_NODE, fleet.naming) for it in held]
    names = tuple(names_of([(POSE_NODE, table) for table in tables]))
    edges = {(it.robot, NODE): [Edge(it.parent, it.child, True)] for it in held}
    more = fleet.table._replace(nodes=tuple(tables), names=names, problems=())
    return fleet._replace(
        table=joined(fleet.table, more, fleet.naming), edges={**fleet.edges, **edges}
    )


def split_per_robot(plan: FleetPlan) -> Iterator[FleetPlan]:
    """Each robot as a fleet of its own, so that steps about one robot need not search all others."""
    fleet = plan.fleet
    nodes: dict[str, list[NodeTable]] = defaultdict(list)
    names: dict[str, list[EndpointName]] = defaultdict(list)
    for node in fleet.table.nodes:
        nodes[node.robot].append(node)
    for name in fleet.table.names:
        names[name.robot].append(name)
    edges: dict[str, dict[tuple[str, str], Sequence[Edge]]] = defaultdict(dict)
    for key, sent in fleet.edges.items():
        edges[key[0]][key] = sent
    for robot in plan.robots:
        own = robot.spec.namespace
        table = fleet.table._replace(nodes=tuple(nodes[own]), names=tuple(names[own]), problems=())
        yield plan._replace(robots=(robot,), fleet=fleet._replace(table=table, edges=edges[own]))
