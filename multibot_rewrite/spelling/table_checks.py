# SPDX-License-Identifier: Apache-2.0
"""What a remap table cannot do or does wrongly."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming
from multibot_rewrite.base.rosnames import BoundNode, bind, resolve_bound
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.records import MANAGER, Endpoint, NodeFacts
from multibot_rewrite.knowledge.stacks import every_release
from multibot_rewrite.spelling.of_runs import asked_beside, expanded, parsed, target_of
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import SERVICE, TOPIC

# A stand-in for a second robot: names of a single robot cannot collide.
PROBE = "multibot_probe"
RUN_TIME = "the name is made at run time"

UNREACHABLE_NAME = declare("MR101", "no-rule-reaches-name", WARNING, formats=("remap",))


def unreachable(nodes: Sequence[NodeFacts], naming: Naming) -> Iterator[Finding]:
    """Report names that every robot would share and that no remap rule reaches."""
    for node in nodes:
        for endpoint in node.endpoints:
            reason = endpoint.fixed or (RUN_TIME if "<" in endpoint.name else "")
            # A relative name made at run time follows the namespace.
            if "<" in endpoint.name:
                is_shared = naming.topics != NAMESPACE or endpoint.name.startswith("/")
            else:
                is_shared = bool(target_of(endpoint.name, endpoint.kind, PROBE, naming))
            if reason and not endpoint.when and not endpoint.own and is_shared:
                message = f"no remap rule reaches {endpoint.kind} {endpoint.name}: {reason}"
                parameter = "" if "parameter" in reason else endpoint.parameter
                hint = f"set its parameter {parameter}" if parameter else ""
                yield UNREACHABLE_NAME.finding(message, hint, node=node.name)


RULE_WITHOUT_NAME = declare("MR103", "rule-matches-no-name", WARNING, formats=("remap-urdf",))
LATER_RULE = declare("MR104", "rule-after-first-match", ERROR, formats=("remap-urdf",))


class _Names(NamedTuple):
    """A node without its rules, and the full names that it asks for."""

    bare: BoundNode
    full: frozenset[tuple[str, str]]


def useless_rules(
    runs: Iterable[Run], release: str, controllers: Sequence[Run] | None = ()
) -> Iterator[Finding]:
    """Report rules that match no name of their node, and rules after one that matches first.
    ``controllers`` are those that a plugin hands its rules on to; None if they are not known. A
    description may serve robots with other controllers: a rule for one known in ``release`` is
    right."""
    others = [*map(_names, controllers or ())]
    known = _of_managers(release)
    by_file = any(it.fact.origin.place.line for it in controllers or ())
    for run in runs:
        own, wide, node = _names(run), run.process_wide, run.node
        asked = [own, *(others if wide else ())]
        robot = "" if run.robot == PROBE else run.robot
        seen: set[tuple[str, str]] = set()
        for left, target in run.rules:
            text, (whose, source) = f"{left}:={target}", _split(left)
            match = (whose, resolve_bound(source, TOPIC, own.bare))
            if match in seen:
                message = f"{text} has no effect: an earlier rule matches first"
                yield LATER_RULE.finding(message, "remove it", robot=robot, node=node)
            elif wide and (controllers is None or source.lstrip("/") in TF_TOPICS):
                pass  # the rewrite itself writes those of tf
            elif wide and not whose and _is_for(source, known, by_file):
                pass
            elif not any(_matches(left, it) for it in asked):
                message = f"{text} matches no name of this node"
                yield RULE_WITHOUT_NAME.finding(message, "remove it", robot=robot, node=node)
            seen.add(match)


@cache
def _of_managers(release: str) -> frozenset[str]:
    """Return the names in the code of controller managers and of controllers that get their rules, in
    any release: one description may be for several."""
    handed_on = controller_way(release).of_manager
    every = every_release().nodes.values()
    nodes = [it for it in every if it.name == MANAGER or (handed_on and it.host == MANAGER)]
    return frozenset(end.name for node in nodes for end in node.endpoints)


def _is_for(source: str, known: frozenset[str], by_file: bool) -> bool:
    """Return whether it is a name in a known controller's code, or below a node that may be one."""
    above, slash, _ = source.partition("/")
    below = "" if by_file or not slash or above == "~" else f"~{source[len(above) :]}"
    return source in known or below in known


def _names(run: Run) -> _Names:
    bare = bind(run.name, run.namespace, ())
    # What is known of a controller manager only by its rules proves none of them.
    known = [it for it in run.fact.endpoints if it.role or not run.process_wide]
    asked = {
        (kind, name)
        for endpoint in known
        for kind, source in expanded(endpoint)
        for name in asked_for(source, endpoint, run.namespace)
    }
    full = {(kind, resolve_bound(name, kind, bare)) for kind, name in asked}
    if any(it.beside for it in known):
        bound = bind(run.name, run.namespace, parsed(run.rules))
        full |= {(it.kind, asked_beside(it, bound)) for it in known if it.beside}
    return _Names(bare, frozenset(full))


def asked_for(name: str, endpoint: Endpoint, namespace: str) -> tuple[str, ...]:
    """Return a name in a node's code, and the name below the namespace above its own."""
    above = namespace.rpartition("/")[0]
    return (name, f"{above}/{name.lstrip('/')}") if endpoint.above and above else (name,)


def _matches(left: str, names: _Names) -> bool:
    whose, source = _split(left)
    if whose not in ("", names.bare.node):
        return False
    match = resolve_bound(source, TOPIC, names.bare)
    return not names.full.isdisjoint((kind, match) for kind in (TOPIC, SERVICE))


def _split(source: str) -> tuple[str, str]:
    """Return the node in the left side of a rule, and the name."""
    whose, colon, name = source.rpartition(":")
    return (whose, name) if colon else ("", source)
