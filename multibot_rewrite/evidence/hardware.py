"""A description -> the interfaces that its ros2_control systems export.

Source: ros2_control hardware_interface component_parser.cpp (``<joint>``, ``<sensor>`` and ``<gpio>``
of a ``<ros2_control>``; an interface is called ``OWNER/INTERFACE``).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.evidence.records import Place

COMMAND, STATE = "command", "state"
OWNERS = ("joint", "sensor", "gpio")


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
                    line: int = it.sourceline or 0  # type: ignore[assignment]
                    yield Exported(kind, name, Place(file, line))
