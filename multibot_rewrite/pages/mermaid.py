"""The scene as a Mermaid flowchart, which GitHub and GitLab draw in Markdown."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

from multibot_rewrite.pages.chart import Chart, largest_fitting
from multibot_rewrite.pages.scene import DrawnName, Scene
from multibot_rewrite.pages.states import (
    CLASH,
    CROSS_TALK,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
)
from multibot_rewrite.pages.text import counted, visible
from multibot_rewrite.system.records import ACTION, SERVICE, TOPIC

# The limits of Mermaid (config.schema.yaml: maxEdges, maxTextSize).
MOST_EDGES, MOST_LETTERS = 500, 50_000
SHAPES = {TOPIC: ("([", "])"), SERVICE: ("[[", "]]"), ACTION: ("{{", "}}")}
# Fill, line, text: readable on a light and on a dark page.
COLOURS = {
    OK: ("#eef1f5", "#5d6979", "#1b2430"),
    LEAK: ("#fdecea", "#c4261d", "#7d1812"),
    CROSS_TALK: ("#fdecea", "#c4261d", "#7d1812"),
    CLASH: ("#f3ebfc", "#7a36c4", "#4f2380"),
    MISSING: ("#fdf3e0", "#96590a", "#6b3f07"),
    UNEXPECTED: ("#eaf1fa", "#2b66b1", "#1d4577"),
}
DASHED = {MISSING: ",stroke-dasharray:5 3", UNEXPECTED: ",stroke-dasharray:2 3"}
# Any other character may have a meaning in Mermaid and is written by its number.
_PLAIN = re.compile(r"[^\w/ .,:()~-]", re.ASCII)


def to_mermaid(scene: Scene) -> bytes:
    """The flowchart; for a large fleet with only as much in it as Mermaid draws."""
    return _text(largest_fitting(scene, _fits)).encode()


def _fits(chart: Chart) -> bool:
    return len(chart.arrows) <= MOST_EDGES and len(_text(chart)) <= MOST_LETTERS


def _text(chart: Chart) -> str:
    return "\n".join(_lines(chart)) + "\n"


def _lines(chart: Chart) -> Iterator[str]:
    yield "flowchart LR"
    yield f"  %% {chart.note}"
    for at, cluster in enumerate(chart.clusters):
        yield f'  subgraph g{at}["{_quoted(cluster.title)}"]'
        for id_, node in cluster.nodes:
            yield f'    {id_}["{_quoted(node.name)}"]:::{_class(node.state)}'
        for id_, name in cluster.names:
            start, end = SHAPES[name.kind]
            yield f'    {id_}{start}"{_quoted(_label(name))}"{end}:::{_class(name.state)}'
        yield "  end"
    for at, robot in enumerate(chart.healthy):
        yield f'  c{at}["{_quoted(robot)}"]:::ok'
    for arrow in chart.arrows:
        yield f"  {arrow.start} {'-.->' if arrow.state == MISSING else '-->'} {arrow.end}"
    yield from _style(chart)


def _style(chart: Chart) -> Iterator[str]:
    by_state: dict[str, list[str]] = defaultdict(list)
    for at, arrow in enumerate(chart.arrows):
        by_state[arrow.state].append(str(at))
    there = {node.state for it in chart.clusters for _, node in it.nodes}
    there |= {name.state for it in chart.clusters for _, name in it.names}
    for state, (fill, line, text) in COLOURS.items():
        if state == OK or state in there:
            dashes = DASHED.get(state, "")
            yield f"  classDef {_class(state)} fill:{fill},stroke:{line},color:{text}{dashes}"
        if state != OK and by_state[state]:
            wide = 1 if state == UNEXPECTED else 2
            yield f"  linkStyle {','.join(by_state[state])} stroke:{line},stroke-width:{wide}px"


def _class(state: str) -> str:
    return state.replace("-", "")


def _label(name: DrawnName) -> str:
    return f"{counted(len(name.merged), name.kind)} without a client" if name.merged else name.name


def _quoted(text: str) -> str:
    return _PLAIN.sub(lambda found: f"#{ord(found[0])};", visible(text))
