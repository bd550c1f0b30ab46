# SPDX-License-Identifier: Apache-2.0
"""The layout of a group's picture: publishers and servers, names, subscribers and clients. Pure.

Lengths are pixels. Names and nodes are ordered by barycenters: each moves towards the middle of what
it is connected to, which leaves few crossings. Faulty names are at the top.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.pages.scene import DrawnEdge, DrawnGroup, DrawnName, DrawnNode
from multibot_rewrite.pages.states import FAULTY, STATES
from multibot_rewrite.system.records import PUBLISHES, SERVES

ROW, NODE_ROW, TOP = 24, 34, 40
SWEEPS = 6
OFFERING = (PUBLISHES, SERVES)


class GroupLayout(NamedTuple):
    """The nodes and names of each column with their vertical middle, and the total height.

    A node that offers and uses names is in both columns.
    """

    left: tuple[tuple[DrawnNode, float], ...]
    names: tuple[tuple[DrawnName, float], ...]
    right: tuple[tuple[DrawnNode, float], ...]
    height: float


_NameKey = tuple[str, str]


def lay_out(group: DrawnGroup) -> GroupLayout:
    """The layout of one group."""
    nodes = {node.name: node for node in group.nodes}
    offers = _names_by_node(edge for edge in group.edges if edge.role in OFFERING)
    uses = _names_by_node(edge for edge in group.edges if edge.role not in OFFERING)
    names = _ordered_names(group, offers, uses)
    height = max(len(names) * ROW, max(len(offers), len(uses)) * NODE_ROW)
    lead = (height - len(names) * ROW) / 2
    at = {key: lead + ROW * (rank + 0.5) for rank, key in enumerate(names)}
    left, right = _column(offers, at, height), _column(uses, at, height)
    idle = sorted(set(nodes) - set(left) - set(right))
    for rank, node in enumerate(idle):
        left[node] = height + NODE_ROW * (rank + 0.5)
    by_key = {(name.kind, name.name): name for name in group.names}
    return GroupLayout(
        tuple((nodes[node], TOP + y) for node, y in left.items()),
        tuple((by_key[key], TOP + y) for key, y in at.items()),
        tuple((nodes[node], TOP + y) for node, y in right.items()),
        TOP + height + NODE_ROW * len(idle),
    )


def _names_by_node(edges: Iterable[DrawnEdge]) -> dict[str, list[_NameKey]]:
    found: dict[str, list[_NameKey]] = defaultdict(list)
    for edge in edges:
        found[edge.node].append((edge.kind, edge.name))
    return found


def _ordered_names(
    group: DrawnGroup,
    offers: Mapping[str, Sequence[_NameKey]],
    uses: Mapping[str, Sequence[_NameKey]],
) -> list[_NameKey]:
    """The names, the worst first, within the same state in an order with few crossings."""
    severity = {(name.kind, name.name): len(STATES) for name in group.names}
    for edge in group.edges:
        if edge.state in FAULTY:
            key = edge.kind, edge.name
            severity[key] = min(severity[key], STATES.index(edge.state))
    names = sorted(severity, key=lambda key: (severity[key], key))
    for _ in range(SWEEPS):
        rank = {key: float(at) for at, key in enumerate(names)}
        pulls: dict[_NameKey, list[float]] = defaultdict(list)
        for side in (offers, uses):
            for keys in side.values():
                middle = _middle([rank[key] for key in keys])
                for key in keys:
                    pulls[key].append(middle)
        names.sort(key=lambda key: (severity[key], _middle(pulls[key]), key))
    return names


def _middle(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _column(
    joined: Mapping[str, Sequence[_NameKey]], at: Mapping[_NameKey, float], height: float
) -> dict[str, float]:
    """Each node beside the middle of its names, moved where two would overlap."""
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
