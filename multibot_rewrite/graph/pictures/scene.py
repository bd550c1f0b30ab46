"""What is to be drawn of a checked graph, each part with its state. Pure, no drawing here."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.expectation import Expectation, Wanted
from multibot_rewrite.graph.pictures.marks import (
    LEAK,
    MISSING,
    OK,
    TROUBLE,
    UNEXPECTED,
    Marks,
    Targets,
    find_targets,
    gravest,
    make_marks,
)
from multibot_rewrite.graph.pictures.outlines import Outline, make_outlines
from multibot_rewrite.graph.rules.comparison import GraphFinding, View, make_view
from multibot_rewrite.graph.snapshot import Environment, GraphEndpoint, Snapshot
from multibot_rewrite.graph.watching import Verdict, judge

# Packages of what every node has: logging, parameters, life cycle; tf has its own pictures.
EVERYDAY = (
    "rcl_interfaces",
    "lifecycle_msgs",
    "type_description_interfaces",
    "bond",
    "tf2_msgs",
)
# Topics and services that an action is made of.
HIDDEN = "/_action/"


class Edge(NamedTuple):
    """A node's end of a name. ``everyday`` tells that every node has its like."""

    node: str
    kind: str
    role: str
    name: str
    type: str
    state: str
    everyday: bool


class Node(NamedTuple):
    """A node; in the group of what is shared it may be a whole robot.

    ``loose`` tells that it is neither planned nor told of in a finding, as tools are.
    """

    name: str
    robot: str
    state: str
    whole: bool = False
    loose: bool = False


class Name(NamedTuple):
    """A topic, service or action; ``merged`` are the names it stands for, if it stands for several."""

    kind: str
    name: str
    robot: str
    state: str
    types: tuple[str, ...]
    merged: tuple[str, ...] = ()


class Group(NamedTuple):
    """What belongs to one robot, or to none where ``robot`` is empty."""

    robot: str
    nodes: tuple[Node, ...]
    names: tuple[Name, ...]
    edges: tuple[Edge, ...]


class Reach(NamedTuple):
    """What joins two groups: a node of ``source`` has ``names`` of ``target``.

    Without ``source`` it is ``node``, which is no robot's; without ``target`` they are no robot's.
    """

    source: str
    node: str
    target: str
    state: str
    names: tuple[str, ...]


class Scene(NamedTuple):
    """Everything there is to see; ``targets`` say what the finding at the same index is about."""

    verdict: Verdict
    layout: str
    robots: tuple[str, ...]
    groups: tuple[Group, ...]
    reaches: tuple[Reach, ...]
    outlines: tuple[Outline, ...]
    findings: tuple[GraphFinding, ...]
    targets: tuple[Targets, ...]
    environment: Environment


class _Owners(NamedTuple):
    """The robot of each node and name; empty for none."""

    nodes: Mapping[str, str]
    names: Mapping[str, str]


def make_scene(plan: Expectation, graph: Snapshot, found: Sequence[GraphFinding]) -> Scene:
    """What is to be drawn of ``graph`` as ``plan`` and the findings see it."""
    view = make_view(plan, graph)
    targets = find_targets(view, found)
    marks = make_marks(found, targets)
    edges = sorted(_edges(view, marks))
    owners = _owners(view, marks, edges)
    nodes = _nodes(view, marks, edges, owners)
    return Scene(
        judge(found, graph),
        plan.layout,
        tuple(robot.name for robot in plan.robots),
        tuple(_groups(plan, edges, nodes, owners)),
        tuple(_reaches(edges, owners)),
        make_outlines(view, marks),
        tuple(found),
        targets,
        graph.environment,
    )


def _edges(view: View, marks: Marks) -> Iterator[Edge]:
    """The ends that are there, and those that a finding calls missing."""
    usual = _everyday_names((*view.graph.endpoints, *view.plan.endpoints))
    for end, type_ in dict.fromkeys(
        ((e.node, e.kind, e.role, e.name), e.type) for e in view.graph.endpoints
    ):
        node, *_, name = end
        everyday = name in usual
        state = marks.ends.get((node, name), OK)
        if state in (OK, MISSING):
            foreseen = everyday or end in view.planned or node in view.plan.shared_nodes
            state = OK if foreseen else UNEXPECTED
        yield Edge(*end, type_, state, everyday)
    for end, wanted in view.planned.items():
        node, *_, name = end
        missed = MISSING in (marks.nodes.get(node), marks.ends.get((node, name)))
        if missed and end not in view.types:
            yield Edge(*end, wanted.type, MISSING, name in usual)


def _everyday_names(ends: Iterable[GraphEndpoint | Wanted]) -> set[str]:
    """Told by the type that one end at least knows."""
    return {
        end.name for end in ends if HIDDEN in end.name or end.type.partition("/")[0] in EVERYDAY
    }


def _owners(view: View, marks: Marks, edges: Iterable[Edge]) -> _Owners:
    missing = (node for node, state in marks.nodes.items() if state == MISSING)
    nodes = {*view.seen, *missing, *(edge.node for edge in edges)}
    names = {edge.name for edge in edges}
    of, shared = view.owners.of, {*view.plan.shared_nodes, *view.plan.shared_topics}
    return _Owners(
        {node: "" if node in shared else of(node) for node in sorted(nodes)},
        {name: "" if name in shared else of(name) for name in sorted(names)},
    )


def _nodes(view: View, marks: Marks, edges: Iterable[Edge], owners: _Owners) -> dict[str, Node]:
    planned = {*view.robot_of, *view.plan.shared_nodes}
    states: dict[str, set[str]] = defaultdict(set)
    for edge in edges:
        states[edge.node].add(edge.state)
    # Planned under another name: each robot's would have this one.
    strays = set(view.stand_ins.values())
    result = {}
    for node, robot in owners.nodes.items():
        own = {marks.nodes.get(node, OK), *(states[node] & TROUBLE - {MISSING})}
        state = LEAK if node in strays and not robot else gravest(own)
        if node not in view.seen:
            state = MISSING
        elif state == OK and node not in planned:
            state = UNEXPECTED
        loose = node not in planned and node not in marks.nodes
        result[node] = Node(node, robot, state, loose=loose)
    return result


def _groups(
    plan: Expectation, edges: Iterable[Edge], nodes: Mapping[str, Node], owners: _Owners
) -> Iterator[Group]:
    """One a robot, then one for what is no robot's; an end that joins two robots is in both."""
    parts: dict[str, list[Edge]] = {robot.name: [] for robot in plan.robots}
    parts[""] = []
    for edge in edges:
        for robot in {owners.nodes[edge.node], owners.names[edge.name]}:
            parts[robot].append(edge)
    names = {(name.kind, name.name): name for name in _names(edges, owners)}
    for robot, ends in parts.items():
        shown = tuple(ends) if robot else tuple(_as_robots(ends, nodes))
        own = {node.name: node for node in nodes.values() if node.robot == robot}
        met = {e.node: nodes.get(e.node) or Node(e.node, e.node, OK, True) for e in shown}
        there = dict.fromkeys((edge.kind, edge.name) for edge in shown)
        yield Group(robot, tuple((own | met).values()), tuple(names[key] for key in there), shown)


def _as_robots(edges: Iterable[Edge], nodes: Mapping[str, Node]) -> Iterator[Edge]:
    """Among what is shared, a robot's nodes are drawn as the robot, but where they are at fault."""
    states: dict[Edge, set[str]] = defaultdict(set)
    for edge in edges:
        robot = nodes[edge.node].robot
        if not robot or edge.state in TROUBLE - {MISSING}:
            yield edge
        else:
            states[edge._replace(node=robot, type="", state=OK)].add(edge.state)
    for edge, found in states.items():
        yield edge._replace(state=common_state(found))


def _names(edges: Iterable[Edge], owners: _Owners) -> Iterator[Name]:
    by_name: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for edge in edges:
        by_name[edge.kind, edge.name].append(edge)
    for (kind, name), ends in by_name.items():
        types = tuple(sorted({end.type for end in ends if end.type}))
        state = common_state({end.state for end in ends})
        yield Name(kind, name, owners.names[name], state, types)


def common_state(states: Collection[str]) -> str:
    """Missing or not planned where all ends are; one that is worse makes it all bad."""
    if len(states) == 1:
        return next(iter(states))
    return gravest(state for state in states if state not in (MISSING, UNEXPECTED))


def _reaches(edges: Iterable[Edge], owners: _Owners) -> Iterator[Reach]:
    found: dict[tuple[str, str, str, str], dict[str, None]] = defaultdict(dict)
    for edge in edges:
        source, target = owners.nodes[edge.node], owners.names[edge.name]
        bad = edge.state in TROUBLE
        if edge.state == MISSING or source == target or not (bad or target):
            continue
        if bad or not edge.everyday:
            node = "" if source else edge.node
            found[source, node, target, edge.state][f"{edge.role} {edge.name}"] = None
    for key, names in sorted(found.items()):
        yield Reach(*key, tuple(names))
