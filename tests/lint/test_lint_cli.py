# SPDX-License-Identifier: Apache-2.0
"""The command urdf-lint: what it says, where, and its exit codes."""

from __future__ import annotations

import io
import json
import os
import pty
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from paths import FIXTURES, write_files

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.cli.declared.commands import PROGRAMS
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.lint.registry import RULES

pytestmark = pytest.mark.more

COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint"]
HARMLESS = '<robot name="r"><link name="a"/></robot>'
BROKEN = '<robot name="r"><link name="a">'
TWO_ROOTS = '<robot name="r">\n<link name="a"/>\n<link name="b"/></robot>'
LEFT = '<robot name="r"><link name="${p}a"/></robot>'
ROVER = str(FIXTURES / "robots" / "rover.urdf")
LINE = re.compile(
    r"(?P<file>.+):(?P<line>\d+):(?P<column>\d+): (error|warning|note): (?P<code>MB\d{3}) \S.*"
)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a file of each kind, which is the working directory."""
    files = {
        "good.urdf": HARMLESS,
        "two_roots.urdf": TWO_ROOTS,
        "left.urdf": LEFT,
        "sub/deep/robot.urdf": HARMLESS,
        "sub/other.srdf": '<robot name="r"/>',
        "sub/notes.txt": BROKEN,
        ".hidden/bad.urdf": BROKEN,
        "empty/readme.md": "",
    }
    write_files(tmp_path, files)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def said(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error."""
    try:
        code = main(list(words))
    except SystemExit as end:
        code = int(end.code or 0)
    out, err = capsys.readouterr()
    return code, out, err


# ---------------------------------------------------------------- exit codes

TWO = ["two_roots.urdf"]
ENDS: list[tuple[Sequence[str], int]] = [
    (["good.urdf"], 0),
    (TWO, 1),
    (["good.urdf", *TWO], 1),
    (["."], 1),
    (["sub"], 0),
    # Not looked for, but named.
    (["sub/notes.txt"], 1),
    ([".hidden/bad.urdf"], 1),
    (["left.urdf"], 1),
    (["left.urdf", "--fail-on", "error"], 0),
    (["left.urdf", "--fail-on", "error", "--ignore", "MB105"], 0),
    ([*TWO, "--ignore", "MB5"], 0),
    ([*TWO, "--select", "MB2"], 0),
    ([*TWO, "--select", "MB501"], 1),
    ([*TWO, "--select", "MB5", "--ignore", "MB501"], 0),
    ([*TWO, "--ignore", "MB5", "--select", "MB501"], 1),
    ([ROVER], 0),
    ([ROVER, "--fail-on", "note"], 1),
    ([ROVER, "--robots", "robot1,robot2", "--layout", "L2"], 0),
    ([ROVER, "--robots", "robot1,robot2", "--fail-on", "note"], 1),
    ([ROVER, "--target", "mjcf"], 0),
    (["--help"], 0),
    (["--version"], 0),
]


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("words", "code"), ENDS, ids=[" ".join(it) for it, _ in ENDS])
def test_exit_codes(words: Sequence[str], code: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert said(capsys, *words)[0] == code


WRONG: list[tuple[Sequence[str], str]] = [
    ([], "no PATH given; for example: urdf-lint urdf/"),
    ([""], "the name of a file is empty"),
    (["nowhere.urdf"], "nowhere.urdf: there is no such file or folder"),
    (["good.urdf", "nowhere"], "nowhere: there is no such file or folder"),
    (
        ["empty"],
        "empty: no *.urdf or *.xacro or *.srdf or *.sdf or *.yaml or *.yml or *.rviz or *.lua or *.xml"
        " there; name a file or another folder",
    ),
    (["good.urdf", "--select", "MB999"], "no rule has the code 'MB999'"),
    (["good.urdf", "--ignore", "MB2,nonsense"], "no rule has the code 'nonsense'"),
    (["good.urdf", "--select", "mb2"], "did you mean 'MB2'?"),
    (["good.urdf", "--select", ","], "',' has an empty part"),
    (["good.urdf", "--format", "xml"], "argument --format: 'xml' is not known, use one of text"),
    (["good.urdf", "--fail-on", "never"], "use one of error, warning, note"),
    (["good.urdf", "--robots", "1a"], "robot name '1a'"),
    (["good.urdf", "--robots", "a,a"], "'a' is given twice"),
    (["good.urdf", "--layout", "L9"], "'L9' is not known, use one of tf-per-robot"),
    (["good.urdf", "--target", "usd"], "use one of mjcf"),
    (["good.urdf", "--diff"], "give both"),
    (["good.urdf", "--lsp"], "leave out PATH"),
    (["--lsp", "--changed-since", "HEAD"], "leave out PATH, --fix"),
    (["good.urdf", "--fix", "--diff", "--output", "x"], "leave out --output"),
    (["good.urdf", "-"], "standard input is linted alone"),
    (["-", "--fix"], "standard input is linted alone"),
    (["good.urdf", "--config", "no.toml"], "no.toml"),
    (["good.urdf", "--baseline", "no.json"], "no.json"),
    (["good.urdf", "--definitions", "no.vocab"], "no.vocab"),
    (["good.urdf", "--output", "left.urdf/report"], "left.urdf is a file; name another folder"),
    (["good.urdf", "--output", "good.urdf"], "choose another one for --output"),
    (["good.urdf", "--output", "sub/../good.urdf"], "choose another one for --output"),
    (["sub", "--write-baseline", "sub/other.srdf"], "choose another one for --write-baseline"),
    (["good.urdf", "--output", "sub"], "it is a folder"),
    (["good.urdf", "--write-baseline", "x", "--baseline", "y"], "takes neither"),
    (["good.urdf", "--layuot", "L2"], "unknown option --layuot; did you mean '--layout'?"),
    (["good.urdf", "--changed-since", "no-such-revision"], "git"),
]


@pytest.mark.parametrize(("words", "reason"), WRONG, ids=[" ".join(it) for it, _ in WRONG])
def test_wrong_use_is_one_line_and_changes_nothing(
    words: Sequence[str], reason: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = {path: path.read_bytes() for path in here.rglob("*") if path.is_file()}
    code, out, err = said(capsys, *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("urdf-lint: ") and reason in err
    assert {path: path.read_bytes() for path in here.rglob("*") if path.is_file()} == before


@pytest.mark.usefixtures("here")
def test_zero_files_are_no_pass(capsys: pytest.CaptureFixture[str]) -> None:
    Path("urdf-lint.toml").write_text('exclude = ["*.urdf", "*.srdf"]\n')
    assert said(capsys, ".") == (
        2,
        "",
        "urdf-lint: .: exclude leaves no file to lint; name a file itself\n",
    )
    assert said(capsys, "good.urdf")[0] == 0


# ---------------------------------------------------------------- what is said


@pytest.mark.usefixtures("here")
def test_lines_are_such_that_editors_find_the_place(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, err = said(capsys, ".", "--robots", "robot1,robot2")
    lines = [LINE.fullmatch(line) for line in out.splitlines()]
    assert all(lines)
    assert {it["file"] for it in lines if it} >= {"left.urdf", "two_roots.urdf"}
    assert re.fullmatch(
        r"urdf-lint: 5 files: 1 error, 1 warning(, \d+ notes?)? \(ROS 2 \w+\)\n", err
    )


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (".", "sub/deep/robot.urdf"),
        ("./sub", "./sub/deep/robot.urdf"),
        ("sub", "sub/deep/robot.urdf"),
        ("sub/deep/robot.urdf", "sub/deep/robot.urdf"),
        ("./sub/deep/robot.urdf", "./sub/deep/robot.urdf"),
    ],
)
def test_files_are_named_as_they_were_given(
    given: str, expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("sub/deep/robot.urdf").write_text(BROKEN)
    _, out, _ = said(capsys, given, "--select", "MB101")
    assert [line.partition(":")[0] for line in out.splitlines()] == [expected]


@pytest.mark.usefixtures("here")
def test_the_order_is_that_of_files_and_lines(capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("b.urdf", "a.urdf"):
        many = "".join(f'\n<link name="{at}"/>' for at in range(30))
        Path(name).write_text(f'<robot name="r">{many}</robot>')
    _, out, _ = said(capsys, "b.urdf", "a.urdf", "--select", "MB501")
    places = [LINE.fullmatch(line) for line in out.splitlines()]
    lines = [int(it["line"]) for it in places if it]
    assert lines == [*range(3, 32)] * 2
    assert [it["file"] for it in places if it] == ["b.urdf"] * 29 + ["a.urdf"] * 29


@pytest.mark.usefixtures("here")
def test_a_file_that_is_given_twice_is_linted_once(capsys: pytest.CaptureFixture[str]) -> None:
    os.symlink("two_roots.urdf", "link.urdf")
    _, out, err = said(capsys, *TWO, "./two_roots.urdf", "link.urdf", ".", "--select", "MB501")
    assert out.count("MB501") == 1
    assert err.startswith("urdf-lint: 5 files: 1 error")


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("form", FORMATS)
def test_output_has_what_would_be_printed(form: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = said(capsys, ".", "--format", form)
    assert said(capsys, ".", "--format", form, "--output", "report")[:2] == (code, "")
    assert Path("report").read_text() == out


@pytest.mark.usefixtures("here")
def test_quiet_says_nothing_but_findings(capsys: pytest.CaptureFixture[str]) -> None:
    assert said(capsys, "good.urdf", "--quiet") == (0, "", "")
    code, out, err = said(capsys, *TWO, "--quiet")
    assert (code, err) == (1, "")
    assert "MB501" in out


@pytest.mark.usefixtures("here")
def test_json_is_there_when_nothing_is_found(capsys: pytest.CaptureFixture[str]) -> None:
    assert json.loads(said(capsys, "good.urdf", "--format", "json")[1])["findings"] == []


def test_help_names_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    out = said(capsys, "--help")[1]
    options = {
        name
        for group in PROGRAMS["urdf-lint"].groups
        for it in group.options
        for name in it.names[-1:]
    }
    options -= {"words"}
    assert [it for it in options if it not in out] == []


def test_every_rule_of_several_robots_asks_for_them() -> None:
    """Without robots there are no findings that depend on them."""
    for code in ("MB106", "MB405", "MB422"):
        assert RULES[code].options.get("robots"), code
    assert RULES["MB202"].level == ERROR


def test_what_one_robot_is_already_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from multibot_rewrite import rewrite

    file = tmp_path / "robot1.urdf"
    file.write_bytes(rewrite(ROVER, "robot1", layout="L2").data)
    words = [str(file), "--layout", "L2", "--select", "MB106"]
    assert said(capsys, *words, "--robots", "robot2,robot1")[0] == 1
    assert said(capsys, *words, "--robots", "robot2,robot3")[0] == 0
    assert said(capsys, *words)[0] == 0


# ---------------------------------------------------------------- streams


def test_standard_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(TWO_ROOTS.encode())))
    code, out, err = said(capsys, "-", "--select", "MB501")
    assert (code, out.partition(" ")[0]) == (1, "<stdin>:3:7:")
    assert err == "urdf-lint: 1 file: 1 error (ROS 2 lyrical)\n"


STREAMS = [
    ("1>&-", 2, "standard output is closed; name a file with -o"),
    ("1>&- --output report", 1, "5 files"),
    (">/dev/full", 2, "No space left on device"),
    ("--output /dev/full", 2, "No space left on device"),
    ("--output /dev/stdout", 1, "5 files"),
    ("2>&-", 1, ""),
    ("<&-", 1, "5 files"),
]


@pytest.mark.sample(3)
@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("how", "code", "words"), STREAMS)
def test_streams_that_are_closed_or_full(how: str, code: int, words: str) -> None:
    line = f"{' '.join(COMMAND)} . {how}"
    result = subprocess.run(line, shell=True, capture_output=True, text=True, check=False)
    assert result.returncode == code
    assert words in result.stderr
    assert "Traceback" not in result.stderr + result.stdout


@pytest.mark.usefixtures("here")
def test_a_reader_that_goes_away() -> None:
    line = f"{' '.join(COMMAND)} . | true; echo ${{PIPESTATUS[0]}}"
    result = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
    assert result.stdout.splitlines()[-1] == "141"  # as of every program that SIGPIPE ends
    assert result.stderr == ""


def on_a_terminal(words: Sequence[str], **environment: str) -> str:
    """Return what the command prints on a terminal."""
    parent, child = pty.openpty()
    known = {**os.environ, "TERM": "xterm", **environment}
    lint = subprocess.Popen([*COMMAND, *words], stdout=child, stderr=child, env=known)
    os.close(child)
    text = b""
    while True:
        try:
            read = os.read(parent, 65536)
        except OSError:  # how a terminal reports its end
            break
        if not read:
            break
        text += read
    lint.wait()
    os.close(parent)
    return text.decode()


@pytest.mark.usefixtures("here")
def test_a_terminal_has_colours_and_a_progress_bar() -> None:
    for at in range(40):
        Path(f"sub/{at}.urdf").write_text(HARMLESS)
    text = on_a_terminal(["."])
    assert "\x1b[31merror: MB501\x1b[0m" in text
    assert "linting" in text and "\x1b[2K" in text
    # The bar is taken away before anything else is written.
    assert "linting" not in text[text.index("two_roots.urdf") :]


@pytest.mark.usefixtures("here")
def test_no_color_is_heeded_and_few_files_have_no_bar() -> None:
    text = on_a_terminal(["."], NO_COLOR="1")
    assert "\x1b" not in text and "linting" not in text
