"""A scene as one chart for programs that lay it out themselves, with as much in it as they bear."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.pictures.lighter import only_trouble, plain, troubled, without_loose
from multibot_rewrite.graph.pictures.marks import MISSING, TROUBLE
from multibot_rewrite.graph.pictures.scene import Edge, Group, Name, Node, Scene
from multibot_rewrite.graph.pictures.text import counted
from multibot_rewrite.remap.records import CALLS, PUBLISHES


class Cluster(NamedTuple):
    """What stands together under a title; ids are letters and digits."""

    title: str
    nodes: tuple[tuple[str, Node], ...]
    names: tuple[tuple[str, Name], ...]


class Arrow(NamedTuple):
    """From one id to another: as messages go, or as a call goes."""

    start: str
    end: str
    state: str


class Chart(NamedTuple):
    """``note`` says what was left out; ``calm`` are robots that are a box without anything in it."""

    note: str
    clusters: tuple[Cluster, ...]
    calm: tuple[str, ...]
    arrows: tuple[Arrow, ...]


def charts(scene: Scene) -> Iterator[Chart]:
    """The scene with less and less in it."""
    groups = [plain(group) for group in scene.groups]
    yield _chart("without what every node has", groups, ())
    joined = [without_loose(group) for group in groups]
    yield _chart("without names that have one end", joined, ())
    wrong = [group for group in joined if troubled(group)]
    calm = [group.robot for group in joined if group.robot and not troubled(group)]
    yield _chart("robots as planned are empty boxes", wrong, calm)
    few = [only_trouble(group) for group in wrong]
    short = [f"{counted(len(calm), 'robot')} as planned"] if calm else []
    yield _chart("only what is missing or wrong", few, short)
    bad = [_only_bad(group) for group in few]
    for most in (300, 100, 30):
        cut = _chart(f"only {most} of all that is wrong", bad, short)
        yield _cut(cut, most)


def fitting(scene: Scene, fits: Callable[[Chart], bool]) -> Chart:
    """The first chart that fits, or the least of them."""
    chart = None
    for chart in charts(scene):
        if fits(chart):
            break
    assert chart is not None
    return chart


def _only_bad(group: Group) -> Group:
    """What is wrong rather than missing comes first, and nothing that is well."""
    edges = [edge for edge in group.edges if edge.state in TROUBLE]
    edges.sort(key=lambda edge: edge.state == MISSING)
    return group._replace(edges=tuple(edges))


def _chart(note: str, groups: Sequence[Group], calm: Iterable[str]) -> Chart:
    """Each thing once, where it belongs; what belongs to a group left out stands where it is met."""
    home = {group.robot for group in groups}
    nodes: dict[str, tuple[str, Node]] = {}
    names: dict[tuple[str, str], tuple[str, Name]] = {}
    edges: dict[Edge, None] = {}
    for group in groups:
        edges.update(dict.fromkeys(e for e in group.edges if e.node in _single(group)))
        for node in group.nodes:
            if not node.whole and (node.robot == group.robot or node.robot not in home):
                nodes.setdefault(node.name, (group.robot, node))
        for name in group.names:
            if name.robot == group.robot or name.robot not in home:
                names.setdefault((name.kind, name.name), (group.robot, name))
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
    arrows = (_arrow(edge, node_ids[edge.node], name_ids[edge.kind, edge.name]) for edge in edges)
    return Chart(note, tuple(c for c in clusters if c.nodes or c.names), tuple(calm), tuple(arrows))


def _single(group: Group) -> set[str]:
    return {node.name for node in group.nodes if not node.whole}


def _arrow(edge: Edge, node: str, name: str) -> Arrow:
    out = edge.role in (PUBLISHES, CALLS)
    return Arrow(node, name, edge.state) if out else Arrow(name, node, edge.state)


def _cut(chart: Chart, most: int) -> Chart:
    """The first arrows, and what they join."""
    arrows = chart.arrows[:most]
    there = {end for arrow in arrows for end in (arrow.start, arrow.end)}
    clusters = (
        Cluster(
            cluster.title,
            tuple((id_, node) for id_, node in cluster.nodes if id_ in there),
            tuple((id_, name) for id_, name in cluster.names if id_ in there),
        )
        for cluster in chart.clusters
    )
    kept = tuple(cluster for cluster in clusters if cluster.nodes or cluster.names)
    return chart._replace(clusters=kept, arrows=arrows)
