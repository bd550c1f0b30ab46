# SPDX-License-Identifier: Apache-2.0
"""Robots in several ROS domains: a plan and what was seen in each of them -> findings.

Each domain is held against its part of the plan, or against the whole of one for robots without names:
who is in another one is never met. Robots are held against each other wherever they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.rules.check import check
from multibot_rewrite.rules.system.differing import COMPARED
from multibot_rewrite.rules.system.planned_ends import missing_endpoint
from multibot_rewrite.rules.system.planned_nodes import missing_node, missing_robot, unplanned_node
from multibot_rewrite.spelling.domain_bridge import DOMAIN_BRIDGE
from multibot_rewrite.system.domains import by_domain, domain_of, seen_by_domain, side_by_side
from multibot_rewrite.system.records import System

_MISSING = frozenset((missing_node.code, missing_robot.code))


def check_view(plan: System, seen: System) -> list[Finding]:
    """What is other than planned in one view of all nodes, each in the domain that it is planned in."""
    return check_domains(plan, seen_by_domain(plan, seen)) if plan.domains else check(plan, seen)


def check_domains(plan: System, seen: Mapping[int, System]) -> list[Finding]:
    """What is other than planned in the domains that were looked at, and wrong there."""
    parts = by_domain(plan)
    found = [
        _told(it, number, plan, seen)
        for number, view in seen.items()
        for it in check(parts.get(number, plan), view)
        if not _is_planned_elsewhere(it, number, plan)
    ]
    if parts and len(seen) > 1:
        found += _across(plan, seen, {name for it in found for name in it.names})
    return sorted(found, key=lambda it: it.code)


def _across(plan: System, seen: Mapping[int, System], told: Set[str]) -> Iterator[Finding]:
    """In what robots of several domains differ. The copies that bridges send are left out: beside
    what they are copies of they would be a second sender."""
    whole, together = (_without_bridges(it, plan) for it in (plan, side_by_side(seen)))
    found = check(whole._replace(domains=()), together)
    return (it for it in found if it.code in COMPARED and told.isdisjoint(it.names))


def _without_bridges(system: System, plan: System) -> System:
    own = _bridges(plan)
    return system._replace(
        nodes=tuple(it for it in system.nodes if it.name not in own),
        ends=tuple(it for it in system.ends if it.node not in own),
    )


def _bridges(plan: System) -> set[str]:
    return {it.name for it in plan.nodes if it.stack == DOMAIN_BRIDGE}


def _told(it: Finding, number: int, plan: System, seen: Mapping[int, System]) -> Finding:
    """The finding with its domain, and where what is missing runs instead."""
    nodes = {own.name for own in plan.nodes if own.robot == it.robot and plan.domains}
    wanted = nodes if it.code == missing_robot.code else nodes & {it.node}
    elsewhere = [
        other
        for other, view in seen.items()
        if it.code in _MISSING and other != number and wanted & {own.name for own in view.nodes}
    ]
    said = _of_bridge(in_domain(it, number), plan)
    if not elsewhere:
        return said
    hint = f"it runs in domain {elsewhere[0]}: start it with ROS_DOMAIN_ID={number}"
    return said._replace(hint=hint, file="", line=0)


def in_domain(it: Finding, number: int) -> Finding:
    """The finding with its domain."""
    return it._replace(message=f"{it.message}, in domain {number}")


def _of_bridge(it: Finding, plan: System) -> Finding:
    """Without a bridge that is missing on one side nothing crosses; its file has its topics."""
    if it.node not in _bridges(plan):
        return it
    if it.code == missing_endpoint.code:
        return it._replace(
            hint=f"the file of {DOMAIN_BRIDGE} has no such topic: build the fleet again"
        )
    if it.code != missing_node.code:
        return it
    level = ERROR if it.level == WARNING else it.level
    hint = f"nothing crosses: does {DOMAIN_BRIDGE} run for the robot, with the file that was built?"
    return it._replace(level=level, hint=hint)


def _is_planned_elsewhere(it: Finding, number: int, plan: System) -> bool:
    """Is it a node that is planned, for another domain? It is told where it is missing."""
    numbers = domain_of(plan)
    own = {one.name: numbers[one.robot] for one in plan.nodes if numbers}
    return it.code == unplanned_node.code and own.get(it.node, number) != number
