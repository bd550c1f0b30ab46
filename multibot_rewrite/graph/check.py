"""Expectation and snapshot -> findings: one function a rule, all of them pure.

Nothing is called missing in a view that may be incomplete: such a finding is *inconclusive*.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.rules import ends, frames, names, nodes
from multibot_rewrite.graph.rules.comparison import INCONCLUSIVE, GraphFinding, View, make_view
from multibot_rewrite.graph.snapshot import Caveat, Snapshot, incomplete

Rule = Callable[[View], Iterator[GraphFinding]]
RULES: tuple[Rule, ...] = (
    nodes.missing_nodes,
    names.missing_endpoints,
    names.leaks,
    names.planned_leaks,
    names.deaf_listeners,
    names.cross_talk,
    nodes.same_names,
    ends.type_clashes,
    ends.qos_clashes,
    nodes.unexpected_nodes,
    names.captured_topics,
    names.unheard,
    frames.two_parents,
    frames.colliding_frames,
    frames.torn_trees,
    frames.undeclared_frames,
    frames.wrong_tf_topics,
    frames.bare_frames,
)
WAITED_FOR = "expected-not-seen"
# What an incomplete view cannot tell.
ABSENCE = ("MG101", "MG102", "MG109", "MG110", "MG111", "MG203", "MG207")


def check(plan: Expectation, graph: Snapshot) -> list[GraphFinding]:
    """Everything that is wrong, in the order of the rules; empty for a healthy fleet."""
    with gc_paused():
        view = make_view(plan, graph)
        found = [finding for rule in RULES for finding in rule(view)]
    if not doubts(graph):
        return found
    return [_softened(finding) if finding.code in ABSENCE else finding for finding in found]


def doubts(graph: Snapshot) -> tuple[Caveat, ...]:
    """Why something may be missing in the view. What was waited for and did not come is no doubt:
    where nothing changed any more it is the answer."""
    return tuple(caveat for caveat in incomplete(graph) if caveat.code != WAITED_FOR)


def _softened(finding: GraphFinding) -> GraphFinding:
    cause = "the view is incomplete: see the snapshot's caveats"
    return finding._replace(level=INCONCLUSIVE, cause=cause)
