# SPDX-License-Identifier: Apache-2.0
"""JUnit XML for Jenkins and others: a suite for each file, a case for each finding."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from lxml import etree

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import Report
from multibot_rewrite.base.findings.formats.plain import (
    by_file,
    file_of,
    lines_of,
    path_below,
    said,
)
from multibot_rewrite.base.wording import one_line

_PASSED = "no findings"


def as_junit(findings: Sequence[Finding], report: Report) -> str:
    """Return JUnit XML: errors and warnings fail, inconclusive ones are skipped, the rest passes."""
    suites = etree.Element("testsuites", {"name": report.tool, **_totals(findings, report)})
    for file, found in by_file(findings, report).items():
        path = one_line(path_below(file)) or "graph"
        totals = _totals(found, report._replace(files=(file,)))
        suite = etree.SubElement(suites, "testsuite", {"name": path, **totals})
        # Jenkins takes what stands before the last dot for a package.
        home = {"classname": f"{report.tool}.{path.replace('.', '_')}", "time": "0"}
        if report.coverage:
            about = {"name": "coverage", "value": str(report.coverage["text"])}
            etree.SubElement(etree.SubElement(suite, "properties"), "property", about)
        if not found:
            etree.SubElement(suite, "testcase", {"name": _PASSED, **home})
        # Jenkins follows a case from build to build by its name: no lines, and no two are equal.
        seen: Counter[str] = Counter()
        names = []
        for it in found:
            name = one_line(
                f"{it.code} {it.place}: {it.message}" if it.node else f"{it.code} {it.message}"
            )
            seen[name] += 1
            names.append(name if seen[name] == 1 else f"{name} #{seen[name]}")
        for it, name in zip(found, names, strict=True):
            case = etree.SubElement(suite, "testcase", {"name": name, **home})
            whole = "\n".join(lines_of(it))
            if it.level == NOTE:
                etree.SubElement(case, "system-out").text = whole
            elif it.level == INCONCLUSIVE:
                etree.SubElement(case, "skipped", {"message": said(it)})
            else:
                failure = {"message": said(it), "type": it.level}
                etree.SubElement(case, "failure", failure).text = whole
    data: bytes = etree.tostring(suites, xml_declaration=True, encoding="utf-8", pretty_print=True)
    return data.decode()


def _totals(findings: Sequence[Finding], report: Report) -> dict[str, str]:
    """Return the counts for the attributes of a test suite, as texts by name."""
    clean = set(report.files) - {file_of(it, report) for it in findings}
    failures = sum(it.level in (ERROR, WARNING) for it in findings)
    skipped = sum(it.level == INCONCLUSIVE for it in findings)
    tests = len(findings) + len(clean)
    numbers = {"tests": tests, "failures": failures, "errors": 0, "skipped": skipped, "time": 0}
    return {name: str(number) for name, number in numbers.items()}
