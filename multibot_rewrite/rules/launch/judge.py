"""A launch -> what the rules for launch files find in it, in the order of the codes."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.rules.launch import models, rows, started, words, world

MODULES = (models, rows, started, words, world)


def _rules() -> Iterator[Rule]:
    for module in MODULES:
        yield from (it for it in vars(module).values() if isinstance(it, Rule))


RULES = tuple(sorted(_rules(), key=lambda it: it.code))


def judge_launch(launched: Launched) -> list[Finding]:
    """What is wrong with what a launch file starts; empty for one that is as it should be."""
    return [it for rule in RULES if rule.check for it in rule.check(launched)]
