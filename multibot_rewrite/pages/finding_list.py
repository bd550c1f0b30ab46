# SPDX-License-Identifier: Apache-2.0
"""The findings on the page: what is the same for many robots is one, opened it says where and why."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, Rule
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.pages.page_sections import LEVELS, PageSection, ids_in, ids_of, link_to
from multibot_rewrite.pages.scene import FindingRow, Scene
from multibot_rewrite.pages.svg import Ids, safe


class Sources(NamedTuple):
    """What findings are explained with: the rules by code, and lines of files by ``file:line``."""

    rules: Mapping[str, Rule]
    snippets: Mapping[str, Sequence[str]]


def filters(scene: Scene) -> Iterator[str]:
    """Yield the HTML of the inputs that filter findings; hidden until the page's script runs."""
    levels = [level for level in LEVELS if any(it.level == level for it in scene.findings)]
    robots = [(str(at), name) for at, name in enumerate(scene.robots)]
    yield '<p id="filters" hidden>'
    yield _select("level", "all levels", [(level, level) for level in levels])
    yield _select("robot", "all robots", [*robots, ("-1", "no robot")])
    yield '<label>name <input type="search" name="text" placeholder="node, topic, frame"></label> '
    yield '<output aria-live="polite"></output></p>\n'


def _select(name: str, default: str, options: Iterable[tuple[str, str]]) -> str:
    """Return a filter: a label with a choice, of which the ``default`` is none."""
    inner = "".join(f'<option value="{value}">{safe(text)}</option>' for value, text in options)
    first = f'<option value="">{default}</option>'
    return f'<label>{name} <select name="{name}">{first}{inner}</select></label> '


def finding_list(
    scene: Scene, ids: Ids, sections: Sequence[PageSection], sources: Sources
) -> Iterator[str]:
    """Yield the findings in their order, as HTML."""
    yield '<section id="findings">\n<h2>Findings</h2>\n'
    if not scene.rows:
        text = f"{scene.coverage.in_words}; no findings: {scene.outcome.words}"
        yield f'<p class="none">{safe(text)}</p>\n'
    order = {robot: at for at, robot in enumerate(scene.robots)}
    inside = {one.group.robot: (one.id, ids_in(one, ids)) for one in sections}
    for at, row in enumerate(scene.rows):
        targets = ids_of(row.targets, ids)
        numbers = " ".join(str(order[robot]) for robot in row.robots) or "-1"
        level = safe(row.finding.level)
        yield (
            f'<details class="finding" id="finding-{at}" data-level="{level}"'
            f' data-robot="{numbers}" data-hits="{" ".join(targets)}">'
            f"{_head(row, link_to(row.finding, targets, inside))}{_body(row, sources)}</details>\n"
        )
    yield "</section>\n"


def _head(row: FindingRow, link: str) -> str:
    """Return the line of a finding, as HTML, which opens its details."""
    finding = row.finding
    level = safe(finding.level)
    who = ", ".join(finding.robots or filter(None, (finding.robot,))) or ", ".join(row.robots)
    named = shorten(who.split(", "))
    hint = f"<small>{safe(finding.hint)}</small>" if finding.hint else ""
    place = f"<code>{safe(finding.node)}</code>" if finding.node else "show"
    return (
        f'<summary><b class="level {level}">{level}</b>'
        f'<a class="rule" href="#rule-{finding.code}">{safe(finding.code)}</a>'
        f'<b class="who" title="{safe(who)}">{safe(named)}</b>'
        f'<span class="what"><a class="place" href="{link}">{place}</a>'
        f" {safe(finding.message)}{hint}</span></summary>"
    )


def _body(row: FindingRow, sources: Sources) -> str:
    """Return the details of a finding as HTML: where, why, and the line of the description."""
    finding = row.finding
    rule = sources.rules.get(finding.code)
    names = ", ".join(filter(None, (finding.node, *finding.names)))
    parts = [
        ("Where", safe(shorten(dict.fromkeys(names.split(", ")), SEVERAL * 4))) if names else None,
        ("Robots", safe(", ".join(finding.robots))) if len(finding.robots) > 1 else None,
        ("Why it matters", with_code(rule.why)) if rule else None,
        ("What to do", with_code(rule.fix)) if rule else None,
        ("Written in", f"<code>{safe(row.place)}</code>") if row.place else None,
    ]
    shown = "".join(f"<div><dt>{part[0]}</dt><dd>{part[1]}</dd></div>" for part in parts if part)
    wanted, lines = row.place.rpartition(":")[2], sources.snippets.get(row.place, ())
    marked = (f"<b>{safe(line)}</b>" if line.split()[0] == wanted else safe(line) for line in lines)
    snippet = f"<pre>{chr(10).join(marked)}</pre>" if lines else ""
    return f"<dl>{shown}</dl>{snippet}"


def explanations(codes: Iterable[str], rules: Mapping[str, Rule]) -> Iterator[str]:
    """Yield a section with what the rules find, why that is a problem and how to fix it."""
    found = [rules[code] for code in sorted(set(codes)) if code in rules]
    if found:
        yield '<section id="rules">\n<h2>What the codes mean</h2>\n'
        for rule in found:
            css_class = "bad" if rule.level == ERROR else "odd"
            parts = ("", rule.what), ("Why: ", rule.why), ("Fix: ", rule.fix)
            lines = "".join(f"<p><b>{head}</b>{with_code(text)}</p>" for head, text in parts)
            yield (
                f'<details id="rule-{rule.code}"><summary class="{css_class}"><b>{rule.code}</b>'
                f" {rule.name} <span>{rule.level}</span></summary>\n<div>{lines}</div></details>\n"
            )
        yield "</section>\n"


def with_code(markdown: str) -> str:
    """Return a sentence as HTML, with words in backticks as code."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", safe(markdown))
