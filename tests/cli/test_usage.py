# SPDX-License-Identifier: Apache-2.0
"""What options mean: robots, arguments, the source of a graph, files that are read and written."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Generator, Mapping
from pathlib import Path
from typing import Any

import pytest
from refusals import said

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli import check, live, output, pictures, rewrite, snapshot, usage, walk
from multibot_rewrite.cli.report import counted_findings
from multibot_rewrite.system.records import Parameter, System


def options(**given: Any) -> argparse.Namespace:
    return argparse.Namespace(**given)


def test_given_options_are_named_as_they_are_written() -> None:
    names = {"a": "--a", "b": "--b", "c": "-c"}
    assert usage.given_options(options(a=1, b="", c=["x"]), names) == ["--a", "-c"]


@pytest.mark.parametrize("text", ["a.urdf", ":3", "a.urdf:", "a.urdf:x", "3"])
def test_a_line_to_explain_is_a_file_and_a_number(text: str) -> None:
    assert (
        said(rewrite._file_and_line, text)
        == f"--why {text}: write FILE:LINE, for example rover.urdf:34"
    )


def test_a_file_with_a_colon_may_be_explained() -> None:
    assert rewrite._file_and_line("a:b.urdf:34") == ("a:b.urdf", 34)


# ---------------------------------------------------------------- the source of a graph


EVERY = {"select": [], "ignore": [], "format": "text"}
USUAL = {"snapshot": [], "zenoh": None, "watch": False, "state": False, "bag": None}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        *(
            ({"bag": "b", it: "x"}, f"b is a recording, which has no nodes: leave out --{it}")
            for it in ("watch", "state", "suggest", "report")
        ),
        ({"snapshot": ["g"], "watch": True}, "--watch is for the live graph, leave out --from"),
        *(
            (
                {it: "x", "state": True},
                "--state asks nodes of the live graph: leave out --from",
            )
            for it in ("snapshot", "zenoh")
        ),
    ],
)
def test_a_graph_has_one_source(given: dict[str, object], message: str) -> None:
    assert said(live.check_source, options(**{**USUAL, **given})) == message


@pytest.mark.parametrize(
    "given",
    [{}, {"snapshot": ["g"]}, {"zenoh": "z"}, {"watch": True, "state": True, **EVERY}, {"bag": "b"},
     {"zenoh": "z", "watch": True, **EVERY}],
)  # fmt: skip
def test_one_source_is_enough(given: dict[str, object]) -> None:
    live.check_source(options(**{**USUAL, **given}))
    live.check_source(options(snapshot=["g"], zenoh=None))


def test_a_live_graph_is_asked_for_with_what_the_options_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from multibot_rewrite.producers.ros import child

    asked: list[tuple[Any, str]] = []
    monkeypatch.setenv("ROS_DOMAIN_ID", "3")
    monkeypatch.setattr(
        child, "observe", lambda it, around, _: asked.append((it, around["ROS_DOMAIN_ID"]))
    )

    def watch(it: Any, around: Mapping[int, Mapping[str, str]]) -> Generator[Any, None, None]:
        asked.append((it, ",".join(one["ROS_DOMAIN_ID"] for one in around.values())))
        first, last = min(around), max(around)
        yield from ((first, "a"), (first, "b"), (last, "c"), (first, "d"))

    monkeypatch.setattr(child, "watch", watch)
    plain = {**USUAL, "timeout": None, "domain": None}
    live.graph(options(**plain))
    live.graph(options(**{**plain, "timeout": 2.0, "domain": 7}))
    next(live.watched(options(**plain), {"a": ["b"]}))
    asks = options(**{**plain, "timeout": 4.0, "state": True})
    # Nothing is said before each has been seen.
    assert [*live.watched(asks, {"a": ["b"]}, (11, 12))] == [{11: "b", 12: "c"}, {11: "d", 12: "c"}]
    first, _, watched, asking = (it for it, _ in asked)
    assert [it for _, it in asked] == ["3", "7", "3", "11,12"]
    assert (first.timeout, first.watch) == (15.0, False)
    assert (watched.timeout, watched.watch, watched.asks) == (float("inf"), True, None)
    assert (asking.timeout, asking.asks) == (4.0, {"a": ["b"]})


def test_a_domain_that_rcl_would_not_take_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "x")
    with pytest.raises(UsageError, match="ROS_DOMAIN_ID"):
        live.environ()
    assert live.environ(5)["ROS_DOMAIN_ID"] == "5"


def test_parameters_of_a_plan_are_asked_by_node() -> None:
    asked = [("/a", "x"), ("/b", "z"), ("/a", "y")]
    plan = System(parameters=tuple(Parameter(node, name, "1") for node, name in asked))
    assert check._asked_parameters(plan) == {"/a": ["x", "y"], "/b": ["z"]}


@pytest.mark.parametrize(
    ("release", "asked", "found"), [("jazzy", "", "jazzy"), ("", "humble", "humble"),
    ("jazzy", "jazzy", "jazzy"), ("", "", "")],
)  # fmt: skip
def test_a_plan_is_of_its_release(release: str, asked: str, found: str) -> None:
    given = options(distro=asked or None, plan="plan.yaml")
    assert check._checked_release(given, System(release=release)).release == found


def test_a_plan_of_another_release_is_refused() -> None:
    given = options(distro="humble", plan="plan.yaml")
    assert said(check._checked_release, given, System(release="jazzy")) == (
        "plan.yaml is for ROS 2 jazzy; make one with multibot plan --distro humble,"
        " or leave out --distro"
    )


def test_notes_about_a_plan_are_counted_where_nobody_asks_for_them(
    capsys: pytest.CaptureFixture[str],
) -> None:
    known = (
        ("MF801", WARNING),
        ("MG316", NOTE),
        ("MG316", NOTE),
        ("MF844", NOTE),
        ("MG316", ERROR),
    )
    gaps = tuple(Finding(code, level, "open") for code, level in known)
    plan = System(gaps=gaps)
    usual = {"select": [], "ignore": [], "quiet": False, "program": "multibot", "verbose": False}
    found = check._shown_gaps(options(**usual, fail_on=ERROR), plan)
    assert found == [gaps[0], gaps[3], gaps[4]]
    assert capsys.readouterr().err == (
        "multibot: note: 2 notes about topics that no known node sends; --verbose shows them\n"
    )
    assert check._shown_gaps(options(**usual, fail_on=NOTE), plan) == list(gaps)
    assert check._shown_gaps(options(**{**usual, "verbose": True}, fail_on=ERROR), plan) == list(
        gaps
    )
    assert len(check._shown_gaps(options(**usual, fail_on=ERROR), System(gaps=gaps[:1]))) == 1
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("levels", "text"),
    [((), "0 findings"), ((NOTE,), "1 note"), ((NOTE, NOTE), "2 notes"), ((NOTE, ERROR), "2 findings"),
     ((ERROR,), "1 finding")],
)  # fmt: skip
def test_only_notes_are_called_notes(levels: tuple[str, ...], text: str) -> None:
    assert counted_findings([Finding("M", it, "") for it in levels]) == text


# ---------------------------------------------------------------- a learned node


@pytest.mark.parametrize(
    ("target", "form", "nodl"),
    [(None, None, False), ("a.yaml", None, False), (None, "nodes", False), ("a.yaml", "nodes", False),
     (None, "nodl", True), ("out", "nodl", True), ("a.nodl.yaml", None, True),
     ("a.nodl.yml", None, True), ("a.nodl.json", "nodl", True)],
)  # fmt: skip
def test_the_name_or_the_form_says_that_it_is_nodl(
    target: str | None, form: str | None, nodl: bool
) -> None:
    assert snapshot.is_nodl(options(output=target, output_kind=form)) is nodl


def test_what_a_snapshot_does_not_take_together() -> None:
    names = {"node": [], "namespace": None, "node_set": None, "distro": None}
    usual = {
        **USUAL,
        **names,
        "timeout": None,
        "domain": None,
        "output": None,
        "output_kind": "nodes",
    }
    usual |= {"expect": []}
    assert snapshot._check_use(options(**usual))
    assert snapshot._check_use(options(**{**usual, "expect": ["/a"], "timeout": 0.0}))
    for name, given in (("timeout", 0.0), ("domain", 0), ("expect", ["/a"])):
        saved = options(**{**usual, "snapshot": ["g.json"], name: given})
        hint = f"--{name} is for the live graph, leave out --from"
        assert said(snapshot._check_use, saved) == hint
        saved.snapshot, saved.bag = [], "bag/"
        assert said(snapshot._check_use, saved) == hint
    same = options(**{**usual, "snapshot": ["g.json"], "output": "./g.json"})
    assert said(snapshot._check_use, same).startswith("./g.json is a file that is read")
    assert snapshot._check_use(options(**{**usual, "snapshot": ["g.json"], "output": "n.yaml"}))
    assert not snapshot._check_use(options(**{**usual, "output_kind": "rosgraph"}))
    words = {"node": ["/a"], "namespace": "/a", "node_set": "s", "distro": "jazzy"}
    for name, given in words.items():
        lonely = options(**{**usual, "output_kind": None, name: given})
        hint = f"--{name} is for a description of nodes: add --output-kind nodes".replace("_", "-")
        assert said(snapshot._check_use, lonely) == hint
    assert said(snapshot.is_nodl, options(output="a.nodl.yaml", output_kind="nodes")) == (
        "a.nodl.yaml is the name of a NoDL file; leave out --output-kind nodes"
    )


# ---------------------------------------------------------------- files and streams


def test_files_below_folders_are_each_once_and_in_order(tmp_path: Path) -> None:
    for name in ("b.urdf", "A.URDF", "c.txt", "sub/d.sdf", ".hidden/e.urdf", "sub/x.urdf"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "loop").symlink_to(tmp_path)
    (tmp_path / "dead.urdf").symlink_to(tmp_path / "none")
    os.mkfifo(tmp_path / "pipe.urdf")
    suffixes = (".urdf", ".sdf")
    found = walk.find_files([str(tmp_path / "b.urdf"), str(tmp_path)], suffixes).files
    assert [os.path.relpath(it, tmp_path) for it in found] == [
        "b.urdf", "A.URDF", "dead.urdf", "sub/d.sdf", "sub/x.urdf",
    ]  # fmt: skip
    wanted = walk.find_files([str(tmp_path)], suffixes, wanted=lambda it: it.endswith(".sdf")).files
    assert wanted == [str(tmp_path / "sub" / "d.sdf")]
    # A file that is named is taken whatever it is called.
    assert walk.find_files([str(tmp_path / "c.txt")], suffixes).files == [str(tmp_path / "c.txt")]
    gone, empty = str(tmp_path / "gone"), tmp_path / "empty"
    empty.mkdir()
    told = f"{gone}: there is no such file or folder; correct the path"
    assert said(walk.find_files, [gone], suffixes) == told
    assert said(walk.find_files, [str(empty)], suffixes) == (
        f"{empty}: no *.urdf or *.sdf there; name a file or another folder"
    )


def test_a_result_does_not_replace_what_is_read(tmp_path: Path) -> None:
    one, two = tmp_path / "a", tmp_path / "b"
    one.write_text("")
    os.link(one, two)
    for target in (str(one), f"{tmp_path}/./a", str(two)):
        assert said(walk.check_target, target, ["x", str(one)]) == (
            f"{target} is a file that is read; choose another one for --output"
        )
    assert said(walk.check_target, "x", ["x"], "--report").endswith(
        "choose another one for --report"
    )
    walk.check_target(str(tmp_path / "c"), [str(one)])
    walk.check_target(str(tmp_path), [str(tmp_path / "c")])


def test_a_link_is_not_written_through(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    link = tmp_path / "sub" / "link"
    link.symlink_to(tmp_path / "far")
    assert said(walk.check_link, str(link)) == (
        f"{link} is a link to {tmp_path / 'far'}; name that, if it is meant"
    )
    for fine in (str(tmp_path / "plain"), "/dev/stdout"):
        walk.check_link(fine)


def test_the_folder_of_a_result_can_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    walk.check_folder(str(tmp_path / "new" / "sub" / "a"))
    target = str(tmp_path / "file" / "sub" / "a")
    assert said(walk.check_folder, target) == (
        f"{target}: cannot be written: {tmp_path / 'file'} is a file; name another folder"
    )


class Stdin:
    def __init__(self, data: bytes) -> None:
        self.buffer = io.BytesIO(data)


def test_standard_input_has_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walk, "MAX_BYTES", 5)
    monkeypatch.setattr(sys, "stdin", Stdin(b"12345"))
    assert walk.standard_input() == b"12345"
    monkeypatch.setattr(sys, "stdin", Stdin(b"123456"))
    with pytest.raises(
        InputError, match="<stdin>: cannot be read: it is over the limit of 5 bytes"
    ):
        walk.standard_input()
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(InputError, match="<stdin>: standard input is closed; name a file instead"):
        walk.standard_input()


class Screen(io.StringIO):
    def __init__(self, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal


@pytest.mark.parametrize(
    ("when", "around", "terminal", "coloured"),
    [
        ("always", {"NO_COLOR": "1"}, False, True), ("never", {"FORCE_COLOR": "1"}, True, False),
        ("auto", {}, True, True), ("auto", {}, False, False), ("auto", {"TERM": "dumb"}, True, False),
        ("auto", {"FORCE_COLOR": "1"}, False, True), ("auto", {"NO_COLOR": "1"}, True, False),
        ("auto", {"NO_COLOR": "1", "FORCE_COLOR": "1"}, True, False),
        ("auto", {"NO_COLOR": ""}, True, True),
    ],
)  # fmt: skip
def test_what_decides_on_colour(
    when: str,
    around: dict[str, str],
    terminal: bool,
    coloured: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    for name, value in around.items():
        monkeypatch.setenv(name, value)
    assert output.is_coloured(when, Screen(terminal)) is coloured
    assert output.is_coloured("auto", None) is bool(
        around.get("FORCE_COLOR") and "NO_COLOR" not in around
    )


@pytest.mark.parametrize("terminal", [True, False])
def test_a_wait_is_a_line_on_a_terminal_that_goes_again(
    terminal: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = Screen(terminal)
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    with pytest.raises(KeyboardInterrupt), output.shown("looking\nfor it"):
        assert screen.getvalue() == "\r\033[Klooking\\nfor it" * terminal
        raise KeyboardInterrupt
    assert screen.getvalue().endswith("\r\033[K" * terminal)


def test_a_diff_is_one_that_patch_reads() -> None:
    made = output.diff(b"a\nb\nc", b"a\nB\nc", "old\nname", "new é")
    assert (
        made
        == (
            "--- old\\nname\n+++ new é\n@@ -1,3 +1,3 @@\n a\n-b\n+B\n c\n\\ No newline at end of file\n"
        ).encode()
    )
    coloured = output.diff(b"a\n", b"b\n", "x", "y", colour=True)
    assert coloured == (
        b"\033[31m--- x\033[0m\n\033[32m+++ y\033[0m\n\033[36m@@ -1,1 +1,1 @@\033[0m\n"
        b"\033[31m-a\033[0m\n\033[32m+b\033[0m\n"
    )
    # Nothing but changed lines is between lines that are often there.
    joints = "".join(f"<joint name='{it}'>\n</joint>\n" for it in range(150)).encode()
    made = output.diff(joints, joints.replace(b"='", b"='p_"), "x", "y")
    assert made.count(b"\n-") == made.count(b"\n+") - 1 == 150
    assert output.diff(joints, joints, "x", "y") == b""


def test_files_that_options_name_to_be_read() -> None:
    given = options(input="a", plan="b", snapshot=["c", "d"], urdf=None, nodes="", config="e")
    assert [path for _, path in output._read_files(given)] == ["a", "b", "c", "d", "e"]
    known = (
        "input",
        "plan",
        "fleet",
        "snapshot",
        "urdf",
        "xacro",
        "definitions",
        "nodes",
        "suggest",
    )
    assert (*known, "config", "baseline") == output.READ


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"input": "rovr.urdf"}, "rovr.urdf is not there; did you mean 'rover.urdf'?"),
        ({"plan": "flet.yaml"}, "flet.yaml is not there; did you mean 'fleet.yaml'?"),
        ({"snapshot": ["rover.urdf", "g.json"]},
         "g.json is not there; multibot snapshot -o FILE writes one"),
        ({"plan": "out/p.yaml"}, "out/p.yaml is not there; multibot build and multibot plan write one"),
        ({"input": "other.yaml"}, "other.yaml is not there; multibot init PATH... writes a fleet file"),
        ({"input": "p.yaml", "command": "urdf-postfix"}, "p.yaml is not there; correct the path"),
        ({"fleet": "our.yml"}, "our.yml is not there; multibot init PATH... writes a fleet file"),
        ({"urdf": "none.xacro"}, "none.xacro is not there; correct the path"),
    ],
)  # fmt: skip
def test_a_file_that_is_not_there_is_told_with_what_helps(
    given: dict[str, object], message: str, here: Path
) -> None:
    for name in ("rover.urdf", "fleet.yaml"):
        Path(name).write_text("")
    assert said(output.check_there, options(**{"command": "plan", **given})) == message


def test_a_result_is_not_written_over_a_file_that_an_option_names(tmp_path: Path) -> None:
    file = tmp_path / "own.vocab"
    file.write_text("old")
    given = options(output=str(file), definitions=[str(file)])
    assert said(output.deliver, given, b"new").startswith(f"{file} is a file that is read")
    assert file.read_text() == "old"


def test_what_may_be_no_file_is_not_looked_for(tmp_path: Path) -> None:
    for given in (
        {"input": "my_bringup"}, {"input": "-"}, {"nodes": ["none"]}, {"suggest": "a.b"},
        {"fleet": "gone.yaml", "undo": True}, {"input": "/dev/fd/63"}, {"plan": None},
    ):  # fmt: skip
        output.check_there(options(**given))


def test_a_line_about_the_work_replaces_the_one_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "11")
    monkeypatch.setenv("TERM", "xterm")
    screen = Screen(True)
    monkeypatch.setattr(sys, "stderr", screen)
    show = output.status()
    show("one\ntwo and more")
    show("")
    assert screen.getvalue() == "\r\033[Kone\\ntwo a\r\033[K"
    monkeypatch.setenv("TERM", "dumb")
    output.status()("not shown")
    monkeypatch.setattr(sys, "stderr", Screen(False))
    output.status()("not shown")
    assert sys.stderr.getvalue() == "" and screen.getvalue().count("\r") == 2  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("quiet", "verbose", "lines"),
    [(False, False, ["p: note"]), (True, False, []), (True, True, []),
     (False, True, ["p: note", "p: more"])],
)  # fmt: skip
def test_what_quiet_and_verbose_show(
    quiet: bool, verbose: bool, lines: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    given = options(quiet=quiet, verbose=verbose, program="p")
    output.note(given, "note")
    output.detail(given, "more")
    assert capsys.readouterr().err.splitlines() == lines


@pytest.mark.parametrize(("target", "file"), [(None, False), ("-", False), ("a", True)])
def test_only_a_name_is_a_file(target: str | None, file: bool) -> None:
    assert output.goes_to_file(options(output=target)) is file


# ---------------------------------------------------------------- the page of a check


def test_a_page_goes_where_nothing_is_read_or_written(tmp_path: Path) -> None:
    plan = str(tmp_path / "plan.yaml")
    pictures.check(options())
    pictures.check(options(report=None))
    pictures.check(options(report=str(tmp_path / "r.html"), output="x", plan=plan, snapshot=["g"]))
    for name in ("plan", "input"):
        given = options(report=plan, **{name: plan})
        assert said(pictures.check, given) == (
            f"{plan} is a file that is read; choose another one for --report"
        )
    given = options(report="g", snapshot=["f", "g"])
    assert said(pictures.check, given).startswith("g is a file that is read")
    given = options(report="./x", output="x")
    assert said(pictures.check, given) == (
        "./x: two results would go to this one file, give each its own"
    )


@pytest.mark.parametrize("suffix", ["urdf", "xacro", "srdf", "sdf", "xml", "world", "yaml", "yml"])
def test_lines_of_a_source_are_shown_with_their_numbers(suffix: str, tmp_path: Path) -> None:
    file = tmp_path / f"a:b.{suffix}"
    file.write_text("".join(f"line {at}  \n" for at in range(1, 8)) + "x" * 170)
    found = pictures.snippets([f"{file}:4", f"{file}:8", f"{file}:1", f"{file}:x", "", ":3"])
    assert found == {
        f"{file}:4": [f"    {at} line {at}" for at in range(2, 7)],
        f"{file}:8": ["    6 line 6", "    7 line 7", f"    8 {'x' * 160}"],
        f"{file}:1": [f"    {at} line {at}" for at in (1, 2, 3)],
    }
