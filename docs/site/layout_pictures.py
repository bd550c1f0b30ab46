# SPDX-License-Identifier: Apache-2.0
"""Draws two robots in each layout: ``python docs/site/layout_pictures.py``.

What is drawn is what a build writes: the frames, the tf topic, the nodes and the topics of its plan.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape

from lxml import etree

from multibot_rewrite import load_fleet
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system import records

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "pictures"
ROVER = ROOT / "examples" / "launch_tutorial" / "rover.urdf"
ROBOTS = {"robot1": "#1f5fbf", "robot2": "#b4520a"}
# What a person looks for first; a plan has more.
SHOWN = ("cmd_vel", "odom", "scan", "joint_states")
COLUMN, GAP, MARGIN, ROW, INDENT = 232, 12, 12, 17, 12
BEFORE = "before"


class Robot(NamedTuple):
    """What is drawn of a robot: frames with their depth in the tree, and names."""

    link: str
    tf: str
    frames: tuple[tuple[str, int], ...]
    nodes: tuple[str, ...]
    topics: tuple[str, ...]


class Column(NamedTuple):
    """A robot, drawn."""

    drawn: str
    height: int


# Text, depth in a tree, kind.
Row = tuple[str, int, str]


def pictures() -> dict[str, str]:
    """Every picture, by its file name."""
    drawn = {f"layout-{it.name}.svg": picture(robots_in(it.name)) for it in LAYOUTS}
    bare = {name: without_name(it) for name, it in robots_in("tf-per-robot").items()}
    return {**drawn, f"layout-{BEFORE}.svg": picture(bare)}


def robots_in(layout: str) -> Mapping[str, Robot]:
    """Two robots of one description, as a build in that layout has them."""
    affix = "postfix" if layout == "postfix" else "prefix"
    fleet = load_fleet(
        {
            **{"layout": layout, "affix": affix, "node_sets": "robot_state", "distro": "jazzy"},
            **{"description": str(ROVER), "robots": [{"name": it} for it in ROBOTS]},
        }
    )
    plan = read_plan(fleet.text("plan.yaml").encode(), "plan.yaml")
    return {
        it.name: _robot(it, first_link(fleet.text(f"{it.name}/{ROVER.name}")), plan)
        for it in plan.robots
    }


def first_link(text: str) -> str:
    """Return the first link of a description."""
    return str(etree.fromstring(text.encode()).find("link").get("name"))


def _robot(planned: records.Robot, link: str, plan: records.System) -> Robot:
    name, nodes = planned.name, tuple(it.name for it in plan.nodes if it.robot == planned.name)
    ends = (it.name for it in plan.ends if it.node in nodes)
    bridged = (it.name for it in plan.topics)
    topics = dict.fromkeys(it for it in (*ends, *bridged) if name in it.split("/"))
    shown = [it for word in SHOWN for it in topics if set(it.split("/")) - {"", name} == {word}]
    odom = next(it for it in planned.other_frames if "odom" in it)
    frames = dict(zip(_links(), planned.frames, strict=True))
    tree = ((frames[link], depth) for link, depth in _depths())
    return Robot(link, planned.tf_topic, ((odom, 0), *tree), nodes, tuple(shown))


def _links() -> list[str]:
    return [str(it.get("name")) for it in etree.parse(ROVER).getroot().iter("link")]


def _depths() -> Iterator[tuple[str, int]]:
    """Each link with its depth below odom; a parent is declared before its children."""
    depths: dict[str, int] = {}
    parents = {
        str(it.find("child").get("link")): str(it.find("parent").get("link"))
        for it in etree.parse(ROVER).getroot().iter("joint")
    }
    for link in _links():
        depths[link] = depths.get(parents.get(link, ""), 0) + 1
        yield link, depths[link]


def without_name(robot: Robot) -> Robot:
    """Return the same before a rewrite: nothing has the name of a robot."""
    names = (robot.nodes, robot.topics)
    bare = (tuple(f"/{it.split('/', 2)[2]}" for it in them) for them in names)
    return Robot(robot.link, "/tf", robot.frames, *bare)


def picture(robots: Mapping[str, Robot]) -> str:
    """Return the robots beside each other, SVG; a name that both have is red where it is in the way."""
    first, second = robots.values()
    columns = [
        _column(name, robots[name], MARGIN + at * (COLUMN + GAP), other)
        for at, (name, other) in enumerate(zip(robots, (second, first), strict=True))
    ]
    width = 2 * (MARGIN + COLUMN) + GAP
    height = max(it.height for it in columns) + 2 * MARGIN
    lines = "\n".join(it.drawn for it in columns)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}"'
        f' font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="11.5">\n'
        f'<rect width="{width}" height="{height}" rx="8" fill="#f6f8fa"/>\n{lines}\n</svg>\n'
    )


def _column(name: str, robot: Robot, left: int, other: Robot) -> Column:
    rows = [
        (name, 0, "robot"),
        ("first link of the description", 0, "head"),
        (robot.link, 0, "own"),
        ("tf topic", 0, "head"),
        (robot.tf, 0, "shared" if robot.tf == other.tf else "own"),
        ("frames", 0, "head"),
        *((frame, depth, _kind(frame, robot, other)) for frame, depth in robot.frames),
        ("nodes", 0, "head"),
        *((it, 0, "clash" if it in other.nodes else "own") for it in robot.nodes),
        ("topics", 0, "head"),
        *((it, 0, "clash" if it in other.topics else "own") for it in robot.topics),
    ]
    heads = sum(kind == "head" for _, _, kind in rows)
    height = len(rows) * ROW + heads * 5 + ROW
    return Column("\n".join(_rows(rows, name, left, height)), height)


def _kind(frame: str, robot: Robot, other: Robot) -> str:
    """Return the same frame of two robots is in the way on one tf topic only."""
    same = frame in dict(other.frames) and robot.tf == other.tf
    return "clash" if same else "own"


def _rows(rows: list[Row], name: str, left: int, height: int) -> Iterator[str]:
    colour = ROBOTS[name]
    yield (
        f'<rect x="{left}" y="{MARGIN}" width="{COLUMN}" height="{height}" rx="6" fill="#fff"'
        f' stroke="{colour}"/>'
    )
    y = MARGIN
    for text, depth, kind in rows:
        y += ROW + (5 if kind == "head" else 0)
        x = left + 10 + depth * INDENT
        if depth:
            yield f'<path d="M{x - 8} {y - 13}v9h5" fill="none" stroke="#8c959f"/>'
        yield f'<text x="{x}" y="{y}" {_style(kind, colour)}>{_coloured(text, name, kind)}</text>'


def _style(kind: str, colour: str) -> str:
    styles = {
        "robot": f'fill="{colour}" font-weight="bold" font-size="13"',
        "head": 'fill="#59636e" font-size="10" font-family="sans-serif"',
        "clash": 'fill="#c4261d" font-weight="bold"',
        "shared": 'fill="#1f2328" font-weight="bold"',
    }
    return styles.get(kind, 'fill="#1f2328"')


def _coloured(text: str, name: str, kind: str) -> str:
    """Return the name of the robot in its colour, wherever it stands."""
    mark = f'<tspan fill="{ROBOTS[name]}" font-weight="bold">{name}</tspan>'
    return escape(text) if kind == "robot" else escape(text).replace(name, mark)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for file, drawn in pictures().items():
        (FOLDER / file).write_text(drawn)
    sys.exit()
