# SPDX-License-Identifier: Apache-2.0
"""Workflow commands: GitHub shows each finding as an annotation beside its line."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import (
    circumstances,
    file_of,
    path_below,
    said_of,
    title,
    via,
)
from multibot_rewrite.base.wording import one_line

_COMMANDS = {ERROR: "error", INCONCLUSIVE: "warning", WARNING: "warning", NOTE: "notice"}
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})


def render(findings: Sequence[Finding], report: Report) -> str:
    """A command a line; the macro calls are further lines of its message."""
    return "".join(f"{_command(it, report)}\n" for it in findings)


def _command(finding: Finding, report: Report) -> str:
    it = finding
    file = one_line(path_below(file_of(it, report)))
    place = {"file": file, "line": str(it.line or 1), "col": str(it.column or 1)} if file else {}
    properties = {**place, "title": title(it, report)}
    pairs = ",".join(f"{key}={value.translate(_PROPERTY)}" for key, value in properties.items())
    message = [f"{said_of(it)}{circumstances(it)}", *via(it, path_below)]
    return f"::{_COMMANDS[it.level]} {pairs}::{chr(10).join(message).translate(_DATA)}"
