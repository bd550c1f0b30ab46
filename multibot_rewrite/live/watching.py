# SPDX-License-Identifier: Apache-2.0
"""A plan and one snapshot after another -> what changed, and the worst verdict so far. Pure."""

from collections.abc import Iterable, Sequence
from enum import IntEnum
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, Finding
from multibot_rewrite.rules.check import ABSENCE
from multibot_rewrite.system.coverage import Coverage
from multibot_rewrite.system.records import CHANGING, System, doubts


class Verdict(IntEnum):
    """The result of a comparison, from good to bad."""

    PLANNED = 0
    INCONCLUSIVE = 1
    WRONG = 2


# By whether there was a plan.
_WORDS = {
    (Verdict.PLANNED, True): "nothing wrong seen",
    (Verdict.INCONCLUSIVE, True): "inconclusive, the view may be incomplete",
    (Verdict.WRONG, True): "not as planned",
    (Verdict.WRONG, False): "something is wrong",
}


class Outcome(NamedTuple):
    """The verdict as a command prints it: in which ``words``, and what judged (``by``).

    Without ``planned`` there was no plan to compare with. ``reasons`` say why it is not certain,
    besides the limitations of the graph."""

    verdict: Verdict
    words: str
    by: str = "multibot check"
    planned: bool = True
    reasons: tuple[str, ...] = ()


def verdict_words(
    verdict: Verdict,
    findings: Iterable[Finding],
    held: Coverage,
    planned: bool = True,
    gaps: Sequence[Finding] = (),
) -> str:
    """Return the verdict in words, which say no more than was seen; ``gaps``: the plan's findings."""
    is_open = any(it.level != NOTE for it in gaps)
    words = _WORDS.get((verdict, planned)) or _WORDS[verdict, True]
    if verdict == Verdict.PLANNED and (levels := {it.level for it in findings}):
        words = f"no error, see the {'notes' if levels == {NOTE} else 'warnings'}"
    elif verdict == Verdict.PLANNED and planned and not is_open:
        words = "as planned" if held.is_whole else "as planned as far as known"
    if is_open:
        return f"{words}, {'but' if verdict == Verdict.PLANNED else 'and'} the plan has faults"
    return f"{words}, with notes on the plan" if gaps else words


class WatchState(NamedTuple):
    """One state of a watched graph, and how it differs from the state before.

    ``complete`` is set once everything planned was in the graph at the same time; what is missing
    before that counts as not started yet. ``worst`` is the worst verdict so far.
    """

    graph: System
    findings: tuple[Finding, ...]
    coverage: Coverage
    appeared: tuple[Finding, ...]
    solved: tuple[Finding, ...]
    complete: bool
    verdict: Verdict
    worst: Verdict


def judge(found: Iterable[Finding], graph: System) -> Verdict:
    """Return as planned, not as planned, or inconclusive because the view may be incomplete."""
    levels = {finding.level for finding in found}
    if ERROR in levels:
        return Verdict.WRONG
    return Verdict.INCONCLUSIVE if INCONCLUSIVE in levels or doubts(graph) else Verdict.PLANNED


def with_found(
    graph: System, held: Coverage, findings: Iterable[Finding], before: WatchState | None
) -> WatchState:
    """Return the state of the graph with these findings, after the state before."""
    found = tuple(findings)
    was_complete = before is not None and before.complete
    old = before.findings if before and was_complete else ()
    complete = was_complete or not any(finding.code in ABSENCE for finding in found)
    worst = before.worst if before else Verdict.PLANNED
    # The verdict that counts for the worst so far. What is not started yet does not count, nor that
    # the graph is still changing.
    verdict = judge([it for it in found if complete or it.code not in ABSENCE], graph)
    changing = not complete or graph.environment.settled == CHANGING
    worst = max(worst, Verdict.PLANNED if verdict == Verdict.INCONCLUSIVE and changing else verdict)
    appeared, solved = _new_findings(old, found), _new_findings(found, old)
    return WatchState(graph, found, held, appeared, solved, complete, judge(found, graph), worst)


def _new_findings(known: Iterable[Finding], found: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return what is found and not known; a finding with another cause is the same finding."""
    before = {it._replace(hint="", file="", line=0) for it in known}
    return tuple(it for it in found if it._replace(hint="", file="", line=0) not in before)


def final(state: WatchState) -> Verdict:
    """Return the worst verdict so far, the last one included."""
    return max(state.worst, state.verdict)


def final_words(state: WatchState, planned: bool, gaps: Sequence[Finding] = ()) -> str:
    """Return the verdict at the end in words, and that of before where it was worse."""
    worst, held = final(state), state.coverage
    if worst == state.verdict:
        return verdict_words(worst, state.findings, held, planned, gaps)
    now = verdict_words(state.verdict, state.findings, held, planned)
    return f"{now} now, but before: {verdict_words(worst, (), held, planned, gaps)}"
