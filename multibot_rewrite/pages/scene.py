# SPDX-License-Identifier: Apache-2.0
"""What is drawn of a checked graph, each part with its state. Pure, and without any drawing."""

from collections import defaultdict
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.selection import with_members
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.live.watching import Outcome, judge, verdict_words
from multibot_rewrite.pages.states import (
    FAULTY,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    FrameTree,
    States,
    Targets,
    find_targets,
    make_frame_trees,
    make_states,
    merged,
    robots_of,
    worst,
)
from multibot_rewrite.planning.plan import robot_words
from multibot_rewrite.rules.check import side_by_side
from multibot_rewrite.rules.system.planned_ends import matches
from multibot_rewrite.system.coverage import Coverage, coverage
from multibot_rewrite.system.index import EndKey, Index
from multibot_rewrite.system.records import (
    ACTION,
    SERVICE,
    TOPIC,
    Environment,
    System,
    alternatives,
)
from multibot_rewrite.system.words import is_tool

# Of findings: errors first, what is not certain last.
_ORDER = (ERROR, WARNING, NOTE, INCONCLUSIVE)
# Packages with the types of endpoints that every node has: logging, parameters, life cycle; and
# tf, which has its own picture.
COMMON_PACKAGES = (
    "rcl_interfaces", "lifecycle_msgs", "type_description_interfaces", "bond", "tf2_msgs",
)  # fmt: skip
# Stands for the bridge that should carry a topic; a space cannot be in the name of a real node.
BRIDGE = "a ros_gz_bridge"
# In the topics and services that an action is made of.
ACTION_PART = "/_action/"


class DrawnEdge(NamedTuple):
    """A node's endpoint of a name. ``common`` endpoints are those that every node has."""

    node: str
    kind: str
    role: str
    name: str
    type: str
    state: str
    common: bool


class DrawnNode(NamedTuple):
    """A node; with ``is_robot`` it stands for a whole robot, in the group of what is shared.

    ``is_tool`` nodes are neither planned nor in a finding."""

    name: str
    robot: str
    state: str
    is_robot: bool = False
    is_tool: bool = False


class DrawnName(NamedTuple):
    """A topic, service or action; one that stands for several has their names in ``merged``."""

    kind: str
    name: str
    robot: str
    state: str
    types: tuple[str, ...]
    merged: tuple[str, ...] = ()


class DrawnGroup(NamedTuple):
    """What belongs to one robot, or to none where ``robot`` is empty."""

    robot: str
    nodes: tuple[DrawnNode, ...]
    names: tuple[DrawnName, ...]
    edges: tuple[DrawnEdge, ...]


class Crossing(NamedTuple):
    """What connects two groups: a node of robot ``source`` uses ``names`` of robot ``target``.

    Without ``source`` the node is ``node``, of no robot; without ``target`` the names are of no
    robot."""

    source: str
    node: str
    target: str
    state: str
    names: tuple[str, ...]


class FindingRow(NamedTuple):
    """A finding, with the robots of which the same is true, and what it is about at all of them.

    ``robots`` are all that it concerns: that it is about, or of which it names a node, a name or a
    frame. ``place`` is ``file:line`` in a source, or else says where the node comes from.
    """

    finding: Finding
    targets: Targets
    robots: tuple[str, ...]
    place: str


class Scene(NamedTuple):
    """All that is drawn; ``rows`` are the ``findings``, those of several robots as one.

    Of each group of nodes in ``one_of`` one should run; those that do are ``running``."""

    outcome: Outcome
    layout: str
    robots: tuple[str, ...]
    groups: tuple[DrawnGroup, ...]
    crossings: tuple[Crossing, ...]
    trees: tuple[FrameTree, ...]
    findings: tuple[Finding, ...]
    rows: tuple[FindingRow, ...]
    environment: Environment
    one_of: tuple[tuple[str, ...], ...]
    running: frozenset[str]
    coverage: Coverage = Coverage(())


class _RobotOf(NamedTuple):
    """The robot of each node and name; empty for none."""

    nodes: Mapping[str, str]
    names: Mapping[str, str]


def make_scene(
    plan: System, graph: System, found: Sequence[Finding], outcome: Outcome | None = None
) -> Scene:
    """Return the drawing of ``graph`` with plan and findings; the outcome follows if not given."""
    verdict, held = judge(found, graph), coverage(plan, graph)
    by_plan, seen = side_by_side(plan, graph)
    targets = find_targets(by_plan, seen, found)
    states = make_states(found, targets)
    edges = sorted(_drawn_edges(by_plan, seen, states))
    missing = (node for node, state in states.nodes.items() if state == MISSING)
    every = {*seen.nodes, *missing, *(edge.node for edge in edges)}
    robot, shared = by_plan.of_names.robot, {*by_plan.own[""], *plan.shared_topics}
    robot_of = _RobotOf(
        *(
            {it: "" if it in shared else robot(it) for it in sorted(its)}
            for its in (every, {edge.name for edge in edges})
        )
    )
    nodes = _drawn_nodes(by_plan, seen, states, edges, robot_of)
    return Scene(
        outcome or Outcome(verdict, verdict_words(verdict, found, held)),
        plan.layout,
        tuple(robot.name for robot in plan.robots),
        tuple(_drawn_groups(plan, edges, nodes, robot_of)),
        tuple(_crossings(edges, robot_of)),
        make_frame_trees(by_plan, seen, states),
        tuple(found),
        tuple(_finding_rows(by_plan, dict(zip(found, targets, strict=True)))),
        graph.environment,
        alternatives(plan),
        frozenset(seen.nodes),
        held,
    )


def _finding_rows(plan: Index, targets: Mapping[Finding, Targets]) -> Iterator[FindingRow]:
    each = with_members(targets, robot_words(plan.system))
    for finding, members in sorted(each, key=lambda it: _ORDER.index(it[0].level)):
        concerned = {robot for it in members for robot in robots_of(plan, it)}
        robots = tuple(robot for robot in plan.declared if robot in concerned)
        place = f"{finding.file}:{finding.line}" if finding.line else finding.file
        node = plan.node.get(finding.node)
        if not place and node is not None:
            # Where a planned node is from: its plugin, a file, or its node set.
            node_set = f"node set {node.node_set}" if node.node_set else ""
            place = str(node.plugin) or str(node.place) or node_set
        yield FindingRow(finding, merged(targets[it] for it in members), robots, place)


def _drawn_edges(plan: Index, seen: Index, states: States) -> Iterator[DrawnEdge]:
    """Yield the endpoints in the graph, and those that a finding reports as missing."""
    # One endpoint with a known type is enough.
    common_names = {
        end.name
        for end in (*seen.system.ends, *plan.system.ends)
        if ACTION_PART in end.name or end.type.partition("/")[0] in COMMON_PACKAGES
    }
    bridged = {(role, it.name): it.type for it in plan.system.topics for role in it.bridge}
    for key, type_ in dict.fromkeys(
        ((e.node, e.kind, e.role, e.name), e.type) for e in seen.sure.system.ends
    ):
        node, *_, name = key
        common = name in common_names
        state = states.endpoints.get((node, name), OK)
        if state in (OK, MISSING):
            state = OK if common or _is_expected(plan, key, bridged) else UNEXPECTED
        yield DrawnEdge(*key, type_, state, common)
    for key, planned in plan.sure.by_key.items():
        node, *_, name = key
        reported = states.nodes.get(node) == MISSING or (node, name) in states.endpoints
        if reported and key not in seen.by_key:
            yield DrawnEdge(*key, planned.type, MISSING, name in common_names)

    carried = {(role, name) for _, _, role, name in seen.by_key}
    for (role, name), type_ in bridged.items():
        if name in states.names and (role, name) not in carried:
            yield DrawnEdge(BRIDGE, TOPIC, role, name, type_, MISSING, False)


def _is_expected(plan: Index, key: EndKey, bridged: Container[tuple[str, str]]) -> bool:
    """Return whether the plan has an endpoint of the graph, by itself or in another form."""
    node, kind, role, name = key
    if key in plan.by_key or node in plan.own[""] or (role, name) in bridged:
        return True
    if kind == ACTION and (node, SERVICE, role, f"{name}{ACTION_PART}send_goal") in plan.by_key:
        return True
    return is_tool(node) and bool(plan.robot(node))


def _drawn_nodes(
    plan: Index, seen: Index, states: States, edges: Sequence[DrawnEdge], robot_of: _RobotOf
) -> dict[str, DrawnNode]:
    planned = {*plan.robot_of, *plan.own[""]}
    edge_states = sets_by_key((it.node, it.state) for it in edges)
    own_states = sets_by_key((it.node, it.state) for it in edges if not it.common)
    # Planned nodes under another name, which the same node of each robot would have.
    misnamed = set(matches(plan, seen).values())
    result = {}
    for node, robot in robot_of.nodes.items():
        own = {states.nodes.get(node, OK), *(edge_states[node] & FAULTY - {MISSING})}
        state = LEAK if node in misnamed and not robot else worst(own)
        if node not in seen.nodes and node not in seen.by_node:
            state = MISSING
        elif state == OK and node not in planned and own_states[node] != {OK}:
            state = OK if robot and is_tool(node) else UNEXPECTED
        unknown = node not in planned and node not in states.nodes
        result[node] = DrawnNode(node, robot, state, is_tool=unknown)
    return result


def _drawn_groups(
    plan: System, edges: Iterable[DrawnEdge], nodes: Mapping[str, DrawnNode], robot_of: _RobotOf
) -> Iterator[DrawnGroup]:
    """Yield a group for each robot and one for the rest; an edge between two robots is in both."""
    parts: dict[str, list[DrawnEdge]] = {robot.name: [] for robot in plan.robots}
    parts[""] = []
    for edge in edges:
        for robot in {robot_of.nodes[edge.node], robot_of.names[edge.name]}:
            parts[robot].append(edge)
    by_name = lists_by_key(((edge.kind, edge.name), edge) for edge in edges)
    names = {}
    for (kind, name), uses in by_name.items():
        types = tuple(sorted({end.type for end in uses if end.type}))
        state = combined_state({end.state for end in uses})
        names[kind, name] = DrawnName(kind, name, robot_of.names[name], state, types)
    for robot, ends in parts.items():
        shown = tuple(ends) if robot else tuple(_nodes_as_robots(ends, nodes))
        own = {node.name: node for node in nodes.values() if node.robot == robot}
        users = {e.node: nodes.get(e.node) or DrawnNode(e.node, e.node, OK, True) for e in shown}
        keys = dict.fromkeys((edge.kind, edge.name) for edge in shown)
        yield DrawnGroup(
            robot, tuple((own | users).values()), tuple(names[key] for key in keys), shown
        )


def _nodes_as_robots(
    edges: Iterable[DrawnEdge], nodes: Mapping[str, DrawnNode]
) -> Iterator[DrawnEdge]:
    """Yield edges to shared names from one box per robot, unless a node's endpoint is faulty."""
    states: dict[DrawnEdge, set[str]] = defaultdict(set)
    for edge in edges:
        robot = nodes[edge.node].robot
        if not robot or edge.state in FAULTY - {MISSING}:
            yield edge
        else:
            states[edge._replace(node=robot, type="", state=OK)].add(edge.state)
    for edge, found in states.items():
        yield edge._replace(state=combined_state(found))


def combined_state(states: Collection[str]) -> str:
    """Return missing or unexpected only if all endpoints are; otherwise the worst other state."""
    if len(states) == 1:
        return next(iter(states))
    return worst(state for state in states if state not in (MISSING, UNEXPECTED))


def _crossings(edges: Iterable[DrawnEdge], robot_of: _RobotOf) -> Iterator[Crossing]:
    found: dict[tuple[str, str, str, str], dict[str, None]] = defaultdict(dict)
    for edge in edges:
        source, target = robot_of.nodes[edge.node], robot_of.names[edge.name]
        faulty = edge.state in FAULTY
        if edge.state == MISSING or source == target or not (faulty or target):
            continue
        if faulty or not edge.common:
            node = "" if source else edge.node
            found[source, node, target, edge.state][f"{edge.role} {edge.name}"] = None
    for key, names in sorted(found.items()):
        yield Crossing(*key, tuple(names))
