"""The same scene with less in it: what every node has left out, small things merged."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from multibot_rewrite.graph.pictures.marks import MISSING, OK, TROUBLE
from multibot_rewrite.graph.pictures.scene import Edge, Group, Name
from multibot_rewrite.remap.records import SERVES

# That many of a node's services without a caller are drawn as one.
MERGED_FROM = 3


def plain(group: Group) -> Group:
    """Without what every node has, as far as nothing is wrong with it; of a node that is not there
    it is not missed either."""
    absent = {node.name for node in group.nodes if node.state == MISSING}
    edges = [
        edge
        for edge in group.edges
        if not edge.everyday or (edge.state in TROUBLE and edge.node not in absent)
    ]
    return _merged(_with_edges(group, edges))


def rest(group: Group) -> Group:
    """What ``plain`` leaves out, by itself."""
    shown = {(edge.kind, edge.name) for edge in plain(group).edges}
    hidden = [edge for edge in group.edges if (edge.kind, edge.name) not in shown]
    there = {edge.node for edge in hidden}
    smaller = _with_edges(group, hidden)
    return smaller._replace(nodes=tuple(n for n in smaller.nodes if n.name in there))


def troubled(group: Group) -> bool:
    """Whether anything in it is missing or wrong."""
    states = {node.state for node in group.nodes} | {edge.state for edge in group.edges}
    return not states.isdisjoint(TROUBLE)


def only_trouble(group: Group) -> Group:
    """What is missing or wrong, and the other ends of those names."""
    bad = {(edge.kind, edge.name) for edge in group.edges if edge.state in TROUBLE}
    smaller = _with_edges(group, [e for e in group.edges if (e.kind, e.name) in bad])
    there = {edge.node for edge in smaller.edges}
    kept = (node for node in smaller.nodes if node.state in TROUBLE or node.name in there)
    return smaller._replace(nodes=tuple(kept))


def without_loose(group: Group) -> Group:
    """Without the names that have one end, as far as nothing is wrong with them."""
    ends: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for edge in group.edges:
        ends[edge.kind, edge.name].append(edge)
    kept = {key for key, own in ends.items() if len(own) > 1 or own[0].state in TROUBLE}
    return _with_edges(group, [e for e in group.edges if (e.kind, e.name) in kept])


def _with_edges(group: Group, edges: Iterable[Edge]) -> Group:
    """The group with these edges only; of tools and the like none is left without an edge."""
    kept = tuple(edges)
    there = {edge.node for edge in kept}
    names = {(edge.kind, edge.name) for edge in kept}
    return group._replace(
        nodes=tuple(n for n in group.nodes if n.name in there or not (n.whole or n.loose)),
        names=tuple(n for n in group.names if (n.kind, n.name) in names),
        edges=kept,
    )


def _merged(group: Group) -> Group:
    """With a node's services that nobody calls as one name, where there are several."""
    ends: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for edge in group.edges:
        ends[edge.kind, edge.name].append(edge)
    lonely: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for edge, *others in ends.values():
        if not others and edge.role == SERVES and edge.state not in TROUBLE:
            lonely[edge.node, edge.kind].append(edge)
    many = {key: own for key, own in lonely.items() if len(own) >= MERGED_FROM}
    gone = {(edge.kind, edge.name) for own in many.values() for edge in own}
    names = [name for name in group.names if (name.kind, name.name) not in gone]
    edges = [edge for edge in group.edges if (edge.kind, edge.name) not in gone]
    for (node, kind), own in many.items():
        # No graph name holds a blank.
        bundle = f"{node} {kind}"
        names.append(Name(kind, bundle, group.robot, OK, (), tuple(edge.name for edge in own)))
        edges.append(own[0]._replace(name=bundle, state=OK))
    return group._replace(names=tuple(names), edges=tuple(edges))
