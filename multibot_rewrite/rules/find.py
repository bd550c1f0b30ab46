"""A graph and its robots -> findings: every declared danger in the order of the codes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import cast

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.bags.recording import is_recorded
from multibot_rewrite.rules.index import Index
from multibot_rewrite.rules.system import (
    clocks,
    commands,
    frame_ids,
    interfaces,
    matching,
    names,
    nodes,
    relays,
    sharing,
    tf_topics,
    transforms,
    unsent,
)
from multibot_rewrite.rules.system import (
    states as states_,
)

_MODULES = (
    nodes, names, matching, commands, relays, sharing, transforms, tf_topics, frame_ids, clocks,
    states_, unsent, interfaces,
)  # fmt: skip
_FOUND = [it for module in _MODULES for it in vars(module).values() if isinstance(it, Rule)]
DANGERS = {it.code: it for it in sorted(_FOUND, key=lambda it: it.code)}
TF_DANGERS = {it.code: it for it in DANGERS.values() if it in vars(transforms).values()}


def judge(seen: Index) -> list[Finding]:
    """All findings in the order of the rules; empty for a system that is as it should be."""
    with gc_paused():
        # A recording has no nodes.
        rules = TF_DANGERS if is_recorded(seen.system) else DANGERS
        return [it for rule in rules.values() for it in _ask(rule, seen)]


def contradictions(seen: Index) -> list[Finding]:
    """What two ends, senders or nodes do to each other: true whatever else runs."""
    rules = (it for it in DANGERS.values() if not it.options["absence"])
    return [it for rule in rules for it in _ask(rule, seen)]


def absences(seen: Index) -> list[Finding]:
    """What is missing, as far as the system is known."""
    rules = (it for it in DANGERS.values() if it.options["absence"])
    return [it for rule in rules for it in _ask(rule, seen)]


def _ask(rule: Rule, seen: Index) -> Iterator[Finding]:
    return cast(Callable[[Index], Iterator[Finding]], rule.check)(seen)
