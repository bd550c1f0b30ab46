# SPDX-License-Identifier: Apache-2.0
"""What only one process can have: by the hardware of a description, and by parameters of nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.bounded import load_yaml, own_text
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.knowledge.parameter_entries import OWN_KINDS
from multibot_rewrite.knowledge.records import Param
from multibot_rewrite.producers import evidence
from multibot_rewrite.producers.evidence.records import Given
from multibot_rewrite.system.records import CALIBRATION, COMPUTER, DEVICE, OWN, Address, Place

_DEVICE = lazy_compile(r"/dev/\S+|v?can\d+")
# Those below are of services of the system.
_FREE_PORTS = 1024
_OFF = ("", "false", "no", "off")
# Of hardware that is not there.
_MOCKS = ("mock_components/", "fake_components/")


def of_hardware(root: _Element, node: str, place: Place) -> Iterator[Address]:
    """The devices of a description; none of a component whose address is nowhere."""
    known, nowhere = _known(), _data()["nowhere"]
    for hardware in root.iterfind("ros2_control/hardware"):
        if (hardware.findtext("plugin") or "").strip().startswith(_MOCKS):
            continue
        params = {it.get("name", ""): (it.text or "").strip() for it in hardware.iterfind("param")}
        found = [
            Address(known[name], name, value, node, place)
            for name, value in params.items()
            if name in known
        ]
        if not any(it.kind == DEVICE and it.value in nowhere for it in found):
            yield from (it for it in dict.fromkeys(found) if it.value not in nowhere)


def of_parameters(
    node: str, params: Mapping[str, Param], values: Mapping[str, Given]
) -> Iterator[Address]:
    """What the parameters of a node name and no other node can have, or none on that computer."""
    for name, given in values.items():
        text = str(given.value).strip()
        known = params.get(name)
        if known and known.kind in OWN_KINDS and text.lower() not in _OFF:
            yield Address(OWN, name, text, node, given.place)
        elif not known and is_held(name, text):
            yield Address(COMPUTER, name, text, node, given.place)


def is_held(name: str, text: str) -> bool:
    """Does a parameter of a node that is not known name what one process of a computer has: a device, a
    port, a file that it writes?"""
    word = name.rpartition(".")[2]
    if _DEVICE.fullmatch(text):
        return True
    if word == "port" or word.endswith("_port"):
        return text.isdecimal() and int(text) >= _FREE_PORTS
    return bool(text) and word in _data()["written"]


def _known() -> Mapping[str, str]:
    kinds = {"address": DEVICE, CALIBRATION: CALIBRATION, COMPUTER: COMPUTER}
    return {name: kind for key, kind in kinds.items() for name in _data()[key]}


@lru_cache
def _data() -> Mapping[str, list[str]]:
    data: Mapping[str, list[str]] = load_yaml(own_text(evidence.__file__, "devices.yaml"))
    return data
