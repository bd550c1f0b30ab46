# SPDX-License-Identifier: Apache-2.0
"""A description -> the interfaces that its ros2_control systems export and its controllers claim, and
the nodes of its hardware.

Sources: ros2_control hardware_interface component_parser.cpp (``<joint>``, ``<sensor>`` and ``<gpio>``
of a ``<ros2_control>``; an interface is called ``OWNER/INTERFACE``). What the code of a plugin exports
besides, and the nodes that it makes, are in ``hardware.yaml``.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.knowledge.node_entries import read_claims
from multibot_rewrite.knowledge.records import MANAGER, Claim, NodeFacts
from multibot_rewrite.knowledge.yaml_with_lines import (
    SOURCE_KEY,
    read_yaml_with_lines,
    table,
    table_of,
    word,
)
from multibot_rewrite.producers.evidence.claims import (
    COMMAND,
    Claimed,
    claimed,
    claimed_twice,
    claims_of,
)
from multibot_rewrite.spelling.records import Given, Run
from multibot_rewrite.system.records import (
    CLAIMS,
    EXPORTS,
    STATE,
    Controller,
    Interface,
    Origin,
    Place,
    System,
)

OWNERS = ("joint", "sensor", "gpio")
_TABLE = "hardware.yaml"


class Exported(NamedTuple):
    """An interface of the hardware: command or state, ``joint/position``, and where it is written."""

    kind: str
    name: str
    place: Place


class _Plugin(NamedTuple):
    """What the code of a plugin exports, and the nodes that it makes: name -> known node."""

    claims: tuple[Claim, ...]
    nodes: Mapping[str, str]


def exported(root: _Element, file: str) -> Iterator[Exported]:
    """The interfaces of every ros2_control system of a description."""
    for system in root.iter("ros2_control"):
        for owner in system.iterchildren(*OWNERS):
            for kind in (COMMAND, STATE):
                for it in owner.iterchildren(f"{kind}_interface"):
                    name = f"{owner.get('name', '')}/{it.get('name', '')}"
                    yield Exported(kind, name, _place(it, file))
        for hardware in system.iterchildren("hardware"):
            yield from _by_code(hardware, file)


def with_hardware(
    nodes: Iterable[NodeFacts], root: _Element, file: str, known: Mapping[str, NodeFacts]
) -> tuple[NodeFacts, ...]:
    """The nodes of a robot and, beside its controller manager, those that its hardware makes.

    ``known`` are the known nodes by name.
    """
    own = tuple(nodes)
    manager = next((it for it in own if MANAGER in (it.name, it.known)), None)
    if manager is None:
        return own
    when = manager.when
    made = (
        known[kind]._replace(name=name, known=kind, origin=it, when=when, of_hardware=True)
        for name, kind, it in _hardware_nodes(root, file)
    )
    return (*own, *made)


def _hardware_nodes(root: _Element, file: str) -> Iterator[tuple[str, str, Origin]]:
    for hardware in root.iterfind("ros2_control/hardware"):
        plugin = _plugin(hardware)
        for name, kind in plugin.nodes.items() if plugin else ():
            yield name, kind, Origin(place=_place(hardware, file))


def _by_code(hardware: _Element, file: str) -> Iterator[Exported]:
    """What the plugin exports whatever the description names."""
    plugin = _plugin(hardware)
    claims = plugin.claims if plugin else ()
    params = {
        it.get("name", ""): Given((it.text or "").strip(), _place(it, file))
        for it in hardware.iterchildren("param")
    }
    for it in claimed(claims, params):
        yield Exported(it.kind, it.name, it.place or _place(hardware, file))


def _place(element: _Element, file: str) -> Place:
    line: int = element.sourceline or 0  # type: ignore[assignment]
    return Place(file, line)


def _plugin(hardware: _Element) -> _Plugin | None:
    return _plugins().get((hardware.findtext("plugin") or "").strip())


@lru_cache
def _plugins() -> Mapping[str, _Plugin]:
    text = own_text(__file__, _TABLE)
    top = table(read_yaml_with_lines(text, _TABLE), _TABLE)
    found = {name: table(item, name, ("claims", "nodes", SOURCE_KEY)) for name, item in top.items()}
    return {
        name: _Plugin(
            tuple(read_claims(keys)),
            {node: word(kind, node) for node, kind in table_of(keys, "nodes").items()},
        )
        for name, keys in found.items()
    }


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
