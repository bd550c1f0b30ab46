# SPDX-License-Identifier: Apache-2.0
"""Descriptions that name another robot of their fleet in values of unknown use."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.description.checks.problem import to_findings
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.rules.files.robot_words import in_description


def for_another_robot(plan: FleetPlan) -> Iterator[Finding]:
    """Each description, at its first such value; what is for the one robot of it is right."""
    words = {word for it in plan.robots for word in it.spec.words}
    for group in group_robots(plan):
        first, *more = group.robots
        source = first.member.source
        others = words if more else words.difference(first.spec.words)
        problems = in_description(source.root, others, first.names.declared)
        yield from to_findings(source, problems, ERROR)
