"""The tf trees of a snapshot: the transforms on a tf topic and its tf_static, and their senders."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules.index import tree_topic
from multibot_rewrite.rules.ownership import NameOwnership
from multibot_rewrite.system.records import Edge, Robot


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


def tf_trees(
    frames: Iterable[Edge], robots: Iterable[Robot], ownership: NameOwnership
) -> tuple[TfTree, ...]:
    """One tree for each tf topic with transforms."""
    home: dict[str, list[str]] = defaultdict(list)
    for robot in robots:
        home[tree_topic(robot.tf_topic)].append(robot.name)
    edges: dict[str, list[Edge]] = defaultdict(list)
    # The same for all transforms on a topic.
    senders: dict[str, tuple[str, ...]] = {}
    for frame in frames:
        edges[frame.topic].append(frame)
        senders[frame.topic] = senders.get(frame.topic) or frame.publishers
    topics: dict[str, list[str]] = defaultdict(list)
    for topic in edges:
        topics[tree_topic(topic)].append(topic)
    return tuple(
        _tree(
            tree,
            tuple(edge for topic in own for edge in edges[topic]),
            _by_robot((node for topic in own for node in senders[topic]), ownership),
            tuple(home.get(tree, ())),
        )
        for tree, own in topics.items()
    )


def _tree(
    topic: str,
    edges: tuple[Edge, ...],
    senders: Mapping[str, tuple[str, ...]],
    home: tuple[str, ...],
) -> TfTree:
    robots = tuple(filter(None, senders)) if senders else home
    return TfTree(topic, edges, senders, home, robots)


def _by_robot(nodes: Iterable[str], ownership: NameOwnership) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = defaultdict(list)
    for node in sorted(set(nodes)):
        found[ownership.robot(node)].append(node)
    return {robot: tuple(own) for robot, own in found.items()}


def frames_in(tree: TfTree) -> Iterator[str]:
    """Every frame of a tree, each once."""
    return iter(dict.fromkeys(name for edge in tree.edges for name in (edge.child, edge.parent)))
