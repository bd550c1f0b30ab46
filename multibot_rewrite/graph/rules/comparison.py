"""A snapshot beside its plan, and what the rules say of it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Set
from typing import NamedTuple

from multibot_rewrite.graph.expectation import Expectation, Wanted, WantedRobot
from multibot_rewrite.graph.rules.likeness import stand_ins
from multibot_rewrite.graph.rules.owners import Owners, frame_owners, name_owners
from multibot_rewrite.graph.rules.trees import TfTree, tf_trees
from multibot_rewrite.graph.snapshot import GraphEndpoint, Snapshot
from multibot_rewrite.graph.tool_nodes import is_tool
from multibot_rewrite.remap.records import PUBLISHES, TOPIC

INCONCLUSIVE = "inconclusive"
# An endpoint: node, kind, role, name.
End = tuple[str, str, str, str]


class GraphFinding(NamedTuple):
    """Something wrong in the graph: what was expected, what is seen, the likely cause and remedy.

    ``level`` is ``error``, ``warning`` or ``inconclusive``. ``about`` are the topics, services,
    actions or frames that it is about, as far as it is not about a node or a robot as a whole.
    """

    code: str
    level: str
    robot: str
    node: str
    message: str
    cause: str
    about: tuple[str, ...] = ()

    def __str__(self) -> str:
        cause = f" ({self.cause})" if self.cause else ""
        who = self.node or self.robot or "graph"
        return f"{who}: {self.level}: {self.code} {self.message}{cause}"


class View(NamedTuple):
    """A snapshot beside the plan, with the look-ups that several rules need.

    ``types`` has the type of every endpoint seen, ``planned`` all endpoints of the plan, ``more``
    by node those seen that are not among them (the parts of an action are seen in the action),
    ``spoken`` the topics that somebody publishes. ``unplanned`` are nodes that the plan does not
    have and nobody ignores; ``stand_ins`` those of them that stand where a planned node is missed
    (missed -> seen). ``places`` tell where in its description a node comes from.
    """

    plan: Expectation
    graph: Snapshot
    by_node: dict[str, list[GraphEndpoint]]
    by_name: dict[str, list[GraphEndpoint]]
    robot_of: dict[str, str]
    owners: Owners
    frame_owners: Owners
    types: Mapping[End, str]
    planned: Mapping[End, Wanted]
    more: Mapping[str, list[GraphEndpoint]]
    spoken: Set[str]
    seen: Mapping[str, int]
    unplanned: tuple[str, ...]
    stand_ins: Mapping[str, str]
    places: Mapping[str, str]
    trees: tuple[TfTree, ...]
    robots: Mapping[str, WantedRobot]
    frames_of: Mapping[str, frozenset[str]]


def make_view(plan: Expectation, graph: Snapshot) -> View:
    """The look-ups, made once."""
    planned = {(w.node, w.kind, w.role, w.name): w for w in plan.endpoints}
    ends = _sorted_out(graph.endpoints, planned)
    robot_of = {node: robot.name for robot in plan.robots for node in robot.nodes}
    seen = Counter(node.name for node in graph.nodes)
    foreseen = {*robot_of, *plan.shared_nodes}
    strangers = [node for node in seen if node not in foreseen]
    unplanned = tuple(node for node in strangers if not is_tool(node, plan.ignored_nodes))
    missing = {node: robot for node, robot in robot_of.items() if node not in seen}
    owners = name_owners(plan)
    return View(
        plan=plan,
        graph=graph,
        by_node=ends.by_node,
        by_name=ends.by_name,
        robot_of=robot_of,
        owners=owners,
        frame_owners=frame_owners(plan),
        types=ends.types,
        planned=planned,
        more=ends.more,
        spoken={n for _, kind, role, n in ends.types if (kind, role) == (TOPIC, PUBLISHES)},
        seen=seen,
        unplanned=unplanned,
        stand_ins=stand_ins(missing, strangers, unplanned, owners),
        places=dict(plan.sources),
        trees=tf_trees(graph.frames, plan.robots, owners),
        robots={robot.name: robot for robot in plan.robots},
        frames_of={r.name: frozenset((*r.frames, *r.other_frames)) for r in plan.robots},
    )


class _Ends(NamedTuple):
    by_node: dict[str, list[GraphEndpoint]]
    by_name: dict[str, list[GraphEndpoint]]
    more: dict[str, list[GraphEndpoint]]
    types: dict[End, str]


def _sorted_out(endpoints: Iterable[GraphEndpoint], planned: Mapping[End, Wanted]) -> _Ends:
    found = _Ends(defaultdict(list), defaultdict(list), defaultdict(list), {})
    by_node, by_name, more, types = found
    for endpoint in endpoints:
        kind, role, name, type_, _, node, _, _ = endpoint
        end = (node, kind, role, name)
        by_node[node].append(endpoint)
        by_name[name].append(endpoint)
        # A node may subscribe a topic more than once.
        if end not in planned and end not in types and "/_" not in name:
            more[node].append(endpoint)
        types[end] = type_
    return found
