"""JUnit XML for Jenkins and others: a suite for each file, a case for each finding."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from lxml import etree

from multibot_rewrite.lint.formats.shared import by_file, one_line, path_below, said
from multibot_rewrite.lint.formats.text import lines
from multibot_rewrite.lint.records import NOTE, LintFinding, Rule

_PASSED = "no findings"


def render(findings: Sequence[LintFinding], files: Sequence[str], rules: Mapping[str, Rule]) -> str:
    """Errors and warnings are failures, a note passes; so does a file without findings."""
    suites = etree.Element("testsuites", {"name": "urdf-lint", **_totals(findings, files)})
    for file, found in by_file(findings, files).items():
        _add_suite(suites, file, found)
    data: bytes = etree.tostring(suites, xml_declaration=True, encoding="utf-8", pretty_print=True)
    return data.decode()


def _add_suite(suites: etree._Element, file: str, found: Sequence[LintFinding]) -> None:
    path = one_line(path_below(file))
    suite = etree.SubElement(suites, "testsuite", {"name": path, **_totals(found, (file,))})
    # Jenkins takes what stands before the last dot for a package.
    home = {"classname": f"urdf-lint.{path.replace('.', '_')}", "time": "0"}
    if not found:
        etree.SubElement(suite, "testcase", {"name": _PASSED, **home})
    for finding, name in zip(found, _names(found), strict=True):
        _tell(etree.SubElement(suite, "testcase", {"name": name, **home}), finding)


def _totals(findings: Sequence[LintFinding], files: Sequence[str]) -> dict[str, str]:
    clean = set(files) - {it.file for it in findings}
    failures = sum(it.level != NOTE for it in findings)
    tests = len(findings) + len(clean)
    return {"tests": str(tests), "failures": str(failures), "errors": "0", "time": "0"}


def _names(findings: Sequence[LintFinding]) -> list[str]:
    """Jenkins follows a case from build to build by its name: no lines, and no two are equal."""
    seen: Counter[str] = Counter()
    names = []
    for it in findings:
        name = one_line(f"{it.code} {it.message}")
        seen[name] += 1
        names.append(name if seen[name] == 1 else f"{name} #{seen[name]}")
    return names


def _tell(case: etree._Element, finding: LintFinding) -> None:
    whole = "\n".join(lines(finding))
    if finding.level == NOTE:
        etree.SubElement(case, "system-out").text = whole
        return
    failure = {"message": said(finding), "type": finding.level}
    etree.SubElement(case, "failure", failure).text = whole
