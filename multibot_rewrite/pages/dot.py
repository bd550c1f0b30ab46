"""The scene as a graph for Graphviz: ``dot -Tsvg``, ``dot -Tpdf``."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.pages.chart import Chart, largest_fitting
from multibot_rewrite.pages.mermaid import COLOURS
from multibot_rewrite.pages.scene import DrawnName, DrawnNode, Scene
from multibot_rewrite.pages.states import MISSING, OK, UNEXPECTED
from multibot_rewrite.pages.text import counted, visible
from multibot_rewrite.system.records import ACTION, SERVICE, TOPIC

# With more dot takes minutes, and the picture is not readable.
MOST_EDGES = 3000
SHAPES = {TOPIC: "ellipse", SERVICE: "component", ACTION: "hexagon"}
STYLES = {MISSING: "dashed", UNEXPECTED: "dotted"}
HEAD = """\
digraph multibot {
  rankdir=LR; compound=true; ranksep=1.2; nodesep=0.12; bgcolor="white";
  node [fontname="monospace", fontsize=10, height=0.28, margin="0.08,0.03"];
  edge [arrowsize=0.6]; graph [fontname="sans-serif", fontsize=13, labeljust=l, style="rounded"];
"""


def to_dot(scene: Scene) -> bytes:
    """The graph, with a cluster for each robot."""
    chart = largest_fitting(scene, lambda chart: len(chart.arrows) <= MOST_EDGES)
    return (HEAD + "\n".join(_lines(chart)) + "\n}\n").encode()


def _lines(chart: Chart) -> Iterator[str]:
    yield f"  // {chart.note}"
    for at, cluster in enumerate(chart.clusters):
        yield f"  subgraph cluster_{at} {{"
        yield f"    label={_quoted(cluster.title)};"
        yield from (f"    {id_} {_node(node)};" for id_, node in cluster.nodes)
        yield from (f"    {id_} {_name(name)};" for id_, name in cluster.names)
        yield "  }"
    for at, robot in enumerate(chart.healthy):
        yield f"  c{at} [label={_quoted(robot)}, shape=box{_style(OK)}];"
    for arrow in chart.arrows:
        wide = 1 if arrow.state in (OK, UNEXPECTED) else 2
        style = STYLES.get(arrow.state, "solid")
        colour = COLOURS[arrow.state][1]
        attributes = f'color="{colour}", style={style}, penwidth={wide}'
        yield f"  {arrow.start} -> {arrow.end} [{attributes}];"


def _node(node: DrawnNode) -> str:
    return f"[label={_quoted(node.name)}, shape=box{_style(node.state)}]"


def _name(name: DrawnName) -> str:
    text = f"{counted(len(name.merged), name.kind)} without a client" if name.merged else name.name
    return f"[label={_quoted(text)}, shape={SHAPES[name.kind]}{_style(name.state)}]"


def _style(state: str) -> str:
    fill, line, text = COLOURS[state]
    style = f"filled,{STYLES.get(state, 'solid')}"
    return f', style="{style}", fillcolor="{fill}", color="{line}", fontcolor="{text}"'


def _quoted(text: str) -> str:
    """A quoted string, safe from the entities and escapes of dot."""
    safe = visible(text).replace("&", "&amp;").replace("\\", "\\\\").replace('"', '\\"')
    return f'"{safe}"'
