"""Records of the live graph and of remap tables -> findings, until their rooms make findings."""

from __future__ import annotations

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.remap.records import Problem


def from_table(it: Problem) -> Finding:
    """What a remap table cannot do."""
    return Finding(it.code, it.level, it.message, it.hint, robot=it.robot, node=it.node)
