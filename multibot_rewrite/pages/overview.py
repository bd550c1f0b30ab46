# SPDX-License-Identifier: Apache-2.0
"""The picture of the fleet: a box for each robot, an arrow where one uses another's names."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.base.wording import plural
from multibot_rewrite.pages.scene import Crossing
from multibot_rewrite.pages.states import FAULTY
from multibot_rewrite.pages.svg import LETTER, MEANINGS, WIDTH, clipped, safe, tooltip

# Space for the arrows above the first row and below the last one.
MARGIN = 44
# Up to so many robots: boxes in a row, width and height of a box, the gap below it.
SIZES = ((4, 4, 230, 58, 74), (30, 6, 160, 54, 60), (100_000, 10, 106, 40, 40))
# More shared nodes than this are one box; more arrows than this have no labels.
MOST_NODES, MOST_LABELS = 8, 12
OTHERS, NO_ROBOT = "other nodes", "names of no robot"


class Tile(NamedTuple):
    """A box: its key in a crossing, its title, a line below it, its link, its CSS class."""

    key: str
    title: str
    note: str
    link: str
    css_class: str


class _Box(NamedTuple):
    """Where a box is drawn, in pixels."""

    x: float
    y: float
    wide: float
    high: float


def overview(robots: Sequence[Tile], crossings: Sequence[Crossing], shared: Iterable[str]) -> str:
    """Return the picture of the robots; ``shared`` are the nodes of no robot."""
    below = list(_shared_tiles(crossings, list(shared)))
    _, in_row, _, tall, gap = next(it for it in SIZES if len(robots) <= it[0])
    middle = -(-len(robots) // in_row) * (tall + gap) if below else 0
    places = {**_boxes_in_rows(robots, 0), **_boxes_in_rows(below, middle)}
    tiles = (*robots, *below)
    high = max((box.y + box.high for box in places.values()), default=0.0) + MARGIN
    arrows, labels = [], []
    for crossing in sorted(crossings, key=lambda crossing: crossing.state in FAULTY):
        start = places.get(crossing.source or crossing.node) or places[OTHERS]
        path, x, y = _arrow_path(start, places[crossing.target or NO_ROBOT])
        faulty, names = crossing.state in FAULTY, crossing.names
        css_class, tip = ("bad", "tip-bad") if faulty else ("calm", "tip")
        who = crossing.source or crossing.node
        title = tooltip(f"{who}: {MEANINGS[crossing.state]}", *names)
        arrows.append(
            f'<path class="reach {css_class}" d="{path}" marker-end="url(#{tip})">{title}</path>'
        )
        if len(crossings) <= MOST_LABELS and crossing.target and faulty:
            first = clipped(names[0].partition(" ")[2], 40)
            text = safe(first if len(names) == 1 else plural(len(names), "name"))
            labels.append(f'<text class="reach-note" x="{x:g}" y="{y:g}">{text}</text>')
    # A few boxes are readable on a narrow screen.
    few = " few" if max(len(robots), len(below)) <= SIZES[0][0] else ""
    boxes = (_tile_svg(tile, places[tile.key]) for tile in tiles)
    return (
        f'<svg class="overview{few}" viewBox="0 0 {WIDTH} {high:g}" role="group"'
        ' aria-label="the fleet">'
        f"{_TIPS}{''.join((*arrows, *boxes, *labels))}</svg>"
    )


_TIPS = "<defs>{}</defs>".format(
    "".join(
        f'<marker id="{name}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7"'
        f' orient="auto"><path class="{name}" d="M0 0L8 4L0 8z"/></marker>'
        for name in ("tip", "tip-bad")
    )
)


def _shared_tiles(crossings: Sequence[Crossing], shared: Sequence[str]) -> Iterator[Tile]:
    """Yield boxes for the nodes of no robot, and for names of no robot that should belong to one."""
    if len(shared) > MOST_NODES:
        yield Tile(OTHERS, plural(len(shared), "other node"), "of no robot", "#shared", "shared")
    else:
        yield from (Tile(node, node, "of no robot", "#shared", "shared") for node in shared)
    leaked = dict.fromkeys(name for r in crossings if not r.target for name in r.names)
    if leaked:
        names = dict.fromkeys(name.partition(" ")[2] for name in leaked)
        yield Tile(NO_ROBOT, NO_ROBOT, ", ".join(names), "#shared", "bad")


def _boxes_in_rows(tiles: Sequence[Tile], top: float) -> dict[str, _Box]:
    # For so many robots the columns, and width, height and gap of the boxes.
    _, columns, wide, high, gap = next(it for it in SIZES if len(tiles) <= it[0])
    cell = WIDTH / min(columns, max(len(tiles), 1))
    return {
        tile.key: _Box(
            at % columns * cell + (cell - wide) / 2,
            MARGIN + top + at // columns * (high + gap),
            wide,
            high,
        )
        for at, tile in enumerate(tiles)
    }


def _tile_svg(tile: Tile, box: _Box) -> str:
    room = int((box.wide - 16) / LETTER)
    middle = f'x="{box.x + box.wide / 2:g}"'
    return (
        f'<a href="{safe(tile.link)}"><g class="tile {tile.css_class}">'
        f'<rect x="{box.x:g}" y="{box.y:g}" width="{box.wide:g}" height="{box.high:g}" rx="7"/>'
        f'<text class="title" {middle} y="{box.y + box.high * 0.44:g}">'
        f"{safe(clipped(tile.title, room))}</text>"
        f'<text class="note" {middle} y="{box.y + box.high * 0.8:g}">'
        f"{safe(clipped(tile.note, room))}</text>"
        f"{tooltip(tile.title, tile.note)}</g></a>"
    )


def _arrow_path(start: _Box, end: _Box) -> tuple[str, float, float]:
    """Return a curve from box to box, and its middle: x, y; two directions do not overlap."""
    x, to_x = start.x + start.wide / 2 + 12, end.x + end.wide / 2 - 12
    if start.y == end.y:
        y, bend = start.y, 46 if x < to_x else 26
        d = f"M{x:g} {y:g}C{x:g} {y - bend:g} {to_x:g} {y - bend:g} {to_x:g} {y:g}"
        return d, (x + to_x) / 2, y - bend * 0.75 + 4
    down = start.y < end.y
    y, to_y = (start.y + start.high, end.y) if down else (start.y, end.y + end.high)
    half = (to_y - y) / 2
    d = f"M{x:g} {y:g}C{x:g} {y + half:g} {to_x:g} {to_y - half:g} {to_x:g} {to_y:g}"
    return d, (x + to_x) / 2, (y + to_y) / 2
