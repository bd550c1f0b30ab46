# SPDX-License-Identifier: Apache-2.0
"""The drawings on the page: who uses whose names, a group for each robot, the tf trees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from multibot_rewrite.base.wording import plural
from multibot_rewrite.pages.overview import Tile, overview
from multibot_rewrite.pages.page_sections import (
    MOST_DRAWN,
    SMALL_FLEET,
    PageSection,
    look_of,
    only_common,
    summarize,
)
from multibot_rewrite.pages.scene import Scene
from multibot_rewrite.pages.states import MISSING, OK, STATES, UNEXPECTED
from multibot_rewrite.pages.svg import MEANINGS, Ids, group_svg, safe, tree_svg
from multibot_rewrite.pages.tf_tree_rows import FrameTree

# What the states mean where there is no plan.
UNPLANNED = {
    **MEANINGS,
    OK: "nothing wrong seen",
    MISSING: "missing: something waits for it",
    UNEXPECTED: "a tool, or with a warning",
}
UNDRAWN = f"Not drawn: of a large fleet {MOST_DRAWN} robots are, those with findings first."
# So many robots without faults are folded together.
MANY_HEALTHY = 12


def graphs(scene: Scene, ids: Ids, sections: Sequence[PageSection]) -> Iterator[str]:
    """The overview where something crosses, and a group for each robot."""
    yield '<section id="graph">\n<h2>Nodes and names</h2>\n'
    met = {robot for it in scene.crossings for robot in (it.source, it.target)}
    tiles = [_tile(section) for section in sections if section.group.robot in met - {""}]
    shared = [node.name for node in sections[-1].group.nodes if not (node.robot or node.is_robot)]
    if scene.crossings:
        yield _pane(overview(tiles, scene.crossings, shared))
    yield '<input type="checkbox" id="more"><label for="more">show what every node has:'
    yield " parameters, life cycle, /rosout, tf, the topics and services of actions</label>\n"
    yield f'<ul class="legend">{"".join(_legend(scene))}</ul>\n<div class="groups">\n'
    healthy = [section for section in sections if section.group.robot and not section.faulty]
    hidden = healthy if len(healthy) >= MANY_HEALTHY else []
    hidden_ids = {section.id for section in hidden}
    for section in sections:
        if section.id not in hidden_ids:
            yield from _group(section, scene, ids)
    if hidden:
        title = f"{plural(len(hidden), 'more robot')} without findings"
        yield f'<details><summary class="good"><b>{title}</b></summary>\n<div>\n'
        yield from (line for section in hidden for line in _group(section, scene, ids))
        yield "</div></details>\n"
    yield "</div>\n</section>\n"


def _pane(drawing: str, css_class: str = "") -> str:
    """Room for a drawing that may be wider than the page."""
    return f'<div class="frame{css_class}"><div class="pane">{drawing}</div></div>\n'


def _legend(scene: Scene) -> Iterator[str]:
    """The states that are drawn."""
    drawn = {node.state for group in scene.groups for node in group.nodes}
    drawn |= {edge.state for group in scene.groups for edge in group.edges}
    for state in STATES:
        if state in drawn:
            meaning = MEANINGS if scene.outcome.planned else UNPLANNED
            yield f'<li class="{state}">{safe(meaning[state])}</li>'


def _tile(section: PageSection) -> Tile:
    robot = section.group.robot
    nodes = plural(sum(node.robot == robot for node in section.group.nodes), "node")
    # Without findings of its own, only another robot's node makes a robot faulty.
    note = summarize(section.levels) or ("used by another robot" if section.faulty else nodes)
    return Tile(robot, robot, note, f"#{section.id}", look_of(section))


def _number(scene: Scene, robot: str) -> str:
    """What the filter knows a robot by."""
    return str(scene.robots.index(robot) if robot in scene.robots else -1)


def _group(section: PageSection, scene: Scene, ids: Ids) -> Iterator[str]:
    title = section.group.robot or "shared and others"
    nodes = plural(sum(not node.is_robot for node in section.group.nodes), "node")
    counts = f"{nodes}, {plural(len(section.group.names), 'name')}"
    findings = summarize(section.levels)
    opened = " open" if section.open else ""
    number = section.id[1:] if section.group.robot else "-1"
    yield f'<details class="group" id="{section.id}" data-robot="{number}"{opened}>'
    yield f'<summary class="{look_of(section)}">'
    yield f"<b>{safe(title)}</b> <span>{counts}</span> <em>{findings}</em></summary>\n"
    yield from _alternatives(section, scene)
    if not section.drawn:
        yield f'<p class="one-of">{UNDRAWN}</p></details>\n'
        return
    yield _pane(group_svg(section.shown, ids, f"{section.id}-"))
    more = only_common(section.group)
    if more.edges:
        yield _pane(group_svg(more, ids, ""), " more")
    yield "</details>\n"


def _alternatives(section: PageSection, scene: Scene) -> Iterator[str]:
    """The groups of nodes of which one runs, as far as they are of this robot."""
    own = {node.name for node in section.group.nodes}
    for group in scene.one_of:
        if own.isdisjoint(group):
            continue
        running = [node for node in group if node in scene.running]
        css_class = "good" if len(running) == 1 else "bad"
        nodes = ", ".join(f"<code>{safe(node)}</code>" for node in group)
        verb = "runs" if len(running) < 2 else "run"
        state = f"{safe(', '.join(running) or 'none')} {verb}"
        yield f'<p class="one-of">one of {nodes}: <em class="{css_class}">{state}</em></p>\n'


def trees(scene: Scene, ids: Ids) -> Iterator[str]:
    """A tree for each robot on each tf topic."""
    yield '<section id="tf">\n<h2>tf</h2>\n'
    if not scene.trees:
        yield '<p class="none">No tf messages were received.</p>\n'
    for topic, found in groupby(scene.trees, key=lambda tree: tree.topic):
        static = "/".join("tf_static" if word == "tf" else word for word in topic.split("/"))
        yield f"<h3>{safe(topic)} <span>and {safe(static)}</span></h3>\n"
        yield '<div class="trees">\n'
        for tree in found:
            yield _panel(tree, scene, ids)
        yield "</div>\n"
    yield "</section>\n"


def _panel(tree: FrameTree, scene: Scene, ids: Ids) -> str:
    frames = plural(len({row.frame for row in tree.rows}), "frame")
    wrong = any(row.faults for row in tree.rows)
    title = f"<b>{safe(tree.robot or 'no robot')}</b> <span>{frames}</span>"
    if not tree.received:
        title += " <em>declared, not received</em>"
    opened = " open" if wrong or len(scene.robots) <= SMALL_FLEET else ""
    css_class = "bad" if wrong else "good" if tree.received else "odd"
    return (
        f'<details class="group" data-robot="{_number(scene, tree.robot)}"{opened}>'
        f'<summary class="{css_class}">{title}</summary>\n'
        f"{_pane(tree_svg(tree, scene.robots, ids))}</details>\n"
    )
