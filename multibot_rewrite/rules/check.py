# SPDX-License-Identifier: Apache-2.0
"""A system, alone or with its plan or its domains -> findings, in the order of the codes.

Where the view may be incomplete, a finding about something missing is *inconclusive*. Each ROS
domain is compared with its part of the plan, or with the whole of one for robots without names:
nodes of different domains never share a topic. Robots are compared wherever they are."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding, Rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import gc_paused, with_gaps
from multibot_rewrite.planning.domain_bridge import DOMAIN_BRIDGE
from multibot_rewrite.producers.bags.recording import is_recorded
from multibot_rewrite.rules.declaration import rules_in
from multibot_rewrite.rules.folded import folded, in_order
from multibot_rewrite.rules.system import clocks, differing, likes
from multibot_rewrite.rules.system.commands import command_to_nobody
from multibot_rewrite.rules.system.differing import BETWEEN_ROBOTS
from multibot_rewrite.rules.system.names import topic_names_miss
from multibot_rewrite.rules.system.planned_ends import missing, missing_endpoint
from multibot_rewrite.rules.system.planned_nodes import missing_node, missing_robot, unplanned_node
from multibot_rewrite.rules.with_plan import one_for_a_cause
from multibot_rewrite.system.domains import (
    by_domain,
    domain_of,
    seen_by_domain,
    side_by_side as domains_together,
)
from multibot_rewrite.system.index import NO_COUNTS, Index, beside, index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import (
    BUSY_MACHINE,
    End,
    System,
    clocks as time_by_node,
    unseen,
)
from multibot_rewrite.system.tf_copies import without_bridged

# What is made at run time, in names of a plan.
ANY = "*"
RULES = {it.code: it for it in sorted(rules_in("system"), key=lambda it: it.code)}
_LACKS = likes.lacks_what_its_likes_have
# Findings about something missing: an incomplete view cannot prove them.
ABSENCE = frozenset(it.code for it in RULES.values() if it.options["absence"])
# About rates and ages: a machine that was too busy shows messages as seldom and old.
_TIMED = {likes.less_than_another_robot.code, clocks.stamp_of_another_time.code}


def judge(seen: Index) -> list[Finding]:
    """Return the findings about a system and its differences from its plan, the likely causes first."""
    with gc_paused():
        plan = seen.expected
        if plan is None:
            return in_order(seen, folded(seen, _judged_findings(seen, _rules(planned=False))))
        # What a robot has not and others have is meant where nothing that is planned is missing.
        asked = (it for it in _rules(planned=False) if it is not _LACKS or missing(plan, seen))
        recorded = is_recorded(seen.system)
        only = (it for it in _rules(planned=True) if not (recorded and it.options["nodes"]))
        by_plan = [*_found_by(only, seen)]
        found = _judged_findings(seen, asked)
        told = one_for_a_cause(seen, plan, found, by_plan, RULES, bool(unseen(seen.system)))
        return in_order(seen, folded(seen, told))


def _rules(planned: bool) -> Iterator[Rule]:
    """Yield the rules that only a plan can answer, or the others."""
    return (it for it in RULES.values() if it.options["planned"] is planned)


def _judged_findings(seen: Index, rules: Iterable[Rule]) -> list[Finding]:
    """Return what rules find, without what another of their findings explains."""
    with gc_paused():
        found = [*_found_by(rules, seen)]
        return differing.unexplained(_without_their_senders(found))


def _found_by(rules: Iterable[Rule], seen: Index) -> Iterator[Finding]:
    """Yield the findings of these rules. Ends that only may exist are asked by rules of ``ABSENCE``."""
    for rule in rules:
        if rule.check:
            yield from rule.check(seen if rule.code in ABSENCE else seen.sure)


def _without_their_senders(found: Sequence[Finding]) -> list[Finding]:
    """Return the findings without those about a sender whose reader has one for the same topic."""
    missed = {name for it in found if it.code == topic_names_miss.code for name in it.names[1:]}
    sender = command_to_nobody.code
    return [it for it in found if it.code != sender or it.names[0] not in missed]


def contradictions(seen: Index) -> list[Finding]:
    """Return the faults that ends, senders or nodes have with each other, whatever else runs."""
    return _findings_by_absence(seen, absent=False)


def absences(seen: Index) -> list[Finding]:
    """Return the findings about what is missing, as far as the system is known."""
    return _findings_by_absence(seen, absent=True)


def _findings_by_absence(seen: Index, absent: bool) -> list[Finding]:
    """Return the findings about what is missing, or the others."""
    found = _judged_findings(
        seen, (it for it in _rules(planned=False) if (it.code in ABSENCE) is absent)
    )
    # What is found of robots held against each other is left to any other finding.
    if any(it.code in differing.BETWEEN_ROBOTS for it in found):
        found = judge(seen)
    return [it for it in found if (it.code in ABSENCE) is absent]


def check(
    plan: System,
    graph: System,
    messages: Mapping[str, int] = NO_COUNTS,
    before: System | None = None,
) -> list[Finding]:
    """Return what is wrong with a system or differs from its plan.

    ``messages`` has the counted messages of each topic; ``before`` is the snapshot that the plan
    was made from, if any."""
    _, seen = side_by_side(plan, graph, messages, before)
    return inconclusive_where_in_doubt(judge(seen), graph)


def side_by_side(
    plan: System,
    graph: System,
    messages: Mapping[str, int] = NO_COUNTS,
    before: System | None = None,
) -> tuple[Index, Index]:
    """Return the indexes of a plan and of a system, with run-time names written alike in both."""
    there = _with_patterns(plan, graph)
    fitting = _with_running_names(plan, there)
    by_plan = index(fitting, whose_by_plan(fitting))
    edges = without_bridged(fitting, there.edges)
    return by_plan, beside(by_plan, there._replace(edges=edges), messages, before)


def _with_patterns(plan: System, graph: System) -> System:
    """Return the graph, with a pattern of the plan in place of each node name that fits it."""
    patterns = {it.name: _compiled_pattern(it.name) for it in plan.nodes if ANY in it.name}
    if not patterns:
        return graph
    names = {
        node.name: pattern
        for node in graph.nodes
        for pattern, found in patterns.items()
        if found.fullmatch(node.name)
    }
    nodes = (it._replace(name=names[it.name]) for it in graph.nodes if it.name in names)
    others = (it for it in graph.nodes if it.name not in names)
    endpoints = (it._replace(node=names.get(it.node, it.node)) for it in graph.ends)
    return graph._replace(
        nodes=(*others, *dict.fromkeys(nodes)), ends=tuple(dict.fromkeys(endpoints))
    )


def _with_running_names(plan: System, graph: System) -> System:
    """Return the plan, with the running names in place of the patterns of its ends."""
    if not any(ANY in it.name for it in plan.ends):
        return plan
    by_node = lists_by_key((end.node, end) for end in graph.ends)
    found = (end for it in plan.ends for end in _matching_ends(it, by_node))
    return plan._replace(ends=tuple(dict.fromkeys(found)))


def _matching_ends(planned: End, by_node: Mapping[str, Sequence[End]]) -> Iterator[End]:
    if ANY not in planned.name:
        yield planned
        return
    pattern, kind = _compiled_pattern(planned.name), (planned.kind, planned.role)
    own = [it.name for it in by_node.get(planned.node, ()) if (it.kind, it.role) == kind]
    fitting = [name for name in own if pattern.fullmatch(name)]
    yield from (planned._replace(name=name) for name in fitting or [planned.name])


def _compiled_pattern(pattern: str) -> re.Pattern[str]:
    return re.compile(with_gaps(pattern.split(ANY), "[^/]"))


def inconclusive_where_in_doubt(found: list[Finding], graph: System) -> list[Finding]:
    """Return the findings; in an incomplete view those about missing things become inconclusive."""
    reasons = {it.code for it in unseen(graph)}
    if not reasons:
        return found
    told, mixed = time_by_node(graph), clocks.clocks_mixed.code
    doubtful = ABSENCE | _TIMED if BUSY_MACHINE in reasons else ABSENCE
    sure = {it for it in found if it.code not in doubtful or (it.code == mixed and it.node in told)}
    hint = "the view of the graph may be incomplete: the line `incomplete:` says why"
    return [
        it
        if it in sure
        else it._replace(level=INCONCLUSIVE, hint=hint, file="", line=0, remaps=(), settings=())
        for it in found
    ]


def check_view(plan: System, seen: System) -> list[Finding]:
    """Return the differences from a plan in one view of all nodes, each in its planned domain."""
    return check_domains(plan, seen_by_domain(plan, seen)) if plan.domains else check(plan, seen)


def check_domains(plan: System, seen: Mapping[int, System]) -> list[Finding]:
    """Return the faults in these domains and their differences from the plan."""
    parts, numbers = by_domain(plan), domain_of(plan)
    own = {one.name: numbers[one.robot] for one in plan.nodes if numbers}
    found = [
        _with_domain(it, number, plan, seen)
        for number, view in seen.items()
        for it in check(parts.get(number, plan), view)
        # A node that is planned for another domain is told where it is missing.
        if it.code != unplanned_node.code or own.get(it.node, number) == number
    ]
    if parts and len(seen) > 1:
        # In what robots of several domains differ. The copies that bridges send are left out: next
        # to what they are copies of they would be a second sender.
        told = {name for it in found for name in it.names}
        whole, together = (_without_bridges(it, plan) for it in (plan, domains_together(seen)))
        across = check(whole._replace(domains=()), together)
        found += (it for it in across if it.code in BETWEEN_ROBOTS and told.isdisjoint(it.names))
    return sorted(found, key=lambda it: it.code)


def _without_bridges(system: System, plan: System) -> System:
    own = {it.name for it in plan.nodes if it.node_set == DOMAIN_BRIDGE}
    return system._replace(
        nodes=tuple(it for it in system.nodes if it.name not in own),
        ends=tuple(it for it in system.ends if it.node not in own),
    )


def _with_domain(it: Finding, number: int, plan: System, seen: Mapping[int, System]) -> Finding:
    """Return the finding with its domain, and a hint if the missing node runs in another domain."""
    nodes = {own.name for own in plan.nodes if own.robot == it.robot and plan.domains}
    wanted = nodes if it.code == missing_robot.code else nodes & {it.node}
    elsewhere = [
        other
        for other, view in seen.items()
        if it.code in (missing_node.code, missing_robot.code)
        and other != number
        and wanted & {own.name for own in view.nodes}
    ]
    said = _with_bridge_hint(in_domain(it, number), plan)
    if not elsewhere:
        return said
    hint = f"it runs in domain {elsewhere[0]}: start it with ROS_DOMAIN_ID={number}"
    return said._replace(hint=hint, file="", line=0)


def in_domain(it: Finding, number: int) -> Finding:
    """Return the finding with the domain in its message."""
    return it._replace(message=f"{it.message}, in domain {number}")


def _with_bridge_hint(it: Finding, plan: System) -> Finding:
    """Return a finding of a domain_bridge: if it is missing, or a topic in its file, as that."""
    if (it.node, DOMAIN_BRIDGE) not in {(own.name, own.node_set) for own in plan.nodes}:
        return it
    if it.code == missing_endpoint.code:
        hint = f"the file of {DOMAIN_BRIDGE} has no such topic: build the fleet again"
        return it._replace(hint=hint)
    if it.code != missing_node.code:
        return it
    level = ERROR if it.level == WARNING else it.level
    hint = f"nothing crosses: does {DOMAIN_BRIDGE} run for the robot, with the file that was built?"
    return it._replace(level=level, hint=hint)
