# SPDX-License-Identifier: Apache-2.0
"""SVG of a group and of a tf tree, with places and states only; page.css has colours and styles.

From left to right are publishers and servers, names, subscribers and clients. Lengths are pixels.
Names and nodes are ordered by barycenters: each moves towards the middle of what it is connected to,
which leaves few crossings. Faulty names are at the top."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import NamedTuple
from unicodedata import east_asian_width

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import plural
from multibot_rewrite.pages.scene import DrawnEdge, DrawnGroup, DrawnName, DrawnNode
from multibot_rewrite.pages.states import (
    CLASH,
    CROSS_TALK,
    FAULTY,
    LEAK,
    MISSING,
    OK,
    STATES,
    UNEXPECTED,
    FrameKey,
    FrameTree,
)
from multibot_rewrite.system.records import ACTION, PUBLISHES, SERVES, SERVICE

# What each state means, for the legend and the tooltips.
MEANINGS = {
    OK: "as planned",
    LEAK: "leak: a robot's node uses a name of no robot",
    CROSS_TALK: "cross-talk: a robot's node uses another robot's name",
    CLASH: "conflict: two nodes with one name, types or QoS that do not match",
    MISSING: "missing: in the plan, but not in the graph",
    UNEXPECTED: "not in the plan, or with a warning",
}
WIDTH = 1180
# Left edge and width of the three columns.
LEFT, MIDDLE, RIGHT = (2, 290), (375, 430), (888, 290)
NODE_HIGH, NAME_HIGH = 26, 19
# The width of a letter in the 12 px fixed-width font is 7.3 px at most.
LETTER, MARGIN = 7.3, 18
COLUMN_TITLES = ("publishes, serves", "topics, services, actions", "subscribes, calls")
TREE_ROW, INDENT = 26, 20


class Ids(NamedTuple):
    """Short ids for the page's script; ``anchors`` are those that are linked to."""

    nodes: Mapping[str, str]
    names: Mapping[str, str]
    frames: Mapping[FrameKey, str]
    anchors: frozenset[str]


def safe(text: str) -> str:
    """Return text for HTML, between tags or in quotes."""
    return escape(visible(text))


def tooltip(*lines: str) -> str:
    """Return the text that is shown under the mouse pointer."""
    return f"<title>{chr(10).join(map(safe, filter(None, lines)))}</title>"


def group_svg(group: DrawnGroup, ids: Ids, prefix: str) -> str:
    """Return the picture of a group; ``prefix`` comes before its anchors, empty for no anchors."""
    place = lay_out(group)
    kinds = {plural(len(group.nodes), "node"), plural(len(group.names), "name")}
    label = safe(f"{group.robot or 'shared'}: {', '.join(sorted(kinds))}")
    parts = [
        f'<svg class="graph" viewBox="0 0 {WIDTH} {place.height + 4:.0f}" role="group"'
        f' aria-label="{label}">',
        *(
            f'<text class="head" x="{x + wide / 2:g}" y="16">{text}</text>'
            for (x, wide), text in zip((LEFT, MIDDLE, RIGHT), COLUMN_TITLES, strict=True)
        ),
        *_edges_svg(group, place, ids),
        *_boxes_svg(group, place, ids, prefix),
        "</svg>",
    ]
    return "".join(parts)


def _edges_svg(group: DrawnGroup, place: "GroupLayout", ids: Ids) -> Iterator[str]:
    """Yield the edges, faulty ones last and so above the others."""
    left = {node.name: y for node, y in place.left}
    right = {node.name: y for node, y in place.right}
    names = {(name.kind, name.name): y for name, y in place.names}
    for edge in sorted(group.edges, key=lambda edge: edge.state in FAULTY):
        there = names[edge.kind, edge.name]
        if edge.role in OFFERING:
            x, y, to_x, to_y = sum(LEFT), left[edge.node], MIDDLE[0], there
        else:
            x, y, to_x, to_y = sum(MIDDLE), there, RIGHT[0], right[edge.node]
        bend = (x + to_x) // 2
        path = f"M{x} {y:.0f}C{bend} {y:.0f} {bend} {to_y:.0f} {to_x} {to_y:.0f}"
        joined = f"{ids.nodes.get(edge.node, '')} {ids.names.get(edge.name, '')}"
        yield f'<path class="e {edge.state}" data-e="{joined}" d="{path}"/>'


def _boxes_svg(group: DrawnGroup, place: "GroupLayout", ids: Ids, prefix: str) -> Iterator[str]:
    drawn = set()
    sides = ((LEFT, place.left), (RIGHT, place.right))
    for (x, wide), node, y in ((column, *it) for column, things in sides for it in things):
        anchors = prefix if node.name not in drawn else ""
        drawn.add(node.name)
        foreign = " foreign" if node.robot != group.robot else ""
        own = _id_attributes(ids.nodes.get(node.name), ids, anchors)
        label = _label(node.name, group.robot, wide - MARGIN)
        yield (
            f'<g class="n {node.state}{foreign}"{own}>'
            f'<rect x="{x}" y="{y - NODE_HIGH / 2:g}" width="{wide}" height="{NODE_HIGH}" rx="5"/>'
            f'<text x="{x + 9}" y="{y + 4:g}">{label}</text>'
            f"{tooltip(node.name, _state_meaning(node.state))}</g>"
        )
    for name, y in place.names:
        yield _name_box(name, group.robot, y, _id_attributes(ids.names.get(name.name), ids, prefix))


def _id_attributes(id_: str | None, ids: Ids, prefix: str) -> str:
    """Return the attributes by which the script finds a thing; ``prefix`` is that of an anchor."""
    if id_ is None:
        return ""
    anchor = f' id="{prefix}{id_}"' if prefix and id_ in ids.anchors else ""
    return f' data-id="{id_}"{anchor}'


def _name_box(name: DrawnName, robot: str, y: float, id_attributes: str) -> str:
    x, wide = MIDDLE
    badge = {SERVICE: "srv", ACTION: "act"}.get(name.kind, "")
    many = plural(len(name.merged), name.kind)
    label = (
        safe(f"{many} without a client")
        if name.merged
        else _label(name.name, robot, wide - MARGIN - (26 if badge else 0))
    )
    shape = "2" if badge else f"{NAME_HIGH / 2:g}"
    end = f'<text class="badge" x="{x + wide - 7}" y="{y + 4:g}">{badge}</text>' if badge else ""
    about = (f"{name.kind} {name.name}", " and ".join(name.types), _state_meaning(name.state))
    return (
        f'<g class="t {name.state}"{id_attributes}>'
        f'<rect x="{x}" y="{y - NAME_HIGH / 2:g}" width="{wide}" height="{NAME_HIGH}"'
        f' rx="{shape}"/><text x="{x + 10}" y="{y + 4:g}">{label}</text>{end}'
        f"{tooltip(*(name.merged or about))}</g>"
    )


def _state_meaning(state: str) -> str:
    return "" if state == OK else MEANINGS[state]


def _label(name: str, robot: str, width: float) -> str:
    """Return a name cut to ``width`` pixels, with the robot's name in it dimmed."""
    text = visible(name)
    spaces = int(width / LETTER)
    for own in (f"/{robot}", f"_{robot}"):
        if robot and text.startswith(f"{own}/") and own[0] == "/":
            rest = clipped(text[len(own) :], spaces - columns(own))
            return f'<tspan class="dim">{escape(own)}</tspan>{escape(rest)}'
        if robot and text.endswith(own) and text != own:
            rest = clipped(text[: -len(own)], spaces - columns(own))
            return f'{escape(rest)}<tspan class="dim">{escape(own)}</tspan>'
    return escape(clipped(text, spaces))


def tree_svg(found: FrameTree, robots: Iterable[str], ids: Ids) -> str:
    """Return a tf tree, with the frames in the colours of their robots."""
    colours = {robot: f" c{at % 8}" for at, robot in enumerate(robots)}
    high = len(found.rows) * TREE_ROW
    lines, boxes, ends = [], [], []
    for at, row in enumerate(found.rows):
        x, y = 2 + row.depth * INDENT, at * TREE_ROW + TREE_ROW / 2
        if row.parent >= 0:
            top = row.parent * TREE_ROW + TREE_ROW - 3
            lines.append(f'<path class="branch" d="M{x - 10} {top}V{y:g}H{x}"/>')
        id_ = ids.frames.get((found.topic, row.frame))
        id_attributes = _id_attributes(id_, ids, "" if row.repeated else "tf-")
        text = visible(row.frame)
        letters = columns(text) * LETTER
        boxes.append(
            f'<g class="f {row.state}{colours.get(row.robot, "")}"{id_attributes}>'
            f'<rect x="{x}" y="{y - 10:g}" width="{letters + 22:.0f}" height="20" rx="4"/>'
            f'<rect class="bar" x="{x}" y="{y - 10:g}" width="5" height="20" rx="2"/>'
            f'<text x="{x + 12}" y="{y + 4:g}">{escape(text)}</text></g>'
        )
        most = columns(text) + columns(", ".join((*row.faults, "static, …")))
        ends.append(row.depth * INDENT + most * LETTER + 60)
        notes = [*row.faults, *(["static"] if row.static else []), *(["…"] if row.repeated else [])]
        after = x + letters + 30
        bad = " bad" if row.faults else ""
        note = safe(", ".join(notes))
        boxes.append(f'<text class="note{bad}" x="{after:.0f}" y="{y + 4:g}">{note}</text>')
    wide = max(ends)
    size = f'width="{wide:.0f}" height="{high}" viewBox="0 0 {wide:.0f} {high}"'
    return f'<svg class="tree" {size}>{"".join(lines)}{"".join(boxes)}</svg>'


def visible(text: str) -> str:
    """Return ``text`` on one line; characters that are not printable are written as escapes."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def clipped(text: str, width: int) -> str:
    """Return ``text`` in at most ``width`` columns, cut in the middle: names differ at their ends."""
    if len(text) * 2 <= width or columns(text) <= width:
        return text
    back = _fitting(text[::-1], width // 2)[::-1]
    return f"{_fitting(text, width - 1 - columns(back))}…{back}"


def columns(text: str) -> int:
    """Return the width of ``text`` in a fixed-width font; East Asian letters are two columns wide."""
    if text.isascii():
        return len(text)
    return sum(2 if east_asian_width(c) in "WF" else 1 for c in text)


def _fitting(text: str, width: int) -> str:
    """Return the longest beginning of ``text`` that fits into ``width`` columns."""
    at = 0
    while at < len(text) and width > 0:
        width -= columns(text[at])
        at += width >= 0
    return text[:at]


ROW, NODE_ROW, TOP = 24, 34, 40
SWEEPS = 6
OFFERING = (PUBLISHES, SERVES)


class GroupLayout(NamedTuple):
    """The nodes and names of each column with their vertical middle, and the total height."""

    left: tuple[tuple[DrawnNode, float], ...]
    names: tuple[tuple[DrawnName, float], ...]
    right: tuple[tuple[DrawnNode, float], ...]
    height: float


_NameKey = tuple[str, str]


def lay_out(group: DrawnGroup) -> GroupLayout:
    """Return the layout of one group."""
    nodes = {node.name: node for node in group.nodes}
    offers = _names_by_node(edge for edge in group.edges if edge.role in OFFERING)
    uses = _names_by_node(edge for edge in group.edges if edge.role not in OFFERING)
    names = _ordered_names(group, offers, uses)
    height = max(len(names) * ROW, max(len(offers), len(uses)) * NODE_ROW)
    lead = (height - len(names) * ROW) / 2
    at = {key: lead + ROW * (rank + 0.5) for rank, key in enumerate(names)}
    left, right = _column(offers, at, height), _column(uses, at, height)
    idle = sorted(set(nodes) - set(left) - set(right))
    for rank, node in enumerate(idle):
        left[node] = height + NODE_ROW * (rank + 0.5)
    by_key = {(name.kind, name.name): name for name in group.names}
    return GroupLayout(
        tuple((nodes[node], TOP + y) for node, y in left.items()),
        tuple((by_key[key], TOP + y) for key, y in at.items()),
        tuple((nodes[node], TOP + y) for node, y in right.items()),
        TOP + height + NODE_ROW * len(idle),
    )


def _names_by_node(edges: Iterable[DrawnEdge]) -> dict[str, list[_NameKey]]:
    return lists_by_key((edge.node, (edge.kind, edge.name)) for edge in edges)


def _ordered_names(
    group: DrawnGroup,
    offers: Mapping[str, Sequence[_NameKey]],
    uses: Mapping[str, Sequence[_NameKey]],
) -> list[_NameKey]:
    """Return the names, the worst first, within the same state in an order with few crossings."""
    severity = {(name.kind, name.name): len(STATES) for name in group.names}
    for edge in group.edges:
        if edge.state in FAULTY:
            key = edge.kind, edge.name
            severity[key] = min(severity[key], STATES.index(edge.state))
    names = sorted(severity, key=lambda key: (severity[key], key))
    for _ in range(SWEEPS):
        rank = {key: float(at) for at, key in enumerate(names)}
        pulls: dict[_NameKey, list[float]] = defaultdict(list)
        for side in (offers, uses):
            for keys in side.values():
                middle = _mean([rank[key] for key in keys])
                for key in keys:
                    pulls[key].append(middle)
        names.sort(key=lambda key: (severity[key], _mean(pulls[key]), key))
    return names


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _column(
    joined: Mapping[str, Sequence[_NameKey]], at: Mapping[_NameKey, float], height: float
) -> dict[str, float]:
    """Return each node at the middle of its names, moved where two would overlap."""
    wish = {node: _mean([at[key] for key in keys]) for node, keys in joined.items()}
    order = sorted(wish, key=lambda node: (wish[node], node))
    places: dict[str, float] = {}
    low = -NODE_ROW / 2
    for node in order:
        low = places[node] = max(wish[node], low + NODE_ROW)
    high = height + NODE_ROW / 2
    for node in reversed(order):
        high = places[node] = min(places[node], high - NODE_ROW)
    return places
