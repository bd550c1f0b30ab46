"""``urdf-lint --statistics``: how often each rule found something, and in how many files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.cli.tables import Grid, deliver_report
from multibot_rewrite.lint.registry import RULES

COLUMNS = ("count", "files", "fixable", "code", "level", "rule")


def deliver_statistics(options: argparse.Namespace, findings: Sequence[Finding]) -> None:
    """Write a line for each rule and level, the most frequent first."""
    rows = sorted(_rows(findings), key=lambda it: (-int(it[0]), it[3:]))
    deliver_report(options, [Grid(COLUMNS, rows)] if rows else [])


def _rows(findings: Sequence[Finding]) -> Iterator[tuple[str, ...]]:
    alike: dict[tuple[str, str], list[Finding]] = {}
    for it in findings:
        alike.setdefault((it.code, it.level), []).append(it)
    for (code, level), its in alike.items():
        files, fixable = len({it.file for it in its}), sum(bool(it.edits) for it in its)
        yield str(len(its)), str(files), str(fixable or ""), code, level, RULES[code].name
