"""A group with less in it: without what every node has, and with small things merged."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from multibot_rewrite.pages.scene import DrawnEdge, DrawnGroup, DrawnName
from multibot_rewrite.pages.states import FAULTY, MISSING, OK
from multibot_rewrite.system.records import SERVES

# So many services of a node without a client are drawn as one.
MERGE_FROM = 3


def without_common(group: DrawnGroup) -> DrawnGroup:
    """Drop the endpoints that every node has (parameter services ...) unless they are faulty.

    Those of a missing node are dropped as well.
    """
    missing = {node.name for node in group.nodes if node.state == MISSING}
    edges = [
        edge
        for edge in group.edges
        if not edge.common or (edge.state in FAULTY and edge.node not in missing)
    ]
    return _merge_unused_services(_with_edges(group, edges))


def only_common(group: DrawnGroup) -> DrawnGroup:
    """What ``without_common`` drops."""
    shown = {(edge.kind, edge.name) for edge in without_common(group).edges}
    hidden = [edge for edge in group.edges if (edge.kind, edge.name) not in shown]
    nodes = {edge.node for edge in hidden}
    smaller = _with_edges(group, hidden)
    return smaller._replace(nodes=tuple(n for n in smaller.nodes if n.name in nodes))


def has_faults(group: DrawnGroup) -> bool:
    """Whether anything in the group is missing or wrong."""
    states = {node.state for node in group.nodes} | {edge.state for edge in group.edges}
    return not states.isdisjoint(FAULTY)


def _with_edges(group: DrawnGroup, edges: Iterable[DrawnEdge]) -> DrawnGroup:
    """The group with only these edges; robots and tools without an edge are dropped."""
    kept = tuple(edges)
    nodes = {edge.node for edge in kept}
    names = {(edge.kind, edge.name) for edge in kept}
    return group._replace(
        nodes=tuple(n for n in group.nodes if n.name in nodes or not (n.is_robot or n.is_tool)),
        names=tuple(name for name in group.names if (name.kind, name.name) in names),
        edges=kept,
    )


def _merge_unused_services(group: DrawnGroup) -> DrawnGroup:
    """Draw a node's services without a client as one name, where there are several."""
    ends: dict[tuple[str, str], list[DrawnEdge]] = defaultdict(list)
    for edge in group.edges:
        ends[edge.kind, edge.name].append(edge)
    unused: dict[tuple[str, str], list[DrawnEdge]] = defaultdict(list)
    for edge, *others in ends.values():
        if not others and edge.role == SERVES and edge.state not in FAULTY:
            unused[edge.node, edge.kind].append(edge)
    merged = {key: own for key, own in unused.items() if len(own) >= MERGE_FROM}
    dropped = {(edge.kind, edge.name) for own in merged.values() for edge in own}
    names = [name for name in group.names if (name.kind, name.name) not in dropped]
    edges = [edge for edge in group.edges if (edge.kind, edge.name) not in dropped]
    for (node, kind), own in merged.items():
        # A space cannot be in the name of a real endpoint.
        bundle = f"{node} {kind}"
        names.append(DrawnName(kind, bundle, group.robot, OK, (), tuple(edge.name for edge in own)))
        edges.append(own[0]._replace(name=bundle, state=OK))
    return group._replace(names=tuple(names), edges=tuple(edges))
