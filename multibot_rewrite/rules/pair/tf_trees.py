# SPDX-License-Identifier: Apache-2.0
"""The tf trees of a snapshot: the transforms on a tf topic and its tf_static, and their senders."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.records import Edge
from multibot_rewrite.system.tf_copies import tree_topic


class TfTree(NamedTuple):
    """The transforms of a tf topic and its tf_static; ``topic`` is the tf topic.

    ``senders`` are all nodes that publish there, by their robot, "" for none; a transform does not
    say which of them sent it. ``home`` are the robots whose tf topic this is by the layout,
    ``robots`` those that publish here, or ``home`` where no publisher is known.
    """

    topic: str
    edges: tuple[Edge, ...]
    senders: Mapping[str, tuple[str, ...]]
    home: tuple[str, ...]
    robots: tuple[str, ...]


@once
def tf_trees(plan: Index, seen: Index) -> Sequence[TfTree]:
    """Those with transforms."""
    home: dict[str, list[str]] = defaultdict(list)
    for robot in plan.system.robots:
        home[tree_topic(robot.tf_topic)].append(robot.name)
    there = (it for it in seen.trees if it.edges)
    return [_tree(plan, it, tuple(home.get(it.topic, ()))) for it in there]


def _tree(plan: Index, tree: Tree, home: tuple[str, ...]) -> TfTree:
    senders: dict[str, tuple[str, ...]] = defaultdict(tuple)
    for node in sorted(tree.senders):
        senders[plan.robot(node)] += (node,)
    robots = tuple(filter(None, senders)) if senders else home
    return TfTree(tree.topic, tree.edges, senders, home, robots)


def frames_in(tree: TfTree) -> Iterator[str]:
    """Every frame of a tree, each once."""
    return iter(dict.fromkeys(name for edge in tree.edges for name in (edge.child, edge.parent)))
