# SPDX-License-Identifier: Apache-2.0
"""Our node sets held against the launch files that start their nodes.

Four kinds of difference: ``not started`` (no launch file of the release starts a node of the node set),
``not ours`` (the node set lacks a node), ``rule missing`` and ``rule not there`` (remap rules).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.releases import has_release
from tools.interfaces.parameter_tables import LaunchFact

NOT_STARTED, NOT_OURS = "not started", "not ours"
RULE_MISSING, RULE_NOT_THERE = "rule missing", "rule not there"
# Layouts decide what becomes of tf.
_TF = ("/tf:=tf", "/tf_static:=tf_static")
# Hosts of components, and what draws.
_NO_PART = ("component_container", "component_container_isolated", "rviz2")


class SetNode(NamedTuple):
    """A node of a node set: its name there, the node's own, and its remap rules."""

    name: str
    node: str
    rules: frozenset[str]


class LaunchDifference(NamedTuple):
    """``what`` is a node's name, or its name and a rule."""

    kind: str
    node_set: str
    what: str


def launch_files() -> Mapping[str, Sequence[str]]:
    """Node set -> its launch files, as ``launched_node_sets.yaml`` has them."""
    text = files("tools.interfaces").joinpath("launched_node_sets.yaml").read_text("utf-8")
    found: Mapping[str, Sequence[str]] = load_yaml(text, "launched_node_sets.yaml")
    return found


def nodes_of_sets(node_sets: str, node_set: str, release: str) -> tuple[SetNode, ...]:
    """Return a node set's own nodes in a release, from the text of node_sets.yaml."""
    entries = load_yaml(node_sets, "node_sets.yaml")["node_sets"][node_set].get("nodes", ())
    rows = [it if isinstance(it, dict) else {"node": it} for it in entries]
    return tuple(_node(it) for it in rows if has_release(it.get("releases", ""), release))


def _node(entry: Mapping[str, object]) -> SetNode:
    node = str(entry["node"])
    remaps = entry.get("remaps", {})
    rules = remaps.items() if isinstance(remaps, dict) else ()
    return SetNode(
        str(entry.get("as", node)), node, frozenset(f"{old}:={new}" for old, new in rules)
    )


def launch_differences(
    node_set: str, ours: Iterable[SetNode], facts: Iterable[LaunchFact], paths: Sequence[str]
) -> Iterator[LaunchDifference]:
    """Where a node set and its launch files differ; nothing where the release has none of the files."""
    started = _started(facts, paths)
    if not started:
        return
    # A costmap is inside of another node: costmap/costmap.
    there = {it.name: it for it in ours if "/" not in it.name}
    for name, node in there.items():
        found = started.get(name, started.get(node.node))
        if found is None:
            yield LaunchDifference(NOT_STARTED, node_set, name)
            continue
        for rule in sorted(found - node.rules):
            yield LaunchDifference(RULE_MISSING, node_set, f"{name} {rule}")
        for rule in sorted(node.rules - found):
            yield LaunchDifference(RULE_NOT_THERE, node_set, f"{name} {rule}")
    known = {*there, *(it.node for it in there.values())}
    for name in sorted(started.keys() - known):
        yield LaunchDifference(NOT_OURS, node_set, name)


def _started(facts: Iterable[LaunchFact], paths: Sequence[str]) -> dict[str, frozenset[str]]:
    """Name of each node that the files start -> its rules, without those that change nothing."""
    found: dict[str, frozenset[str]] = {}
    for fact in facts:
        path = f"{fact.package}/{fact.place.path.rpartition('/')[2]}"
        if path not in paths or fact.node.executable in _NO_PART:
            continue
        name = fact.node.name or fact.node.executable.rpartition(":")[2]
        found[name] = found.get(name, frozenset()) | frozenset(_rules(fact.node.remaps))
    return found


def _rules(remaps: str) -> Iterator[str]:
    for rule in remaps.split():
        old, _, new = rule.partition(":=")
        if rule not in _TF and old != new:
            yield rule
