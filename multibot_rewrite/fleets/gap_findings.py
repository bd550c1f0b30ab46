"""A gap of a robot as a finding: where the name is needed, and what may be meant."""

from __future__ import annotations

from typing import Any

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.evidence.records import Place
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot


def meant(gap: Gap) -> str:
    """The hint: the name that is there, and its place."""
    if not gap.near:
        return f"see {gap.near_place}" if gap.near_place else "name one that is there"
    where = f" ({gap.near_place})" if gap.near_place else ""
    return f"did you mean {gap.near}{where}?"


def at_gap(
    rule: Rule, robot: RewrittenRobot, gap: Gap, message: str, hint: str, level: str = ""
) -> Finding:
    """The finding where the name is needed, else at the robot in the fleet file."""
    at = gap.place or gap.at or Place(robot.spec.file, robot.spec.line)
    place: dict[str, Any] = {"file": at.file, "line": at.line, "column": 1}
    return rule.finding(message, hint, level=level or rule.level, **place)
