# SPDX-License-Identifier: Apache-2.0
"""What commands do not take together, and what a watch ends with: no process, no file of a robot."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Generator, Mapping
from pathlib import Path
from typing import Any

import pytest
import small_fleet
from refusals import said

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.cli import (
    check,
    lint,
    live,
    rewrite_use,
    unplanned,
    view,
)
from multibot_rewrite.system.records import System


def options(**given: Any) -> argparse.Namespace:
    return argparse.Namespace(**given)


# ---------------------------------------------------------------- urdf-postfix


REWRITE = {
    "input": "r.urdf", "words": [], "urdf": None, "xacro": None, "definitions": [], "undo": False,
    "in_place": False, "output": None, "output_kind": "description", "diff": False, "select": [],
    "ignore": [],
    "format": "text",
}  # fmt: skip


def test_a_rewrite_does_not_land_on_what_it_reads(tmp_path: Path) -> None:
    files = {it: str(tmp_path / it) for it in ("r.urdf", "u", "v", "x.xacro")}
    for path in files.values():
        Path(path).write_text("")
    use = {**REWRITE, "input": files["r.urdf"]}
    told = f"{files['r.urdf']} is the input file; choose another name, or --in-place"
    onto = options(**{**use, "output": files["r.urdf"]})
    assert said(rewrite_use.check_use, onto, ["a"]) == told
    for more, option in (
        ({"urdf": files["u"], "output": files["u"]}, "urdf"),
        (
            {"definitions": [files["v"]], "output_kind": "changes", "output": files["v"]},
            "definitions",
        ),
        ({"xacro": files["x.xacro"], "undo": True, "output": files["x.xacro"]}, "xacro"),
    ):
        message = said(rewrite_use.check_use, options(**{**use, **more}), ["a"])
        assert message.endswith(f"is the file of --{option}; choose another name")
    read = options(output="out/{robot}")
    told = said(rewrite_use.check_unread, read, ["a", "b"], ["out/b"])
    assert told.startswith("out/b is a file that")
    rewrite_use.check_unread(read, ["a"], ["out/b"])
    rewrite_use.check_unread(options(output=None), ["a"], ["x"])


def test_the_input_as_messages_call_it() -> None:
    named = [rewrite_use.input_name(options(input=it)) for it in ("-", "a.urdf", "a.xacro")]
    assert named == ["<stdin>", "a.urdf", "a.xacro (expanded)"]
    assert rewrite_use.target_path("out/{robot}/{robot}.urdf", "a") == "out/a/a.urdf"


# ---------------------------------------------------------------- urdf-lint


LINT = {
    "words": ["a.urdf"], "fix": False, "changed_since": None, "diff": False, "output": None,
    "write_baseline": None, "baseline": None,
}  # fmt: skip


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"words": []}, "no PATH given; for example: urdf-lint urdf/"),
        ({"words": ["a", ""]}, "the name of a file is empty; write its path"),
        *(
            ({"words": ["-"], **it},
             "standard input is linted alone, without --fix and --changed-since")
            for it in ({"words": ["-", "a"]}, {"fix": True}, {"changed_since": "HEAD"})
        ),
        ({"diff": True}, "--diff shows what --fix would change: give both"),
        ({"diff": True, "fix": True, "output": "x"},
         "--diff prints to standard output: leave out --output"),
        *(
            ({"write_baseline": "b", **it},
             "--write-baseline takes neither --fix, --baseline nor --output")
            for it in ({"fix": True}, {"baseline": "c"}, {"output": "x"})
        ),
    ],
)  # fmt: skip
def test_a_lint_that_cannot_be_meant(given: dict[str, object], message: str) -> None:
    assert said(lint.check_use, options(**{**LINT, **given})) == message


# ---------------------------------------------------------------- plan, check --watch


PLAN = {
    **dict.fromkeys(("robots", "count", "node_set", "launch", "layout", "affix", "topics")),
    "output_kind": "plan",
    "separator": [], "shared": [], "input": "a.launch.py", "words": [], "output": None,
}  # fmt: skip


def views(*graphs: System) -> Generator[Mapping[int, System], None, None]:
    yield from ({0: it} for it in graphs)


WATCH = {
    "plan": "plan.yaml", "program": "multibot", "command": "check", "quiet": False, "verbose": False,
    "fail_on": ERROR, "select": [], "ignore": [], "output": None, "report": None, "state": False,
    "suggest": None, "format": "text", "color": "never", "snapshot": [],
}  # fmt: skip


HELD = "2 robots, 2 nodes each"


def watched(
    monkeypatch: pytest.MonkeyPatch, run: Callable[..., int], *graphs: System, **more: object
) -> int:
    monkeypatch.setattr(live, "watched", lambda *_, **__: views(*graphs))
    given = {**WATCH, **more}
    planned = (given.pop("of"),) if "of" in given else ()
    return run(options(**given), *planned)


@pytest.mark.parametrize(
    ("gap", "code", "words"),
    [
        ((), 0, "0 findings: as planned"),
        ((WARNING,), 0, "1 finding: nothing wrong seen, but the plan has faults"),
        ((ERROR,), 1, "1 finding: nothing wrong seen, but the plan has faults"),
    ],
)
def test_a_watch_of_a_plan_ends_with_its_worst(
    gap: tuple[str, ...], code: int, words: str, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    gaps = tuple(Finding("MF801", it, "is open", robot="robot1") for it in gap)
    of = small_fleet.plan()._replace(gaps=gaps, release="lyrical")
    assert watched(monkeypatch, check._watch, small_fleet.healthy(), of=of) == code
    told = capsys.readouterr()
    assert told.err == f"multibot: {HELD}: all known, all seen; {words} (ROS 2 lyrical)\n"
    assert told.out.startswith("".join(f"robot1: {it}: MF801 is open\n" for it in gap))


def test_a_watch_with_a_fault_writes_its_findings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    out = tmp_path / "found.txt"
    graphs = (small_fleet.healthy(), small_fleet.clash())
    given = {"output": str(out), "of": small_fleet.plan()}
    assert watched(monkeypatch, check._watch, *graphs, **given) == 1
    assert "MG306" in out.read_text()
    assert f"{HELD}: all known, all seen; 1 finding: not as planned" in capsys.readouterr().err


@pytest.mark.parametrize("run", [check._watch, unplanned._watch])
def test_a_watch_that_saw_nothing_is_inconclusive(
    run: Callable[..., int], monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    given = {"of": small_fleet.plan()} if run is check._watch else {}
    assert watched(monkeypatch, run, **given) == 3
    assert capsys.readouterr().err == "multibot: ended before anything was seen\n"


def test_a_watch_without_a_plan(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    out = tmp_path / "found.txt"
    assert watched(monkeypatch, unplanned._watch, small_fleet.healthy()) == 0
    assert capsys.readouterr().err == f"multibot: {HELD}; 0 findings: nothing wrong seen\n"
    assert watched(monkeypatch, unplanned._watch, small_fleet.clash(), output=str(out)) == 1
    assert capsys.readouterr().err == f"multibot: {HELD}; 1 finding: something is wrong\n"
    assert "types-differ" in out.read_text() or "MG306" in out.read_text()


def test_what_a_check_does_not_take_together() -> None:
    usual = {**WATCH, "watch": True, "zenoh": None, "bag": None}
    for given in ({"select": ["M"]}, {"ignore": ["M"]}, {"format": "json"}):
        for run in (check._check_use, unplanned._check_use):
            assert said(run, options(**{**usual, **given})) == (
                "--watch shows every finding: leave out --select, --ignore and --format"
            )
    suggesting = options(**{**usual, "suggest": "x", "watch": False})
    assert said(check._check_use, suggesting) == "--suggest begins a plan: leave out PLAN"


def test_a_folder_is_a_file_of_each_robot_below_it(tmp_path: Path) -> None:
    """As a build writes them."""
    assert rewrite_use.below("out/", "a/rover.urdf.xacro") == "out/{robot}/rover.urdf"
    assert rewrite_use.below(str(tmp_path), "-") == f"{tmp_path}/{{robot}}/robot.urdf"
    assert rewrite_use.below("out/{robot}.urdf", "a.urdf") == "out/{robot}.urdf"
    assert rewrite_use.below(None, "a.urdf") is None


@pytest.mark.parametrize("name", ["f.yaml", "f.yml"])
@pytest.mark.parametrize(
    ("given", "written"),
    [({"words": ["a"]}, "ROBOT"), ({"words": ["x:=1"]}, "ROBOT"), ({"robots": ["a"]}, "--robots"),
     ({"shared": ["/t"]}, "--shared"), ({"layout": "both"}, "--layout")],
)  # fmt: skip
def test_a_fleet_file_to_view_has_its_own(
    name: str, given: dict[str, object], written: str
) -> None:
    usual = {"words": [], "robots": [], "layout": None, "affix": None, "topics": None}
    asked = options(**{**usual, "separator": [], "shared": [], "input": name, **given})
    assert said(view._plan_of, asked) == f"{name}: a fleet file has its own, leave out {written}"
