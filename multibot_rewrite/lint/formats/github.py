"""Workflow commands: GitHub shows each finding as an annotation beside its line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from multibot_rewrite.lint.formats.shared import circumstances, one_line, path_below, said, via
from multibot_rewrite.lint.records import NOTE, LintFinding, Rule
from multibot_rewrite.model import ERROR, WARNING

_COMMANDS = {ERROR: "error", WARNING: "warning", NOTE: "notice"}
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})


def render(findings: Sequence[LintFinding], files: Sequence[str], rules: Mapping[str, Rule]) -> str:
    """A command a line; the macro calls are further lines of its message."""
    return "".join(f"{_command(it, rules)}\n" for it in findings)


def _command(finding: LintFinding, rules: Mapping[str, Rule]) -> str:
    it = finding
    name = f" {rules[it.code].name}" if it.code in rules else ""
    properties = {
        "file": one_line(path_below(it.file)),
        "line": str(it.line),
        "col": str(it.column),
        "title": f"{it.code}{name}",
    }
    told = ",".join(f"{key}={value.translate(_PROPERTY)}" for key, value in properties.items())
    message = [f"{said(it)}{circumstances(it)}", *via(it, path_below)]
    return f"::{_COMMANDS[it.level]} {told}::{chr(10).join(message).translate(_DATA)}"
