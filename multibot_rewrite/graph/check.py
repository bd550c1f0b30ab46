"""Expectation and snapshot -> findings: one pure function for each rule.

Where the view of the graph may be incomplete, a finding about something missing is *inconclusive*.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.rules import frames, nodes, topics, type_and_qos
from multibot_rewrite.graph.rules.comparison import INCONCLUSIVE, GraphFinding, View, make_view
from multibot_rewrite.graph.snapshot import Caveat, Snapshot, incomplete

GraphRule = Callable[[View], Iterator[GraphFinding]]
RULES: tuple[GraphRule, ...] = (
    nodes.missing_nodes,
    topics.missing_endpoints,
    topics.leaks,
    topics.planned_leaks,
    topics.wrong_tf_listeners,
    topics.cross_talk,
    nodes.duplicate_node_names,
    type_and_qos.type_conflicts,
    type_and_qos.incompatible_qos,
    nodes.unexpected_nodes,
    topics.topics_below_own_namespace,
    topics.subscriptions_without_publisher,
    frames.two_parents,
    frames.colliding_frames,
    frames.disconnected_trees,
    frames.undeclared_frames,
    frames.wrong_tf_topics,
    frames.frames_without_robot_name,
)
WAITED_FOR = "expected-not-seen"
# Findings about something missing: an incomplete view cannot prove them.
ABSENCE = ("MG101", "MG102", "MG109", "MG110", "MG111", "MG203", "MG207")


def check(plan: Expectation, graph: Snapshot) -> list[GraphFinding]:
    """All findings in the order of the rules; empty for a fleet as planned."""
    with gc_paused():
        view = make_view(plan, graph)
        found = [finding for rule in RULES for finding in rule(view)]
    if not doubts(graph):
        return found
    return [_inconclusive(finding) if finding.code in ABSENCE else finding for finding in found]


def doubts(graph: Snapshot) -> tuple[Caveat, ...]:
    """The caveats that make a view incomplete.

    That an expected node did not come is not one of them: once the graph is quiet it is missing.
    """
    return tuple(caveat for caveat in incomplete(graph) if caveat.code != WAITED_FOR)


def _inconclusive(finding: GraphFinding) -> GraphFinding:
    cause = "the view of the graph may be incomplete: see the caveats of the snapshot"
    return finding._replace(level=INCONCLUSIVE, cause=cause)
