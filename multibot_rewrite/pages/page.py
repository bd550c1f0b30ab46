# SPDX-License-Identifier: Apache-2.0
"""The scene as one HTML file without external resources; the same input gives the same bytes."""

import base64
import hashlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from html import escape
from importlib.resources import files
from itertools import groupby
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, Rule
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.live.watching import Verdict
from multibot_rewrite.pages.finding_list import Sources, explanations, filters, finding_list
from multibot_rewrite.pages.overview import Tile, overview
from multibot_rewrite.pages.page_sections import (
    LEVELS,
    MOST_DRAWN,
    SMALL_FLEET,
    PageSection,
    css_class_of,
    make_ids,
    make_sections,
    only_common,
    robot_cards,
    summarize,
)
from multibot_rewrite.pages.scene import Scene
from multibot_rewrite.pages.states import MISSING, OK, STATES, UNEXPECTED, FrameTree
from multibot_rewrite.pages.svg import MEANINGS, Ids, group_svg, safe, tree_svg
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.records import QUIET, ZENOH

# The CSS class of a verdict; a good one with findings is not drawn as good.
LOOKS = {Verdict.PLANNED: "good", Verdict.INCONCLUSIVE: "unsure", Verdict.WRONG: "bad"}
NO_SNIPPETS: Mapping[str, Sequence[str]] = {}


class Framed(NamedTuple):
    """A page within the page: its HTML, and what its policy lets it use.

    The outer page has to allow that too. W3C, Content Security Policy Level 3, 7.8: a frame of
    ``srcdoc`` inherits the policy."""

    html: str
    styles: str
    scripts: str


def to_html(
    scene: Scene,
    rules: Mapping[str, Rule] = RULES,
    snippets: Mapping[str, Sequence[str]] = NO_SNIPPETS,
    robots: Framed | None = None,
) -> bytes:
    """Return the page, with ``snippets`` of files by ``file:line``, and ``robots`` below its head."""
    css, js = _asset_text("page.css"), _asset_text("page.js") + _asset_text("zoom.js")
    # Nothing but what is in the page.
    style, script, images, frame = source_hash(css), source_hash(js), "", ""
    if robots is not None:
        style, script = f"{style} {robots.styles}", f"{script} {robots.scripts}"
        inner = f'sandbox="allow-scripts" srcdoc="{escape(robots.html)}"'
        frame = f'<iframe title="the robots in 3D" {inner}></iframe>'
        frame = f'<section id="robots">\n<h2>The robots</h2>\n{frame}\n</section>\n'
        images = " img-src data: blob:;"
    policy = (
        f"default-src 'none'; style-src {style};{images} script-src {script};"
        " base-uri 'none'; form-action 'none'"
    )
    ids, sections = make_ids(scene), make_sections(scene)
    title = f"{scene.outcome.words}: {plural(len(scene.robots), 'robot')}, layout {scene.layout}"
    drawings = [graphs(scene, ids, sections), trees(scene, ids)]
    # A tf tree with faults is above the nodes.
    if any(row.faults for tree in scene.trees for row in tree.rows):
        drawings.reverse()
    parts = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{safe(title)}</title>\n<style>{css}</style>\n</head>\n<body>\n",
        *_header_html(scene, sections, rules),
        "<main>\n",
        frame,
        *filters(scene),
        *finding_list(scene, ids, sections, Sources(rules, snippets)),
        *(line for drawing in drawings for line in drawing),
        *explanations((row.finding.code for row in scene.rows), rules),
        *_environment_html(scene),
        f"</main>\n<script>{js}</script>\n</body>\n</html>\n",
    )
    return "".join(parts).encode()


@cache
def _asset_text(name: str) -> str:
    return files(__package__).joinpath(name).read_text("utf-8")


def source_hash(text: str) -> str:
    """Return the hash of a style or script as a content policy has it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _header_html(
    scene: Scene, sections: Sequence[PageSection], rules: Mapping[str, Rule]
) -> Iterator[str]:
    about = next((one.about for one in LAYOUTS if scene.layout in (one.name, one.short)), "")
    layout = "layout" if scene.outcome.planned else "looks like layout"
    # The count that the command prints, and in how many rows it is shown.
    levels = Counter(finding.level for finding in scene.findings)
    rows = f" in {plural(len(scene.rows), 'row')}" if len(scene.rows) < len(scene.findings) else ""
    told = summarize(levels) or plural(levels[NOTE], "note") * bool(levels[NOTE])
    # It is good only where nothing below says otherwise.
    verdict = scene.outcome.verdict
    doubtful = any(row.finding.level in LEVELS for row in scene.rows)
    look = LOOKS[Verdict.INCONCLUSIVE if verdict == Verdict.PLANNED and doubtful else verdict]
    facts = (
        f"{told}{rows}" if told else "no findings",
        f"{plural(len(scene.robots), 'robot')}: {shorten(scene.robots, SEVERAL)}",
        scene.coverage.in_words,
        f"{layout} {scene.layout}{f': {about}' if about else ''}",
    )
    yield f'<header class="{look}">\n<p>{safe(scene.outcome.by)}</p>\n'
    yield f"<h1>{safe(scene.outcome.words)}</h1>\n<ul>"
    yield "".join(f"<li>{safe(fact)}</li>" for fact in facts)
    yield "</ul>\n"
    caveats = (it.message for it in scene.environment.caveats if it.incomplete)
    for reason in dict.fromkeys((*caveats, *scene.outcome.reasons)):
        yield f'<p class="doubt">{safe(reason)}</p>\n'
    yield from robot_cards(scene, sections, rules)
    yield "</header>\n"


def _environment_html(scene: Scene) -> Iterator[str]:
    around = scene.environment
    why = "no more changes" if around.settled == QUIET else around.settled
    server = around.discovery_server or "none"
    ways = (
        ("discovery range", around.range),
        ("static peers", " ".join(around.static_peers) or "none"),
        ("discovery server", f"{server}{', super client' if around.super_client else ''}"),
    )
    rows = (
        ("domain", str(around.domain)),
        ("RMW", around.rmw),
        *((("router", server),) if around.rmw == ZENOH else ways),
        ("participants", str(around.participants)),
        ("observed for", f"{around.seconds:.1f} s ({why})"),
    )
    yield '<section id="environment">\n<h2>Environment</h2>\n<dl>'
    yield "".join(f"<div><dt>{key}</dt><dd>{safe(value)}</dd></div>" for key, value in rows)
    yield "</dl>\n"
    for caveat in around.caveats:
        kind = "incomplete" if caveat.incomplete else "note"
        yield f'<p class="{kind}"><b>{kind}</b> {safe(caveat.message)}</p>\n'
    yield "</section>\n"


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
    """Yield the overview, if something crosses, and a group for each robot."""
    yield '<section id="graph">\n<h2>Nodes and names</h2>\n'
    met = {robot for it in scene.crossings for robot in (it.source, it.target)}
    tiles = []
    for section in (it for it in sections if it.group.robot in met - {""}):
        robot = section.group.robot
        nodes = plural(sum(node.robot == robot for node in section.group.nodes), "node")
        # Without findings of its own, only another robot's node makes a robot faulty.
        note = summarize(section.levels) or ("used by another robot" if section.faulty else nodes)
        tiles.append(Tile(robot, robot, note, f"#{section.id}", css_class_of(section)))
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
            yield from _group_html(section, scene, ids)
    if hidden:
        title = f"{plural(len(hidden), 'more robot')} without findings"
        yield f'<details><summary class="good"><b>{title}</b></summary>\n<div>\n'
        yield from (line for section in hidden for line in _group_html(section, scene, ids))
        yield "</div></details>\n"
    yield "</div>\n</section>\n"


def _pane(drawing: str, css_class: str = "") -> str:
    """Return the element for a drawing that may be wider than the page."""
    return f'<div class="frame{css_class}"><div class="pane">{drawing}</div></div>\n'


def _legend(scene: Scene) -> Iterator[str]:
    """Yield the states that are drawn."""
    drawn = {node.state for group in scene.groups for node in group.nodes}
    drawn |= {edge.state for group in scene.groups for edge in group.edges}
    for state in STATES:
        if state in drawn:
            meaning = MEANINGS if scene.outcome.planned else UNPLANNED
            yield f'<li class="{state}">{safe(meaning[state])}</li>'


def _group_html(section: PageSection, scene: Scene, ids: Ids) -> Iterator[str]:
    title = section.group.robot or "shared and others"
    nodes = plural(sum(not node.is_robot for node in section.group.nodes), "node")
    counts = f"{nodes}, {plural(len(section.group.names), 'name')}"
    findings = summarize(section.levels)
    opened = " open" if section.open else ""
    number = section.id[1:] if section.group.robot else "-1"
    yield f'<details class="group" id="{section.id}" data-robot="{number}"{opened}>'
    yield f'<summary class="{css_class_of(section)}">'
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
    """Yield the groups of nodes of which one runs, as far as they are of this robot."""
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
    """Yield a tree for each robot on each tf topic."""
    yield '<section id="tf">\n<h2>tf</h2>\n'
    if not scene.trees:
        yield '<p class="none">No tf messages were received.</p>\n'
    for topic, found in groupby(scene.trees, key=lambda tree: tree.topic):
        static = "/".join("tf_static" if word == "tf" else word for word in topic.split("/"))
        yield f"<h3>{safe(topic)} <span>and {safe(static)}</span></h3>\n"
        yield '<div class="trees">\n'
        for tree in found:
            yield _tree_panel(tree, scene, ids)
        yield "</div>\n"
    yield "</section>\n"


def _tree_panel(tree: FrameTree, scene: Scene, ids: Ids) -> str:
    frames = plural(len({row.frame for row in tree.rows}), "frame")
    wrong = any(row.faults for row in tree.rows)
    title = f"<b>{safe(tree.robot or 'no robot')}</b> <span>{frames}</span>"
    if not tree.received:
        title += " <em>declared, not received</em>"
    opened = " open" if wrong or len(scene.robots) <= SMALL_FLEET else ""
    css_class = "bad" if wrong else "good" if tree.received else "odd"
    # What the filter knows a robot by.
    number = scene.robots.index(tree.robot) if tree.robot in scene.robots else -1
    return (
        f'<details class="group" data-robot="{number}"{opened}>'
        f'<summary class="{css_class}">{title}</summary>\n'
        f"{_pane(tree_svg(tree, scene.robots, ids))}</details>\n"
    )
