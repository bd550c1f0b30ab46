"""SVG of a group and of a tf tree. Looks are in page.css: only places and states are written here."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from html import escape
from typing import NamedTuple

from multibot_rewrite.graph.pictures.layout import OFFERS, Layout, lay_out
from multibot_rewrite.graph.pictures.marks import (
    CLASH,
    CROSS_TALK,
    LEAK,
    MISSING,
    OK,
    TROUBLE,
    UNEXPECTED,
    FrameKey,
)
from multibot_rewrite.graph.pictures.outlines import Outline
from multibot_rewrite.graph.pictures.scene import Group, Name, Node
from multibot_rewrite.graph.pictures.text import clipped, columns, counted, visible
from multibot_rewrite.remap.records import ACTION, SERVICE

# What a state means, in a few words.
MEANING = {
    OK: "as planned",
    LEAK: "leak: a robot's node has a name that is no robot's",
    CROSS_TALK: "cross-talk: a robot's node has another robot's name",
    CLASH: "clash: two of one name, types or QoS that do not meet",
    MISSING: "planned and not there",
    UNEXPECTED: "not in the plan, or odd",
}
WIDTH = 1180
# Left edge and width of the three columns.
LEFT, MIDDLE, RIGHT = (2, 290), (375, 430), (888, 290)
NODE_HIGH, NAME_HIGH = 26, 19
# A column of the 12 px fixed-width font is 7.3 px at most.
LETTER, MARGIN = 7.3, 18
HEADS = ("publishes, serves", "topics, services, actions", "subscribes, calls")
BADGES = {SERVICE: "srv", ACTION: "act"}
TREE_ROW, INDENT = 26, 20


class Ids(NamedTuple):
    """Short names of the parts for the page's script; ``anchors`` are those that links lead to."""

    nodes: Mapping[str, str]
    names: Mapping[str, str]
    frames: Mapping[FrameKey, str]
    anchors: frozenset[str]


def safe(text: str) -> str:
    """Text as it may stand in HTML, between tags or in quotes."""
    return escape(visible(text))


def told(*lines: str) -> str:
    """What is shown where the pointer rests."""
    return f"<title>{chr(10).join(map(safe, filter(None, lines)))}</title>"


def graph(group: Group, ids: Ids, prefix: str) -> str:
    """The picture of a group; ``prefix`` begins its anchors, there are none if it is empty."""
    place = lay_out(group)
    kinds = {counted(len(group.nodes), "node"), counted(len(group.names), "name")}
    label = safe(f"{group.robot or 'shared'}: {', '.join(sorted(kinds))}")
    parts = [
        f'<svg class="graph" viewBox="0 0 {WIDTH} {place.height + 4:.0f}" role="group"'
        f' aria-label="{label}">',
        *_heads(),
        *_edges(group, place, ids),
        *_boxes(group, place, ids, prefix),
        "</svg>",
    ]
    return "".join(parts)


def _heads() -> Iterator[str]:
    for (x, wide), text in zip((LEFT, MIDDLE, RIGHT), HEADS, strict=True):
        yield f'<text class="head" x="{x + wide / 2:g}" y="16">{text}</text>'


def _edges(group: Group, place: Layout, ids: Ids) -> Iterator[str]:
    """What is wrong is drawn last: on top."""
    left = {node.name: y for node, y in place.left}
    right = {node.name: y for node, y in place.right}
    names = {(name.kind, name.name): y for name, y in place.names}
    for edge in sorted(group.edges, key=lambda edge: edge.state in TROUBLE):
        there = names[edge.kind, edge.name]
        if edge.role in OFFERS:
            path = _curve(sum(LEFT), left[edge.node], MIDDLE[0], there)
        else:
            path = _curve(sum(MIDDLE), there, RIGHT[0], right[edge.node])
        joined = f"{ids.nodes.get(edge.node, '')} {ids.names.get(edge.name, '')}"
        yield f'<path class="e {edge.state}" data-e="{joined}" d="{path}"/>'


def _curve(x: int, y: float, to_x: int, to_y: float) -> str:
    bend = (x + to_x) // 2
    return f"M{x} {y:.0f}C{bend} {y:.0f} {bend} {to_y:.0f} {to_x} {to_y:.0f}"


def _boxes(group: Group, place: Layout, ids: Ids, prefix: str) -> Iterator[str]:
    told = set()
    for column, things in ((LEFT, place.left), (RIGHT, place.right)):
        for node, y in things:
            once = prefix if node.name not in told else ""
            told.add(node.name)
            yield _node(node, group.robot, column, y, _hook(ids.nodes.get(node.name), ids, once))
    for name, y in place.names:
        yield _name(name, group.robot, y, _hook(ids.names.get(name.name), ids, prefix))


def _hook(id_: str | None, ids: Ids, prefix: str) -> str:
    if id_ is None:
        return ""
    anchor = f' id="{prefix}{id_}"' if prefix and id_ in ids.anchors else ""
    return f' data-id="{id_}"{anchor}'


def _node(node: Node, robot: str, column: tuple[int, int], y: float, hook: str) -> str:
    x, wide = column
    foreign = " foreign" if node.robot != robot else ""
    return (
        f'<g class="n {node.state}{foreign}"{hook}>'
        f'<rect x="{x}" y="{y - NODE_HIGH / 2:g}" width="{wide}" height="{NODE_HIGH}" rx="5"/>'
        f'<text x="{x + 9}" y="{y + 4:g}">{_label(node.name, robot, wide - MARGIN)}</text>'
        f"{told(node.name, MEANING[node.state])}</g>"
    )


def _name(name: Name, robot: str, y: float, hook: str) -> str:
    x, wide = MIDDLE
    badge = BADGES.get(name.kind, "")
    many = counted(len(name.merged), name.kind)
    label = (
        safe(f"{many} nobody calls")
        if name.merged
        else _label(name.name, robot, wide - MARGIN - (26 if badge else 0))
    )
    shape = "2" if badge else f"{NAME_HIGH / 2:g}"
    end = f'<text class="badge" x="{x + wide - 7}" y="{y + 4:g}">{badge}</text>' if badge else ""
    return (
        f'<g class="t {name.state}"{hook}>'
        f'<rect x="{x}" y="{y - NAME_HIGH / 2:g}" width="{wide}" height="{NAME_HIGH}"'
        f' rx="{shape}"/><text x="{x + 10}" y="{y + 4:g}">{label}</text>{end}'
        f"{told(*_about(name))}</g>"
    )


def _about(name: Name) -> tuple[str, ...]:
    types = " and ".join(name.types)
    return name.merged or (f"{name.kind} {name.name}", types, MEANING[name.state])


def _label(name: str, robot: str, room: float) -> str:
    """A name that fits into ``room`` pixels, the robot's part of it dimmed."""
    text = visible(name)
    spaces = int(room / LETTER)
    for own in (f"/{robot}", f"_{robot}"):
        if robot and text.startswith(f"{own}/") and own[0] == "/":
            rest = clipped(text[len(own) :], spaces - columns(own))
            return f'<tspan class="dim">{escape(own)}</tspan>{escape(rest)}'
        if robot and text.endswith(own) and text != own:
            rest = clipped(text[: -len(own)], spaces - columns(own))
            return f'{escape(rest)}<tspan class="dim">{escape(own)}</tspan>'
    return escape(clipped(text, spaces))


def outline(found: Outline, robots: Iterable[str], ids: Ids) -> str:
    """A tf tree as an outline, the frames in the colours of their robots."""
    colours = {robot: f" c{at % 8}" for at, robot in enumerate(robots)}
    wide = max(_tree_end(row.frame, row.depth, row.words) for row in found.rows)
    high = len(found.rows) * TREE_ROW
    lines, boxes = [], []
    for at, row in enumerate(found.rows):
        x, y = 2 + row.depth * INDENT, at * TREE_ROW + TREE_ROW / 2
        if row.parent >= 0:
            top = row.parent * TREE_ROW + TREE_ROW - 3
            lines.append(f'<path class="branch" d="M{x - 10} {top}V{y:g}H{x}"/>')
        id_ = ids.frames.get((found.topic, row.frame))
        hook = _hook(id_, ids, "" if row.again else "tf-")
        boxes.append(_frame(row.frame, x, y, f"{row.state}{colours.get(row.robot, '')}", hook))
        notes = [*row.words, *(["static"] if row.static else []), *(["…"] if row.again else [])]
        after = x + columns(visible(row.frame)) * LETTER + 30
        bad = " bad" if row.words else ""
        note = safe(", ".join(notes))
        boxes.append(f'<text class="note{bad}" x="{after:.0f}" y="{y + 4:g}">{note}</text>')
    size = f'width="{wide:.0f}" height="{high}" viewBox="0 0 {wide:.0f} {high}"'
    return f'<svg class="tree" {size}>{"".join(lines)}{"".join(boxes)}</svg>'


def _frame(frame: str, x: float, y: float, looks: str, hook: str) -> str:
    text = visible(frame)
    wide = columns(text) * LETTER + 22
    return (
        f'<g class="f {looks}"{hook}><rect x="{x}" y="{y - 10:g}" width="{wide:.0f}" height="20"'
        f' rx="4"/><rect class="bar" x="{x}" y="{y - 10:g}" width="5" height="20" rx="2"/>'
        f'<text x="{x + 12}" y="{y + 4:g}">{escape(text)}</text></g>'
    )


def _tree_end(frame: str, depth: int, words: Iterable[str]) -> float:
    letters = columns(visible(frame)) + columns(", ".join((*words, "static, …")))
    return depth * INDENT + letters * LETTER + 60
