"""A gap of a robot as a finding: where the name is needed, and what may be meant."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.fleet.outputs.output_values import OutputText, line_in_source
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.rules.closure.gap import Gap
from multibot_rewrite.system.records import Place


def meant(gap: Gap) -> str:
    """The hint: the name that is there, and its place."""
    if not gap.near:
        return f"see {gap.near_place}" if gap.near_place else "name one that is there"
    where = f" ({gap.near_place})" if gap.near_place else ""
    return f"did you mean {gap.near}{where}?"


def in_source(gap: Gap, texts: Iterable[OutputText]) -> Gap:
    """The gap with its place in the file that the user wrote: what is made may not be written."""
    place = gap.place
    for text in texts:
        if place and place.file == text.path and text.sources:
            return gap._replace(place=Place(*line_in_source(text, place.line)))
    return gap


def at_gap(
    rule: Rule, robot: RewrittenRobot, gap: Gap, message: str, hint: str, level: str = ""
) -> Finding:
    """The finding where the name is needed, else at the robot in the fleet file."""
    at = gap.place or gap.at or Place(robot.spec.file, robot.spec.line)
    place: dict[str, Any] = {"file": at.file, "line": at.line, "column": 1}
    return rule.finding(message, hint, level=level or rule.level, **place)
