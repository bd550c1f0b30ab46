"""What the rules of any system find in a fleet as it is written, and whether its sources have it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.fleets.fleet import Fleet, expected
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.rules.find import absences, contradictions
from multibot_rewrite.rules.index import Index, index
from multibot_rewrite.rules.ownership import (
    Whose,
    frame_ownership,
    name_ownership,
    whose_by_plan,
)
from multibot_rewrite.rules.system.unsent import is_needed, no_longer_sent, open_ends
from multibot_rewrite.system.records import RUNS, End, System

# A robot alone has no name in what it is called.
ALONE = Whose((), lambda _: "", lambda name: name, lambda _: "", lambda frame: frame)
Key = tuple[str, ...]


def whose_names(fleet: Fleet) -> Whose:
    """Whose the names of a fleet are, by its plan."""
    plan = expected(fleet)
    return whose_by_plan(plan, name_ownership(plan), frame_ownership(plan))


def contradicted(plan: FleetPlan, whole: System, whose: Whose) -> Iterator[Finding]:
    """What nodes that surely run do to each other; in one robot they did so before its rewrite."""
    robots = {it.spec.namespace: it for it in plan.robots}
    sure = tuple(it for it in whole.ends if it.sure == RUNS)
    for it in contradictions(index(whole._replace(ends=sure), whose)):
        level = WARNING if it.robot and it.level == ERROR else it.level
        yield in_file(it._replace(level=level), robots.get(it.robot) or plan.robots[-1])


def missing(
    robot: RewrittenRobot, before: System, after: System, whose: Whose
) -> Iterator[Finding]:
    """What a robot needs and nothing gives, as it is written: an error where its sources had it."""
    old, new = index(before, ALONE), index(after, whose)
    was_open, is_open = _keys(old, open_ends(old)), _keys(new, open_ends(new))
    had = _keys(old, (it for it in before.ends if is_needed(it))).keys() - was_open.keys()
    opened = {(it.node, it.name): it for key, it in is_open.items() if key in had}
    for it in absences(new):
        end = opened.pop((it.node, next(iter(it.names), "")), None)
        level = WARNING if it.level == ERROR and not end else it.level
        yield in_file(it._replace(level=level), robot)
    yield from (in_file(no_longer_sent(it), robot) for it in opened.values())


def _keys(seen: Index, ends: Iterable[End]) -> Mapping[Key, End]:
    """Ends by what is the same before and after a rewrite: the node, and the name in its code."""
    known = {it.name: it.known for it in seen.system.nodes}
    return {(it.kind, it.role, known.get(it.node, it.node), it.code_name): it for it in ends}


def in_file(finding: Finding, robot: RewrittenRobot) -> Finding:
    """The finding as one of its file, else of the robot's line in the fleet file: who it is about is in
    the message."""
    it = finding
    place = (it.file, it.line, it.column) if it.file else (robot.spec.file, robot.spec.line, 1)
    message = f"{it.node} {it.message}" if it.node else it.message
    file, line, column = place
    return it._replace(message=message, node="", robot="", file=file, line=line, column=column)
