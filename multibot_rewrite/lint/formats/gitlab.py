"""GitLab's Code Quality report, which merge requests show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from multibot_rewrite.lint.formats.shared import (
    circumstances,
    fingerprints,
    json_text,
    path_below,
    said,
)
from multibot_rewrite.lint.records import NOTE, LintFinding, Rule
from multibot_rewrite.model import ERROR, WARNING

_SEVERITIES = {ERROR: "critical", WARNING: "major", NOTE: "info"}


def render(findings: Sequence[LintFinding], files: Sequence[str], rules: Mapping[str, Rule]) -> str:
    """A JSON list; GitLab tells new findings from old ones by their fingerprints."""
    report = [
        {
            "description": f"{it.code}: {said(it)}{circumstances(it)}",
            "check_name": f"{it.code} {rules[it.code].name}" if it.code in rules else it.code,
            "fingerprint": fingerprint,
            "severity": _SEVERITIES[it.level],
            "location": {"path": path_below(it.file), "lines": {"begin": it.line}},
        }
        for it, fingerprint in zip(findings, fingerprints(findings), strict=True)
    ]
    return json_text(report)
