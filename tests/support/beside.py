# SPDX-License-Identifier: Apache-2.0
"""What is found in a file beside a description: by its rewrite, and by the rules for its kind."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.related_files.named_file import RelatedFile
from multibot_rewrite.rules.files.judge import judged_once


def findings_of(made: RelatedFile, robots: Iterable[str] = ()) -> tuple[Finding, ...]:
    """In the order of places; ``robots`` are words that stand for robots."""
    file = made.file._replace(robots=frozenset(robots))
    return tuple(sorted((*made.findings, *judged_once(file)), key=_place))


def _place(it: Finding) -> tuple[int, int, str]:
    return it.line, it.column, it.code
