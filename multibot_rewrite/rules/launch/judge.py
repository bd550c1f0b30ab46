# SPDX-License-Identifier: Apache-2.0
"""A launch -> what the rules for launch files find in it, in the order of the codes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding, Rule
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.models import Model
from multibot_rewrite.producers.launch.running import DESCRIPTION
from multibot_rewrite.rules.launch import models, started, words as rules_of_words
from multibot_rewrite.rules.system.planned_nodes import missing_node
from multibot_rewrite.rules.system.states import interface_claimed_twice, interface_not_exported
from multibot_rewrite.rules.system.tf_pieces import is_sure, tf_tree_in_pieces
from multibot_rewrite.rules.system.unsent import FOR_DRIVERS, is_for_driver
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import System

CLAIMS = (interface_not_exported.code, interface_claimed_twice.code)
_LEFT = "no node of its node set or file is started here: name the launch file that does, too"
MODULES = (models, started, rules_of_words)


_DECLARED = (it for module in MODULES for it in vars(module).values() if isinstance(it, Rule))
RULES = tuple(sorted(_DECLARED, key=lambda it: it.code))


def as_sure(it: Finding, launched: Launched, seen: Index) -> Finding:
    """Return a finding about a launch at its certain level.

    An unmet claim becomes an error, and what the driver of a real robot may send a note."""
    if it.code in CLAIMS and it.level == WARNING:
        return it._replace(level=ERROR)
    if it.code not in FOR_DRIVERS or it.level not in (ERROR, WARNING):
        return it
    own = _models_of(it, launched, seen)
    cut = it.code == tf_tree_in_pieces.code
    if cut and is_sure(seen, it, any(_moves_itself(one, launched, seen) for one in own)):
        return it
    if not own and is_for_driver(seen, it):
        return it._replace(level=NOTE)
    return it._replace(level=WARNING) if cut else it


def _models_of(it: Finding, launched: Launched, seen: Index) -> list[Model]:
    """Return the spawned models that may be the robot whose frames a finding names."""
    models = [one for one in launched.models.found if one.spawned]
    edges = (one for one in seen.system.edges if not {one.parent, one.child}.isdisjoint(it.names))
    senders = [name for one in edges for name in one.publishers]
    # Each robot may have a tree with the same frames.
    senders = [name for name in senders if seen.robot(name) == it.robot] or senders
    published = {one.full_name: one.value(DESCRIPTION) for one in launched.nodes}
    own = {text for name in senders if (text := published.get(name))}
    found = [one for one in models if one.text in own]
    return found or [one for one in models if not own or one.text not in published.values()]


def _moves_itself(model: Model, launched: Launched, seen: Index) -> bool:
    """Return whether a model has a plugin that takes velocities, sends odometry or has controllers."""
    nodes = model.reading.nodes
    inside = (one for it in launched.simulated if it.text == model.text for one in it.topics)
    orders = [(f"/{one.ros.lstrip('/')}", one.ros_type) for one in inside]
    orders += [(end.name, end.type) for it in nodes for end in it.endpoints]
    if any(it.manager or it.sends for it in nodes):
        return True
    return any(words.moves(seen.plain(name), type_) for name, type_ in orders)


def as_one_of_several(found: Iterable[Finding], plan: System, seen: System) -> Iterator[Finding]:
    """Yield the findings; a missing node is inconclusive if another launch file may start it."""
    sources = {it.name: it.node_set or it.place.file for it in plan.nodes}
    begun = {"", *(sources.get(it.name, "") for it in seen.nodes)}
    for it in found:
        is_left = it.code == missing_node.code and _source_of_node(it.node, sources) not in begun
        yield it._replace(level=INCONCLUSIVE, hint=_LEFT) if is_left else it


def _source_of_node(node: str, sources: Mapping[str, str]) -> str:
    """Return the node set or file of a planned node, or of the node that makes it for itself."""
    if source := sources.get(node, ""):
        return source
    makers = (it for it in sources if it != node and node.startswith(it))
    return sources.get(max(makers, key=len, default=""), "")


def placed(findings: Iterable[Finding], launched: Launched, seen: Index) -> Iterator[Finding]:
    """Yield findings about a system where the launch file starts the nodes that they are about."""
    system, nodes = launched.system, {it.full_name: it.place for it in launched.nodes}
    for it in findings:
        robots = [name for name in nodes if it.robot and it.robot == seen.robot(name)]
        ends = (end.node for end in system.ends if end.name in it.names)
        edges = (edge.publishers for edge in system.edges if edge.child in it.names)
        about = chain((it.node,), ends, *edges, robots)
        place = None if it.file else next((nodes[name] for name in about if name in nodes), None)
        if place is None or not place.file:
            yield it
            continue
        hint = f"{it.hint}; started at {place}" if it.hint else f"started at {place}"
        line, column = place.line, place.column or 1
        yield it._replace(file=place.file, line=line, column=column, hint=hint)


def judge_launch(launched: Launched) -> list[Finding]:
    """Return what is wrong with what a launch file starts; empty if nothing is."""
    return [it for rule in RULES if rule.check for it in rule.check(launched)]
