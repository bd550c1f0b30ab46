"""What hurts any fleet, judged with its plan: what is planned is meant, and nothing is said twice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.graph.dangers.find import DANGERS, find_dangers
from multibot_rewrite.graph.dangers.seen import Owners
from multibot_rewrite.graph.rules.comparison import View
from multibot_rewrite.graph.rules.planned_states import clock_not_planned, planned_clocks
from multibot_rewrite.system.records import CALLS, PUBLISHES, SIM_TIME, End, System

# Who sends, and who calls: what a danger is about.
_ACTING = (PUBLISHES, CALLS)


def dangers_beside(view: View, found: Sequence[Finding]) -> Iterator[Finding]:
    """The dangers of a graph that are neither meant by the plan nor among the findings of its rules."""
    dangers = find_dangers(_without_planned(view), _owners(view))
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
    states = {it.node for it in view.plan.states if it.lifecycle}
    timed = dict(planned_clocks(view.plan.states))
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


def _owners(view: View) -> Owners:
    """Whose each name is, by the plan."""
    graph, whose, frames_of = view.graph, view.ownership, view.frame_ownership
    used = dict.fromkeys((*view.by_name, *(edge.topic for edge in graph.edges)))
    senders = (it for edge in graph.edges for it in edge.publishers)
    nodes = dict.fromkeys((*view.seen, *view.by_node, *senders))
    shared = {*view.plan.shared_nodes, *view.plan.shared_topics}
    names = {it: "" if it in shared else whose.robot(it) for it in (*nodes, *used)}
    frames = {it: frames_of.robot(it) for edge in graph.edges for it in (edge.child, edge.parent)}
    return Owners(
        tuple(sorted(it.name for it in view.plan.robots)),
        names,
        frames,
        {it: whose.without_robot(it, names[it]) for it in used},
        {it: frames_of.without_robot(it, robot) for it, robot in frames.items()},
    )


def _is_meant(view: View, danger: Finding) -> bool:
    """Whether somebody sends or calls each of its names, and all who do are planned to; the clocks of
    the plan are compared with it."""
    if DANGERS[danger.code].options["planned"] == clock_not_planned.code:
        return danger.node in dict(planned_clocks(view.plan.states))
    return bool(danger.names) and all(_is_used_as_planned(view, it) for it in danger.names)


def _is_used_as_planned(view: View, name: str) -> bool:
    ends = [end for end in view.by_name.get(name, ()) if end.role in _ACTING]
    return bool(ends) and all(_is_planned(view, it) for it in ends)


def _is_planned(view: View, end: End) -> bool:
    if (end.node, end.kind, end.role, end.name) in view.planned:
        return True
    senders = (it.senders for it in view.plan.topics if it.name == end.name)
    return any(fnmatchcase(end.node, pattern) for own in senders for pattern in own)
