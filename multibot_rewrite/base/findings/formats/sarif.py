# SPDX-License-Identifier: Apache-2.0
"""SARIF 2.1.0, as GitHub's code scanning and other collectors of findings read it."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from multibot_rewrite.base.bounded import bytes_if_read
from multibot_rewrite.base.findings.finding import INCONCLUSIVE, WARNING, Finding, Rule, locate
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.plain import (
    calls,
    circumstances,
    file_of,
    fingerprints,
    inside,
    json_text,
    said_of,
)
from multibot_rewrite.base.wording import one_line
from multibot_rewrite.version import __version__

Json = dict[str, Any]
SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)
_ROOT = "%SRCROOT%"
_ROOT_SAID = "The folder in which the command was started: the root of the repository."


def as_sarif(findings: Sequence[Finding], report: Report) -> str:
    """Return one SARIF run with every rule, the linted files, and a result for each finding."""
    numbers = {code: number for number, code in enumerate(report.rules)}
    driver = {
        "name": report.tool,
        "version": __version__,
        "semanticVersion": __version__,
        "rules": [_sarif_rule(it) for it in report.rules.values()],
    }
    properties = {"distro": report.release, "coverage": report.coverage}
    run = {
        "tool": {"driver": driver},
        "originalUriBaseIds": {_ROOT: {"description": {"text": _ROOT_SAID}}},
        "artifacts": [{"location": _file(path)} for path in dict.fromkeys(report.files)],
        "columnKind": "unicodeCodePoints",
        **({"properties": said} if (said := {k: v for k, v in properties.items() if v}) else {}),
        "results": [
            _result(it, report, numbers, fingerprint)
            for it, fingerprint in zip(findings, fingerprints(findings), strict=True)
        ],
    }
    return json_text({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]})


def _sarif_rule(rule: Rule) -> Json:
    both = (("Bad", rule.page.bad), ("Good", rule.page.good))
    examples = [(title, it) for title, it in both if it]
    prose = [rule.what, f"Why: {rule.why}", f"Fix: {rule.fix}"]
    text = [*prose, *(f"{title}:\n{example}" for title, example in examples)]
    marked = [rule.what, f"**Why.** {rule.why}", f"**Fix.** {rule.fix}"]
    marked += [f"{title}:\n\n```xml\n{example}\n```" for title, example in examples]
    return {
        "id": rule.code,
        "name": rule.name,
        "shortDescription": {"text": rule.what.partition(". ")[0].rstrip(".")},
        "fullDescription": {"text": rule.what},
        "help": {"text": "\n\n".join(text), "markdown": "\n\n".join(marked)},
        "defaultConfiguration": {"level": rule.level},
    }


def _result(finding: Finding, report: Report, numbers: Mapping[str, int], fingerprint: str) -> Json:
    """Return a finding as a SARIF result; ``numbers`` has the index of each rule."""
    it = finding
    # Text inside a link of a message.
    macros = (re.sub(r"([\\\[\]])", r"\\\1", one_line(call.macro)) for call in calls(it))
    via = ", ".join(f"[{macro}]({at})" for at, macro in enumerate(macros, 1))
    message = f"{said_of(it)}{circumstances(it)}"
    related = [
        {
            "id": at,
            **_location(call.file, {"startLine": call.line}),
            "message": {"text": f"call of {one_line(call.macro)}"},
        }
        for at, call in enumerate(calls(it), 1)
    ]
    # No fix where the file is not the one that was linted any more.
    source = bytes_if_read(it.file) if it.edits else b""
    fixes = []
    if source and all(edit.end <= len(source) for edit in it.edits):
        names = ("startLine", "startColumn", "endLine", "endColumn")
        replacements = []
        for edit in it.edits:
            ends = (*locate(source, edit.start), *locate(source, edit.end))
            text = (edit.before + (edit.after or b"")).decode("utf-8", "replace")
            region = dict(zip(names, ends, strict=True))
            replacements.append({"deletedRegion": region, "insertedContent": {"text": text}})
        change = {"artifactLocation": _file(it.file), "replacements": replacements}
        description = {"text": one_line(it.hint or it.message)}
        fixes = [{"description": description, "artifactChanges": [change]}]
    return {
        "ruleId": it.code,
        **({"ruleIndex": numbers[it.code]} if it.code in numbers else {}),
        "level": WARNING if it.level == INCONCLUSIVE else it.level,
        "message": {"text": f"{message} via {via}" if via else message},
        "locations": _locations(it, report),
        # GitHub's upload adds its own, made from the line's text, and complains of another one
        # that has its name.
        "partialFingerprints": {"urdfLint/v1": fingerprint},
        **({"relatedLocations": related} if via else {}),
        **({"fixes": fixes} if fixes else {}),
    }


def _locations(finding: Finding, report: Report) -> list[Json]:
    """Return the places of a finding: in a file, and the robot's node; empty if neither is known."""
    it = finding
    node = {"fullyQualifiedName": it.place, "kind": "resource"} if it.robot or it.node else {}
    file = file_of(it, report)
    if not file:
        return [{"logicalLocations": [node]}] if node else []
    region = {"startLine": it.line or 1, "startColumn": it.column or 1}
    return [{**_location(file, region), **({"logicalLocations": [node]} if node else {})}]


def _location(path: str, region: Json) -> Json:
    return {"physicalLocation": {"artifactLocation": _file(path), "region": region}}


def _file(path: str) -> Json:
    """Return the SARIF location of a file, relative to the working directory if it is below it."""
    below = inside(path)
    if below is not None:
        return {"uri": quote(os.fsencode(below)), "uriBaseId": _ROOT}
    return {"uri": f"file://{quote(os.fsencode(os.path.abspath(path)))}"}
