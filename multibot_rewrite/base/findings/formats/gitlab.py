# SPDX-License-Identifier: Apache-2.0
"""GitLab's Code Quality report, which merge requests show."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.shared import (
    circumstances,
    file_of,
    fingerprints,
    json_text,
    path_below,
    said_of,
    title,
)

_SEVERITIES = {ERROR: "critical", INCONCLUSIVE: "minor", WARNING: "major", NOTE: "info"}


def render(findings: Sequence[Finding], report: Report) -> str:
    """A JSON list; GitLab tells new findings from old ones by their fingerprints."""
    entries = [
        {
            "description": f"{it.code}: {said_of(it)}{circumstances(it)}",
            "check_name": title(it, report),
            "fingerprint": fingerprint,
            "severity": _SEVERITIES[it.level],
            "location": {"path": path_below(file_of(it, report)), "lines": {"begin": it.line or 1}},
        }
        for it, fingerprint in zip(findings, fingerprints(findings), strict=True)
    ]
    return json_text(entries)
