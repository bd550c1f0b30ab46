"""A description -> the interfaces that its ros2_control systems export.

Sources: ros2_control hardware_interface component_parser.cpp (``<joint>``, ``<sensor>`` and ``<gpio>``
of a ``<ros2_control>``; an interface is called ``OWNER/INTERFACE``). What the code of a plugin exports
besides is in ``hardware.yaml``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.evidence.claims import claimed
from multibot_rewrite.evidence.records import Given, Place
from multibot_rewrite.remap.fact_words import SOURCE_KEY
from multibot_rewrite.remap.node_library import read_claims
from multibot_rewrite.remap.records import Claim
from multibot_rewrite.remap.yaml_with_lines import read_yaml_with_lines, table

COMMAND, STATE = "command", "state"
OWNERS = ("joint", "sensor", "gpio")
_TABLE = "hardware.yaml"


class Exported(NamedTuple):
    """An interface of the hardware: command or state, ``joint/position``, and where it is written."""

    kind: str
    name: str
    place: Place


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


def _by_code(hardware: _Element, file: str) -> Iterator[Exported]:
    """What the plugin exports whatever the description names."""
    claims = _plugins().get((hardware.findtext("plugin") or "").strip(), ())
    params = {
        it.get("name", ""): Given((it.text or "").strip(), _place(it, file))
        for it in hardware.iterchildren("param")
    }
    for it in claimed(claims, params):
        yield Exported(it.kind, it.name, it.place or _place(hardware, file))


def _place(element: _Element, file: str) -> Place:
    line: int = element.sourceline or 0  # type: ignore[assignment]
    return Place(file, line)


@lru_cache
def _plugins() -> Mapping[str, tuple[Claim, ...]]:
    text = files("multibot_rewrite.evidence").joinpath(_TABLE).read_text(encoding="utf-8")
    top = table(read_yaml_with_lines(text, _TABLE), _TABLE)
    return {
        name: tuple(read_claims(table(item, name, ("claims", SOURCE_KEY))))
        for name, item in top.items()
    }
