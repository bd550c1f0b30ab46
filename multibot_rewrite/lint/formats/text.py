"""Lines for people and editors: ``file:line:column: CODE message (hint)``, ``note:`` before what does
not make the lint fail."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.lint.formats.shared import circumstances, one_line, path_given, said, via
from multibot_rewrite.lint.records import NOTE, LintFinding, Rule
from multibot_rewrite.model import ERROR, WARNING

_PAINT = {ERROR: "\033[31m", WARNING: "\033[33m", NOTE: "\033[36m"}
_PLAIN = "\033[0m"


def render(
    findings: Sequence[LintFinding],
    files: Sequence[str],
    rules: Mapping[str, Rule],
    *,
    colour: bool = False,
) -> str:
    """A line for each finding, and an indented one for each macro call that led to it."""
    return "".join(f"{line}\n" for it in findings for line in lines(it, colour=colour))


def lines(finding: LintFinding, *, colour: bool = False) -> Iterator[str]:
    """The lines of one finding."""
    it = finding
    code = f"{_PAINT.get(it.level, '')}{it.code}{_PLAIN}" if colour else it.code
    place = f"{one_line(path_given(it.file))}:{it.line}:{it.column}"
    note = "note: " if it.level == NOTE else ""
    yield f"{place}: {code} {note}{said(it)}{circumstances(it)}"
    yield from (f"    {line}" for line in via(it, path_given))
