"""Expectation and snapshot -> findings: every declared rule in the order of the codes.

Where the view of the graph may be incomplete, a finding about something missing is *inconclusive*.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import cast

from multibot_rewrite.findings.finding import INCONCLUSIVE, Finding
from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.bags.recording import is_recorded
from multibot_rewrite.graph.patterns import fitted
from multibot_rewrite.rules.find import DANGERS
from multibot_rewrite.rules.pair import (
    demands,
    endpoints,
    frame_names,
    frames_heard,
    in_enclaves,
    leaks,
    nodes,
    planned_states,
    publishers,
    transforms,
    type_and_qos,
)
from multibot_rewrite.rules.pair.beside_plan import dangers_beside
from multibot_rewrite.rules.pair.comparison import View, make_view
from multibot_rewrite.system.records import Caveat, System, incomplete

_MODULES = (
    nodes,
    endpoints,
    leaks,
    type_and_qos,
    publishers,
    demands,
    in_enclaves,
    planned_states,
    transforms,
    frame_names,
    frames_heard,
)
_FOUND = [it for module in _MODULES for it in vars(module).values() if isinstance(it, Rule)]
RULES = {it.code: it for it in sorted(_FOUND, key=lambda it: it.code)}
# What can be asked of a recording, which has no nodes.
_ABOUT_FRAMES = (*vars(transforms).values(), *vars(frame_names).values())
FRAME_RULES = {it.code: it for it in RULES.values() if it in _ABOUT_FRAMES}
WAITED_FOR = "expected-not-seen"
# Findings about something missing: an incomplete view cannot prove them.
# With a plan and without one.
ALL_RULES = {**RULES, **DANGERS}
ABSENCE = frozenset(it.code for it in ALL_RULES.values() if it.options["absence"])


def check(plan: System, graph: System) -> list[Finding]:
    """All findings in the order of the rules; empty for a fleet as planned."""
    with gc_paused():
        view = make_view(*fitted(plan, graph))
        rules = FRAME_RULES if is_recorded(graph) else RULES
        found = [finding for rule in rules.values() for finding in _ask(rule, view)]
        if not is_recorded(graph):
            found += dangers_beside(view, found)
    return inconclusive_where_in_doubt(found, graph)


def _ask(rule: Rule, view: View) -> Iterator[Finding]:
    return cast(Callable[[View], Iterator[Finding]], rule.check)(view)


def inconclusive_where_in_doubt(found: list[Finding], graph: System) -> list[Finding]:
    """The findings; those about something missing are inconclusive in an incomplete view."""
    if not doubts(graph):
        return found
    return [_inconclusive(finding) if finding.code in ABSENCE else finding for finding in found]


def doubts(graph: System) -> tuple[Caveat, ...]:
    """The caveats that make a view incomplete.

    That an expected node did not come is not one of them: once the graph is quiet it is missing.
    """
    return tuple(caveat for caveat in incomplete(graph) if caveat.code != WAITED_FOR)


def _inconclusive(finding: Finding) -> Finding:
    hint = "the view of the graph may be incomplete: see the caveats of the snapshot"
    return finding._replace(level=INCONCLUSIVE, hint=hint, file="", line=0)
