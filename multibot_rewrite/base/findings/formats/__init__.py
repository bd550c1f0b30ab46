# SPDX-License-Identifier: Apache-2.0
"""Findings as a report. Only the module of the format that is asked for is imported.

Each format is a function of findings and the report. Its text can always be encoded as UTF-8 and ends
with a line feed, or is empty.
"""

from collections.abc import Mapping, Sequence
from importlib import import_module
from types import MappingProxyType
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding, Rule

# What --format takes, and the module beside this one that has it, as ``as_json`` for json.
FORMATS = {
    "text": "plain",
    "json": "plain",
    "sarif": "sarif",
    "github": "plain",
    "gitlab": "plain",
    "junit": "junit",
    "markdown": "plain",
    "statistics": "plain",
}
NO_COVERAGE: Mapping[str, object] = MappingProxyType({})


class Report(NamedTuple):
    """What a report says besides its findings.

    The command that made it, the files that were read, all rules by code, the ROS 2 release whose facts
    it rests on, and how much of the robots it is about (``Coverage.as_value``)."""

    tool: str
    files: Sequence[str]
    rules: Mapping[str, Rule]
    release: str = ""
    coverage: Mapping[str, object] = NO_COVERAGE


def rendered(
    name: str, findings: Sequence[Finding], report: Report, *, colour: bool = False
) -> str:
    """Return the report in the format ``name``; ``colour`` is for the text on a terminal."""
    render = getattr(import_module(f"{__name__}.{FORMATS[name]}"), f"as_{name}")
    options = {"colour": colour} if name == "text" else {}
    text: str = render(findings, report, **options)
    return text
