"""A scene as one chart for programs with their own layout, with as much in it as they accept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.pages.scene import DrawnEdge, DrawnGroup, DrawnName, DrawnNode, Scene
from multibot_rewrite.pages.simplify import (
    has_faults,
    only_faults,
    without_common,
    without_single_endpoints,
)
from multibot_rewrite.pages.states import FAULTY, MISSING
from multibot_rewrite.pages.text import counted
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.system.records import CALLS, PUBLISHES


class Cluster(NamedTuple):
    """Nodes and names in a box with a title; ids are letters and digits."""

    title: str
    nodes: tuple[tuple[str, DrawnNode], ...]
    names: tuple[tuple[str, DrawnName], ...]


class Arrow(NamedTuple):
    """From one id to another, in the direction of the messages or of the call."""

    start: str
    end: str
    state: str


class Chart(NamedTuple):
    """``note`` says what was left out; ``healthy`` are robots that are drawn as an empty box."""

    note: str
    clusters: tuple[Cluster, ...]
    healthy: tuple[str, ...]
    arrows: tuple[Arrow, ...]


def charts(scene: Scene) -> Iterator[Chart]:
    """Charts of the scene with less and less in them."""
    groups = [without_common(group) for group in scene.groups]
    yield _chart("without what every node has", groups, ())
    connected = [without_single_endpoints(group) for group in groups]
    yield _chart("without names that have only one endpoint", connected, ())
    faulty = [group for group in connected if has_faults(group)]
    healthy = [group.robot for group in connected if group.robot and not has_faults(group)]
    yield _chart("robots as planned are empty boxes", faulty, healthy)
    few = [only_faults(group) for group in faulty]
    summary = [f"{counted(len(healthy), 'robot')} as planned"] if healthy else []
    yield _chart("only what is missing or wrong", few, summary)
    wrong = _chart("", [_faulty_edges(group) for group in few], summary)
    for most in (300, 100, 30):
        yield _cut(wrong, most)._replace(note=f"only {most} of all that is wrong")


def largest_fitting(scene: Scene, fits: Callable[[Chart], bool]) -> Chart:
    """The first chart that fits, or the smallest one."""
    chart = None
    for chart in charts(scene):
        if fits(chart):
            break
    assert chart is not None
    return chart


def _faulty_edges(group: DrawnGroup) -> DrawnGroup:
    """Keep only faulty edges, wrong ones before missing ones."""
    edges = [edge for edge in group.edges if edge.state in FAULTY]
    edges.sort(key=lambda edge: edge.state == MISSING)
    return group._replace(edges=tuple(edges))


# A node or name by its key, with the robot of the cluster it is drawn in.
_Nodes = Mapping[str, tuple[str, DrawnNode]]
_Names = Mapping[tuple[str, str], tuple[str, DrawnName]]


def _chart(note: str, groups: Sequence[DrawnGroup], healthy: Iterable[str]) -> Chart:
    """Each node and name once: in its robot's cluster, or in the first one if that is left out."""
    nodes, names = _place_nodes(groups), _place_names(groups)
    node_ids = {node: f"n{at}" for at, node in enumerate(nodes)}
    name_ids = {name: f"t{at}" for at, name in enumerate(names)}
    clusters = (
        Cluster(
            group.robot or "shared and others",
            tuple((node_ids[key], n) for key, (robot, n) in nodes.items() if robot == group.robot),
            tuple((name_ids[key], n) for key, (robot, n) in names.items() if robot == group.robot),
        )
        for group in groups
    )
    arrows = (
        _arrow(edge, node_ids[edge.node], name_ids[edge.kind, edge.name]) for edge in _edges(groups)
    )
    return Chart(note, _not_empty(clusters), tuple(healthy), tuple(arrows))


def _place_nodes(groups: Sequence[DrawnGroup]) -> _Nodes:
    robots = {group.robot for group in groups}
    placed: dict[str, tuple[str, DrawnNode]] = {}
    for group in groups:
        for node in _single_nodes(group):
            if node.robot == group.robot or node.robot not in robots:
                placed.setdefault(node.name, (group.robot, node))
    return placed


def _place_names(groups: Sequence[DrawnGroup]) -> _Names:
    robots = {group.robot for group in groups}
    placed: dict[tuple[str, str], tuple[str, DrawnName]] = {}
    for group in groups:
        for name in group.names:
            if name.robot == group.robot or name.robot not in robots:
                placed.setdefault((name.kind, name.name), (group.robot, name))
    return placed


def _edges(groups: Iterable[DrawnGroup]) -> Iterable[DrawnEdge]:
    """The edges of single nodes, each once."""
    found: dict[DrawnEdge, None] = {}
    for group in groups:
        single = {node.name for node in _single_nodes(group)}
        found.update(dict.fromkeys(edge for edge in group.edges if edge.node in single))
    return found


def _single_nodes(group: DrawnGroup) -> Iterator[DrawnNode]:
    return (node for node in group.nodes if not node.is_robot)


def _not_empty(clusters: Iterable[Cluster]) -> tuple[Cluster, ...]:
    return tuple(cluster for cluster in clusters if cluster.nodes or cluster.names)


def _arrow(edge: DrawnEdge, node: str, name: str) -> Arrow:
    outgoing = edge.role in (PUBLISHES, CALLS)
    return Arrow(node, name, edge.state) if outgoing else Arrow(name, node, edge.state)


def _cut(chart: Chart, most: int) -> Chart:
    """The first arrows, and what they connect."""
    arrows = chart.arrows[:most]
    ids = {id_ for arrow in arrows for id_ in (arrow.start, arrow.end)}
    clusters = (
        Cluster(
            cluster.title,
            tuple((id_, node) for id_, node in cluster.nodes if id_ in ids),
            tuple((id_, name) for id_, name in cluster.names if id_ in ids),
        )
        for cluster in chart.clusters
    )
    return chart._replace(clusters=_not_empty(clusters), arrows=arrows)
