# SPDX-License-Identifier: Apache-2.0
"""A report in every format, whole: readers of CI services take each word of it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from multibot_rewrite.base.findings import codes
from multibot_rewrite.base.findings.finding import (
    ERROR,
    INCONCLUSIVE,
    NOTE,
    WARNING,
    Finding,
    Rule,
    RulePage,
)
from multibot_rewrite.base.findings.formats import Report, plain, rendered
from multibot_rewrite.base.model import Edit, UsageError


class WrittenRule(Rule):
    """A rule without a page."""

    what, why, fix = "It is. Really.", "It hurts.", "Do it."
    page = RulePage(bad="<a/>", good="<b/>")


class FixedRule(WrittenRule):
    """A rule with a fix."""

    page = RulePage(bad="<a>\n</a>", good="<b/>", fixed="<b/>")


class RuleOfFiles(WrittenRule):
    """A rule about several files."""

    page = RulePage(bad="<a/>", beside={"a.yaml": "x: 1\n", "empty": "", "b.stl": "\n"})


def rule(code: str, name: str, level: str = ERROR) -> dict[str, object]:
    return {code: WrittenRule(code, name, level)}


RULES = rule("MB101", "bad-name")
IN_FILE = Finding(
    "MB101", ERROR, "is 100% bad", "do: it", "a b.urdf", 3, 5, ("m.xacro:7: wheel",), "side:=left",
    (Edit(0, 1, b"x", b"y"),), robots=("r1", "r2"), robot="r1",
)  # fmt: skip
IN_GRAPH = Finding("MG102", INCONCLUSIVE, "may be lost", robot="r1", node="/r1/a", names=("/r1/t",))
NOTED = Finding("MB101", NOTE, "is odd", file="c.urdf")
FOUND = (IN_FILE, IN_GRAPH, NOTED)
REPORT = Report("multibot lint", ["a b.urdf", "c.urdf"], RULES, "jazzy")  # type: ignore[arg-type]


@pytest.fixture(autouse=True)
def folder(here: Path) -> Path:
    (here / "a b.urdf").write_bytes(b"1234")
    return here


def test_json() -> None:
    made = json.loads(rendered("json", FOUND, REPORT))
    first, second, third = made.pop("findings")
    assert made == {
        "version": 3, "tool": "multibot lint", "distro": "jazzy", "files": 2,
        "counts": {"error": 1, "warning": 0, "note": 1, "inconclusive": 1},
    }  # fmt: skip
    assert first == {
        "code": "MB101", "name": "bad-name", "level": "error", "message": "is 100% bad",
        "hint": "do: it",
        "file": "a b.urdf", "line": 3, "column": 5,
        "calls": [{"file": "m.xacro", "line": 7, "macro": "wheel"}], "arguments": "side:=left",
        "robot": "r1", "robots": ["r1", "r2"], "node": "", "names": [],
        "edits": [{"start": 0, "end": 1, "text": "xy"}],
    }  # fmt: skip
    assert (second["name"], second["file"], second["line"], second["column"]) == (
        "",
        None,
        None,
        None,
    )
    assert (second["names"], second["node"], third["edits"]) == (["/r1/t"], "/r1/a", [])
    assert json.loads(rendered("json", [], REPORT._replace(release="")))["distro"] is None


def test_junit() -> None:
    pytest.importorskip("lxml")
    failed = "is 100% bad; the same for r2 (do: it)"
    report = REPORT._replace(files=(*REPORT.files, "d.e.urdf"))
    found = (*FOUND, NOTED._replace(level=WARNING))
    case = 'classname="multibot lint.{}" time="0"'
    totals = 'tests="{}" failures="{}" errors="0" skipped="{}" time="0"'
    assert rendered("junit", found, report) == (
        "<?xml version='1.0' encoding='utf-8'?>\n"
        f'<testsuites name="multibot lint" {totals.format(5, 2, 1)}>\n'
        f'  <testsuite name="a b.urdf" {totals.format(2, 1, 1)}>\n'
        f'    <testcase name="MB101 is 100% bad" {case.format("a b_urdf")}>\n'
        f'      <failure message="{failed}" type="error">r1: error: MB101 {failed}'
        " [with side:=left]\n    via m.xacro:7: wheel</failure>\n    </testcase>\n"
        f'    <testcase name="MG102 /r1/a: may be lost" {case.format("a b_urdf")}>\n'
        '      <skipped message="may be lost"/>\n    </testcase>\n  </testsuite>\n'
        f'  <testsuite name="c.urdf" {totals.format(2, 1, 0)}>\n'
        f'    <testcase name="MB101 is odd" {case.format("c_urdf")}>\n'
        "      <system-out>c.urdf:0:0: note: MB101 is odd</system-out>\n    </testcase>\n"
        f'    <testcase name="MB101 is odd #2" {case.format("c_urdf")}>\n'
        '      <failure message="is odd" type="warning">c.urdf:0:0: warning: MB101 is odd</failure>\n'
        "    </testcase>\n  </testsuite>\n"
        f'  <testsuite name="d.e.urdf" {totals.format(1, 0, 0)}>\n'
        f'    <testcase name="no findings" {case.format("d_e_urdf")}/>\n  </testsuite>\n</testsuites>\n'
    )
    graph = rendered("junit", [IN_GRAPH], REPORT._replace(files=()))
    assert f'<testsuite name="graph" {totals.format(1, 0, 1)}>' in graph


HEAD = "| line | level | code | finding |\n| ---: | --- | --- | --- |\n"


def test_markdown(monkeypatch: pytest.MonkeyPatch) -> None:
    assert rendered("markdown", FOUND, REPORT) == (
        "**multibot lint**: 1 error, 1 note, 1 inconclusive in 2 files\n"
        f"\n#### a b.urdf\n\n{HEAD}"
        "| 3 | error | MB101 bad-name | r1: is 100% bad; the same for r2 (do: it) [with side:=left]"
        "<br>via m.xacro:7: wheel |\n".replace("[with side:=left]", r"\[with side:=left\]")
        + "|  | inconclusive | MG102 | /r1/a: may be lost |\n"
        f"\n#### c.urdf\n\n{HEAD}|  | note | MB101 bad-name | is odd |\n"
    )
    assert rendered("markdown", [], REPORT) == "**multibot lint**: no findings in 2 files\n"
    one_file = REPORT._replace(files=("a.urdf",))
    assert rendered("markdown", [], one_file) == "**multibot lint**: no findings in 1 file\n"
    marked = NOTED._replace(message="a_b|c*<d>")
    assert r"| a\_b\|c\*\<d\> |" in rendered("markdown", [marked], REPORT)
    text = rendered("markdown", [NOTED] * 3, REPORT)
    assert text.startswith("**multibot lint**: 3 notes in 2 files\n")
    monkeypatch.setattr(plain, "ROOM", len(text))
    assert rendered("markdown", [NOTED] * 3, REPORT) == text
    monkeypatch.setattr(plain, "ROOM", len(text) - 1)
    cut = rendered("markdown", [NOTED] * 3, REPORT)
    assert cut.endswith("\n1 more are not shown here.\n") and cut.count("is odd") == 2


def test_statistics() -> None:
    found = [NOTED, NOTED._replace(file="d.urdf"), IN_GRAPH, IN_FILE]
    assert rendered("statistics", found, REPORT) == (
        "count  files  fixable  code   level         rule\n"
        "    2      2           MB101  note          bad-name\n"
        "    1      1        1  MB101  error         bad-name\n"
        "    1      1           MG102  inconclusive\n"
    )
    assert rendered("statistics", [], REPORT) == ""


def test_sarif_of_a_graph_and_of_files_elsewhere(folder: Path) -> None:
    nowhere = REPORT._replace(files=(), release="")
    (run,) = json.loads(rendered("sarif", [IN_GRAPH, NOTED._replace(file="")], nowhere))["runs"]
    node = {"fullyQualifiedName": "/r1/a", "kind": "resource"}
    assert [it["locations"] for it in run["results"]] == [[{"logicalLocations": [node]}], []]
    assert "properties" not in run
    far = json.loads(rendered("sarif", [], nowhere._replace(files=("/far/a b.urdf",))))
    assert far["runs"][0]["artifacts"] == [{"location": {"uri": "file:///far/a%20b.urdf"}}]
    # A file that is another one by now is not mended.
    gone = IN_FILE._replace(edits=(Edit(0, 5, b"x", None),))
    assert "fixes" not in json.loads(rendered("sarif", [gone], REPORT))["runs"][0]["results"][0]
    lost = NOTED._replace(edits=(Edit(0, 0, b"x", None),))
    assert "fixes" not in json.loads(rendered("sarif", [lost], REPORT))["runs"][0]["results"][0]
    whole = IN_FILE._replace(edits=(Edit(0, 4, b"x", None),), hint="", calls=("m:1: a[b]\\",))
    (result,) = json.loads(rendered("sarif", [whole], REPORT))["runs"][0]["results"]
    assert result["fixes"][0]["description"] == {"text": "is 100% bad"}
    assert result["message"]["text"].endswith("via [a\\[b\\]\\\\](1)")


def test_a_lone_surrogate_is_text() -> None:
    made = rendered("json", [NOTED._replace(message="\udcff")], REPORT)
    assert json.loads(made)["findings"][0]["message"] == "\\udcff"


# ---------------------------------------------------------------- rules by their codes


KNOWN = {**rule("MB101", "bad-name"), **rule("MB102", "odd-name"), **rule("MG201", "lost-topic")}


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("MB1019", "did you mean 'MB101'?"),
        ("mb199", "did you mean 'MB1'?"), ("MG21", "did you mean 'MG2'?"),
        ("lost-topc", "did you mean 'lost-topic'?"),
        ("topics", "rules about it: MG201 lost-topic"),
        ("name", "rules about it: MB101 bad-name, MB102 odd-name"),
        ("really", "rules about it: MB101 bad-name, MB102 odd-name, MG201 lost-topic"),
        ("xyz", "see multibot inspect"), ("it", "see multibot inspect"),
    ],
)  # fmt: skip
def test_a_code_that_no_rule_has(word: str, hint: str) -> None:
    with pytest.raises(UsageError) as caught:
        codes.find_codes(["MB", "MB101", word], "--select", KNOWN)  # type: ignore[arg-type]
    assert str(caught.value) == (
        f"--select: no rule has the code {word!r}, and none begins with it; {hint}"
    )
    with pytest.raises(UsageError):
        codes.find_codes(["M"], "--select", KNOWN)  # type: ignore[arg-type]


def test_a_rule_for_a_terminal() -> None:
    it = FixedRule("MB101", "bad-name", ERROR)
    assert codes.explained(it) == (
        "MB101 bad-name (error)\n\nIt is. Really.\n\nWhy: It hurts.\n\nFix: Do it.\n\n"
        "Bad:\n\n    <a>\n    </a>\n\nFixed by --fix:\n\n    <b/>\n"
    )
    assert codes.examples(WrittenRule(*it)) == [("Bad", "<a/>"), ("Good", "<b/>")]
    assert codes.examples(RuleOfFiles(*it))[1:] == [("With it, a.yaml", "x: 1\n")]
