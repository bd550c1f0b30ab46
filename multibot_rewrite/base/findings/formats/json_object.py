# SPDX-License-Identifier: Apache-2.0
"""One JSON object, the same from release to release: see docs/lint.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import calls, counts, json_text, path_given
from multibot_rewrite.base.model import Edit

# Grows when a key goes or means something else; a new key is no new version.
VERSION = 3


def render(findings: Sequence[Finding], report: Report) -> str:
    """The object, indented, in UTF-8."""
    table = {
        "version": VERSION,
        "tool": report.tool,
        "distro": report.release or None,
        "files": len(report.files),
        **({"coverage": report.coverage} if report.coverage else {}),
        "counts": counts(findings),
        "findings": [_finding(it, report) for it in findings],
    }
    return json_text(table)


def _finding(finding: Finding, report: Report) -> dict[str, Any]:
    it = finding
    return {
        "code": it.code,
        "name": report.rules[it.code].name if it.code in report.rules else "",
        "level": it.level,
        "message": it.message,
        "hint": it.hint,
        "file": path_given(it.file) or None,
        "line": it.line or None,
        "column": it.column or None,
        "calls": [call._replace(file=path_given(call.file))._asdict() for call in calls(it)],
        "arguments": it.arguments,
        "robot": it.robot,
        "robots": list(it.robots or filter(None, (it.robot,))),
        "node": it.node,
        "names": list(it.names),
        "edits": [_edit(edit) for edit in it.edits],
    }


def _edit(edit: Edit) -> dict[str, Any]:
    text = edit.before + (edit.after or b"")
    return {"start": edit.start, "end": edit.end, "text": text.decode("utf-8", "replace")}
