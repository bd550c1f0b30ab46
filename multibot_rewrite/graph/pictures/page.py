"""The scene as one HTML file without external resources; the same input gives the same bytes."""

from __future__ import annotations

import base64
import hashlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from itertools import groupby

from multibot_rewrite.findings.finding import ERROR
from multibot_rewrite.graph.pictures.explanations import explanations, rule_link
from multibot_rewrite.graph.pictures.overview import Tile, overview
from multibot_rewrite.graph.pictures.page_sections import (
    LEVELS,
    SMALL_FLEET,
    PageSection,
    ids_in,
    ids_of,
    link_to,
    make_ids,
    make_sections,
    summarize,
)
from multibot_rewrite.graph.pictures.scene import FindingRow, Scene
from multibot_rewrite.graph.pictures.simplify import only_common
from multibot_rewrite.graph.pictures.states import MISSING, STATES
from multibot_rewrite.graph.pictures.svg import MEANINGS, Ids, group_svg, safe, tree_svg
from multibot_rewrite.graph.pictures.text import counted
from multibot_rewrite.graph.pictures.tf_tree_rows import FrameTree
from multibot_rewrite.graph.snapshot import QUIET, ZENOH
from multibot_rewrite.graph.watching import Verdict
from multibot_rewrite.graph.wording import SEVERAL, shorten
from multibot_rewrite.naming import LAYOUTS

# The heading for a verdict, and its CSS class.
VERDICTS = {
    Verdict.PLANNED: ("as planned", "good"),
    Verdict.INCONCLUSIVE: ("inconclusive", "unsure"),
    Verdict.WRONG: ("not as planned", "bad"),
}
NOTHING = (
    "No faults were found, but the view of the graph may be incomplete.",
    "No faults: everything planned is in the graph, and no name leaks.",
)
# So many robots without faults are folded together.
MANY_HEALTHY = 12


def to_html(scene: Scene) -> bytes:
    """The page."""
    css, js = _asset("page.css"), _asset("page.js")
    policy = (
        f"default-src 'none'; style-src '{_hash(css)}'; script-src '{_hash(js)}';"
        " base-uri 'none'; form-action 'none'"
    )
    ids, sections = make_ids(scene), make_sections(scene)
    parts = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{safe(_title(scene))}</title>\n<style>{css}</style>\n</head>\n<body>\n",
        *_header(scene),
        "<main>\n",
        *_findings(scene, ids, sections),
        *explanations(row.finding.code for row in scene.rows),
        *_graphs(scene, ids, sections),
        *_trees(scene, ids),
        *_environment(scene),
        f"</main>\n<script>{js}</script>\n</body>\n</html>\n",
    )
    return "".join(parts).encode()


@cache
def _asset(name: str) -> str:
    return files(__package__).joinpath(name).read_text("utf-8")


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _title(scene: Scene) -> str:
    robots = counted(len(scene.robots), "robot")
    return f"{VERDICTS[scene.verdict][0]}: {robots}, layout {scene.layout}"


def _header(scene: Scene) -> Iterator[str]:
    verdict, css_class = VERDICTS[scene.verdict]
    about = next((one.about for one in LAYOUTS if scene.layout in (one.name, one.short)), "")
    nodes = {n.name for g in scene.groups for n in g.nodes if not n.is_robot and n.state != MISSING}
    facts = (
        summarize(Counter(finding.level for finding in scene.findings)) or "no findings",
        f"{counted(len(scene.robots), 'robot')}: {shorten(scene.robots, SEVERAL)}",
        counted(len(nodes), "node"),
        f"layout {scene.layout}{f': {about}' if about else ''}",
    )
    yield f'<header class="{css_class}">\n<p>multibot check</p>\n<h1>{verdict}</h1>\n<ul>'
    yield "".join(f"<li>{safe(fact)}</li>" for fact in facts)
    yield "</ul>\n"
    for caveat in scene.environment.caveats:
        if caveat.incomplete:
            yield f'<p class="doubt">{safe(caveat.message)}</p>\n'
    yield "</header>\n"


def _findings(scene: Scene, ids: Ids, sections: Sequence[PageSection]) -> Iterator[str]:
    yield '<section id="findings">\n<h2>Findings</h2>\n'
    if not scene.findings:
        yield f'<p class="none">{NOTHING[scene.verdict == Verdict.PLANNED]}</p>\n'
    else:
        yield from _filters(scene)
        heads = "".join(
            f"<th>{head}</th>"
            for head in ("level", "code", "robot", "node", "message and likely cause")
        )
        yield f'<div class="wide"><table><thead><tr>{heads}</tr></thead>\n<tbody>\n'
        order = {robot: at for at, robot in enumerate(scene.robots)}
        inside = {one.group.robot: (one.id, ids_in(one, ids)) for one in sections}
        for row in scene.rows:
            targets = ids_of(row.targets, ids)
            yield _row(row, order, targets, link_to(row.finding, targets, inside))
        yield "</tbody></table></div>\n"
    yield "</section>\n"


def _filters(scene: Scene) -> Iterator[str]:
    """The filters, which the script shows because they need it."""
    found = {finding.robot for finding in scene.findings}
    robots = [(str(at), name) for at, name in enumerate(scene.robots) if name in found]
    if found - set(scene.robots):
        robots.append(("-1", "no robot"))
    levels = [level for level in LEVELS if any(f.level == level for f in scene.findings)]
    yield '<p id="filters" hidden>'
    yield _select("level", "all levels", [(level, level) for level in levels])
    yield _select("robot", "all robots", robots)
    yield '<output aria-live="polite"></output></p>\n'


def _select(name: str, default: str, options: Iterable[tuple[str, str]]) -> str:
    inner = "".join(f'<option value="{value}">{safe(text)}</option>' for value, text in options)
    first = f'<option value="">{default}</option>'
    return f'<label>{name} <select name="{name}">{first}{inner}</select></label> '


def _row(row: FindingRow, order: Mapping[str, int], targets: Iterable[str], link: str) -> str:
    finding = row.finding
    robots = (finding.robot, *finding.others)
    numbers = " ".join(str(order.get(robot, -1)) for robot in robots)
    hint = f"<small>{safe(finding.hint)}</small>" if finding.hint else ""
    level, who = safe(finding.level), safe(shorten(robots))
    node = safe(finding.node or "show")
    return (
        f'<tr data-level="{level}" data-robot="{numbers}" data-hits="{" ".join(targets)}">'
        f'<td><b class="level {level}">{level}</b></td>'
        f'<td><a class="rule" href="{rule_link(finding.code)}">{safe(finding.code)}</a></td>'
        f'<td title="{safe(", ".join(robots))}">{who}</td>'
        f'<td><a class="place" href="{link}"><code>{node}</code></a></td>'
        f"<td>{safe(finding.message)}{hint}</td></tr>\n"
    )


def _graphs(scene: Scene, ids: Ids, sections: Sequence[PageSection]) -> Iterator[str]:
    yield '<section id="graph">\n<h2>Robots</h2>\n'
    tiles = [_tile(section) for section in sections if section.group.robot]
    shared = [node.name for node in sections[-1].group.nodes if not (node.robot or node.is_robot)]
    yield f"{overview(tiles, scene.crossings, shared)}\n"
    yield '<input type="checkbox" id="more"><label for="more">show what every node has:'
    yield " parameters, life cycle, /rosout, tf, the topics and services of actions</label>\n"
    yield f'<ul class="legend">{"".join(_legend())}</ul>\n<div class="groups">\n'
    healthy = [section for section in sections if section.group.robot and not section.faulty]
    hidden = healthy if len(healthy) >= MANY_HEALTHY else []
    hidden_ids = {section.id for section in hidden}
    for section in sections:
        if section.id not in hidden_ids:
            yield from _group(section, ids)
    if hidden:
        title = f"{counted(len(hidden), 'more robot')} as planned"
        yield f'<details><summary class="good"><b>{title}</b></summary>\n<div>\n'
        yield from (line for section in hidden for line in _group(section, ids))
        yield "</div></details>\n"
    yield "</div>\n</section>\n"


def _legend() -> Iterator[str]:
    for state in STATES:
        yield f'<li class="{state}">{safe(MEANINGS[state])}</li>'


def _tile(section: PageSection) -> Tile:
    robot = section.group.robot
    nodes = counted(sum(node.robot == robot for node in section.group.nodes), "node")
    # Without findings of its own, only another robot's node makes a robot faulty.
    note = summarize(section.levels) or ("used by another robot" if section.faulty else nodes)
    return Tile(robot, robot, note, f"#{section.id}", _css_class(section))


def _css_class(section: PageSection) -> str:
    return "bad" if section.levels[ERROR] else "odd" if section.faulty else "good"


def _group(section: PageSection, ids: Ids) -> Iterator[str]:
    title = section.group.robot or "shared and others"
    nodes = counted(sum(not node.is_robot for node in section.group.nodes), "node")
    counts = f"{nodes}, {counted(len(section.group.names), 'name')}"
    findings = summarize(section.levels)
    opened = " open" if section.open else ""
    yield f'<details id="{section.id}"{opened}><summary class="{_css_class(section)}">'
    yield f"<b>{safe(title)}</b> <span>{counts}</span> <em>{findings}</em></summary>\n"
    yield f"<div>{group_svg(section.shown, ids, f'{section.id}-')}</div>\n"
    more = only_common(section.group)
    if more.edges:
        yield f'<div class="more">{group_svg(more, ids, "")}</div>\n'
    yield "</details>\n"


def _trees(scene: Scene, ids: Ids) -> Iterator[str]:
    yield '<section id="tf">\n<h2>tf</h2>\n'
    if not scene.trees:
        yield '<p class="none">No tf messages were received.</p>\n'
    for topic, trees in groupby(scene.trees, key=lambda tree: tree.topic):
        static = "/".join("tf_static" if word == "tf" else word for word in topic.split("/"))
        yield f"<h3>{safe(topic)} <span>and {safe(static)}</span></h3>\n"
        yield '<div class="trees">\n'
        for tree in trees:
            yield _panel(tree, scene, ids)
        yield "</div>\n"
    yield "</section>\n"


def _panel(tree: FrameTree, scene: Scene, ids: Ids) -> str:
    frames = counted(len({row.frame for row in tree.rows}), "frame")
    wrong = any(row.faults for row in tree.rows)
    title = f"<b>{safe(tree.robot or 'no robot')}</b> <span>{frames}</span>"
    if not tree.received:
        title += " <em>declared, not received</em>"
    opened = " open" if wrong or len(scene.robots) <= SMALL_FLEET else ""
    css_class = "bad" if wrong else "good" if tree.received else "odd"
    return (
        f'<details{opened}><summary class="{css_class}">{title}</summary>\n'
        f'<div class="wide">{tree_svg(tree, scene.robots, ids)}</div></details>\n'
    )


def _environment(scene: Scene) -> Iterator[str]:
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
