# SPDX-License-Identifier: Apache-2.0
"""Known findings: written, read, held against new ones; files that are not a baseline."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from multibot_rewrite import UsageError
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.lint.config.baseline import (
    FORMAT,
    baseline_text,
    beyond,
    read_baseline,
)

pytestmark = pytest.mark.usefixtures("here")


def finding(
    code: str = "MB501", file: str = "a.urdf", message: str = "m", line: int = 1
) -> Finding:
    return Finding(code, "error", message, "hint", file, line, 1)


def kept(known: list[Finding], found: list[Finding], path: str = "b.json") -> tuple[int, int]:
    """How many are new and how many gone after a way through the file."""
    Path(path).write_bytes(baseline_text(known, path))
    new, gone = beyond(found, read_baseline(path), path)
    return len(new), gone


A, B = finding(), finding("MB502")
KEPT = [
    ([], [], (0, 0)),
    ([A], [A], (0, 0)),
    ([A], [], (0, 1)),
    ([], [A], (1, 0)),
    ([A], [A._replace(line=900, column=7)], (0, 0)),
    ([A], [A._replace(level="note", hint="", arguments="sim:=gz", calls=("c",))], (0, 0)),
    ([A], [A._replace(message="other")], (1, 1)),
    ([finding(message="m, first at line 3")], [finding(message="m, first at line 12")], (0, 0)),
    ([finding(message="line_3 of 4")], [finding(message="line_4 of 4")], (1, 1)),
    ([A], [A._replace(file="b.urdf")], (1, 1)),
    ([A], [B], (1, 1)),
    ([A], [A, A._replace(line=2)], (1, 0)),
    ([A, A._replace(line=2)], [A], (0, 1)),
    ([A, A, A], [], (0, 3)),
    ([A, A, B], [A, A, A, B, B], (2, 0)),
]


@pytest.mark.parametrize(("known", "found", "wanted"), KEPT)
def test_only_what_is_on_top_is_new(
    known: list[Finding], found: list[Finding], wanted: tuple[int, int]
) -> None:
    assert kept(known, found) == wanted


def test_of_many_alike_the_last_are_new() -> None:
    lines = [finding(line=line) for line in (1, 2, 3)]
    Path("b.json").write_bytes(baseline_text(lines[:2], "b.json"))
    assert beyond(lines, read_baseline("b.json"), "b.json") == ([lines[2]], 0)


FILES = [
    ("b.json", "a.urdf", "a.urdf"),
    ("ci/b.json", "robots/a.urdf", "../robots/a.urdf"),
    ("ci/b.json", "./ci/a.urdf", "a.urdf"),
    ("b.json", "robots/../a.urdf", "a.urdf"),
    ("b.json", "a.xacro (expanded)", "a.xacro (expanded)"),
    ("b.json", "grün 'a\".urdf", "grün 'a\".urdf"),
]


@pytest.mark.parametrize(("path", "file", "written"), FILES)
def test_files_hang_on_the_folder_of_the_baseline(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: str, file: str, written: str
) -> None:
    """So it is the same from wherever the lint runs."""
    for folder in ("ci", "robots"):
        (tmp_path / folder).mkdir()
    assert kept([finding(file=file)], [finding(file=str(tmp_path / file))], path) == (0, 0)
    assert json.loads(Path(path).read_bytes())["findings"][0]["file"] == written
    monkeypatch.chdir(tmp_path / "robots")
    there = f"../{path}"
    assert beyond([finding(file=f"../{file}")], read_baseline(there), there) == ([], 0)


def test_of_files_that_were_not_linted_nothing_is_gone(tmp_path: Path) -> None:
    known = [finding(file="a.urdf"), finding(file="b.urdf"), finding(file="deleted.urdf")]
    for name in ("a.urdf", "b.urdf"):
        (tmp_path / name).touch()
    (tmp_path / "b.json").write_bytes(baseline_text(known, "b.json"))
    baseline = read_baseline("b.json")
    assert beyond([], baseline, "b.json") == ([], 3)
    assert beyond([], baseline, "b.json", ["./a.urdf"]) == ([], 2)
    assert beyond([], baseline, "b.json", []) == ([], 1)


def entry(**other: object) -> str:
    it = {"code": "MB501", "file": "a", "message": "m", "count": 1, **other}
    return json.dumps({FORMAT: 1, "findings": [it]})


BROKEN = [
    ("", "Expecting value"),
    ("{", "Expecting property name"),
    ("[]", '"urdf-lint-baseline": 1 is not in it'),
    ("{}", '"urdf-lint-baseline": 1 is not in it'),
    ('{"urdf-lint-baseline": 2, "findings": []}', "1 is not in it"),
    ('{"urdf-lint-baseline": 1}', '"findings" is not a list'),
    ('{"urdf-lint-baseline": 1, "findings": {}}', '"findings" is not a list'),
    ('{"urdf-lint-baseline": 1, "findings": [1]}', "finding 1 does not have just code, file"),
    (entry(line=3), "finding 1 does not have just"),
    (entry(code=501), "'code' of finding 1 is 501"),
    (entry(count=True), "'count' of finding 1 is True"),
    (entry(count=0), "'count' of finding 1 is 0"),
    (entry(count=1.5), "'count' of finding 1 is 1.5"),
    (entry(message=None), "'message' of finding 1 is None"),
    ("[" * 100000, "nested deeper"),
    ('{"a": ' + "1" * 5000 + "}", "5,000 characters"),
    (b"\xff\xfe\xfa", "decode"),
    (b"{\xff", "decode"),
]


@pytest.mark.parametrize(("text", "words"), BROKEN)
def test_what_is_not_a_baseline_is_one_line(text: str | bytes, words: str) -> None:
    Path("b.json").write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UsageError) as caught:
        read_baseline("b.json")
    message = str(caught.value)
    assert message.startswith("b.json: not a baseline of urdf-lint: ")
    assert message.endswith("; write one with --write-baseline b.json")
    assert words in message
    assert "\n" not in message


@pytest.mark.parametrize(("path", "words"), [("none.json", "No such file"), (".", "directory")])
def test_a_baseline_that_is_not_there_is_one_line(path: str, words: str) -> None:
    with pytest.raises(UsageError, match=f"{path}: cannot be read: .*{words}"):
        read_baseline(path)
