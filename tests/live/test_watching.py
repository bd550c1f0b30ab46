# SPDX-License-Identifier: Apache-2.0
"""What ``check --watch`` says of one view after the other, and the worst it remembers."""

from __future__ import annotations

from collections.abc import Iterable

from graph_cases import environment, moved
from small_fleet import clash, half, healthy, moving, plan

from multibot_rewrite.live.watching import Verdict, WatchState, final, with_found
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.coverage import Coverage
from multibot_rewrite.system.records import Caveat, System

HELD = Coverage(())


def watched(graphs: Iterable[System]) -> list[WatchState]:
    states: list[WatchState] = []
    for graph in graphs:
        states.append(with_found(graph, HELD, check(plan(), graph), states[-1] if states else None))
    return states


def test_a_fleet_that_comes_up_and_stays_is_as_planned() -> None:
    nothing = healthy()._replace(nodes=(), ends=(), edges=())
    unseen = nothing._replace(environment=environment(Caveat("nothing-seen", True, "no node")))
    graphs = [moving(nothing), unseen, moving(half()), half(), moving(healthy()), healthy()]
    states = watched(graphs)
    assert [state.complete for state in states] == [False] * 4 + [True] * 2
    assert states[1].verdict == Verdict.INCONCLUSIVE
    assert states[3].verdict == Verdict.WRONG
    assert final(states[-1]) == Verdict.PLANNED


def test_what_is_not_there_at_the_end_counts() -> None:
    assert final(watched([moving(half()), half()])[-1]) == Verdict.WRONG


def test_what_went_away_is_remembered() -> None:
    states = watched([healthy(), moving(half()), half(), moving(healthy()), healthy()])
    assert states[-1].verdict == Verdict.PLANNED
    assert final(states[-1]) == Verdict.WRONG


def test_a_short_gap_is_not_the_worst() -> None:
    states = watched([healthy(), moving(half()), moving(healthy()), healthy()])
    assert final(states[-1]) == Verdict.PLANNED


def test_a_fault_counts_while_the_fleet_comes_up() -> None:
    states = watched([moving(clash()), moving(healthy()), healthy()])
    assert final(states[-1]) == Verdict.WRONG


def test_an_ended_watch_that_never_settled_is_inconclusive() -> None:
    assert final(watched([moving(healthy())])[-1]) == Verdict.INCONCLUSIVE


def test_changes_come_and_go() -> None:
    graph = moved(healthy(), "/robot1/cmd_vel", "/cmd_vel")
    first, second, third = watched([healthy(), graph, healthy()])
    assert (first.appeared, first.solved) == ((), ())
    assert {finding.code for finding in second.appeared} == {"MG310"}
    assert second.solved == ()
    assert (third.appeared, set(third.solved)) == ((), set(second.appeared))


def test_what_is_wrong_from_the_start_is_announced_when_all_has_come() -> None:
    early = half()._replace(ends=(*half().ends, clash().ends[-1]))
    first, second = watched([moving(early), clash()])
    assert [it.complete for it in (first, second)] == [False, True]
    assert {it.code for it in second.appeared} == {it.code for it in second.findings} == {"MG306"}
    # That robot2 was missing has never been said.
    assert second.solved == ()
