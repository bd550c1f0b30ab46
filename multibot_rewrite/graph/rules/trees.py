"""The tf trees of a snapshot: the edges of a tf topic and its static twin, and who sends them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.graph.expectation import WantedRobot
from multibot_rewrite.graph.rules.owners import Owners
from multibot_rewrite.graph.snapshot import Frame


class TfTree(NamedTuple):
    """``topic`` is the one the tree is called by. ``senders`` are all nodes that publish there (a
    transform does not tell which of them sent it), by their robot, "" for none. ``home`` are the
    robots whose tf the layout puts here, ``robots`` those that publish here; where nobody is known
    to, those of the layout."""

    topic: str
    edges: tuple[Frame, ...]
    senders: Mapping[str, tuple[str, ...]]
    home: tuple[str, ...]
    robots: tuple[str, ...]


def tf_trees(
    frames: Iterable[Frame], robots: Iterable[WantedRobot], owners: Owners
) -> tuple[TfTree, ...]:
    """One tree for each tf topic that was heard."""
    home: dict[str, list[str]] = defaultdict(list)
    for robot in robots:
        home[tree_of(robot.tf)].append(robot.name)
    edges: dict[str, list[Frame]] = defaultdict(list)
    # The same for all edges of a topic.
    senders: dict[str, tuple[str, ...]] = {}
    for frame in frames:
        edges[frame.topic].append(frame)
        senders[frame.topic] = senders.get(frame.topic) or frame.publishers
    topics: dict[str, list[str]] = defaultdict(list)
    for topic in edges:
        topics[tree_of(topic)].append(topic)
    return tuple(
        _tree(
            tree,
            tuple(edge for topic in there for edge in edges[topic]),
            _by_robot((node for topic in there for node in senders[topic]), owners),
            tuple(home.get(tree, ())),
        )
        for tree, there in topics.items()
    )


def _tree(
    topic: str,
    edges: tuple[Frame, ...],
    senders: Mapping[str, tuple[str, ...]],
    home: tuple[str, ...],
) -> TfTree:
    robots = tuple(filter(None, senders)) if senders else home
    return TfTree(topic, edges, senders, home, robots)


def tree_of(topic: str) -> str:
    """tf and tf_static of one robot are one tree, called by tf."""
    return "/".join("tf" if word == "tf_static" else word for word in topic.split("/"))


def _by_robot(nodes: Iterable[str], owners: Owners) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = defaultdict(list)
    for node in sorted(set(nodes)):
        found[owners.of(node)].append(node)
    return {robot: tuple(there) for robot, there in found.items()}


def names_on(tree: TfTree) -> Iterator[str]:
    """Every frame of a tree, each once."""
    return iter(dict.fromkeys(name for edge in tree.edges for name in (edge.child, edge.parent)))
