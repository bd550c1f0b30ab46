"""One JSON object, the same from release to release: see docs/lint-ci.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from multibot_rewrite.lint.formats.shared import calls, counts, json_text, path_given
from multibot_rewrite.lint.records import LintFinding, Rule
from multibot_rewrite.model import Edit

# Grows when a key goes or means something else; a new key is no new version.
VERSION = 1


def render(findings: Sequence[LintFinding], files: Sequence[str], rules: Mapping[str, Rule]) -> str:
    """The object, indented, in UTF-8."""
    table = {
        "version": VERSION,
        "files": len(files),
        "counts": counts(findings),
        "findings": [_finding(it, rules) for it in findings],
    }
    return json_text(table)


def _finding(finding: LintFinding, rules: Mapping[str, Rule]) -> dict[str, Any]:
    it = finding
    return {
        "code": it.code,
        "name": rules[it.code].name if it.code in rules else "",
        "level": it.level,
        "message": it.message,
        "hint": it.hint,
        "file": path_given(it.file),
        "line": it.line,
        "column": it.column,
        "calls": [call._replace(file=path_given(call.file))._asdict() for call in calls(it)],
        "arguments": it.arguments,
        "edits": [_edit(edit) for edit in it.edits],
    }


def _edit(edit: Edit) -> dict[str, Any]:
    text = edit.before + (edit.after or b"")
    return {"start": edit.start, "end": edit.end, "text": text.decode("utf-8", "replace")}
