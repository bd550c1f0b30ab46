# SPDX-License-Identifier: Apache-2.0
"""What only one process can have: by the hardware of a description, and by parameters of nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from ipaddress import IPv4Address
from itertools import pairwise

from lxml.etree import _Element

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.description.readback.active import (
    ADDRESS,
    NOWHERE,
    RELATIVE,
    TRANSFORMS_ON,
    hardware_section,
    is_device,
    opened,
    says_what_it_opens,
)
from multibot_rewrite.description.rewriters.plugin_definitions import (
    Definitions,
    PluginDefinition,
    split_path,
    split_step,
)
from multibot_rewrite.knowledge.node_entries import OWN_KINDS
from multibot_rewrite.knowledge.records import Param
from multibot_rewrite.planning.records import Given
from multibot_rewrite.producers import evidence
from multibot_rewrite.system.records import CALIBRATION, COMPUTER, DEVICE, OWN, Address, Place

# Those below are of services of the system.
_FREE_PORTS = 1024
_OFF = ("", "false", "no", "off")


def of_hardware(
    root: _Element, node: str, place: Place, definitions: Definitions, of_networks: bool = False
) -> Iterator[Address]:
    """Yield devices that hardware opens, by its known class or parameter names (or any address)."""
    for system in root.iterfind("ros2_control"):
        section = hardware_section(system, definitions)
        params = system.iterfind("hardware/param")
        values = [(it.get("name", ""), (it.text or "").strip()) for it in params]
        held = [(_known_parameters().get(it[0]) or _kind_of_value(it[1]), *it) for it in values]
        if of_networks:
            held = [(it[0] or (DEVICE if is_of_network(it[2]) else ""), *it[1:]) for it in held]
        if any(kind == DEVICE and text in NOWHERE for kind, _, text in held):
            continue
        if section is not None and says_what_it_opens(section):
            own = [*_opened_by(system, section)]
            held = [*own, *(it for it in held if own and it[0] == CALIBRATION)]
        else:
            held = [it for it in held if it[0] and it[2] not in NOWHERE]
        yield from dict.fromkeys(Address(*it, node, place) for it in held)


def _opened_by(system: _Element, section: PluginDefinition) -> Iterator[tuple[str, str, str]]:
    """Yield (kind, parameter, value) of what a known class of hardware opens."""
    for kind, value, path in opened(system, section):
        if kind not in (RELATIVE, TRANSFORMS_ON):
            label = split_step(split_path(path)[0][-1])[2] or path
            yield DEVICE if kind == ADDRESS else COMPUTER, label, value


def of_parameters(
    node: str, params: Mapping[str, Param], values: Mapping[str, Given]
) -> Iterator[Address]:
    """Yield what a node's parameters name that only it, or only one node of its computer, can have."""
    for name, given in values.items():
        text = str(given.value).strip()
        known = params.get(name)
        if known and known.kind in OWN_KINDS and text.lower() not in _OFF:
            yield Address(OWN, name, text, node, given.place)
        elif not known and (kind := held_by(name, text)):
            yield Address(kind, name, text, node, given.place)


def of_words(node: str, words: Sequence[str], place: Place) -> Iterator[Address]:
    """Yield what a program's arguments name: a device, or what a parameter of a flag's name holds."""
    for flag, word in pairwise(("", *words)):
        name, sign, value = word.partition(":=" if ":=" in word else "=")
        if not sign:
            name, value = flag if flag.startswith("-") else "", word
        label = name.lstrip("-").replace("-", "_")
        if kind := held_by(label, value) if label else _kind_of_value(value):
            yield Address(kind, label, value, node, place)


def held_by(name: str, text: str) -> str:
    """Return the kind of address that a parameter of an unknown node has: device, computer or empty."""
    word = name.rpartition(".")[2]
    if word in _data()["address"]:
        numbered = word.startswith("serial_n") and text not in NOWHERE
        return DEVICE if numbered or is_of_network(text) else _kind_of_value(text)
    if word == "port" or word.endswith("_port"):
        return COMPUTER if text.isdecimal() and int(text) >= _FREE_PORTS else _kind_of_value(text)
    numbered = text.isdecimal() and word in _data()["numbered"]
    opened = numbered or (text and word in _data()["written"])
    return COMPUTER if opened else _kind_of_value(text)


def _kind_of_value(text: str) -> str:
    """Return COMPUTER for the path of a device; otherwise empty."""
    return COMPUTER if is_device(text) else ""


def is_of_network(text: str) -> bool:
    """Return whether a text is the address of another computer, alone or with a port."""
    try:
        it = IPv4Address(text.partition(":")[0])
        return not (it.is_loopback or it.is_unspecified or text.startswith("255."))
    except ValueError:
        return False


def _known_parameters() -> Mapping[str, str]:
    """Return the kind of address by the name of a parameter."""
    kinds = {"address": DEVICE, CALIBRATION: CALIBRATION, COMPUTER: COMPUTER}
    return {name: kind for key, kind in kinds.items() for name in _data()[key]}


@lru_cache
def _data() -> Mapping[str, list[str]]:
    data: Mapping[str, list[str]] = load_own_yaml(evidence.__file__, "devices.yaml")
    return data
