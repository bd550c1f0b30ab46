"""A table a file: a comment on a pull request, or the summary of a job."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.lint.formats.shared import (
    by_file,
    circumstances,
    counts,
    one_line,
    path_below,
    said,
    via,
)
from multibot_rewrite.lint.records import LintFinding, Rule

# A comment on GitHub holds 65,536 characters.
ROOM = 60_000
_MARKUP = re.compile(r"([\\`*_{}\[\]<>|~#&!$])")


def render(findings: Sequence[LintFinding], files: Sequence[str], rules: Mapping[str, Rule]) -> str:
    """Counts, then a table for each file with findings, as many as a comment holds."""
    told = _sum(findings, files)
    shown = 0
    for is_row, part in _parts(findings, rules):
        if len(told) + len(part) > ROOM:
            return f"{told}\n{len(findings) - shown} more are not shown here.\n"
        told += part
        shown += is_row
    return told


def _sum(findings: Sequence[LintFinding], files: Sequence[str]) -> str:
    found = [_counted(number, level) for level, number in counts(findings).items() if number]
    return f"**urdf-lint**: {', '.join(found) or 'no findings'} in {_counted(len(files), 'file')}\n"


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


def _parts(
    findings: Sequence[LintFinding], rules: Mapping[str, Rule]
) -> Iterator[tuple[bool, str]]:
    """What the text is put together from, and whether it is a finding's row."""
    for file, found in by_file(findings).items():
        head = "| line | level | code | finding |\n| ---: | --- | --- | --- |\n"
        yield False, f"\n#### {_escaped(path_below(file))}\n\n{head}"
        yield from ((True, _row(it, rules)) for it in found)


def _row(finding: LintFinding, rules: Mapping[str, Rule]) -> str:
    it = finding
    name = f" {rules[it.code].name}" if it.code in rules else ""
    calls = "".join(f"<br>{_escaped(line)}" for line in via(it, path_below))
    what = f"{_escaped(said(it) + circumstances(it))}{calls}"
    return f"| {it.line} | {it.level} | {it.code}{name} | {what} |\n"


def _escaped(text: str) -> str:
    return _MARKUP.sub(r"\\\1", one_line(text))
