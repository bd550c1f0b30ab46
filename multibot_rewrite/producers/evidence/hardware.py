# SPDX-License-Identifier: Apache-2.0
"""The interfaces that a description's hardware exports and its controllers claim, and its nodes.

Sources: ros2_control hardware_interface component_parser.cpp (``<joint>``, ``<sensor>`` and ``<gpio>``
of a ``<ros2_control>``; an interface is called ``OWNER/INTERFACE``). What the code of a plugin exports
besides, and the nodes that it makes, are in ``hardware.yaml``.

What a controller claims is a template in its node's table: a name with parameters in <>.
``<joints>/<command_interfaces>`` is every joint with every interface. ``<a|b>`` is the first of
them that is set, ``<a=x>`` is ``x`` where it is not, ``<a+_>`` is its value and ``_``. ``[0..17]``
counts, ``[x,y]`` is each word. ``{a}`` in the name of a parameter, or in the condition, is replaced as
``<a>`` is. A parameter that is not set and has no default makes no name. ``<type>`` is the type of the
controller."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.knowledge.conditions import Values, holds
from multibot_rewrite.knowledge.node_entries import read_claims
from multibot_rewrite.knowledge.records import MANAGER, Claim, NodeFacts
from multibot_rewrite.knowledge.yaml_with_lines import (
    SOURCE_KEY,
    read_yaml_with_lines,
    table,
    table_of,
    word,
)
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.system.records import (
    CLAIMS,
    EXPORTS,
    HARDWARE_NODE,
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
    """Yield the interfaces of every ros2_control system of a description."""
    for system in root.iter("ros2_control"):
        for owner in system.iterchildren(*OWNERS):
            for kind in (COMMAND, STATE):
                for it in owner.iterchildren(f"{kind}_interface"):
                    name = f"{owner.get('name', '')}/{it.get('name', '')}"
                    yield Exported(kind, name, _place(it, file))
        for hardware in system.iterchildren("hardware"):
            # What the plugin exports whatever the description names.
            plugin = _plugin(hardware)
            claims = plugin.claims if plugin else ()
            params = {
                one.get("name", ""): Given((one.text or "").strip(), _place(one, file))
                for one in hardware.iterchildren("param")
            }
            for one in claimed(claims, params):
                yield Exported(one.kind, one.name, one.place or _place(hardware, file))


def with_hardware(
    nodes: Iterable[NodeFacts], root: _Element, file: str, known: Mapping[str, NodeFacts]
) -> tuple[NodeFacts, ...]:
    """Return a robot's nodes and, if a controller manager is among them, those of its hardware."""
    own = tuple(nodes)
    manager = next((it for it in own if MANAGER in (it.name, it.known)), None)
    if manager is None:
        return own
    when = manager.when
    made = []
    for hardware in root.iterfind("ros2_control/hardware"):
        plugin, origin = _plugin(hardware), Origin(place=_place(hardware, file))
        for name, kind in plugin.nodes.items() if plugin else ():
            node = known[kind]._replace(name=name, known=kind, origin=origin, when=when)
            made.append(node._replace(of_hardware=True))
    return (*own, *made)


def components(root: _Element, file: str, known: Mapping[str, NodeFacts]) -> Iterator[NodeFacts]:
    """Yield the node of each hardware component, if any (hardware_component_interface.cpp)."""
    entry = known.get(HARDWARE_NODE)
    if entry is None:
        return
    for system in root.iterfind("ros2_control[hardware]"):
        name = system.get("name", "").lower().replace("/", "_")
        origin = Origin(place=_place(system, file))
        yield entry._replace(name=name, known=HARDWARE_NODE, origin=origin, of_hardware=True)


def _place(element: _Element, file: str) -> Place:
    line: int = element.sourceline or 0  # type: ignore[assignment]
    return Place(file, line)


def _plugin(hardware: _Element) -> _Plugin | None:
    """Return what is known of a hardware plugin; None for an unknown one."""
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
    """Return the controllers in files, and all interfaces; ``active``: started so by launch files."""
    declared = [it for it in given if it.host_name]
    own = [Interface(it.kind, it.name, f"/{MANAGER}", EXPORTS, it.place) for it in exports]
    controllers = []
    for it in declared:
        node, is_active = known.get(it.fact.known), it.node in active
        rows = node.claims if node else ()
        # What a controller claims, and once more what two of its parameters name.
        claims = [*claims_of(rows, it), *(twice for twice, _ in claimed_twice(rows, it))]
        for one in claims:
            place = one.place or it.place
            own.append(Interface(one.kind, one.name, f"/{it.node}", CLAIMS, place))
        commands = tuple(one.name for one in claims if one.kind == COMMAND) * is_active
        name, state = it.node.rpartition("/")[2], ACTIVE if is_active else ""
        controllers.append(Controller(f"/{it.host_name}", name, state, commands))
    return System(controllers=tuple(controllers), interfaces=tuple(own))


TYPE, COMMAND = "type", "command"
_PART = lazy_compile(
    r"<(?P<names>[^<>=+]+)(?:\+(?P<after>[^<>=]*))?(?P<default>=[^<>]*)?>"
    r"|\[(?P<first>\d+)\.\.(?P<last>\d+)\]|\[(?P<words>[^\[\]]+)\]"
)


class Claimed(NamedTuple):
    """A command or state interface that a controller claims; ``place`` is None for a default's."""

    kind: str
    name: str
    place: Place | None


class _Made(NamedTuple):
    """The beginning of a name, the condition with what was chosen, and where that is written."""

    text: str
    condition: str
    place: Place | None


def claims_of(claims: Iterable[Claim], node: Run) -> Iterator[Claimed]:
    """Yield the interfaces that a controller claims with its parameters, each once."""
    yield from claimed(claims, {**node.values, TYPE: Given(node.program, node.place)})


def claimed(claims: Iterable[Claim], values: Mapping[str, Given]) -> Iterator[Claimed]:
    """Yield the interfaces that these claims make with these parameters, each once."""
    found: dict[tuple[str, str], Claimed] = {}
    for claim in claims:
        for made in _filled_templates(claim.template, _Made("", claim.condition, None), values):
            if made.text and holds(made.condition, _lookup(values)):
                it = Claimed(claim.kind, made.text, made.place)
                found.setdefault((it.kind, it.name), it)
    yield from found.values()


def claimed_twice(claims: Iterable[Claim], node: Run) -> Iterator[tuple[Claimed, Place]]:
    """Yield (command interface, place of the first claim) that two parameters of a controller claim."""
    values, first = {**node.values, TYPE: Given(node.program, node.place)}, dict[str, Place]()
    for claim in (it for it in claims if it.kind == COMMAND):
        for made in _filled_templates(claim.template, _Made("", claim.condition, None), values):
            if made.place and holds(made.condition, _lookup(values)):
                other = first.setdefault(made.text, made.place)
                if other != made.place:
                    yield Claimed(claim.kind, made.text, made.place), other


def _lookup(values: Mapping[str, Given]) -> Values:
    """Return a function that finds the value of a parameter; it gives None for one that is not set."""
    return lambda name: values[name].value if name in values else None


def _filled_templates(template: str, made: _Made, values: Mapping[str, Given]) -> Iterator[_Made]:
    """Yield the names that a template makes with these parameters."""
    part = _PART.search(template)
    if part is None:
        yield made._replace(text=made.text + template)
        return
    slot, before, rest = f"{{{part['names']}}}", template[: part.start()], template[part.end() :]
    for chosen, place in _choices(part, values):
        text = f"{made.text}{before}{chosen}{(part['after'] or '') if chosen else ''}"
        found = _Made(text, made.condition.replace(slot, chosen), made.place or place)
        yield from _filled_templates(rest.replace(slot, chosen), found, values)


def _choices(
    part: re.Match[str], values: Mapping[str, Given]
) -> Iterator[tuple[str, Place | None]]:
    """Yield (value, where it is written) for one place of a template."""
    if part["words"]:
        yield from ((it, None) for it in part["words"].split(","))
        return
    if not part["names"]:
        yield from ((f"{it}", None) for it in range(int(part["first"]), int(part["last"]) + 1))
        return
    named = (values[it] for it in part["names"].split("|") if it in values)
    given = next((it for it in named if it.value not in ("", [])), None)
    if given is not None:
        many = given.value if isinstance(given.value, list) else [given.value]
        yield from ((str(it), given.place) for it in many)
    elif part["default"] is not None:
        empty = next((values[it] for it in part["names"].split("|") if it in values), None)
        # An empty text in a file is the value; an empty list makes no name.
        words = part["default"][1:].split(",") if empty is None else [""] * (empty.value == "")
        yield from ((it, None) for it in words)
