"""The interfaces that controllers claim, against those that the hardware exports.

Sources: ros2_control controller_manager.cpp (a controller whose interfaces do not exist is not
activated) and its chaining: a controller's own interfaces are called ``CONTROLLER/...``.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.evidence.claims import Claimed, claimed_twice, claims_of
from multibot_rewrite.evidence.hardware import COMMAND, Exported
from multibot_rewrite.evidence.records import GivenNode
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.nearest import Guesses
from multibot_rewrite.system.conventions import PLACEHOLDER
from multibot_rewrite.system.records import Place

INTERFACE, TWICE, CONTESTED = "interface", "claimed twice", "contested"


def interface_gaps(
    given: Sequence[GivenNode], known: Mapping[str, NodeFacts], exports: Sequence[Exported]
) -> Iterator[Gap]:
    """What the controllers of a robot claim and its hardware lacks.

    Nothing is said where the description has no ros2_control system: another one may have it.
    """
    if not exports:
        return
    controllers = [it for it in given if it.manager]
    own = [it.name.rpartition("/")[2] for it in controllers]
    places = {(it.kind, it.name): it.place for it in exports}
    hints = Guesses()
    for at, controller in enumerate(controllers):
        for number, it in enumerate(_claims(controller, known)):
            # Launch files fill in placeholders such as <namespace>.
            filled = not PLACEHOLDER.search(it.name)
            # A controller chains to another one; its own name may be that of a sensor.
            chained = it.name.partition("/")[0] in (*own[:at], *own[at + 1 :])
            if (it.kind, it.name) in places or chained or not filled:
                continue
            near = hints.nearest(it.name, _names(exports, it.kind))
            key = (INTERFACE, str(at), it.kind, str(number))
            where = it.place or controller.place
            name = f"{it.kind} interface {it.name}"
            there = places.get((it.kind, near)) or _beside(it.name, exports)
            yield Gap(INTERFACE, name, controller.name, key, where, near, there)


def _beside(name: str, exports: Iterable[Exported]) -> Place | None:
    """Where another interface of the same joint, sensor or gpio is."""
    owner = name.rpartition("/")[0]
    return next((it.place for it in exports if it.name.rpartition("/")[0] == owner), None)


def claims_any(
    given: Iterable[GivenNode], known: Mapping[str, NodeFacts], exports: Iterable[Exported]
) -> bool:
    """Do the controllers claim an interface of this hardware? Else they are for another robot."""
    there = {(it.kind, it.name) for it in exports}
    return any((it.kind, it.name) in there for one in given for it in _claims(one, known))


def contested_gaps(
    given: Iterable[GivenNode], known: Mapping[str, NodeFacts], active: Collection[str]
) -> Iterator[Gap]:
    """Command interfaces that two controllers claim which are both ``active``: the first of each pair.

    ``name`` is the interface, ``near`` the controller that claims it first.
    """
    first: dict[tuple[str, str], tuple[GivenNode, Place]] = {}
    for it in (it for it in given if it.manager and it.name in active):
        against = set()
        for claim in (claim for claim in _claims(it, known) if claim.kind == COMMAND):
            other, where = first.setdefault((it.manager, claim.name), (it, claim.place or it.place))
            if other is not it and other.name not in against:
                against.add(other.name)
                key = (CONTESTED, it.name, other.name)
                place = claim.place or it.place
                yield Gap(CONTESTED, claim.name, it.name, key, place, other.name, where)


def twice_gaps(given: Sequence[GivenNode], known: Mapping[str, NodeFacts]) -> Iterator[Gap]:
    """Command interfaces that a controller claims by two of its parameters: it is not activated."""
    for it in (it for it in given if it.manager and it.known in known):
        for claim, first in claimed_twice(known[it.known].claims, it):
            key = (TWICE, it.known, claim.name)
            yield Gap(TWICE, claim.name, it.name, key, claim.place, "", first)


def _claims(controller: GivenNode, known: Mapping[str, NodeFacts]) -> Iterator[Claimed]:
    node = known.get(controller.known)
    yield from claims_of(node.claims, controller) if node else ()


def _names(exports: Iterable[Exported], kind: str) -> list[str]:
    return [it.name for it in exports if it.kind == kind]
