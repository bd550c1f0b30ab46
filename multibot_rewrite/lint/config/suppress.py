"""Findings that settings suppress; those that comments do are looked at where there are comments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.settings import MARK, Settings, file_of, is_silent


def unsuppressed(
    findings: Sequence[Finding], sources: Mapping[str, bytes], settings: Settings
) -> list[Finding]:
    """The findings that no comment and no per-file setting suppresses, and those about comments.

    The first of ``sources`` is the file that is linted, the others are those it includes.
    """
    reported = [it for it in findings if not is_silent(settings, file_of(it), it.code)]
    if not any(MARK in source for source in sources.values()):
        return reported
    # Few files have a comment for the lint.
    from multibot_rewrite.lint.config.comments import after_comments

    return after_comments(reported, {it.code for it in findings}, sources, settings)
