# SPDX-License-Identifier: Apache-2.0
"""Nodes that a robot's own files leave idle: without a lifecycle manager or a joint.

The rules are those of ``check-launch``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.knowledge.programs import LIFECYCLE_MANAGER
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.rules.declaration import at
from multibot_rewrite.rules.launch.started import (
    bond_message,
    is_managed,
    keeps_no_bond,
    moves_nothing,
    no_joints,
    not_listed,
)


def left_idle(
    nodes: Sequence[NodeFacts], given: Iterable[Run], known: Mapping[str, NodeFacts]
) -> Iterator[Finding]:
    """Yield what starts and does nothing, by the robot's own parameter files."""
    own = {it.node: it for it in given}
    yield from _unlisted(nodes, own)
    yield from _without_bond(nodes, own)
    running = {it.name for it in nodes if not it.when}
    for it in own.values():
        facts = known.get(it.fact.known)
        if it.host_name and it.node in running and facts and moves_nothing(facts, it):
            message = f"controller {it.node} gets no parameter that names a joint"
            yield at(
                no_joints, it.place, message, "write them into a section of its name", level=WARNING
            )


def _unlisted(nodes: Sequence[NodeFacts], own: Mapping[str, Run]) -> Iterator[Finding]:
    """Report managed nodes that no lifecycle manager lists, if a file has the list."""
    managers = [it for it in nodes if it.kind == LIFECYCLE_MANAGER]
    place = next((own[it.name].place for it in managers if it.name in own), None)
    listed = _listed_nodes(managers)
    for it in nodes if place else ():
        idle = is_managed(it.kind) and it.name not in listed and not (it.when or it.shared)
        if idle and place:
            message = f"{it.name} is in the list of no lifecycle manager"
            yield at(not_listed, place, message, "add it to node_names", level=WARNING)


def _without_bond(nodes: Sequence[NodeFacts], own: Mapping[str, Run]) -> Iterator[Finding]:
    """Report nodes that keep no bond with the manager that lists them, if a file has the list."""
    for manager in (it for it in nodes if it.kind == LIFECYCLE_MANAGER and it.name in own):
        given, listed = own[manager.name], _listed_nodes([manager])
        timeout = given.values.get("bond_timeout")
        for it in nodes if timeout is None or timeout.value != 0 else ():
            if it.name in listed and keeps_no_bond(it):
                said = bond_message(manager.name, it.name)
                yield at(not_listed, given.place, *said, level=WARNING)


def _listed_nodes(managers: Sequence[NodeFacts]) -> Set[str]:
    """Return the nodes whose services managers call."""
    return {end.name.strip("/").partition("/")[0] for it in managers for end in it.endpoints}
