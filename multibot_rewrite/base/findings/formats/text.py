# SPDX-License-Identifier: Apache-2.0
"""Lines for people and editors, as compilers write them: ``file:line:column: level: CODE message
(hint)``, with a node or robot in the place of the file where it is about one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import circumstances, path_given, said, via
from multibot_rewrite.base.wording import one_line

_PAINT = {ERROR: "\033[31m", WARNING: "\033[33m", INCONCLUSIVE: "\033[35m", NOTE: "\033[36m"}
_PLAIN = "\033[0m"


def render(findings: Sequence[Finding], report: Report, *, colour: bool = False) -> str:
    """A line for each finding, and an indented one for each macro call that led to it."""
    return "".join(f"{line}\n" for it in findings for line in lines(it, colour=colour))


def lines(finding: Finding, *, colour: bool = False) -> Iterator[str]:
    """The lines of one finding."""
    it = finding._replace(file=path_given(finding.file))
    paint, plain = (_PAINT.get(it.level, ""), _PLAIN) if colour else ("", "")
    head = f"{one_line(it.place)}: {paint}{it.level}: {it.code}{plain}"
    yield f"{head} {said(it)}{circumstances(it)}"
    yield from (f"    {line}" for line in via(it, path_given))
