"""A plan with the look-ups that its rules share, and a system seen beside it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.graph.expectation import Expectation, PlannedEndpoint, PlannedRobot
from multibot_rewrite.graph.questions import SIM_TIME
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules.index import NO_COUNTS, EndKey, Index, Known, index, tree_topic
from multibot_rewrite.rules.ownership import (
    NameOwnership,
    frame_ownership,
    name_ownership,
    whose_by_plan,
)
from multibot_rewrite.rules.pair.tf_copies import copying_nodes
from multibot_rewrite.system.records import System


class Sent(NamedTuple):
    """A transform that a node sends by the plan."""

    node: str
    parent: str
    child: str

    def __str__(self) -> str:
        return f"{self.parent} -> {self.child}"


class Planned(NamedTuple):
    """A plan; ``names`` and ``frames`` say whose a name is by it, ``robot_of`` of the planned nodes.

    ``ends`` are by their key, ``sent`` the transforms besides those of the descriptions. ``frames_of``
    has the frames of each robot, ``places`` file and line of the plugin that starts a node.
    ``may_miss`` are the nodes that need not run: optional ones, and those of which another one may run
    in their place.
    """

    system: Expectation
    names: NameOwnership
    frames: NameOwnership
    robots: Mapping[str, PlannedRobot]
    robot_of: Mapping[str, str]
    ends: Mapping[EndKey, PlannedEndpoint]
    sent: tuple[Sent, ...]
    frames_of: Mapping[str, frozenset[str]]
    places: Mapping[str, str]
    may_miss: frozenset[str]


def planned(plan: Expectation) -> Planned:
    """The look-ups, made once."""
    optional = (robot.optional for robot in plan.robots)
    return Planned(
        plan,
        name_ownership(plan),
        frame_ownership(plan),
        {robot.name: robot for robot in plan.robots},
        {node: robot.name for robot in plan.robots for node in robot.nodes},
        # Their first four fields are the key.
        {end[:4]: end for end in plan.endpoints},
        tuple(_sent(plan)),
        {it.name: frozenset((*it.frames, *it.other_frames)) for it in plan.robots},
        dict(plan.sources),
        frozenset(node for group in (*optional, *plan.one_of) for node in group),
    )


def _sent(plan: Expectation) -> Iterator[Sent]:
    for node, text in plan.sends:
        for edge in text.split(", "):
            parent, arrow, child = edge.partition(" -> ")
            if arrow:
                yield Sent(node, parent, child)


def beside(plan: Planned, graph: System, messages: Mapping[str, int] = NO_COUNTS) -> Index:
    """A system with what its plan says of names, tf topics, senders and tools."""
    senders: dict[tuple[str, str], tuple[str, ...]] = defaultdict(tuple)
    for it in plan.sent:
        senders[it.parent, it.child] += (it.node,)
    clocks = {it.node for it in plan.system.states for own in it.parameters if own.name == SIM_TIME}
    known = Known(
        {robot.name: tree_topic(robot.tf) for robot in plan.system.robots},
        senders,
        plan.robot_of,
        plan.system.ignored_nodes,
        clocks,
        copying_nodes(plan.system),
        messages,
        graph.environment.seconds,
    )
    return index(graph, whose_by_plan(plan.system, plan.names, plan.frames), known)
