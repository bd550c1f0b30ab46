"""Comments in a description that keep the lint silent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from multibot_rewrite.lint.records import LintFinding
from multibot_rewrite.lint.settings import Settings


def unsuppressed(
    findings: Sequence[LintFinding], sources: Mapping[str, bytes], settings: Settings
) -> list[LintFinding]:
    """The findings that no comment and no per-file setting silences, and those about comments."""
    return list(findings)
