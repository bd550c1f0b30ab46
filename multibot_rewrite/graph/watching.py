"""A plan and one snapshot after the other -> what changed, and the worst that was seen. Pure."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import NamedTuple

from multibot_rewrite.graph.check import ABSENCE, check, doubts
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.rules.comparison import GraphFinding
from multibot_rewrite.graph.snapshot import CHANGING, Snapshot
from multibot_rewrite.model import ERROR


class Verdict(IntEnum):
    """What a comparison comes to, from good to bad."""

    PLANNED = 0
    INCONCLUSIVE = 1
    WRONG = 2


class There(NamedTuple):
    """How much of a robot's plan is there, each as (seen, planned)."""

    robot: str
    nodes: tuple[int, int]
    names: tuple[int, int]


class Moment(NamedTuple):
    """One state of a watched graph, and how it differs from the one before.

    ``whole`` tells that everything planned was there at once, now or before; what is missing
    before that has not been started yet. ``worst`` is the worst verdict so far.
    """

    graph: Snapshot
    found: tuple[GraphFinding, ...]
    appeared: tuple[GraphFinding, ...]
    solved: tuple[GraphFinding, ...]
    robots: tuple[There, ...]
    whole: bool
    verdict: Verdict
    worst: Verdict


def judge(found: Iterable[GraphFinding], graph: Snapshot) -> Verdict:
    """As planned, not as planned, or not to be told from this view."""
    if any(finding.level == ERROR for finding in found):
        return Verdict.WRONG
    return Verdict.INCONCLUSIVE if doubts(graph) else Verdict.PLANNED


def next_moment(plan: Expectation, graph: Snapshot, before: Moment | None) -> Moment:
    """Compare, and tell what changed since ``before``."""
    found = tuple(check(plan, graph))
    old = before.found if before else ()
    robots = tuple(there(plan, graph))
    absent = any(finding.code in ABSENCE for finding in found)
    whole = (before is not None and before.whole) or not absent
    verdict = judge(found, graph)
    return Moment(
        graph,
        found,
        _beyond(found, old),
        _beyond(old, found),
        robots,
        whole,
        verdict,
        max(before.worst if before else Verdict.PLANNED, _counted(found, graph, whole)),
    )


def _beyond(
    some: Iterable[GraphFinding], others: Iterable[GraphFinding]
) -> tuple[GraphFinding, ...]:
    known = {finding._replace(cause="") for finding in others}
    return tuple(finding for finding in some if finding._replace(cause="") not in known)


def _counted(found: Iterable[GraphFinding], graph: Snapshot, whole: bool) -> Verdict:
    """What a moment adds to the worst: neither what is not started yet nor that things move."""
    judged = judge([it for it in found if whole or it.code not in ABSENCE], graph)
    coming = not whole or graph.environment.settled == CHANGING
    return Verdict.PLANNED if judged == Verdict.INCONCLUSIVE and coming else judged


def final(moment: Moment) -> Verdict:
    """The worst seen; what is not there yet at the end counts, too."""
    return max(moment.worst, moment.verdict)


def there(plan: Expectation, graph: Snapshot) -> list[There]:
    """How much of each robot is there."""
    nodes = {node.name for node in graph.nodes}
    ends = {(end.node, end.kind, end.role, end.name) for end in graph.endpoints}
    wanted: dict[str, list[bool]] = {}
    for want in plan.endpoints:
        seen = (want.node, want.kind, want.role, want.name) in ends
        wanted.setdefault(want.node, []).append(seen)
    result = []
    for robot in plan.robots:
        names = [seen for node in robot.nodes for seen in wanted.get(node, ())]
        here = sum(node in nodes for node in robot.nodes)
        result.append(There(robot.name, (here, len(robot.nodes)), (sum(names), len(names))))
    return result
