# SPDX-License-Identifier: Apache-2.0
"""Every format holds real findings of nasty documents, by its own schema or parser."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import pytest
from lint_calls import RULES, ArgumentSet, Settings, lint_file, lint_files
from lxml import etree
from markdown_it import MarkdownIt
from no_workers import lint_in_this_process

from multibot_rewrite.base.findings import formats
from multibot_rewrite.base.findings.finding import ERROR, LEVELS, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.formats import FORMATS, Report, plain
from multibot_rewrite.base.model import Edit

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
NASTY = ("<b>", '"', "|", "a\nb", "%0A", "::error::x", "é😀\u2028", "`*_[x](1)_*`", "\\|", "&amp;")
SPECIAL = str.maketrans({"<": "&lt;", ">": "&gt;", '"': "&quot;", "&": "&amp;", "\n": "&#10;"})
# Bytes of a name that are no UTF-8 reach Python as lone surrogates.
FILES = (
    "plain.urdf",
    "with space, colon: and %41#?.urdf",
    "new\nline|`.urdf",
    "日本😀\u2028.urdf",
    os.fsdecode(b"b\xff\xfe.urdf"),
)
# A part below the base, so that the base is not a finding.
HAND = (
    '<link name="hand"/><joint name="wrist" type="fixed">'
    '<parent link="base"/><child link="hand"/></joint>'
)
ARM = f"""<robot name="r" {XACRO}>
  <xacro:arg name="sim" default="0"/>
  <xacro:macro name="wheel" params="side"><link name="${{side}}"/></xacro:macro>
  <xacro:macro name="axle" params="at">
    <xacro:wheel side="${{at}}_left"/>
  </xacro:macro>
  <link name="base"/>{HAND}
  <xacro:axle at="front"/>
  <xacro:if value="$(arg sim)"><link name="ground"/></xacro:if>
</robot>
"""
SETTINGS = Settings(select=("MB101", "MB501"), levels={"MB101": WARNING})


def rendered(
    name: str, findings: Sequence[Finding], files: Sequence[str], *, colour: bool = False
) -> str:
    """Return the report of urdf-lint."""
    report = Report("urdf-lint", files, RULES)
    return formats.rendered(name, findings, report, colour=colour)


class Linted(NamedTuple):
    """Findings and the files they are of."""

    findings: list[Finding]
    files: list[str]


def pieces(*names: str) -> str:
    """Return a robot with a base and links without a joint: each of them is a finding."""
    links = [f'<link name="{name.translate(SPECIAL)}"/>' for name in names]
    return "\n  ".join(['<robot name="r">', f'<link name="base"/>{HAND}', *links, "</robot>"])


@pytest.fixture
def nasty(here: Path, monkeypatch: pytest.MonkeyPatch) -> Linted:
    """Nasty files with findings of every level, one without any, and one through macros."""
    lint_in_this_process(monkeypatch)
    for name in FILES:
        Path(name).write_text(pieces(*NASTY), encoding="utf-8")
    Path("clean.urdf").write_text(pieces())
    Path("broken.urdf").write_bytes(b'<robot name="r"><link name="\xff"')
    Path("arm.urdf.xacro").write_text(ARM)
    files = ["clean.urdf", *FILES, "broken.urdf", "arm.urdf.xacro"]
    simulated = ArgumentSet("*", (("sim", "1"),))
    found = lint_files(files, SETTINGS._replace(arguments=(simulated,)), jobs=1)
    notes = [it._replace(level=NOTE, hint="why\nnot") for it in found[:3]]
    return Linted([*notes, *found[3:]], files)


@pytest.fixture
def thousand(here: Path) -> Linted:
    Path("many.urdf").write_text(pieces(*(f"link_{at}" for at in range(1000))))
    return Linted(lint_files(["many.urdf"], SETTINGS, jobs=1), ["many.urdf"])


@pytest.fixture(
    params=["nasty", pytest.param("thousand", marks=pytest.mark.slow), "none", "nothing"]
)
def linted(request: pytest.FixtureRequest, here: Path) -> Linted:
    if request.param == "none":
        return Linted([], ["a.urdf", "b.urdf"])
    if request.param == "nothing":
        return Linted([], [])
    found: Linted = request.getfixturevalue(request.param)
    return found


def report(name: str, linted: Linted) -> Any:
    return json.loads(rendered(name, *linted))


def test_the_nasty_findings_are_what_the_tests_need(nasty: Linted) -> None:
    found = nasty.findings
    assert {it.level for it in found} == set(LEVELS)
    assert {it.file for it in found} == {*nasty.files} - {"clean.urdf"}
    assert [len(it.calls) for it in found if it.calls] == [2]
    assert [it.arguments for it in found if it.arguments] == ["sim:=1"]
    assert any("😀" in it.message for it in found)
    assert any("|" in it.message and "\\" in it.message for it in found)


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", FORMATS)
def test_a_report_is_utf8_and_the_same_each_time(name: str, linted: Linted) -> None:
    once = rendered(name, *linted)
    assert once.encode("utf-8").decode("utf-8") == once
    assert once == rendered(name, *linted)
    assert once.endswith("\n") or not linted.findings


@pytest.mark.slow
def test_only_the_module_of_a_format_is_loaded() -> None:
    code = """if True:
        import sys
        from multibot_rewrite.base.findings.formats import FORMATS, Report, rendered
        for name in FORMATS:
            rendered(name, [], Report("lint", [], {}))
            loaded = {it for it in sys.modules if ".findings.formats." in it}
            print(name, *(it.rpartition(".")[2] for it in loaded))
            for it in loaded: del sys.modules[it]
    """
    command = [sys.executable, "-c", code]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    loaded = {name: {*modules} for name, *modules in map(str.split, printed.splitlines())}
    expected = {name: {module, "plain"} for name, module in FORMATS.items()}
    assert loaded == expected


# text


def test_text_is_a_line_a_finding() -> None:
    first = Finding("MB501", ERROR, "'é' is lost", "", "a b.urdf", 4, 3)
    calls = ("p/r.urdf.xacro:5: wheel", "p/r.urdf.xacro:8: axle")
    more = first._replace(hint="join it", calls=calls, arguments="sim:=gz n:=2", level=WARNING)
    assert rendered("text", [first, more], []).splitlines() == [
        "a b.urdf:4:3: error: MB501 'é' is lost",
        "a b.urdf:4:3: warning: MB501 'é' is lost (join it) [with sim:=gz n:=2]",
        "    via p/r.urdf.xacro:5: wheel",
        "    via p/r.urdf.xacro:8: axle",
    ]


def test_text_is_what_was_found(nasty: Linted) -> None:
    lines = iter(rendered("text", *nasty).splitlines())
    for it in nasty.findings:
        line = next(lines)
        assert line.startswith(
            f"{plain.one_line(it.file)}:{it.line}:{it.column}: {it.level}: {it.code} "
        )
        assert it.message in line
        for call in it.calls:
            assert next(lines) == f"    via {call}"
    assert next(lines, None) is None


def test_text_holds_on_to_its_lines(nasty: Linted) -> None:
    calls = sum(len(it.calls) for it in nasty.findings)
    printed = rendered("text", *nasty)
    assert len(printed.splitlines()) == len(nasty.findings) + calls
    assert "new\\nline|`.urdf:" in printed
    assert "b\\udcff\\udcfe.urdf:" in printed


# json

NUMBER = {"type": "integer", "minimum": 0}
PLACE = {"type": "integer", "minimum": 1}
STRING = {"type": "string"}


def object_of(**properties: Any) -> dict[str, Any]:
    required = sorted(properties)
    return {
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": False,
    }


def list_of(item: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": item}


JSON_FINDING = object_of(
    code={"pattern": r"^MB\d{3}$"},
    name=STRING,
    level={"enum": list(LEVELS)},
    message=STRING,
    hint=STRING,
    file=STRING,
    line=PLACE,
    column=PLACE,
    calls=list_of(object_of(file=STRING, line=PLACE, macro=STRING)),
    arguments=STRING,
    robot=STRING,
    robots=list_of(STRING),
    node=STRING,
    names=list_of(STRING),
    edits=list_of(object_of(start=NUMBER, end=NUMBER, text=STRING)),
)
JSON = object_of(
    version={"const": 3},
    tool=STRING,
    files=NUMBER,
    distro={"type": ["string", "null"]},
    counts=object_of(**dict.fromkeys(LEVELS, NUMBER)),
    findings=list_of(JSON_FINDING),
)


@pytest.mark.more
def test_json_is_the_documented_object(linted: Linted) -> None:
    reported = report("json", linted)
    jsonschema.validate(reported, JSON)
    assert reported["files"] == len(linted.files)
    assert sum(reported["counts"].values()) == len(reported["findings"]) == len(linted.findings)
    for it, finding in zip(reported["findings"], linted.findings, strict=True):
        assert (it["code"], it["line"], it["column"]) == (
            finding.code,
            finding.line,
            finding.column,
        )
        assert (it["message"], it["hint"]) == (finding.message, finding.hint)


def test_a_call_is_read_from_its_end() -> None:
    calls = ("a:3: b.xacro:5: wheel",)
    finding = Finding("MB501", ERROR, "m", "", "a", 1, 1, calls)
    (call,) = report("json", Linted([finding], []))["findings"][0]["calls"]
    assert call == {"file": "a:3: b.xacro", "line": 5, "macro": "wheel"}


# SARIF


@pytest.fixture(scope="session")
def sarif_schema(pytestconfig: pytest.Config) -> dict[str, Any]:
    """Return the official schema, which the source distribution of cfn-lint has for its tests."""
    kept = pytestconfig.cache.mkdir("sarif") / "schema-2.1.0.json"
    if not kept.exists():
        command = [
            sys.executable,
            "-m",
            "pip",
            "download",
            "-q",
            "--no-deps",
            "--no-build-isolation",
        ]
        command += ["--no-binary", ":all:", "--dest", str(kept.parent), "cfn-lint==1.58.0"]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode:
            pytest.skip(f"no SARIF schema: cfn-lint cannot be downloaded: {ended.stderr[-200:]}")
        kept.write_bytes(from_archive(next(kept.parent.glob("*.tar.gz")), kept.name))
    schema: dict[str, Any] = json.loads(kept.read_bytes())
    return schema


def from_archive(path: Path, name: str) -> bytes:
    with tarfile.open(path) as archive:
        member = next(it for it in archive.getmembers() if it.name.endswith(f"/sarif/{name}"))
        file = archive.extractfile(member)
        assert file is not None
        return file.read()


def with_fixes(linted: Linted) -> Linted:
    """Every finding in a plain file with an edit of its own."""
    edit = Edit(1, 3, "é".encode(), None)
    fixed = [it._replace(edits=(edit,)) if it.file == FILES[0] else it for it in linted.findings]
    return linted._replace(findings=fixed)


@pytest.mark.deep
def test_sarif_holds_by_the_official_schema(linted: Linted, sarif_schema: dict[str, Any]) -> None:
    checker = jsonschema.Draft7Validator.FORMAT_CHECKER
    validator = jsonschema.Draft7Validator(sarif_schema, format_checker=checker)
    assert list(validator.iter_errors(report("sarif", with_fixes(linted)))) == []
    wrong = report("sarif", linted) | {"version": "2.0.0"}
    assert list(validator.iter_errors(wrong)) != []


def unknown(model: object) -> set[str]:
    """Keys that the models of SARIF do not know."""
    if isinstance(model, list):
        return {key for item in model for key in unknown(item)}
    from pydantic import BaseModel

    if not isinstance(model, BaseModel):
        return set()
    inside = (getattr(model, name) for name in type(model).model_fields)
    return {*(model.model_extra or ()), *(key for value in inside for key in unknown(value))}


@pytest.mark.more
@pytest.mark.sample(1)
def test_sarif_holds_by_its_models(linted: Linted) -> None:
    from sarif_pydantic import Sarif

    log = Sarif.model_validate_json(rendered("sarif", *with_fixes(linted)))
    # They lack this one, which the schema has.
    assert unknown(log) - {"columnKind"} == set()
    assert log.version == "2.1.0"


@pytest.mark.more
def test_sarif_has_every_rule_with_its_words(nasty: Linted) -> None:
    (run,) = report("sarif", nasty)["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert [it["id"] for it in rules] == list(RULES)
    for it in rules:
        rule = RULES[it["id"]]
        assert it["defaultConfiguration"]["level"] == rule.level
        assert all(len(it[key]["text"]) <= 1024 for key in ("shortDescription", "fullDescription"))
        words = (rule.what, rule.why, rule.fix, rule.page.bad, rule.page.good)
        for reported in it["help"].values():
            assert all(word in reported for word in words)


def replaced(lines: list[str], region: dict[str, int], text: str) -> str:
    """Return the text with the characters of a region replaced, as SARIF counts them."""
    offsets = [
        sum(len(line) for line in lines[: region[f"{end}Line"] - 1]) + region[f"{end}Column"] - 1
        for end in ("start", "end")
    ]
    whole = "".join(lines)
    return whole[: offsets[0]] + text + whole[offsets[1] :]


def test_a_sarif_fix_mends_as_the_edit_does(here: Path) -> None:
    source = pieces("é😀", "arm").encode()
    Path("a.urdf").write_bytes(source)
    (finding, _) = lint_file("a.urdf", SETTINGS)
    start = source.index("😀".encode())
    edit = Edit(start, source.index(b"arm") + 1, "ü\n".encode(), None)
    finding = finding._replace(edits=(edit,), hint="so")
    (fix,) = report("sarif", Linted([finding], ["a.urdf"]))["runs"][0]["results"][0]["fixes"]
    (change,) = fix["artifactChanges"]
    (replacement,) = change["replacements"]
    lines = source.decode().splitlines(keepends=True)
    inserted = replacement["insertedContent"]["text"]
    fixed = replaced(lines, replacement["deletedRegion"], inserted)
    assert fixed.encode() == source[: edit.start] + edit.before + source[edit.end :]


# paths


@pytest.mark.sample(1)
@pytest.mark.parametrize("spelled", ["a/b.urdf", "./a/b.urdf", "a/../a/b.urdf", "{here}/a/b.urdf"])
def test_services_get_paths_relative_to_where_the_lint_runs(spelled: str, here: Path) -> None:
    path = spelled.format(here=here)
    linted = Linted([Finding("MB501", ERROR, "m", "", path, 1, 1)], [path])
    result = report("sarif", linted)["runs"][0]["results"][0]
    location = result["locations"][0]["physicalLocation"]["artifactLocation"]
    assert location == {"uri": "a/b.urdf", "uriBaseId": "%SRCROOT%"}
    assert report("gitlab", linted)[0]["location"]["path"] == "a/b.urdf"
    assert "file=a/b.urdf," in rendered("github", *linted)
    assert "\n#### a/b.urdf\n" in rendered("markdown", *linted)
    assert '<testsuite name="a/b.urdf"' in rendered("junit", *linted)
    assert rendered("text", *linted).startswith(f"{path}:1:1: ")
    assert report("json", linted)["findings"][0]["file"] == path


def test_a_path_elsewhere_is_absolute_in_sarif(here: Path) -> None:
    linted = Linted([Finding("MB501", ERROR, "m", "", "../é a.urdf", 1, 1)], [])
    result = report("sarif", linted)["runs"][0]["results"][0]
    location = result["locations"][0]["physicalLocation"]["artifactLocation"]
    assert location == {"uri": f"file://{here.parent}/%C3%A9%20a.urdf"}
    assert report("gitlab", linted)[0]["location"]["path"] == "../é a.urdf"


# fingerprints


def prints(linted: Linted) -> list[tuple[str, str]]:
    results = report("sarif", linted)["runs"][0]["results"]
    there = [it["partialFingerprints"]["urdfLint/v1"] for it in results]
    return list(zip(there, [it["fingerprint"] for it in report("gitlab", linted)], strict=True))


@pytest.mark.more
@pytest.mark.sample(1)
def test_no_two_fingerprints_are_equal(linted: Linted) -> None:
    twice = linted._replace(findings=[*linted.findings, *linted.findings])
    assert len(set(prints(twice))) == 2 * len(linted.findings)


def test_a_fingerprint_survives_a_moved_line_and_another_path_to_it(here: Path) -> None:
    Path("a.urdf").write_text(pieces("x", "y"))
    before = Linted(lint_files(["a.urdf"], SETTINGS, jobs=1), [])
    Path("a.urdf").write_text("<!-- new -->\n\n" + pieces("x", "y"))
    after = Linted(lint_files([str(here / "a.urdf")], SETTINGS, jobs=1), [])
    assert before.findings[0].line != after.findings[0].line
    assert prints(before) == prints(after)


# GitHub

UNESCAPES = (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%"))


def unescaped(text: str, marks: str) -> str:
    for escape, mark in UNESCAPES:
        text = text.replace(escape, mark) if mark in marks else text
    return text


def parsed(line: str) -> tuple[str, dict[str, str], str]:
    """Return a workflow command as the runner reads it: name, properties, message."""
    line = line.lstrip()
    assert line.startswith("::")
    head, _, message = line[2:].partition("::")
    name, _, reported = head.partition(" ")
    pairs = [pair.split("=", 1) for pair in reported.strip().split(",") if pair]
    properties = {key: unescaped(value, "\r\n:,%") for key, value in pairs}
    return name, properties, unescaped(message, "\r\n%")


def test_github_reads_back_every_finding(linted: Linted) -> None:
    commands = [parsed(line) for line in rendered("github", *linted).split("\n")[:-1]]
    for (name, properties, message), finding in zip(commands, linted.findings, strict=True):
        assert name == {ERROR: "error", WARNING: "warning", NOTE: "notice"}[finding.level]
        assert message.split("\n")[0].startswith(finding.message)
        assert len(message.split("\n")) == 1 + len(finding.calls)
        assert properties.pop("file") in (finding.file, plain.one_line(finding.file))
        assert properties == {
            "line": str(finding.line),
            "col": str(finding.column),
            "title": f"{finding.code} {RULES[finding.code].name}",
        }


# GitLab

GITLAB = list_of(
    object_of(
        description=STRING,
        check_name=STRING,
        fingerprint={"type": "string", "minLength": 1},
        severity={"enum": ["info", "minor", "major", "critical", "blocker"]},
        location=object_of(path={"pattern": r"^(?!\./)"}, lines=object_of(begin=PLACE)),
    )
)


def test_gitlab_is_a_code_quality_report(linted: Linted) -> None:
    reported = report("gitlab", linted)
    jsonschema.validate(reported, GITLAB)
    for it, finding in zip(reported, linted.findings, strict=True):
        assert it["severity"] == {ERROR: "critical", WARNING: "major", NOTE: "info"}[finding.level]
        assert it["description"].startswith(f"{finding.code}: {finding.message}")
        assert it["location"]["lines"]["begin"] == finding.line


# JUnit


def test_junit_cases_hold_the_whole_text(nasty: Linted) -> None:
    root = etree.fromstring(rendered("junit", *nasty).encode())
    reported = [it.text for it in root.iter("failure", "system-out")]
    assert sorted(reported) == sorted("\n".join(plain.lines_of(it)) for it in nasty.findings)
    kinds = Counter(it.get("type") for it in root.iter("failure"))
    assert kinds == Counter(it.level for it in nasty.findings if it.level != NOTE)


@pytest.mark.parametrize("code", [*range(0x20), 0x7F, 0x85, 0xFFFE, 0xFFFF, 0xD800, 0xDFFF])
def test_junit_holds_characters_that_xml_does_not(code: int) -> None:
    finding = Finding("MB501", ERROR, f"a{chr(code)}b", "", f"{chr(code)}.urdf", 1, 1)
    (case,) = etree.fromstring(rendered("junit", [finding], []).encode()).iter("failure")
    assert case.get("message") == "a" + chr(code).encode("unicode_escape").decode() + "b"


# Markdown


def cells(markdown: str) -> list[list[str]]:
    """Return the rows of all tables as a reader sees them, headings of tables left out."""
    tokens = MarkdownIt("commonmark").enable("table").parse(markdown)
    rows: list[list[str]] = []
    for at, token in enumerate(tokens):
        if token.type == "tr_open":
            rows.append([])
        if token.type == "td_open":
            reported = tokens[at + 1].children or []
            assert {it.type for it in reported} <= {"text", "html_inline"}
            rows[-1].append("".join(it.content for it in reported))
    return [row for row in rows if row]


def test_markdown_shows_what_was_found(nasty: Linted) -> None:
    reported = Counter(tuple(row) for row in cells(rendered("markdown", *nasty)))
    expected = Counter()
    for it in nasty.findings:
        _, *calls = plain.lines_of(it)
        hint = f" ({it.hint})" if it.hint else ""
        given = f" [with {it.arguments}]" if it.arguments else ""
        first = plain.one_line(f"{it.message}{hint}{given}")
        what = "<br>".join([first, *(line.strip() for line in calls)])
        expected[(str(it.line), it.level, f"{it.code} {RULES[it.code].name}", what)] += 1
    assert reported == expected


def test_markdown_has_a_heading_a_file_with_findings(nasty: Linted) -> None:
    tokens = MarkdownIt().parse(rendered("markdown", *nasty))
    heads = [tokens[at + 1].children for at, it in enumerate(tokens) if it.type == "heading_open"]
    shown = ["".join(it.content for it in head or ()) for head in heads]
    assert shown == [plain.one_line(file) for file in nasty.files if file != "clean.urdf"]


# Codes that no rule has


@pytest.mark.parametrize("name", FORMATS)
def test_a_finding_of_an_unknown_rule_is_told_all_the_same(name: str, here: Path) -> None:
    finding = Finding("MB999", ERROR, "odd", "", "a.urdf", 1, 1)
    told = "MB999" if name == "statistics" else "odd"  # it counts, and tells no message
    assert told in rendered(name, [finding], ["a.urdf"])
