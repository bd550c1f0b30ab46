"""Which node sends a transform, by the plan; a transform itself does not say it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.graph.transforms import STATE_PUBLISHER
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules.index import tree_topic
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.tf_trees import TfTree
from multibot_rewrite.system.records import Edge, Robot, System


class Sent(NamedTuple):
    """A transform that a node sends by the plan."""

    node: str
    parent: str
    child: str

    def __str__(self) -> str:
        return f"{self.parent} -> {self.child}"


def planned_transforms(plan: System) -> Iterator[Sent]:
    """What nodes send besides the description's transforms, as ``sends`` of the plan has it."""
    for edge in plan.edges:
        yield from (Sent(node, edge.parent, edge.child) for node in edge.publishers)


def sent_by_robot(view: View, robot: Robot) -> list[Sent]:
    """Those of one robot's nodes."""
    own = (it for it in planned_transforms(view.plan) if view.robot_of.get(it.node) == robot.name)
    return list(own)


def foreign(view: View, robot: Robot) -> Iterator[tuple[str, Edge]]:
    """Transforms of other robots, each with its robot, that a node of this one may send: all on a tf
    topic of its own, else what several nodes send."""
    for tree in view.trees:
        if tree.topic != tree_topic(robot.tf_topic):
            continue
        for edge in tree.edges:
            other = view.frame_ownership.robot(edge.child)
            if other not in ("", robot.name) and (len(tree.home) == 1 or edge.several):
                yield other, edge


def described_robots(view: View, robot: Robot) -> Iterator[str]:
    """The robots whose description a node of this one seems to have, by fixed transforms of theirs."""
    return (other for other, edge in foreign(view, robot) if edge.static)


def sender_of(view: View, robot: Robot, frame: str) -> str:
    """The node that sends a planned frame of the robot: a node of its own, else the description's."""
    found = (it.node for it in sent_by_robot(view, robot) if frame in (it.parent, it.child))
    return next(found, "") or state_publisher(view, robot)


def state_publisher(view: View, robot: Robot) -> str:
    """The robot's robot_state_publisher by the plan; empty where it has none."""
    return next((it for it in view.own[robot.name] if STATE_PUBLISHER in it), "")


def senders_there(tree: TfTree, robot: str, first: Mapping[str, None]) -> list[str]:
    """Who publishes on a tree's topics: ``first``, then the robot's nodes, then all others."""
    others = [node for nodes in tree.senders.values() for node in nodes]
    every = dict.fromkeys((*first, *tree.senders.get(robot, ()), *others))
    return [node for node in every if node in others]


def where_set(view: View, node: str) -> str:
    """The file that holds a node's frames: its plugin's line, or that of its parameters; or empty."""
    planned = view.nodes.get(node)
    return str(planned.plugin) or str(planned.place) if planned else ""
