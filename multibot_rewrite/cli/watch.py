# SPDX-License-Identifier: Apache-2.0
"""``multibot check --watch``: the comparison kept live, as a screen or as lines."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from functools import partial

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.wording import plural, shorten
from multibot_rewrite.cli.output import print_lines
from multibot_rewrite.cli.report import with_coverage
from multibot_rewrite.cli.tables import Grid, render
from multibot_rewrite.live.watching import WatchState, verdict_words, with_found
from multibot_rewrite.rules.system.planned_nodes import missing_robot
from multibot_rewrite.system.coverage import Coverage
from multibot_rewrite.system.records import CHANGING, System

# As many findings as a screen holds beside the robots.
_SHOWN = 15
Show = Callable[[WatchState], None]
# What is seen, by domain, -> all of it as one graph, how much of the robots it has, what is found.
Views = Mapping[int, System]
Look = Callable[[Views], tuple[System, Coverage, Sequence[Finding]]]


def follow(
    look: Look, snapshots: Generator[Views, None, None], planned: bool = True
) -> WatchState | None:
    """Show every change until the snapshots end or the user ends it; return the last state."""
    state: WatchState | None = None
    with ExitStack() as stack:
        stack.enter_context(closing(snapshots))
        screen = sys.stdout.isatty()
        show = stack.enter_context(_screen(planned)) if screen else partial(_print_lines, planned)
        try:
            for views in snapshots:
                state = with_found(*look(views), state)
                show(state)
        except KeyboardInterrupt:
            # The usual way to end it.
            return state
    return state


def _print_lines(planned: bool, state: WatchState) -> None:
    """Print what changed, for a log: findings come with + and go with -."""
    at = f"{state.graph.environment.seconds:7.1f} s"
    changes = (("+", state.appeared), ("-", state.solved)) if state.complete else ()
    lines = [f"{at}  {sign} {finding}" for sign, findings in changes for finding in findings]
    print_lines([*lines, f"{at}  {_headline(planned, state)}"])


@contextmanager
def _screen(planned: bool) -> Iterator[Show]:
    """Yield a function that redraws a screen at every change."""
    from rich.live import Live
    from rich.text import Text

    with Live(auto_refresh=False) as live:
        yield lambda state: live.update(
            Text.from_ansi(render(_screen_parts(planned, state), live.console.width, colour=True)),
            refresh=True,
        )


def _screen_parts(planned: bool, state: WatchState) -> Iterator[str | Grid]:
    yield _headline(planned, state)
    yield ""
    findings, held = Counter(it.robot for it in state.findings), state.coverage
    rows = []
    for it in (one for one in held.robots if one.robot):
        nodes = f"{it.seen}/{it.nodes}" if held.compared else f"{it.nodes}"
        rows.append((it.robot, nodes, f"{findings[it.robot]}"))
    # Those with findings first: a screen does not hold a hundred.
    rows.sort(key=lambda row: row[2] == "0")
    yield Grid(("robot", "nodes", "findings"), rows[:_SHOWN])
    yield from _line_for_more(len(rows), "robots")
    yield ""
    yield from map(
        str, sorted(state.findings, key=lambda finding: finding.level != "error")[:_SHOWN]
    )
    yield from _line_for_more(len(state.findings), "findings")


def _line_for_more(count: int, what: str) -> Iterator[str]:
    if count > _SHOWN:
        yield f"and {count - _SHOWN} more {what}"


def _headline(planned: bool, state: WatchState) -> str:
    """Return one line: how much is seen, and the result."""
    moving = state.graph.environment.settled == CHANGING
    words = verdict_words(state.verdict, state.findings, state.coverage, planned)
    found = plural(len(state.findings), "finding")
    gone = [it.robot for it in state.findings if it.code == missing_robot.code]
    without = f"without {shorten(gone)}, " if gone else ""
    verdict = f"{without}{found}: {'still changing' if moving else words}"
    return with_coverage(state.coverage, verdict)
