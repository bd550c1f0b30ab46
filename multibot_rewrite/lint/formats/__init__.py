"""Findings as a report. One file a format; only the one that is asked for is imported.

Each has ``render(findings, files, rules)``: ``files`` are the ones that were linted, ``rules`` are
all there are, by code. The text can always be encoded as UTF-8 and ends with a line feed, or is empty.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from multibot_rewrite.lint.records import LintFinding
from multibot_rewrite.lint.registry import RULES

# What --format takes, and the module beside this one that renders it.
FORMATS = {
    "text": "text",
    "json": "json_object",
    "sarif": "sarif",
    "github": "github",
    "gitlab": "gitlab",
    "junit": "junit",
    "markdown": "markdown",
}


def rendered(
    name: str, findings: Sequence[LintFinding], files: Sequence[str], *, colour: bool = False
) -> str:
    """The report; ``colour`` is for the text on a terminal."""
    render = import_module(f"{__name__}.{FORMATS[name]}").render
    options = {"colour": colour} if name == "text" else {}
    report: str = render(findings, files, RULES, **options)
    return report
