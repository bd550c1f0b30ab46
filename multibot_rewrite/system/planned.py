"""A plan with the look-ups that its rules share, and a system seen beside it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.index import NO_COUNTS, EndKey, Index, Known, index, tree_topic
from multibot_rewrite.system.ownership import (
    NameOwnership,
    frame_ownership,
    name_ownership,
    whose_by_plan,
)
from multibot_rewrite.system.records import (
    SIM_TIME,
    End,
    Node,
    Robot,
    System,
    may_miss,
    nodes_by_robot,
)
from multibot_rewrite.system.tf_copies import copying_nodes


class Sent(NamedTuple):
    """A transform that a node sends by the plan."""

    node: str
    parent: str
    child: str

    def __str__(self) -> str:
        return f"{self.parent} -> {self.child}"


class Planned(NamedTuple):
    """A plan; ``names`` and ``frames`` say whose a name is by it.

    ``nodes`` are by their names, ``own`` the names of those of each robot, ``robot_of`` the robot of
    those that have one. ``ends`` are by their key, ``sent`` the transforms besides those of the
    descriptions. ``frames_of`` has the frames of each robot. ``may_miss`` are the nodes that need not
    run: on a condition, or because another one may run instead.
    """

    system: System
    names: NameOwnership
    frames: NameOwnership
    robots: Mapping[str, Robot]
    nodes: Mapping[str, Node]
    own: Mapping[str, Sequence[str]]
    robot_of: Mapping[str, str]
    ends: Mapping[EndKey, End]
    sent: tuple[Sent, ...]
    frames_of: Mapping[str, frozenset[str]]
    may_miss: frozenset[str]


def planned(plan: System) -> Planned:
    """The look-ups, made once."""
    return Planned(
        plan,
        name_ownership(plan),
        frame_ownership(plan),
        {robot.name: robot for robot in plan.robots},
        {it.name: it for it in plan.nodes},
        nodes_by_robot(plan),
        {it.name: it.robot for it in plan.nodes if it.robot},
        {(it.node, it.kind, it.role, it.name): it for it in plan.ends},
        tuple(_sent(plan)),
        {it.name: frozenset((*it.frames, *it.other_frames)) for it in plan.robots},
        frozenset(it.name for it in plan.nodes if may_miss(it)),
    )


def _sent(plan: System) -> Iterator[Sent]:
    for edge in plan.edges:
        yield from (Sent(node, edge.parent, edge.child) for node in edge.publishers)


def beside(plan: Planned, graph: System, messages: Mapping[str, int] = NO_COUNTS) -> Index:
    """A system with what its plan says of names, tf topics, senders and tools."""
    senders: dict[tuple[str, str], tuple[str, ...]] = defaultdict(tuple)
    for it in plan.sent:
        senders[it.parent, it.child] += (it.node,)
    known = Known(
        {robot.name: tree_topic(robot.tf_topic) for robot in plan.system.robots},
        senders,
        plan.robot_of,
        plan.system.ignored_nodes,
        {it.node for it in plan.system.parameters if it.name == SIM_TIME},
        copying_nodes(plan.system),
        messages,
        graph.environment.seconds,
    )
    return index(graph, whose_by_plan(plan.system, plan.names, plan.frames), known)
