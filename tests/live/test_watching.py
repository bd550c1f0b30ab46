# SPDX-License-Identifier: Apache-2.0
"""What ``check --watch`` says of one view after the other, and the worst it remembers."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from graph_cases import environment
from small_fleet import half, healthy, moving, plan

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.live.watching import Verdict, WatchState, final, verdict_words, with_found
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.coverage import Coverage
from multibot_rewrite.system.records import Caveat, System

HELD = Coverage(())


def watched(graphs: Iterable[System]) -> list[WatchState]:
    states: list[WatchState] = []
    for graph in graphs:
        states.append(with_found(graph, HELD, check(plan(), graph), states[-1] if states else None))
    return states


@pytest.mark.parametrize(
    ("levels", "words"),
    [
        ((), "as planned"),
        ((NOTE,), "no error, see the notes"),
        ((NOTE, WARNING), "no error, see the warnings"),
    ],
)
def test_nothing_is_as_planned_above_findings(levels: tuple[str, ...], words: str) -> None:
    found = [Finding("MG108", it, "x") for it in levels]
    assert verdict_words(Verdict.PLANNED, found, HELD) == words


def test_a_fleet_that_comes_up_and_stays_is_as_planned() -> None:
    nothing = healthy()._replace(nodes=(), ends=(), edges=())
    unseen = nothing._replace(environment=environment(Caveat("nothing-seen", True, "no node")))
    graphs = [moving(nothing), unseen, moving(half()), half(), moving(healthy()), healthy()]
    states = watched(graphs)
    assert [state.complete for state in states] == [False] * 4 + [True] * 2
    assert states[1].verdict == Verdict.INCONCLUSIVE
    assert states[3].verdict == Verdict.WRONG
    assert final(states[-1]) == Verdict.PLANNED
