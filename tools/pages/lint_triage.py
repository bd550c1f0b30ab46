# SPDX-License-Identifier: Apache-2.0
"""The page of judgements: which findings of the lint in public files are true."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.lint.registry import RULES
from tools.pages.markdown import plain

FIXTURES = Path(__file__).parents[2] / "fixtures"
COUNTS = FIXTURES / "lint_triage_counts.tsv"
SHOWN = 5
_HEAD = """\
# Findings of urdf-lint in public robots

Made from `fixtures/lint_triage_*.tsv`.

Every rule that finds an error in {corpus} public files or {wheels} of Python packages was
judged: at least five of its findings, or all, by reading the file or with check_urdf,
sdformat or MuJoCo. False errors were bugs of the rule and are fixed. Of warnings and notes a
sample was judged; rules with a few false findings are warnings for that reason. Each rule
shows some judgements here, the files have all of them. The counts are those of errors; a test
checks them.

| rule | public files | packages | judged | false |
|---|--:|--:|--:|--:|
"""


class Judged(NamedTuple):
    """A judgement: is a finding true, and why."""

    code: str
    file: str
    line: int
    true: bool
    reason: str


def judgements() -> list[Judged]:
    """All of them, by rule."""
    files = sorted(FIXTURES.glob("lint_triage_MB*.tsv"))
    lines = (line for path in files for line in path.read_text().splitlines()[1:] if line)
    return sorted(_judged(line) for line in lines)


def _judged(line: str) -> Judged:
    code, file, number, judgement, reason = line.split("\t")
    assert judgement in ("true", "false"), line
    return Judged(code, file.removeprefix("urdf/"), int(number), judgement == "true", reason)


def committed() -> dict[str, tuple[int, int]]:
    """Return the committed counts."""
    rows = [line.split("\t") for line in COUNTS.read_text().splitlines()[1:]]
    return {code: (int(corpus), int(wheels)) for code, corpus, wheels in rows}


def page() -> str:
    """Return the page of judgements, Markdown."""
    counts = committed()
    by_rule: dict[str, list[Judged]] = defaultdict(list)
    for it in judgements():
        by_rule[it.code].append(it)
    corpus, wheels = counts.pop("files")
    parts = [_HEAD.format(corpus=f"{corpus:,}", wheels=wheels)]
    codes = [code for code in sorted({*counts, *by_rule}) if code in RULES]
    parts += [_row(code, *counts.get(code, (0, 0)), by_rule[code]) for code in codes]
    parts += [part for code in codes if by_rule[code] for part in _section(code, by_rule[code])]
    return "".join(parts)


def _row(code: str, corpus: int, wheels: int, judged: list[Judged]) -> str:
    rule = RULES[code]
    false = sum(not it.true for it in judged)
    level = "" if rule.level == ERROR else f" ({rule.level})"
    shown = (corpus, wheels) if rule.level == ERROR else ("", "")
    return f"| {code} {rule.name}{level} | {shown[0]} | {shown[1]} | {len(judged)} | {false} |\n"


def _section(code: str, judged: list[Judged]) -> Iterator[str]:
    yield f"\n## {code} {RULES[code].name}\n\n"
    # One of each reason first, then more of them.
    firsts = {(it.true, it.reason): it for it in reversed(judged)}
    order = sorted(judged, key=lambda it: firsts[it.true, it.reason] is not it)
    for it in sorted(order[:SHOWN]):
        verdict = "true" if it.true else "false"
        yield f"- `{it.file}:{it.line}` {verdict}: {plain(it.reason)}\n"
