"""The scene as one HTML file: no network, no font from outside, the same bytes for the same input."""

from __future__ import annotations

import base64
import hashlib
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from importlib.resources import files
from itertools import groupby

from multibot_rewrite.graph.environment import listed
from multibot_rewrite.graph.pictures.lighter import rest
from multibot_rewrite.graph.pictures.marks import MISSING, STATES
from multibot_rewrite.graph.pictures.outlines import Outline
from multibot_rewrite.graph.pictures.overview import Tile, overview
from multibot_rewrite.graph.pictures.parts import (
    LEVELS,
    SMALL_FLEET,
    Part,
    drawn,
    hits_of,
    link_to,
    make_ids,
    make_parts,
    summary,
)
from multibot_rewrite.graph.pictures.scene import Scene
from multibot_rewrite.graph.pictures.svg import MEANING, Ids, graph, outline, safe
from multibot_rewrite.graph.pictures.text import counted
from multibot_rewrite.graph.rules.comparison import GraphFinding
from multibot_rewrite.graph.snapshot import QUIET
from multibot_rewrite.graph.watching import Verdict
from multibot_rewrite.model import ERROR
from multibot_rewrite.naming import LAYOUTS

# What a verdict is called, and how it looks.
VERDICTS = {
    Verdict.PLANNED: ("as planned", "good"),
    Verdict.INCONCLUSIVE: ("inconclusive", "unsure"),
    Verdict.WRONG: ("not as planned", "bad"),
}
NOTHING = (
    "Nothing wrong was found, but the view may be incomplete.",
    "Nothing is wrong: what is planned is there, and nothing leaks.",
)
# That many robots with nothing wrong are put away together.
MANY_CALM = 12


def to_html(scene: Scene) -> bytes:
    """The page."""
    css, js = _asset("page.css"), _asset("page.js")
    policy = (
        f"default-src 'none'; style-src '{_hash(css)}'; script-src '{_hash(js)}';"
        " base-uri 'none'; form-action 'none'"
    )
    ids, parts = make_ids(scene), make_parts(scene)
    pieces = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{safe(_title(scene))}</title>\n<style>{css}</style>\n</head>\n<body>\n",
        *_header(scene),
        "<main>\n",
        *_findings(scene, ids, parts),
        *_graphs(scene, ids, parts),
        *_trees(scene, ids),
        *_environment(scene),
        f"</main>\n<script>{js}</script>\n</body>\n</html>\n",
    )
    return "".join(pieces).encode()


@cache
def _asset(name: str) -> str:
    return files(__package__).joinpath(name).read_text("utf-8")


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _title(scene: Scene) -> str:
    robots = counted(len(scene.robots), "robot")
    return f"{VERDICTS[scene.verdict][0]}: {robots}, layout {scene.layout}"


def _header(scene: Scene) -> Iterator[str]:
    verdict, looks = VERDICTS[scene.verdict]
    about = next((one.about for one in LAYOUTS if scene.layout in (one.name, one.short)), "")
    nodes = {n.name for g in scene.groups for n in g.nodes if not n.whole and n.state != MISSING}
    facts = (
        summary(Counter(finding.level for finding in scene.findings)) or "no findings",
        f"{counted(len(scene.robots), 'robot')}: {listed(scene.robots)}",
        counted(len(nodes), "node"),
        f"layout {scene.layout}{f': {about}' if about else ''}",
    )
    yield f'<header class="{looks}">\n<p>multibot check</p>\n<h1>{verdict}</h1>\n<ul>'
    yield "".join(f"<li>{safe(fact)}</li>" for fact in facts)
    yield "</ul>\n"
    for caveat in scene.environment.caveats:
        if caveat.incomplete:
            yield f'<p class="doubt">{safe(caveat.message)}</p>\n'
    yield "</header>\n"


def _findings(scene: Scene, ids: Ids, parts: Sequence[Part]) -> Iterator[str]:
    yield '<section id="findings">\n<h2>Findings</h2>\n'
    if not scene.findings:
        yield f'<p class="none">{NOTHING[scene.verdict == Verdict.PLANNED]}</p>\n'
    else:
        yield from _filters(scene)
        heads = "".join(f"<th>{head}</th>" for head in ("level", "code", "robot", "node", "what"))
        yield f'<div class="wide"><table><thead><tr>{heads}</tr></thead>\n<tbody>\n'
        order = {robot: at for at, robot in enumerate(scene.robots)}
        there = {part.group.robot: (part.id, drawn(part, ids)) for part in parts}
        for finding, about in zip(scene.findings, scene.targets, strict=True):
            hits = hits_of(about, ids)
            link = link_to(finding, hits, there)
            yield _row(finding, order.get(finding.robot, -1), hits, link)
        yield "</tbody></table></div>\n"
    yield "</section>\n"


def _filters(scene: Scene) -> Iterator[str]:
    """Shown by the script, which they need."""
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


def _row(finding: GraphFinding, robot: int, hits: Iterable[str], link: str) -> str:
    cause = f"<small>{safe(finding.cause)}</small>" if finding.cause else ""
    level = safe(finding.level)
    return (
        f'<tr data-level="{level}" data-robot="{robot}" data-hits="{" ".join(hits)}">'
        f'<td><b class="level {level}">{level}</b></td>'
        f'<td><a href="{link}">{safe(finding.code)}</a></td>'
        f"<td>{safe(finding.robot)}</td><td><code>{safe(finding.node)}</code></td>"
        f"<td>{safe(finding.message)}{cause}</td></tr>\n"
    )


def _graphs(scene: Scene, ids: Ids, parts: Sequence[Part]) -> Iterator[str]:
    yield '<section id="graph">\n<h2>Robots</h2>\n'
    tiles = [_tile(part) for part in parts if part.group.robot]
    shared = [node.name for node in parts[-1].group.nodes if not (node.robot or node.whole)]
    yield f"{overview(tiles, scene.reaches, shared)}\n"
    yield '<input type="checkbox" id="more"><label for="more">also what every node has:'
    yield " parameters, life cycle, /rosout, tf, the inner parts of actions</label>\n"
    yield f'<ul class="legend">{"".join(_legend())}</ul>\n<div class="groups">\n'
    calm = [part for part in parts if part.group.robot and not part.wrong]
    hidden = calm if len(calm) >= MANY_CALM else []
    away = {part.id for part in hidden}
    for part in parts:
        if part.id not in away:
            yield from _group(part, ids)
    if hidden:
        title = f"{counted(len(hidden), 'more robot')} as planned"
        yield f'<details><summary class="good"><b>{title}</b></summary>\n<div>\n'
        yield from (line for part in hidden for line in _group(part, ids))
        yield "</div></details>\n"
    yield "</div>\n</section>\n"


def _legend() -> Iterator[str]:
    for state in STATES:
        yield f'<li class="{state}">{safe(MEANING[state])}</li>'


def _tile(part: Part) -> Tile:
    robot = part.group.robot
    nodes = counted(sum(node.robot == robot for node in part.group.nodes), "node")
    looks = "bad" if part.levels[ERROR] else "odd" if part.wrong else "good"
    reached = "reached into" if part.wrong else nodes
    return Tile(robot, robot, summary(part.levels) or reached, f"#{part.id}", looks)


def _group(part: Part, ids: Ids) -> Iterator[str]:
    title = part.group.robot or "shared and others"
    nodes = counted(sum(not node.whole for node in part.group.nodes), "node")
    words = f"{nodes}, {counted(len(part.group.names), 'name')}"
    told = summary(part.levels)
    looks = "bad" if part.levels[ERROR] else "odd" if part.wrong else "good"
    yield f'<details id="{part.id}"{" open" if part.open else ""}><summary class="{looks}">'
    yield f"<b>{safe(title)}</b> <span>{words}</span> <em>{told}</em></summary>\n"
    yield f"<div>{graph(part.light, ids, f'{part.id}-')}</div>\n"
    more = rest(part.group)
    if more.edges:
        yield f'<div class="more">{graph(more, ids, "")}</div>\n'
    yield "</details>\n"


def _trees(scene: Scene, ids: Ids) -> Iterator[str]:
    yield '<section id="tf">\n<h2>tf</h2>\n'
    if not scene.outlines:
        yield '<p class="none">No tf was heard.</p>\n'
    for topic, trees in groupby(scene.outlines, key=lambda one: one.topic):
        static = "/".join("tf_static" if word == "tf" else word for word in topic.split("/"))
        yield f"<h3>{safe(topic)} <span>and {safe(static)}</span></h3>\n"
        yield '<div class="trees">\n'
        for one in trees:
            yield _panel(one, scene, ids)
        yield "</div>\n"
    yield "</section>\n"


def _panel(one: Outline, scene: Scene, ids: Ids) -> str:
    frames = counted(len({row.frame for row in one.rows}), "frame")
    wrong = any(row.words for row in one.rows)
    title = f"<b>{safe(one.robot or 'no robot')}</b> <span>{frames}</span>"
    if not one.heard:
        title += " <em>declared, not heard</em>"
    opened = " open" if wrong or len(scene.robots) <= SMALL_FLEET else ""
    looks = "bad" if wrong else "good" if one.heard else "odd"
    return (
        f'<details{opened}><summary class="{looks}">{title}</summary>\n'
        f'<div class="wide">{outline(one, scene.robots, ids)}</div></details>\n'
    )


def _environment(scene: Scene) -> Iterator[str]:
    around = scene.environment
    why = "no change any more" if around.settled == QUIET else around.settled
    server = around.discovery_server or "none"
    rows = (
        ("domain", str(around.domain)),
        ("discovery range", around.range),
        ("static peers", " ".join(around.static_peers) or "none"),
        ("RMW", around.rmw),
        ("discovery server", f"{server}{', super client' if around.super_client else ''}"),
        ("participants", str(around.participants)),
        ("looked", f"{around.seconds:.1f} s ({why})"),
    )
    yield '<section id="environment">\n<h2>Environment</h2>\n<dl>'
    yield "".join(f"<div><dt>{key}</dt><dd>{safe(value)}</dd></div>" for key, value in rows)
    yield "</dl>\n"
    for caveat in around.caveats:
        kind = "incomplete" if caveat.incomplete else "note"
        yield f'<p class="{kind}"><b>{kind}</b> {safe(caveat.message)}</p>\n'
    yield "</section>\n"
