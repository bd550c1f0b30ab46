# SPDX-License-Identifier: Apache-2.0
"""Comments that suppress findings: what they reach, their faults, and when one is not needed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from paths import ROOT

from multibot_rewrite.base.findings.finding import Finding, Rule
from multibot_rewrite.base.findings.selection import is_on
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.lint.check import lint_file, unsuppressed
from multibot_rewrite.lint.config.directives import ALWAYS_REPORTED
from multibot_rewrite.lint.fix import fix
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import Subject

PAGE = (ROOT / "docs" / "lint.md").read_text()
XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'
QUIET = ("MB502", "MB503", "MB504")
ON = ("MB501", *QUIET, "MB0")
REAL = RULES["MB501"]


def links(subject: Subject) -> Iterator[Problem]:
    """Every link is a finding, but that called base."""
    for link in subject.robot.links:
        if link.name != "base":
            yield Problem(link.element, f"link {link.name!r}")


def active(settings: Settings, format_: str) -> list[Rule]:
    """As the registry has it, of the rules there are at this moment."""
    return [it for it in RULES.values() if format_ in it.formats and is_on(settings, it.code)]


@pytest.fixture(autouse=True)
def simple_rule(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the rules of this file."""
    monkeypatch.setattr("multibot_rewrite.lint.check.active_rules", active)
    monkeypatch.setitem(RULES, "MB501", REAL._replace(check=links, options={}))
    for code in QUIET:
        monkeypatch.setitem(RULES, code, RULES[code]._replace(check=lambda _: (), options={}))


def linted(folder: Path, text: str, name: str = "a.urdf", **options: Any) -> list[Finding]:
    path = folder / name
    path.write_bytes(text.encode())
    return lint_file(str(path), Settings(**{"select": ON, **options}))


def reported(found: list[Finding]) -> list[str]:
    return [f"{it.code}:{it.line}" for it in found]


def robot(body: str) -> str:
    """Return a robot whose body starts on line 2."""
    return f'<robot name="r"><link name="base"/>\n{body}\n</robot>\n'


def ignore(codes: str) -> str:
    return f"<!-- urdf-lint: ignore {codes} -->"


HERE = ignore("MB501")
REACH = [
    ('<link name="a"/>', ["MB501:2"]),
    # Its own line.
    (f'<link name="a"/> {HERE}', []),
    (f'{HERE}<link name="a"/>', []),
    (f'<link name="a"/>{HERE}<link name="b"/>', []),
    (f'<link name="a"\n/>{HERE}', ["MB501:2", "MB002:3"]),
    (f'<link name="a"/>\n{HERE}', ["MB501:2", "MB002:3"]),
    (f'<link name="a"/> {HERE}\n<link name="b"/>', ["MB501:3"]),
    (f'<link name="b"/>\n<link name="a"/> {HERE}', ["MB501:2"]),
    ('<link name="a"/><!-- urdf-lint: ignore MB501 - one\n two -->\n<link name="b"/>', ["MB501:4"]),
    # The element below, wherever in it.
    (f'{HERE}\n<link name="a"/>', []),
    (f'  {HERE}  \n\n\n  <link name="a"/>', []),
    (f'{HERE}\n<link\nname="a"\n/>', []),
    (f'{HERE}\n<link name="a"/><link name="b"/>', ["MB501:3"]),
    (f'{HERE}\n<link name="a"/>\n<link name="b"/>', ["MB501:4"]),
    (f'{HERE}\n<!-- one -->\n<!-- two -->\n<link name="a"/>', []),
    (f'{HERE}\n{HERE}\n<link name="a"/>', []),
    (f'{HERE} <!-- not alone -->\n<link name="a"/>', ["MB002:2", "MB501:3"]),
    (f'<!-- not alone -->{HERE}\n<link name="a"/>', ["MB002:2", "MB501:3"]),
    (f'{HERE}\ntext\n<link name="a"/>', ["MB002:2", "MB501:4"]),
    (f'<![CDATA[<link>]]>\n{HERE}\n<link name="a"/>', []),
    (f'<!-- {HERE[4:]}\n<link name="a"/>', []),
    (f'{HERE}\n<?pi?>\n<link name="a"/>', ["MB002:2", "MB501:4"]),
    # More than one code.
    (f'{ignore("MB501, MB502")}\n<link name="a"/>', ["MB002:2"]),
    (f'{ignore("MB502 MB501")}\n<link name="a"/>', ["MB002:2"]),
    (f'{ignore("MB502")}\n<link name="a"/>', ["MB002:2", "MB501:3"]),
    # No comments for the lint.
    (f'<![CDATA[\n{HERE}\n]]><link name="a"/>', ["MB501:4"]),
    ('<link name="a"/><!-- MB501 -->', ["MB501:2"]),
    ('<link name="a"/><!-- checked with urdf-lint -->', ["MB501:2"]),
    ('<link name="a"/><!-- urdf-lint 1.0 is content -->', ["MB501:2"]),
    ('<link name="a"/><!-- noqa: urdf-lint: ignore MB501 -->', ["MB501:2"]),
    ('<link name="a" title="&lt;!-- urdf-lint: ignore MB501 -->"/>', ["MB501:2"]),
]


@pytest.mark.parametrize("end", ["\n", "\r\n"], ids=["lf", "crlf"])
@pytest.mark.parametrize(("body", "wanted"), REACH)
def test_what_a_comment_reaches(tmp_path: Path, body: str, wanted: list[str], end: str) -> None:
    assert reported(linted(tmp_path, robot(body).replace("\n", end))) == wanted


def test_before_the_root_it_is_for_all_of_it(tmp_path: Path) -> None:
    text = robot('<link name="a"/>\n<link name="b"/>')
    assert linted(tmp_path, f"{HERE}\n{text}") == []
    assert linted(tmp_path, f'<?xml version="1.0"?>\n{HERE}\n{text}') == []


FILE = "<!-- urdf-lint: ignore-file MB501 -->"
BODY = '<link name="a"/>\n<link name="b"/>\n'
WHOLE = [
    (f'<robot name="r">{FILE}\n{BODY}</robot>', []),
    (f'{FILE}\n<robot name="r">\n{BODY}</robot>', []),
    (f'{FILE}<robot name="r">\n{BODY}</robot>', []),
    (
        f'<robot name="r">\n<link name="c"/>{FILE}\n{BODY}</robot>',
        ["MB501:2", "MB003:2", "MB501:3", "MB501:4"],
    ),
    (f'<robot name="r">\n{BODY}</robot>\n{FILE}', ["MB501:2", "MB501:3", "MB003:5"]),
    (f'<robot name="r">{FILE}\n<link name="base"/>\n</robot>', ["MB002:1"]),
    (f'<robot name="r">{FILE}</robot>', ["MB002:1"]),
]


@pytest.mark.parametrize(("text", "wanted"), WHOLE)
def test_a_comment_for_the_whole_file(tmp_path: Path, text: str, wanted: list[str]) -> None:
    assert reported(linted(tmp_path, text)) == wanted


# The comment -> None where it suppresses MB501, else words of the message and hint.
GRAMMAR: list[tuple[str, str | None]] = [
    ("urdf-lint: ignore MB501", None),
    ("urdf-lint:ignore MB501", None),
    ("urdf-lint : ignore MB501", None),
    ("\n  urdf-lint: ignore\n    MB501\n", None),
    ("urdf-lint: ignore MB501 - a reason, MB9999", None),
    ("urdf-lint: ignore MB501: a reason", None),
    ("urdf-lint: ignore MB501 : a reason", None),
    ("urdf-lint: ignore MB501 \u2013 a reason", None),
    ("urdf-lint: ignore MB501 — grüße", None),
    ("urdf-lint: ignore MB501 -", None),
    ("urdf-lint: ignore MB501:", None),
    ("urdf-lint: ignore ,MB501,", None),
    ("urdf-lint: ignore MB501, MB501", None),
    ("urdf-lint: disable MB501", "unknown word 'disable' (write"),
    ("urdf-lint: ignored MB501", "unknown word 'ignored' (did you mean 'ignore'?)"),
    (
        "urdf-lint: ignore_file MB501",
        "unknown word 'ignore_file' (did you mean 'ignore-",
    ),
    ("urdf-lint: Ignore MB501", "did you mean 'ignore'?"),
    ("urdf-lint: ignore[MB501]", "unknown word 'ignore[MB501]'"),
    ("urdf-lint: MB501", "unknown word 'MB501'"),
    ("urdf-lint:", "the comment is empty"),
    ("urdf-lint: ignore", "there is no code in it"),
    ("urdf-lint: ignore - MB501", "there is no code in it"),
    ("urdf-lint: ignore: MB501", "there is no code in it"),
    ("urdf-lint ignore MB501", "there is no colon after 'urdf-lint'"),
    ("urdf-lint: ignore MB9999", "no rule has the code 'MB9999'"),
    ("urdf-lint: ignore mb501", "no rule has the code 'mb501' (did you mean MB501?)"),
    ("urdf-lint: ignore MB5", "'MB5' is not a whole code (write whole codes)"),
    (
        "urdf-lint: ignore several-roots",
        "'several-roots' is a rule's name, not its code (write MB501)",
    ),
    ("urdf-lint: ignore several-rots", "'several-rots' is not a code"),
    ("urdf-lint: ignore MB501-MB503", "'MB501-MB503' is not a code"),
    ("urdf-lint: ignore MB502:MB501", "'MB502:MB501' is not a code"),
    ("urdf-lint: ignore because I say so", "'because' is not a code (put a dash before a reason"),
    *(
        (f"urdf-lint: ignore {code}", f"no comment can suppress {code}")
        for code in sorted(ALWAYS_REPORTED)
    ),
]


@pytest.mark.parametrize(("text", "words"), GRAMMAR)
def test_the_grammar(tmp_path: Path, text: str, words: str | None) -> None:
    """Where it cannot be followed that is one error, and the finding stays."""
    found = linted(tmp_path, robot(f'<link name="a"/> <!-- {text} -->'))
    if words is None:
        assert found == []
        return
    line, broken = (found[0], found[1])
    assert (line.code, broken.code, broken.level) == ("MB501", "MB003", "error")
    assert len(found) == 2
    assert words in f"{broken.message} ({broken.hint})"


def test_the_codes_that_are_right_hold_beside_a_wrong_one(tmp_path: Path) -> None:
    text = robot(f'{ignore("MB501, MB9999 as it is")}\n<link name="a"/>')
    found = linted(tmp_path, text)
    assert [(it.code, it.line, it.column) for it in found] == [("MB003", 2, 31), ("MB003", 2, 38)]


def test_the_rules_about_comments_can_be_off(tmp_path: Path) -> None:
    text = robot(f"<!-- urdf-lint: disable -->\n{HERE}")
    assert reported(linted(tmp_path, text)) == ["MB003:2", "MB002:3"]
    assert reported(linted(tmp_path, text, ignore=("MB003",))) == ["MB002:3"]
    assert linted(tmp_path, text, per_file=(("*.urdf", ("MB0",)),)) == []
    levels = {"MB002": "note", "MB003": "warning"}
    assert [it.level for it in linted(tmp_path, text, levels=levels)] == ["warning", "note"]


# Settings under which a comment for MB501 above a lone root is not called unused.
SPARED: list[tuple[dict[str, Any], bool]] = [
    ({}, False),
    ({"select": ("MB0",)}, True),
    ({"ignore": ("MB501",)}, True),
    ({"levels": {"MB501": "off"}}, True),
    ({"per_file": (("*", ("MB5",)),)}, True),
    ({"per_file": (("*.srdf", ("MB5",)),)}, False),
]


@pytest.mark.parametrize(("options", "spared"), SPARED)
def test_unused_is_told_only_of_rules_that_are_asked(
    tmp_path: Path, options: dict[str, Any], spared: bool
) -> None:
    text = f'<robot name="r">\n{HERE}\n<link name="base"/></robot>'
    assert reported(linted(tmp_path, text, **options)) == ([] if spared else ["MB002:2"])


def test_a_rule_without_its_settings_is_not_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = f'<robot name="r">\n{HERE}\n<link name="base"/></robot>'
    dependent = RULES["MB501"]._replace(options={"robots": ("r1",), "layout": "L4"})
    monkeypatch.setitem(RULES, "MB501", dependent)
    assert linted(tmp_path, text) == []
    assert reported(linted(tmp_path, text, robots=("r1",))) == ["MB002:2"]


def test_a_file_that_was_not_looked_at_to_its_end_is_not_judged() -> None:
    source = {"f": f'<robot name="r">\n{HERE}\n<link name="base"/></robot>'.encode()}
    settings = Settings(select=ON)
    assert [it.code for it in unsuppressed([], source, settings)] == ["MB002"]
    for code in ("MB001", "MB004", "MB101", "MB102", "MB103"):
        finding = Finding(code, "error", "m", "", "f", 2, 1)
        assert unsuppressed([finding], source, settings) == [finding]


def test_per_file_settings_need_no_comment(tmp_path: Path) -> None:
    text = robot('<link name="a"/>')
    for pattern, left in (("*.urdf", 0), (f"{tmp_path}/*", 0), ("*.xacro", 1), ("a.urdf", 1)):
        found = linted(tmp_path, text, per_file=((pattern, ("MB5",)),))
        assert len(found) == left


# Text, and what --fix makes of it.
FIXES = [
    (f'<link name="base"/>\n  {HERE}\n', '<link name="base"/>\n'),
    (f'<link name="base"/> {HERE}\n', '<link name="base"/>\n'),
    (f'<link name="base"/>\n{HERE}<joint/>\n', '<link name="base"/>\n<joint/>\n'),
    (f'<link name="base"/>{ignore("MB502 - why")}', '<link name="base"/>'),
    (f'{ignore("MB502, MB503")}\n<link name="base"/>', '<link name="base"/>'),
    (ignore("MB501, MB502"), ignore("MB501")),
    (ignore("MB502, MB501"), ignore("MB501")),
    (ignore("MB502 MB501 MB503: why"), ignore("MB501: why")),
    (ignore("MB502, MB503, MB501, MB504"), ignore("MB501")),
    (f"text {HERE.replace('501', '502')} more", None),
    (f"text {HERE.replace('501', '502')}", None),
    (f"{HERE.replace('501', '502')} more", None),
    (ignore("MB502, MB9999"), None),
]


@pytest.mark.parametrize("end", ["\n", "\r\n"], ids=["lf", "crlf"])
@pytest.mark.parametrize(("before", "after"), FIXES)
def test_an_unused_code_is_taken_out(before: str, after: str | None, end: str) -> None:
    """A comment after a second root suppresses its MB501."""
    one = "MB501" in (after or "")
    frame = '<robot name="r"><link name="base"/>\n{}<link name="z"/>\n</robot>\n'
    if not one:
        frame = '<robot name="r">\n{}\n</robot>\n'
    text = frame.format(before).replace("\n", end)
    wanted = text if after is None else frame.format(after).replace("\n", end)
    data, left = fix("f.urdf", text.encode(), Settings(select=ON))
    assert data.decode() == wanted
    assert [it for it in left if it.edits] == []


# In xacro: the body on line 2 of a file whose root has a name, MB501 or MB002 by line.
IF = '<xacro:if value="0">'
MACRO = '<xacro:macro name="m">\n<link name="a"/>\n</xacro:macro>\n'
IN_XACRO = [
    (f'{HERE}\n<link name="a"/>', []),
    (f"{HERE}\n<gazebo/>", ["MB002:2"]),
    # Not in every expansion, so not judged.
    (f"{IF}\n{HERE}\n<gazebo/>\n</xacro:if>", []),
    (f'<xacro:unless value="1">\n{HERE}\n<gazebo/>\n</xacro:unless>', []),
    (f"{HERE}\n{IF}<gazebo/></xacro:if>", []),
    (f"{HERE}\n<gazebo>{IF}<a/></xacro:if></gazebo>", []),
    (f'<xacro:macro name="m">\n{HERE}\n<gazebo/>\n</xacro:macro>', []),
    (f"{IF}<gazebo/></xacro:if>\n{HERE}\n<gazebo/>", ["MB002:3"]),
    # At the macro for all calls, at a call for what it makes.
    (f"{MACRO}<xacro:m/>", ["MB501:3"]),
    (f"{MACRO.replace('<link', HERE + '<link')}<xacro:m/>", []),
    (f"{MACRO}{HERE}\n<xacro:m/>", []),
    (f"{MACRO}<xacro:m/> {HERE}", []),
    (f"{MACRO}{HERE}\n<gazebo/>\n<xacro:m/>", ["MB501:3", "MB002:5"]),
    (f"{MACRO}{HERE}\n<xacro:m/>\n<xacro:m/>", ["MB501:3"]),
]


@pytest.mark.sample(1)
@pytest.mark.parametrize(("body", "wanted"), IN_XACRO)
def test_in_xacro_it_stands_in_the_source(tmp_path: Path, body: str, wanted: list[str]) -> None:
    text = f'{XACRO}<link name="base"/>\n{body}\n</robot>'
    assert reported(linted(tmp_path, text, "a.urdf.xacro")) == wanted


def test_a_part_of_some_robot_is_not_judged(tmp_path: Path) -> None:
    part = f"{XACRO}\n{HERE}\n<gazebo/></robot>"
    assert reported(linted(tmp_path, part, "a.xacro")) == ["MB002:2"]
    assert linted(tmp_path, part.replace(' name="r"', ""), "a.xacro") == []
    path = str(tmp_path / "a.xacro")
    (tmp_path / "a.xacro").write_text(part)
    assert lint_file(path, Settings(select=ON, included=frozenset({path}))) == []


@pytest.mark.parametrize(
    "text",
    [
        b"<!-- urdf-lint: ignore MB501",
        b"urdf-lint <a <a <a '",
        b"</a></b>\n<!-- urdf-lint: ignore MB501 -->\n</a>",
        b"<!-- urdf-lint: ignore MB501 -->\n<a>",
        b"<!-- urdf-lint: ignore \xff\xfe -->",
        b"<!-- urdf-lint: \xff -->",
        b"<![CDATA[ urdf-lint",
        b'<robot a="' + b"<a b=\n" * 500 + b"urdf-lint",
    ],
)
def test_text_that_is_no_xml_ends_in_no_traceback(text: bytes) -> None:
    unsuppressed([Finding("MB501", "error", "m", "", "f", 1, 1)], {"f": text}, Settings())


@pytest.mark.slow
def test_hundreds_of_comments_take_no_time(tmp_path: Path) -> None:
    text = robot("\n".join(f'{HERE}\n<link name="l{at}"/>' for at in range(400)))
    assert linted(tmp_path, text, seconds=5) == []


@pytest.mark.parametrize("text", re.findall(r"```xml\n(.*?)```", PAGE, re.DOTALL))
def test_an_example_of_the_page_suppresses(
    tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(RULES, "MB501", REAL)
    assert linted(tmp_path, text) == []
    assert reported(linted(tmp_path, re.sub("<!--.*?-->", "", text))) != []


@pytest.mark.parametrize(
    ("call", "silent"), [(2, False), (3, True), (4, True), (6, True), (7, False)]
)
def test_a_comment_reaches_what_is_called_in_the_element_below_it(call: int, silent: bool) -> None:
    """The comment is in line 3, its element in lines 4 to 6."""
    text = '<robot name="r">\n\n  <!-- urdf-lint: ignore MB501 - known -->\n'
    text += '  <link name="a">\n    <visual/>\n  </link>\n</robot>\n'
    within = Finding("MB501", "error", "m", "", "b.xacro", 9, 9, (f"a.xacro:{call}: part",))
    left = unsuppressed([within], {"a.xacro": text.encode()}, Settings(select=("MB501",)))
    assert left == ([] if silent else [within])
