"""The view that the rules check: a snapshot beside its plan."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence, Set

from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules.ownership import NameOwnership, frame_ownership, name_ownership
from multibot_rewrite.rules.pair.similar_names import probable_matches
from multibot_rewrite.rules.pair.tf_copies import without_bridged
from multibot_rewrite.rules.pair.tf_trees import TfTree, tf_trees
from multibot_rewrite.system.records import (
    PUBLISHES,
    TOPIC,
    End,
    Node,
    Robot,
    System,
    may_miss,
    nodes_by_robot,
)

# Node, kind, role and name of an endpoint.
EndpointKey = tuple[str, str, str, str]


class View(NamedTuple):
    """A snapshot beside the plan, with the look-ups that several rules need.

    ``types`` has the type of every endpoint in the graph, ``planned`` all endpoints of the plan,
    ``missing`` those of them that are not in the graph.
    ``unplanned_endpoints`` are by node those in the graph that are not in the plan, without the
    hidden topics and services of actions. ``published_topics`` have a publisher in the graph.
    ``seen`` counts the nodes by name. ``unplanned`` are nodes that are not in the plan and not
    ignored. ``probable_matches`` maps a missing node to the running node that it probably is.
    ``nodes`` has the planned nodes by name, ``own`` the names of those of each robot. ``may_miss`` are
    the planned nodes that need not run: on a condition, or because another one may run instead.
    """

    plan: System
    graph: System
    by_node: dict[str, list[End]]
    by_name: dict[str, list[End]]
    robot_of: dict[str, str]
    ownership: NameOwnership
    frame_ownership: NameOwnership
    types: Mapping[EndpointKey, str]
    planned: Mapping[EndpointKey, End]
    missing: Mapping[EndpointKey, End]
    unplanned_endpoints: Mapping[str, list[End]]
    published_topics: Set[str]
    seen: Mapping[str, int]
    unplanned: tuple[str, ...]
    probable_matches: Mapping[str, str]
    nodes: Mapping[str, Node]
    own: Mapping[str, Sequence[str]]
    trees: tuple[TfTree, ...]
    robots: Mapping[str, Robot]
    frames_of: Mapping[str, frozenset[str]]
    may_miss: frozenset[str]


def make_view(plan: System, graph: System) -> View:
    """Build the look-ups once for all rules."""
    graph = graph._replace(edges=without_bridged(plan, graph.edges))
    planned = {(it.node, it.kind, it.role, it.name): it for it in plan.ends}
    index = _index_endpoints(graph.ends, planned)
    nodes = {it.name: it for it in plan.nodes}
    robot_of = {it.name: it.robot for it in plan.nodes if it.robot}
    seen = Counter(node.name for node in graph.nodes)
    others = [node for node in seen if node not in nodes]
    unplanned = tuple(node for node in others if not is_tool(node, plan.ignored_nodes))
    missing = {node: robot for node, robot in robot_of.items() if node not in seen}
    ownership = name_ownership(plan)
    return View(
        plan=plan,
        graph=graph,
        by_node=index.by_node,
        by_name=index.by_name,
        robot_of=robot_of,
        ownership=ownership,
        frame_ownership=frame_ownership(plan),
        types=index.types,
        planned=planned,
        missing=index.missing,
        unplanned_endpoints=index.unplanned,
        published_topics=index.published,
        seen=seen,
        unplanned=unplanned,
        probable_matches=probable_matches(missing, others, unplanned, ownership),
        nodes=nodes,
        own=nodes_by_robot(plan),
        trees=tf_trees(graph.edges, plan.robots, ownership),
        robots={robot.name: robot for robot in plan.robots},
        frames_of={r.name: frozenset((*r.frames, *r.other_frames)) for r in plan.robots},
        may_miss=frozenset(it.name for it in plan.nodes if may_miss(it)),
    )


class _EndpointIndex(NamedTuple):
    by_node: dict[str, list[End]]
    by_name: dict[str, list[End]]
    unplanned: dict[str, list[End]]
    types: dict[EndpointKey, str]
    published: set[str]
    missing: dict[EndpointKey, End]


def _index_endpoints(
    endpoints: Iterable[End], planned: Mapping[EndpointKey, End]
) -> _EndpointIndex:
    index = _EndpointIndex(
        defaultdict(list), defaultdict(list), defaultdict(list), {}, set(), dict(planned)
    )
    by_node, by_name, unplanned, types, published, missing = index
    for endpoint in endpoints:
        kind, role, name, type_, _, node = endpoint[:6]
        key = (node, kind, role, name)
        by_node[node].append(endpoint)
        by_name[name].append(endpoint)
        if role == PUBLISHES and kind == TOPIC:
            published.add(name)
        met = missing.pop(key, None)
        # A node may subscribe to a topic more than once.
        if met is None and "/_" not in name and key not in planned and key not in types:
            unplanned[node].append(endpoint)
        types[key] = type_
    return index
