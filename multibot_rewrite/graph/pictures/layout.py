"""Where things stand in the picture of a group: who offers, the names, who uses. Pure.

Lengths are pixels. The order of names and nodes is settled by barycenters: each thing moves towards
the middle of what it is joined to, which leaves few crossings; what is wrong stands on top.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.pictures.marks import STATES, TROUBLE
from multibot_rewrite.graph.pictures.scene import Edge, Group, Name, Node
from multibot_rewrite.remap.records import PUBLISHES, SERVES

ROW, NODE_ROW, TOP = 24, 34, 40
SWEEPS = 6
OFFERS = (PUBLISHES, SERVES)


class Layout(NamedTuple):
    """Middles of the things of each column from the top, and the height of it all.

    A node that offers and uses stands in both columns.
    """

    left: tuple[tuple[Node, float], ...]
    names: tuple[tuple[Name, float], ...]
    right: tuple[tuple[Node, float], ...]
    height: float


_Key = tuple[str, str]


def lay_out(group: Group) -> Layout:
    """The layout of one group."""
    nodes = {node.name: node for node in group.nodes}
    offers = _joined(edge for edge in group.edges if edge.role in OFFERS)
    uses = _joined(edge for edge in group.edges if edge.role not in OFFERS)
    names = _ordered(group, offers, uses)
    height = max(len(names) * ROW, max(len(offers), len(uses)) * NODE_ROW)
    lead = (height - len(names) * ROW) / 2
    at = {key: lead + ROW * (rank + 0.5) for rank, key in enumerate(names)}
    left, right = _column(offers, at, height), _column(uses, at, height)
    idle = sorted(set(nodes) - set(left) - set(right))
    for rank, node in enumerate(idle):
        left[node] = height + NODE_ROW * (rank + 0.5)
    by_key = {(name.kind, name.name): name for name in group.names}
    return Layout(
        tuple((nodes[node], TOP + y) for node, y in left.items()),
        tuple((by_key[key], TOP + y) for key, y in at.items()),
        tuple((nodes[node], TOP + y) for node, y in right.items()),
        TOP + height + NODE_ROW * len(idle),
    )


def _joined(edges: Iterable[Edge]) -> dict[str, list[_Key]]:
    found: dict[str, list[_Key]] = defaultdict(list)
    for edge in edges:
        found[edge.node].append((edge.kind, edge.name))
    return found


def _ordered(
    group: Group, offers: Mapping[str, Sequence[_Key]], uses: Mapping[str, Sequence[_Key]]
) -> list[_Key]:
    """The names, the worst first, those as bad in an order with few crossings."""
    calm = {(name.kind, name.name): len(STATES) for name in group.names}
    for edge in group.edges:
        if edge.state in TROUBLE:
            key = edge.kind, edge.name
            calm[key] = min(calm[key], STATES.index(edge.state))
    names = sorted(calm, key=lambda key: (calm[key], key))
    for _ in range(SWEEPS):
        rank = {key: float(at) for at, key in enumerate(names)}
        pulls: dict[_Key, list[float]] = defaultdict(list)
        for side in (offers, uses):
            for keys in side.values():
                middle = _middle([rank[key] for key in keys])
                for key in keys:
                    pulls[key].append(middle)
        names.sort(key=lambda key: (calm[key], _middle(pulls[key]), key))
    return names


def _middle(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _column(
    joined: Mapping[str, Sequence[_Key]], at: Mapping[_Key, float], height: float
) -> dict[str, float]:
    """Each node beside the middle of its names, moved apart where two would overlap."""
    wish = {node: _middle([at[key] for key in keys]) for node, keys in joined.items()}
    order = sorted(wish, key=lambda node: (wish[node], node))
    places: dict[str, float] = {}
    low = -NODE_ROW / 2
    for node in order:
        low = places[node] = max(wish[node], low + NODE_ROW)
    high = height + NODE_ROW / 2
    for node in reversed(order):
        high = places[node] = min(places[node], high - NODE_ROW)
    return places
