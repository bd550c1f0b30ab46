# SPDX-License-Identifier: Apache-2.0
"""The interfaces of ros2_control that the hardware of a description exports and controllers claim."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.knowledge.records import MANAGER, NodeFacts
from multibot_rewrite.producers.evidence.claims import COMMAND, Claimed, claimed_twice, claims_of
from multibot_rewrite.producers.evidence.hardware import Exported
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import CLAIMS, EXPORTS, Controller, Interface, System

ACTIVE = "active"


def control_system(
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
    exports: Iterable[Exported],
    active: Collection[str] = (),
) -> System:
    """The controllers that files declare, and all interfaces; ``active`` are those that launch files
    start so."""
    declared = [it for it in given if it.host_name]
    own = [Interface(it.kind, it.name, f"/{MANAGER}", EXPORTS, it.place) for it in exports]
    for it in declared:
        own += (_claim(claim, it) for claim in _claims(it, known))
    return System(
        controllers=tuple(_controller(it, known, active) for it in declared),
        interfaces=tuple(own),
    )


def _controller(it: Run, known: Mapping[str, NodeFacts], active: Collection[str]) -> Controller:
    claims = (claim.name for claim in _claims(it, known) if claim.kind == COMMAND)
    is_active = it.node in active
    name = it.node.rpartition("/")[2]
    return Controller(
        f"/{it.host_name}", name, ACTIVE if is_active else "", tuple(claims) * is_active
    )


def _claims(it: Run, known: Mapping[str, NodeFacts]) -> Iterator[Claimed]:
    """What a controller claims, and once more what two of its parameters name."""
    node = known.get(it.fact.known)
    if node is not None:
        yield from claims_of(node.claims, it)
        yield from (claim for claim, _ in claimed_twice(node.claims, it))


def _claim(claim: Claimed, it: Run) -> Interface:
    return Interface(claim.kind, claim.name, f"/{it.node}", CLAIMS, claim.place or it.place)
