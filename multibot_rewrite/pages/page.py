# SPDX-License-Identifier: Apache-2.0
"""The scene as one HTML file without external resources; the same input gives the same bytes."""

from __future__ import annotations

import base64
import hashlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from html import escape
from importlib.resources import files

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.live.watching import Verdict
from multibot_rewrite.pages.drawings import graphs, trees
from multibot_rewrite.pages.finding_list import Sources, explanations, filters, finding_list
from multibot_rewrite.pages.page_sections import (
    LEVELS,
    PageSection,
    make_ids,
    make_sections,
    summarize,
)
from multibot_rewrite.pages.robot_cards import robot_cards
from multibot_rewrite.pages.scene import Scene
from multibot_rewrite.pages.svg import Ids, safe
from multibot_rewrite.rules.check import RULES
from multibot_rewrite.system.coverage import in_words
from multibot_rewrite.system.records import QUIET, ZENOH

# The CSS class of a verdict; a good one with findings is not drawn as good.
LOOKS = {Verdict.PLANNED: "good", Verdict.INCONCLUSIVE: "unsure", Verdict.WRONG: "bad"}
NO_SNIPPETS: Mapping[str, Sequence[str]] = {}


class Framed(NamedTuple):
    """A page within the page: its HTML, and what its policy lets it use, which the outer one has to
    allow too. W3C, Content Security Policy Level 3, 7.8: a frame of ``srcdoc`` inherits the policy."""

    html: str
    styles: str
    scripts: str


def to_html(
    scene: Scene,
    rules: Mapping[str, Rule] = RULES,
    snippets: Mapping[str, Sequence[str]] = NO_SNIPPETS,
    robots: Framed | None = None,
) -> bytes:
    """The page; ``snippets`` are lines of files by ``file:line``, ``robots`` is below its head."""
    css, js = _asset("page.css"), _asset("page.js") + _asset("zoom.js")
    policy = _policy(source_hash(css), source_hash(js), robots)
    ids, sections = make_ids(scene), make_sections(scene)
    parts = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{safe(_title(scene))}</title>\n<style>{css}</style>\n</head>\n<body>\n",
        *_header(scene, sections, rules),
        "<main>\n",
        _frame(robots),
        *filters(scene),
        *finding_list(scene, ids, sections, Sources(rules, snippets)),
        *_drawings(scene, ids, sections),
        *explanations((row.finding.code for row in scene.rows), rules),
        *_environment(scene),
        f"</main>\n<script>{js}</script>\n</body>\n</html>\n",
    )
    return "".join(parts).encode()


def _drawings(scene: Scene, ids: Ids, sections: Sequence[PageSection]) -> Iterator[str]:
    """A tf tree with faults is above the nodes."""
    parts = [graphs(scene, ids, sections), trees(scene, ids)]
    wrong_tf = any(row.faults for tree in scene.trees for row in tree.rows)
    for part in reversed(parts) if wrong_tf else parts:
        yield from part


@cache
def _asset(name: str) -> str:
    return files(__package__).joinpath(name).read_text("utf-8")


def source_hash(text: str) -> str:
    """A style or script as a policy names it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _policy(style: str, script: str, robots: Framed | None) -> str:
    """Nothing but what is in the page."""
    end = "base-uri 'none'; form-action 'none'"
    if robots is None:
        return f"default-src 'none'; style-src {style}; script-src {script}; {end}"
    styles, scripts = f"{style} {robots.styles}", f"{script} {robots.scripts}"
    images = "img-src data: blob:"
    return f"default-src 'none'; style-src {styles}; {images}; script-src {scripts}; {end}"


def _frame(robots: Framed | None) -> str:
    if robots is None:
        return ""
    page = escape(robots.html)
    frame = f'<iframe title="the robots in 3D" sandbox="allow-scripts" srcdoc="{page}"></iframe>'
    return f'<section id="robots">\n<h2>The robots</h2>\n{frame}\n</section>\n'


def _title(scene: Scene) -> str:
    robots = plural(len(scene.robots), "robot")
    return f"{scene.outcome.words}: {robots}, layout {scene.layout}"


def _look(scene: Scene) -> str:
    """The CSS class of the head: good only where nothing below says otherwise."""
    verdict = scene.outcome.verdict
    doubtful = any(row.finding.level in LEVELS for row in scene.rows)
    return LOOKS[Verdict.INCONCLUSIVE if verdict == Verdict.PLANNED and doubtful else verdict]


def _count(scene: Scene) -> str:
    """The count that the command prints, and in how many rows it is shown."""
    levels = Counter(finding.level for finding in scene.findings)
    rows = f" in {plural(len(scene.rows), 'row')}" if len(scene.rows) < len(scene.findings) else ""
    told = summarize(levels) or plural(levels[NOTE], "note") * bool(levels[NOTE])
    return f"{told}{rows}" if told else "no findings"


def _header(
    scene: Scene, sections: Sequence[PageSection], rules: Mapping[str, Rule]
) -> Iterator[str]:
    about = next((one.about for one in LAYOUTS if scene.layout in (one.name, one.short)), "")
    layout = "layout" if scene.outcome.planned else "looks like layout"
    facts = (
        _count(scene),
        f"{plural(len(scene.robots), 'robot')}: {shorten(scene.robots, SEVERAL)}",
        in_words(scene.coverage),
        f"{layout} {scene.layout}{f': {about}' if about else ''}",
    )
    yield f'<header class="{_look(scene)}">\n<p>{safe(scene.outcome.by)}</p>\n'
    yield f"<h1>{safe(scene.outcome.words)}</h1>\n<ul>"
    yield "".join(f"<li>{safe(fact)}</li>" for fact in facts)
    yield "</ul>\n"
    caveats = (it.message for it in scene.environment.caveats if it.incomplete)
    for reason in dict.fromkeys((*caveats, *scene.outcome.reasons)):
        yield f'<p class="doubt">{safe(reason)}</p>\n'
    yield from robot_cards(scene, sections, rules)
    yield "</header>\n"


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
