# SPDX-License-Identifier: Apache-2.0
"""What ``check --watch`` shows of one view after the other, without nodes: as lines and as a screen."""

from __future__ import annotations

import io
import sys
from collections.abc import Generator, Sequence

import pytest
from small_fleet import healthy, plan

from multibot_rewrite import compare
from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.cli import live
from multibot_rewrite.cli.multibot import main as multibot
from multibot_rewrite.cli.watch import Views, follow
from multibot_rewrite.live.watching import WatchState
from multibot_rewrite.system.coverage import Coverage, coverage
from multibot_rewrite.system.records import System

MANY = 17


def look(views: Views) -> tuple[System, Coverage, Sequence[Finding]]:
    return views[0], coverage(plan(), views[0]), compare(plan(), views[0])


def views(*graphs: System, ended: bool = False) -> Generator[Views, None, None]:
    """Yield the views, and Ctrl-C after the last."""
    yield from ({0: it} for it in graphs)
    if ended:
        raise KeyboardInterrupt


def test_nothing_seen_is_no_state() -> None:
    assert follow(look, views()) is None
    assert follow(look, views(ended=True)) is None


class Terminal(io.StringIO):
    """A screen of 200 columns that says that it is one."""

    def isatty(self) -> bool:
        return True


def shown(monkeypatch: pytest.MonkeyPatch, found: Sequence[Finding]) -> list[str]:
    """Return the lines of the last screen."""
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("LINES", "60")
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setattr(sys, "stdout", screen := Terminal())
    state = follow(lambda it: (it[0], coverage(plan(), it[0]), found), views(healthy()))
    assert isinstance(state, WatchState)
    return [it.rstrip() for it in screen.getvalue().splitlines()]


def finding(level: str, at: int, robot: str = "") -> Finding:
    return Finding("MG306", level, f"message {at}", "hint", robot=robot)


@pytest.mark.more
def test_a_screen_has_robots_with_findings_and_errors_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    notes = [finding(NOTE, at) for at in range(MANY)]
    lines = shown(monkeypatch, [*notes, finding(ERROR, MANY, "robot2")])
    assert any("18 findings: not as planned" in it for it in lines)
    robots = [it.split() for it in lines if it.split()[:1] in (["robot1"], ["robot2"])]
    assert robots == [["robot2", "2/2", "1"], ["robot1", "2/2", "0"]]
    told = [it for it in lines if "MG306" in it]
    assert len(told) == 15 and "error" in told[0] and f"message {MANY}" in told[0]
    assert "and 3 more findings" in lines
    assert not any("more robots" in it for it in lines)


def test_as_many_as_a_screen_holds_are_all(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = shown(monkeypatch, [finding(NOTE, at) for at in range(15)])
    assert len([it for it in lines if "MG306" in it]) == 15
    assert not any("more" in it for it in lines)


def test_a_robot_that_vanishes_is_named_and_the_last_line_agrees(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a watch without a plan: robot2 goes, and comes again."""
    one = healthy()
    kept = tuple(it for it in one.nodes if it.name.startswith("/robot1/"))
    less = one._replace(
        nodes=kept, ends=tuple(it for it in one.ends if it.node.startswith("/robot1/"))
    )
    for graphs, told in (((one, less), "error"), ((one, less, one), "now, but before")):
        monkeypatch.setattr(live, "watched", lambda _, domains, seen=graphs: views(*seen))
        assert multibot(["check", "--watch"]) == 1
        out, err = capsys.readouterr()
        assert "robot2 is gone: none of its" in out and "; without robot2, " in out
        assert told in (out if told == "error" else err)
        assert "0 findings: something is wrong" not in err
