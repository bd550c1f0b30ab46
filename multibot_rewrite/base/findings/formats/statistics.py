# SPDX-License-Identifier: Apache-2.0
"""How often each rule found something, and in how many files: the most frequent first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import title

COLUMNS = ("count", "files", "fixable", "code", "level", "rule")
_NUMBERS = COLUMNS[:3]


def render(findings: Sequence[Finding], report: Report) -> str:
    """A line for each rule and level; nothing where nothing is found."""
    rows = sorted(_rows(findings, report), key=lambda it: (-int(it[0]), it[3:]))
    columns = [list(cells) for cells in zip(COLUMNS, *rows, strict=True)] if rows else []
    widths = [max(map(len, cells)) for cells in columns]
    lines = ("  ".join(map(_cell, row, COLUMNS, widths)) for row in zip(*columns, strict=True))
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _rows(findings: Sequence[Finding], report: Report) -> Iterator[tuple[str, ...]]:
    alike: dict[tuple[str, str], list[Finding]] = {}
    for it in findings:
        alike.setdefault((it.code, it.level), []).append(it)
    for (code, level), its in alike.items():
        files, fixable = len({it.file for it in its}), sum(bool(it.edits) for it in its)
        name = title(its[0], report).removeprefix(code).lstrip()
        yield str(len(its)), str(files), str(fixable or ""), code, level, name


def _cell(text: str, column: str, width: int) -> str:
    return text.rjust(width) if column in _NUMBERS else text.ljust(width)
