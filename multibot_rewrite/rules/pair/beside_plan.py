"""What hurts any fleet, judged with its plan: what is planned is meant, and nothing is said twice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.rules.find import DANGERS, judge
from multibot_rewrite.rules.index import index
from multibot_rewrite.rules.ownership import whose_by_plan
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.planned_states import clock_not_planned, planned_clocks
from multibot_rewrite.system.records import CALLS, PUBLISHES, SIM_TIME, End, System

# Who sends, and who calls: what a danger is about.
_ACTING = (PUBLISHES, CALLS)


def dangers_beside(view: View, found: Sequence[Finding]) -> Iterator[Finding]:
    """The dangers of a graph that are neither meant by the plan nor among the findings of its rules."""
    dangers = judge(
        index(
            _without_planned(view), whose_by_plan(view.plan, view.ownership, view.frame_ownership)
        )
    )
    if not dangers:
        return
    said = {(it.code, name) for it in found for name in (*it.names, it.node)}
    names = {*_names_of_missing(view), *(name for it in found for name in it.names)}
    for danger in dangers:
        planned = DANGERS[danger.code].options["planned"]
        about = (*danger.names, danger.node)
        if any((planned, it) in said for it in about if it) or not names.isdisjoint(danger.names):
            continue
        if not _is_meant(view, danger):
            yield danger


def _without_planned(view: View) -> System:
    """The graph without the states that the plan has: they are compared with it."""
    states = {it.name for it in view.plan.nodes if it.lifecycle}
    timed = dict(planned_clocks(view.plan))
    return view.graph._replace(
        nodes=tuple(
            it._replace(lifecycle="") if it.name in states else it for it in view.graph.nodes
        ),
        parameters=tuple(
            it for it in view.graph.parameters if it.name != SIM_TIME or it.node not in timed
        ),
    )


def _names_of_missing(view: View) -> Iterator[str]:
    """What the nodes have that are in the plan and not in the graph: their absence is said already."""
    return (name for node, _, _, name in view.missing if node not in view.seen)


def _is_meant(view: View, danger: Finding) -> bool:
    """Whether somebody sends or calls each of its names, and all who do are planned to; the clocks of
    the plan are compared with it."""
    if DANGERS[danger.code].options["planned"] == clock_not_planned.code:
        return danger.node in dict(planned_clocks(view.plan))
    return bool(danger.names) and all(_is_used_as_planned(view, it) for it in danger.names)


def _is_used_as_planned(view: View, name: str) -> bool:
    ends = [end for end in view.by_name.get(name, ()) if end.role in _ACTING]
    return bool(ends) and all(_is_planned(view, it) for it in ends)


def _is_planned(view: View, end: End) -> bool:
    if (end.node, end.kind, end.role, end.name) in view.planned:
        return True
    senders = (it.senders for it in view.plan.topics if it.name == end.name)
    return any(fnmatchcase(end.node, pattern) for own in senders for pattern in own)
