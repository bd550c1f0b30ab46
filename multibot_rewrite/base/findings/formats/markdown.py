# SPDX-License-Identifier: Apache-2.0
"""A table a file: a comment on a pull request, or the summary of a job."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import (
    by_file,
    circumstances,
    counts,
    in_words,
    path_below,
    said_of,
    title,
    via,
)
from multibot_rewrite.base.wording import one_line, plural

# A comment on GitHub holds 65,536 characters.
ROOM = 60_000
_MARKUP = re.compile(r"([\\`*_{}\[\]<>|~#&!$])")


def render(findings: Sequence[Finding], report: Report) -> str:
    """Counts, then a table for each file with findings, as many as a comment holds."""
    found = in_words(counts(findings)) or "no findings"
    files = plural(len(report.files), "file")
    held = f" ({_escaped(str(report.coverage['text']))})" if report.coverage else ""
    text = f"**{report.tool}**: {found} in {files}{held}\n"
    shown = 0
    for is_row, part in _parts(findings, report):
        if len(text) + len(part) > ROOM:
            return f"{text}\n{len(findings) - shown} more are not shown here.\n"
        text += part
        shown += is_row
    return text


def _parts(findings: Sequence[Finding], report: Report) -> Iterator[tuple[bool, str]]:
    """What the text is put together from, and whether it is a finding's row."""
    for file, found in by_file(findings, report).items():
        if not found:
            continue
        head = "| line | level | code | finding |\n| ---: | --- | --- | --- |\n"
        yield False, f"\n#### {_escaped(path_below(file))}\n\n{head}"
        yield from ((True, _row(it, report)) for it in found)


def _row(finding: Finding, report: Report) -> str:
    it = finding
    calls = "".join(f"<br>{_escaped(line)}" for line in via(it, path_below))
    what = f"{_escaped(said_of(it) + circumstances(it))}{calls}"
    return f"| {it.line or ''} | {it.level} | {title(it, report)} | {what} |\n"


def _escaped(text: str) -> str:
    return _MARKUP.sub(r"\\\1", one_line(text))
